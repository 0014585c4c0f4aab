//! Systems of many platforms: matrices by their entries, and how they are solved.
//!
//! A platform is coupled with those that it shares limbs with and with no other. Systems of more
//! than [`FEW`] platforms are eliminated block by block in an order that keeps this so; where a rank
//! must be decided, and for few platforms, [`Saddle`] decides on the dense matrix.

use nalgebra::DMatrix;

use crate::linalg::block_elimination::{BlockFactors, FEW, Pivots};
use crate::linalg::saddle::Saddle;
use crate::linalg::sparse::Sparse;
use crate::model::chain::Scale;
use crate::number::larger;

/// Motions of the platforms that limbs forbid, as rows over all of them, `k x 6P`.
#[derive(Clone, Debug)]
pub(crate) struct RigidRows {
    pub matrix: Sparse,
    /// The moving platform (from 0) at the tip of every row's limb.
    pub platform: Vec<usize>,
}

impl RigidRows {
    /// Empty rows, for a number of moving platforms.
    pub fn none(moving: usize) -> Self {
        Self {
            matrix: Sparse::zeros(0, 6 * moving),
            platform: Vec::new(),
        }
    }

    pub fn count(&self) -> usize {
        self.platform.len()
    }

    /// New rows of a limb whose tip is on a moving platform (from 0); their first index.
    pub fn grow(&mut self, platform: usize, count: usize) -> usize {
        let first = self.count();
        self.platform.resize(first + count, platform);
        self.matrix.rows = first + count;
        first
    }
}

/// Motions of a platform in units of the square root of energy.
pub(crate) fn motion_units(count: usize, scale: Scale) -> Vec<f64> {
    let root = scale.stiffness.sqrt();
    let unit = |i: usize| {
        if i % 6 < 3 {
            1.0 / root
        } else {
            1.0 / (root * scale.length)
        }
    };
    (0..count).map(unit).collect()
}

/// A square system over the motions of the platforms and the wrenches that limbs carry rigidly.
#[derive(Clone, Debug)]
pub(crate) struct PlatformSystem {
    pub matrix: Sparse,
    /// Units of rows and columns.
    pub units: Vec<f64>,
    /// Platform that every unknown belongs to.
    pub nodes: Vec<usize>,
}

impl PlatformSystem {
    /// `[K 0; 0 0]`, room for the constraints; their units make them the size of the stiffest
    /// direction, so that none is lost in rounding.
    fn sized(stiffness: Sparse, rigid: &RigidRows, scale: Scale) -> Self {
        let size = stiffness.rows;
        let mut units = motion_units(size, scale);
        if rigid.count() > 0 {
            let diagonal = stiffness.diagonal();
            let stiffest = diagonal
                .iter()
                .zip(&units)
                .map(|(d, u)| d.abs() * u * u)
                .fold(1.0, larger);
            let mut sizes = vec![0.0; rigid.count()];
            for &(i, j, value) in &rigid.matrix.entries {
                sizes[i] += (value * units[j]).powi(2);
            }
            units.extend(sizes.into_iter().map(|square: f64| {
                if square > 0.0 {
                    stiffest / square.sqrt()
                } else {
                    1.0
                }
            }));
        }
        let mut nodes: Vec<usize> = (0..size).map(|i| i / 6).collect();
        nodes.extend(&rigid.platform);
        let mut matrix = stiffness;
        (matrix.rows, matrix.columns) = (units.len(), units.len());
        Self {
            matrix,
            units,
            nodes,
        }
    }

    /// `[K N^T; N 0]`.
    pub fn new(stiffness: Sparse, rigid: &RigidRows, scale: Scale) -> Self {
        Self::with_reactions(stiffness, rigid, rigid, &rigid.matrix, scale)
    }

    /// `[K M^T; N 0]`: conditions `N` and the motions `M` on which their wrenches work; `sizes` are
    /// the rows by which the units are chosen.
    pub fn with_reactions(
        stiffness: Sparse,
        sizes: &RigidRows,
        rows: &RigidRows,
        reactions: &Sparse,
        scale: Scale,
    ) -> Self {
        let size = stiffness.rows;
        let mut system = Self::sized(stiffness, sizes, scale);
        let entries = &mut system.matrix.entries;
        entries.extend(
            rows.matrix
                .entries
                .iter()
                .map(|&(i, j, v)| (size + i, j, v)),
        );
        entries.extend(reactions.entries.iter().map(|&(i, j, v)| (j, size + i, v)));
        system
    }

    /// The system without the unknowns and rows of one platform's motion, which then are zero.
    pub fn holding(mut self, platform: usize) -> Self {
        let own = 6 * platform..6 * platform + 6;
        self.matrix
            .entries
            .retain(|(i, j, _)| !own.contains(i) && !own.contains(j));
        self
    }

    /// Block factors where they decide the rank for certain: a system that is regular.
    pub fn factors(&self, pivots: Pivots) -> Option<BlockFactors> {
        let platforms = self.nodes.iter().max().map_or(0, |most| most + 1);
        if platforms <= FEW {
            return None;
        }
        BlockFactors::new(&self.matrix, &self.nodes, &self.units, pivots)
    }

    /// Solves for all columns of `b`, in place; the shortest solution where the system is singular.
    pub fn solve(&self, b: &mut DMatrix<f64>) {
        match self.factors(Pivots::Any) {
            Some(factors) => factors.solve(b),
            None => Saddle::new(self.matrix.dense(), &self.units, &self.units).solve(b),
        }
    }
}

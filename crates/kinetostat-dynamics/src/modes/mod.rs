//! Modes about the loaded equilibrium: signed frequencies, shapes, and what takes part in them.

pub(crate) mod complex;
pub(crate) mod mode;
pub(crate) mod pencil;
pub(crate) mod quadratic;

use nalgebra::{DMatrix, DVector, Matrix6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;

pub use mode::{EnergyShare, Mode, ModeKind};

/// Numbers of directions of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct DirectionCounts {
    /// Modes that vibrate.
    pub vibrating: usize,
    /// Mass without stiffness: frequency zero.
    pub free: usize,
    /// Negative stiffness.
    pub unstable: usize,
    /// Stiffness without mass: they follow at once, and have no mode.
    pub massless: usize,
    /// Massless directions of negative stiffness: no frequency tells of them, yet the equilibrium does not hold.
    pub massless_unstable: usize,
    /// Neither mass nor stiffness, such as the spin of a slender strut between two ball joints.
    pub neutral: usize,
    /// Motions of the tool that the machine cannot make, of six.
    pub rigid: usize,
}

/// All modes of a machine about an equilibrium.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Modes {
    /// Modes by ascending `w^2`: unstable ones first, then free ones.
    pub modes: Vec<Mode>,
    /// Directions of each kind.
    pub counts: DirectionCounts,
    /// Names of the joints and springs that take part in neutral directions.
    pub neutral: Vec<String>,
}

impl Modes {
    /// Signed frequencies, Hz, ascending.
    #[must_use]
    pub fn frequencies_hz(&self) -> Vec<f64> {
        self.modes.iter().map(Mode::frequency_hz).collect()
    }

    /// True if no mode and no massless direction diverges; free directions are allowed. For loads with a potential.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.counts.unstable == 0 && self.counts.massless_unstable == 0
    }
}

/// Below this share of the stiffnesses that act in a mode, what is left of them is rounding.
const NOTHING: f64 = 1e-11;

/// Kind of a mode, and its `w^2`, set to zero where it is rounding: `size` is the magnitude of the stiffnesses in the
/// mode, `shift` was added to find it.
pub(crate) fn kind_of(squared: f64, size: f64, shift: f64) -> (ModeKind, f64) {
    if squared.abs() <= NOTHING * size + 1e-12 * shift {
        return (ModeKind::Free, 0.0);
    }
    match squared > 0.0 {
        true => (ModeKind::Vibration, squared),
        false => (ModeKind::Unstable, squared),
    }
}

/// Motions of the tool that no coordinate makes, by the sum of the products of all that are made, in natural units; `most`
/// is the largest of these before anything cancels.
pub(crate) fn rigid_of(gram: &Matrix6<f64>, most: f64) -> usize {
    let values = gram.symmetric_eigenvalues();
    // Squares: a ten-millionth of the largest motion is none.
    values.iter().filter(|v| **v <= 1e-14 * most).count()
}

impl DirectionCounts {
    /// Counts the lowest modes, all unstable and free ones among them, out of `all`.
    pub(crate) fn of(lowest: &[Mode], all: usize) -> Self {
        let of = |kind| lowest.iter().filter(|m| m.kind == kind).count();
        let (free, unstable) = (of(ModeKind::Free), of(ModeKind::Unstable));
        Self {
            vibrating: all - free - unstable,
            free,
            unstable,
            ..Self::default()
        }
    }
}

impl LinearDynamics {
    /// Modes without damping; of the symmetric part of `K - H`. Where loads have no potential
    /// ([`Self::is_circulatory`]) see [`Self::complex_modes`].
    ///
    /// # Errors
    /// [`Error::NotSolved`] where the matrices are no numbers or no shift makes them definite.
    pub fn modes(&self) -> Result<Modes> {
        let scaled = |a: &DMatrix<f64>| {
            let u = &self.units;
            DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| {
                0.5 * (a[(i, j)] + a[(j, i)]) * u[i] * u[j]
            })
        };
        let (mass, tangent) = (scaled(&self.mass), scaled(&self.tangent));
        let solved = pencil::solve(&mass, &tangent).ok_or_else(|| {
            Error::NotSolved(format!(
                "the modes of '{}' were not found: mass or stiffness is no number",
                self.name
            ))
        })?;
        let sizes = tangent.abs();
        let mut modes = Vec::with_capacity(solved.squared.len());
        for (k, &squared) in solved.squared.iter().enumerate() {
            let scaled = solved.shapes.column(k);
            let size = scaled.abs().dot(&(&sizes * scaled.abs()));
            let (kind, squared) = kind_of(squared, size, solved.shift);
            let shape = DVector::from_fn(scaled.len(), |i, _| scaled[i] * self.units[i]);
            let tool = self.motion_at(self.tool, &shape);
            modes.push(Mode {
                squared,
                kind,
                shape,
                tool,
            });
        }
        modes.sort_by(|a, b| a.squared.total_cmp(&b.squared));
        let counts = DirectionCounts {
            massless: solved.massless,
            massless_unstable: solved.massless_unstable,
            neutral: solved.neutral.ncols(),
            rigid: self.rigid_directions(),
            ..DirectionCounts::of(&modes, modes.len())
        };
        let neutral = self.names_in(&solved.neutral);
        Ok(Modes {
            modes,
            counts,
            neutral,
        })
    }

    /// Motions of the tool that no coordinate makes.
    fn rigid_directions(&self) -> usize {
        let scaled = |mut motions: DMatrix<f64>| {
            for k in 0..6 {
                let unit = if k < 3 { 1.0 / self.length } else { 1.0 };
                for (j, u) in self.units.iter().enumerate() {
                    motions[(k, j)] *= unit * u;
                }
            }
            motions
        };
        let motions = scaled(self.motions_of(self.tool));
        // Contributions that cancel where the tool is held leave rounding of this size.
        let parts = scaled(self.motion_sizes_of(self.tool));
        let gram = &motions * motions.transpose();
        let most = parts.row_iter().map(|row| row.norm_squared());
        let most = most.fold(0.0, kinetostat::number::larger);
        rigid_of(&Matrix6::from_fn(|i, j| gram[(i, j)]), most)
    }

    /// Names of the coordinates with a share in the columns of a basis.
    fn names_in(&self, basis: &DMatrix<f64>) -> Vec<String> {
        if basis.ncols() == 0 {
            return Vec::new();
        }
        let mut own = basis.clone();
        for (mut row, unit) in own.row_iter_mut().zip(&self.units) {
            row *= *unit;
        }
        let all = match &self.basis {
            Some(whole) => whole * own,
            None => own,
        };
        let named = self
            .coordinates
            .iter()
            .filter(|c| all.row(c.index).norm() > 1e-6 * all.norm());
        named.map(|c| c.name.clone()).collect()
    }
}

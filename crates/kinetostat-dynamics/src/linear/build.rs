//! Transforms blocks of limbs and platforms, with conditions on them, to independent coordinates.

use nalgebra::DMatrix;

use crate::ends::null_space;
use crate::error::{Error, Result};
use crate::linear::limb::LimbShare;
use crate::linear::{LinearDynamics, LumpedLink, NamedCoordinate, Place, SpringPart};
use crate::mass::{MassKind, MassPart};

/// Everything by all coordinates, before conditions are met.
#[derive(Default)]
pub(crate) struct Whole {
    pub mass: DMatrix<f64>,
    pub tangent: DMatrix<f64>,
    pub elastic: DMatrix<f64>,
    /// Natural units of all coordinates.
    pub units: Vec<f64>,
    pub blocks: Vec<Vec<usize>>,
    pub masses: Vec<MassPart>,
    pub springs: Vec<SpringPart>,
    pub places: Vec<Place>,
    pub coordinates: Vec<NamedCoordinate>,
    pub coarse_links: Vec<String>,
    pub lumped_links: Vec<LumpedLink>,
}

impl Whole {
    pub fn sized(units: Vec<f64>, blocks: Vec<Vec<usize>>) -> Self {
        let n = units.len();
        Self {
            mass: DMatrix::zeros(n, n),
            tangent: DMatrix::zeros(n, n),
            elastic: DMatrix::zeros(n, n),
            units,
            blocks,
            ..Self::default()
        }
    }

    /// Adds the matrices of a limb at the coordinates of its block.
    pub fn add_limb(&mut self, block: usize, share: LimbShare) {
        let own = &self.blocks[block];
        for (into, from) in [
            (&mut self.mass, &share.mass),
            (&mut self.tangent, &share.tangent),
            (&mut self.elastic, &share.elastic),
        ] {
            for (j, &column) in own.iter().enumerate() {
                for (i, &row) in own.iter().enumerate() {
                    into[(row, column)] += from[(i, j)];
                }
            }
        }
        self.masses.extend(share.masses);
        self.springs.extend(share.springs);
        self.places.extend(share.places);
    }

    /// Meets the conditions: all coordinates are `start` times fewer (`None`: the same), and `rows` (over those fewer, in
    /// units of a natural length) times those is zero. `units` are theirs.
    pub fn constrained(
        self,
        name: &str,
        start: Option<DMatrix<f64>>,
        rows: Option<DMatrix<f64>>,
        tool: usize,
        length: f64,
        start_units: Vec<f64>,
    ) -> Result<LinearDynamics> {
        let weigh = |m: &DMatrix<f64>| m.iter().any(|x| *x != 0.0);
        if !weigh(&self.mass) {
            return Err(Error::NoMass(name.to_owned()));
        }
        let rows = rows.filter(|rows| rows.nrows() > 0);
        let (basis, units) = match (start, rows) {
            (None, None) => (None, start_units),
            (Some(start), None) => (Some(start), start_units),
            (start, Some(rows)) => {
                let mut scaled = rows;
                for (mut column, unit) in scaled.column_iter_mut().zip(&start_units) {
                    column *= *unit;
                }
                let (mut free, _) = null_space(&scaled);
                for (mut row, unit) in free.row_iter_mut().zip(&start_units) {
                    row *= *unit;
                }
                let units = vec![1.0; free.ncols()];
                (
                    Some(start.map_or_else(|| free.clone(), |start| start * &free)),
                    units,
                )
            }
        };
        let by = |m: DMatrix<f64>| match &basis {
            Some(basis) => basis.tr_mul(&(m * basis)),
            None => m,
        };
        Ok(LinearDynamics {
            name: name.to_owned(),
            mass: by(self.mass),
            tangent: by(self.tangent),
            elastic: by(self.elastic),
            basis,
            units,
            blocks: self.blocks,
            masses: self.masses,
            springs: self.springs,
            places: self.places,
            coordinates: self.coordinates,
            tool,
            length,
            coarse_links: self.coarse_links,
            lumped_links: self.lumped_links,
        })
    }

    /// A platform's mass about its origin, in its six motions.
    pub fn add_platform(&mut self, name: &str, block: usize, matrix: nalgebra::Matrix6<f64>) {
        if matrix.iter().all(|x| *x == 0.0) {
            return;
        }
        let part = MassPart {
            name: name.to_owned(),
            kind: MassKind::Platform,
            block,
            motions: DMatrix::identity(6, 6),
            inertia: DMatrix::from_fn(6, 6, |i, j| matrix[(i, j)]),
        };
        let own = &self.blocks[block];
        for i in 0..6 {
            for j in 0..6 {
                self.mass[(own[i], own[j])] += matrix[(i, j)];
            }
        }
        self.masses.push(part);
    }
}

//! Places of a machine by name, and their motions.

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use kinetostat::spatial::shift_matrix;

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;

/// A point of a machine at which it is pushed or looked at: a node or platform, or a point fixed to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub(crate) place: usize,
    /// Arm from the place's origin, base axes, m.
    pub(crate) arm: Vector3<f64>,
}

impl Point {
    /// A point fixed to the same part, `arm` from the origin of the part (m, base axes at the equilibrium): the cutting
    /// edge of a tool, say.
    #[must_use]
    pub fn at(self, arm: Vector3<f64>) -> Self {
        Self { arm, ..self }
    }
}

impl LinearDynamics {
    /// Names of all places: nodes of limbs (`limb.node` where there are several limbs) and platforms.
    pub fn place_names(&self) -> impl Iterator<Item = &str> {
        self.places.iter().map(|p| p.name.as_str())
    }

    /// The tool: the platform that carries it, or the end of a chain.
    #[must_use]
    pub fn tool(&self) -> Point {
        Point {
            place: self.tool,
            arm: Vector3::zeros(),
        }
    }

    /// The place of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the names that exist.
    pub fn place(&self, name: &str) -> Result<Point> {
        let place = self.places.iter().position(|p| p.name == name);
        let place = place.ok_or_else(|| Error::UnknownName {
            what: "place",
            name: name.to_owned(),
            known: self.place_names().collect::<Vec<_>>().join(", "),
        })?;
        Ok(Point {
            place,
            arm: Vector3::zeros(),
        })
    }

    /// Position of a point at the equilibrium, base axes, m.
    #[must_use]
    pub fn position(&self, point: Point) -> Vector3<f64> {
        self.places[point.place].position + point.arm
    }

    /// Motion of a place (twist at its origin) in a motion of the independent coordinates.
    pub(crate) fn motion_at(&self, place: usize, shape: &DVector<f64>) -> Vector6<f64> {
        let own = &self.places[place];
        match &self.basis {
            None => {
                let mut sum = Vector6::zeros();
                for (column, &i) in own.motions.column_iter().zip(&self.blocks[own.block]) {
                    sum += column * shape[i];
                }
                sum
            }
            Some(_) => {
                let moved = &own.motions * self.of_block(own.block, &self.all(shape));
                Vector6::from_column_slice(moved.as_slice())
            }
        }
    }

    /// Motions of a place by the independent coordinates, 6 x m.
    pub(crate) fn motions_of(&self, place: usize) -> DMatrix<f64> {
        let own = &self.places[place];
        let columns = &self.blocks[own.block];
        match &self.basis {
            Some(basis) => {
                let moved = &own.motions * basis.select_rows(columns);
                DMatrix::from_fn(6, moved.ncols(), |i, j| moved[(i, j)])
            }
            None => {
                let mut motions = DMatrix::zeros(6, self.len());
                for (column, &j) in own.motions.column_iter().zip(columns) {
                    motions.fixed_view_mut::<6, 1>(0, j).copy_from(&column);
                }
                motions
            }
        }
    }

    /// Sums of the sizes of what makes these motions.
    pub(crate) fn motion_sizes_of(&self, place: usize) -> DMatrix<f64> {
        let own = &self.places[place];
        match &self.basis {
            Some(basis) => {
                let parts = own.motions.abs() * basis.select_rows(&self.blocks[own.block]).abs();
                DMatrix::from_fn(6, parts.ncols(), |i, j| parts[(i, j)])
            }
            None => self.motions_of(place).abs(),
        }
    }

    /// Motions of a point by the independent coordinates, 6 x m: its twist, base axes.
    #[must_use]
    pub fn motions(&self, point: Point) -> DMatrix<f64> {
        let motions = self.motions_of(point.place);
        if point.arm == Vector3::zeros() {
            return motions;
        }
        let shifted = shift_matrix(&point.arm) * motions;
        DMatrix::from_fn(6, shifted.ncols(), |i, j| shifted[(i, j)])
    }
}

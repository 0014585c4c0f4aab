//! Constraints on the tool, and the motions that are left: null spaces of closures and held directions [D 3, D5].

use kinetostat::chain::Prescribed;
use kinetostat::{Directions, EndCondition};
use nalgebra::{DMatrix, DVector, Rotation3};

/// Directions of the tool (or of the end of a chain) that are held while the machine vibrates.
///
/// ```
/// use kinetostat::Directions;
/// use kinetostat_dynamics::Held;
///
/// let free = Held::nothing();
/// let pressed = Held::directions(Directions::POSITION); // its place, while it may turn
/// assert!(free.is_free() && !pressed.is_free());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Axes of the directions, base from these axes.
    pub axes: Rotation3<f64>,
    /// `x y z rx ry rz` of those axes, at the origin of the tool.
    pub directions: [bool; 6],
}

impl Held {
    /// The tool is free.
    #[must_use]
    pub fn nothing() -> Self {
        Self {
            axes: Rotation3::identity(),
            directions: [false; 6],
        }
    }

    /// The tool is held in all six directions.
    #[must_use]
    pub fn everything() -> Self {
        Self {
            directions: [true; 6],
            ..Self::nothing()
        }
    }

    /// Holds these directions of the base's axes.
    #[must_use]
    pub fn directions(directions: Directions) -> Self {
        Self {
            directions: directions.as_array(),
            ..Self::nothing()
        }
    }

    /// Holds the directions whose pose an end condition of the statics prescribes.
    #[must_use]
    pub fn of_end(end: &EndCondition) -> Self {
        Self {
            axes: end.axes,
            directions: end.prescribed.map(|p| p == Prescribed::Pose),
        }
    }

    /// True if nothing is held.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.directions == [false; 6]
    }
}

/// Relative size of a pivot below which a condition says nothing new.
const DEPENDENT: f64 = 1e-10;

/// Basis of the null space of `rows` (scaled, k x n), n x m, and the rank of the rows: by Householder reflections with
/// column pivoting of the transpose, so that redundant conditions do no harm.
pub(crate) fn null_space(rows: &DMatrix<f64>) -> (DMatrix<f64>, usize) {
    null_space_below(rows, DEPENDENT)
}

/// Null space with an explicit threshold for pivots, relative to the largest.
pub(crate) fn null_space_below(rows: &DMatrix<f64>, dependent: f64) -> (DMatrix<f64>, usize) {
    let n = rows.ncols();
    if rows.nrows() == 0 || n == 0 {
        return (DMatrix::identity(n, n), 0);
    }
    let qr = rows.transpose().col_piv_qr();
    let triangle = qr.r();
    let diagonal = DVector::from_fn(triangle.nrows().min(triangle.ncols()), |k, _| {
        triangle[(k, k)]
    });
    let most = diagonal
        .iter()
        .fold(0.0_f64, |m, x| if x.abs() > m { x.abs() } else { m });
    let rank = diagonal
        .iter()
        .filter(|x| x.abs() > dependent * most)
        .count();
    let mut transposed = DMatrix::identity(n, n);
    qr.q_tr_mul(&mut transposed);
    // The last rows of Q^T are orthogonal to all conditions.
    (transposed.rows(rank, n - rank).transpose(), rank)
}

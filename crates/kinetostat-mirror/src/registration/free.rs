//! Motions that the points do not determine, in a form that one can name.
//!
//! The directions of the unknowns that change no distance from the path are a space of which any basis is as good as another: on
//! a line, a turn about it, a shift along it and a growth along it may come as three mixtures. Here growth is taken out
//! first, then what has no turn (shifts), and what is left are turns.

use nalgebra::{SMatrix, SVector, Vector3};

use crate::registration::closest::Closest;
use crate::registration::motion::FreeMotion;

/// Turn, shift and growth.
pub(crate) const UNKNOWNS: usize = 7;

pub(crate) type Unknowns = SVector<f64, UNKNOWNS>;

type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// The unknown that is growth; turns about x, y and z stand first, then shifts.
const GROWTH: usize = 6;

/// A direction with so small a square of its turn (a way at the mean distance from the middle, of a whole of 1) is a shift, and
/// one with so small a square of its growth has none.
const NONE: f64 = 0.01;

/// Free motions from the projection onto the directions that the points leave open.
pub(crate) fn free_motions(
    mut open: Square,
    closest: &Closest,
    with_scale: bool,
) -> Vec<FreeMotion> {
    let mut free = Vec::new();
    let growth: Unknowns = open.column(GROWTH).into_owned();
    // A projection: the square of its length is its own entry.
    if growth[GROWTH] > NONE {
        open -= growth * growth.transpose() / growth[GROWTH];
        // Growth is not determined if no scale is sought.
        free.extend(with_scale.then_some(FreeMotion::Growth));
    }
    let turns = Square::from_diagonal(&Unknowns::from_fn(|i, _| f64::from(u8::from(i < 3))));
    // Open directions by the square of their turn, from 0 to 1; all others at 2.
    let eigen = (open * turns * open + (Square::identity() - open) * 2.0).symmetric_eigen();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        let way = Vector3::new(vector[0], vector[1], vector[2]);
        let shift = Vector3::new(vector[3], vector[4], vector[5]);
        match *value {
            value if value < NONE => {
                free.extend(direction(shift).map(|along| FreeMotion::Shift { along }))
            }
            value if value < 1.5 => free.extend(direction(way).map(|along| {
                let turn = way / closest.size_mm;
                FreeMotion::Turn {
                    through_mm: closest.middle + turn.cross(&shift) / turn.norm_squared(),
                    along,
                }
            })),
            _ => {}
        }
    }
    free
}

/// Returns the one of two opposite directions whose largest component is positive.
fn direction(of: Vector3<f64>) -> Option<Vector3<f64>> {
    let direction = of.try_normalize(f64::MIN_POSITIVE)?;
    Some(match direction[direction.iamax()] < 0.0 {
        true => -direction,
        false => direction,
    })
}

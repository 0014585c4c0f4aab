//! Effect of one passive joint on the stiffness of a link: the rank-1 elimination [R 3.11, 3.16] and its cases with
//! names [R Tables 3.1-3.3].
//!
//! Spatial matrices are 6 x 6 (N/m, N/rad, N m/m, N m/rad), order `x y z rx ry rz`, at the far end
//! of a link whose x axis points there; planar ones are 3 x 3, order `x y rz`.

use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector3, Vector6};

use crate::error::{Error, Place, Result, Whole};
use crate::model::limits::{check_number, positive};

/// A pivot below this share of the terms that make it up is rounding: the direction is free.
const FREE: f64 = 1e-12;

/// A stiffness after a passive joint was added.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Elimination<const N: usize> {
    /// Remaining stiffness; unchanged if the joint was free already.
    pub matrix: SMatrix<f64, N, N>,
    /// `mu = J^T K J`: stiffness that the joint gave up, N/m or N m/rad.
    pub pivot: f64,
    /// The joint moves in a direction that was free before: a redundant passive joint, skipped
    /// [R corollary of 3.11].
    pub already_free: bool,
}

/// Adds a passive joint to a stiffness: `K - (K J)(J^T K) / mu`, `mu = J^T K J` [R 3.16], `column`
/// the motion of the end per unit of the joint (m or rad per m or rad).
///
/// # Errors
/// A stiffness that is not symmetric or has a negative diagonal entry, numbers that are not finite, a
/// joint that moves nothing.
pub fn eliminate_passive<const N: usize>(
    stiffness: &SMatrix<f64, N, N>,
    column: &SVector<f64, N>,
) -> Result<Elimination<N>> {
    check(stiffness)?;
    for &value in column {
        let what = || "the motion of the end per unit of the joint".to_owned();
        check_number(&place(), what, value)?;
    }
    if column.amax() == 0.0 {
        let reason = "the joint moves the end in no direction: its column is zero";
        return Err(Error::model(place(), reason));
    }
    Ok(eliminated(stiffness, column))
}

fn place() -> Place {
    Place::of(Whole::PassiveJointRule)
}

/// Refuses what is no stiffness of an unloaded link.
fn check<const N: usize>(k: &SMatrix<f64, N, N>) -> Result<()> {
    for &value in k {
        check_number(&place(), || "an entry of the stiffness".to_owned(), value)?;
    }
    for i in 0..N {
        // A direction that another joint freed is zero to rounding.
        let size = (k[(i, i)].abs()).max(1e-12 * k.row(i).amax());
        if k[(i, i)] < -1e-9 * size.max(k.row(i).amax()) {
            let reason = format!(
                "the stiffness is negative: entry ({0}, {0}) is {1}",
                i + 1,
                k[(i, i)]
            );
            return Err(Error::model(place(), reason));
        }
        for j in 0..i {
            let (a, b) = (k[(i, j)], k[(j, i)]);
            let unit = (k[(i, i)] * k[(j, j)]).abs().sqrt();
            if (a - b).abs() > 1e-9 * (unit + a.abs() + b.abs()) {
                let reason = format!(
                    "the stiffness is not symmetric: entry ({0}, {1}) is {a}, entry ({1}, {0}) is {b}; the rule is that of an unloaded link",
                    i + 1,
                    j + 1
                );
                return Err(Error::model(place(), reason));
            }
        }
    }
    Ok(())
}

/// See [`eliminate_passive`]; the caller knows that the input is sound.
pub(crate) fn eliminated<const N: usize>(
    stiffness: &SMatrix<f64, N, N>,
    column: &SVector<f64, N>,
) -> Elimination<N> {
    let terms = column.abs().dot(&(stiffness.abs() * column.abs()));
    let pivot = (column.transpose() * stiffness * column)[0];
    if pivot.abs() <= FREE * terms {
        return Elimination {
            matrix: *stiffness,
            pivot,
            already_free: true,
        };
    }
    let (force, row) = (stiffness * column, column.transpose() * stiffness);
    let matrix = SMatrix::from_fn(|i, j| {
        let (own, less) = (stiffness[(i, j)], force[i] * row[j] / pivot);
        let left = own - less;
        // Cancelled entries are zero, not rounding: the next joint must not divide by them.
        if left.abs() <= FREE * (own.abs() + less.abs()) {
            0.0
        } else {
            left
        }
    });
    Elimination {
        matrix,
        pivot,
        already_free: false,
    }
}

/// Axis of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along the link.
    X,
    /// Across.
    Y,
    /// Across.
    Z,
}

impl Axis {
    fn index(self) -> usize {
        self as usize
    }

    fn unit(self) -> Vector3<f64> {
        let mut unit = Vector3::zeros();
        unit[self.index()] = 1.0;
        unit
    }
}

/// A passive slide `T_x, T_y, T_z` anywhere on the link: a trivial joint,
/// `K_jk - K_jp K_pk / K_pp` [R 3.23; Table 3.2 rows 1-3].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn with_slide(stiffness: &Matrix6<f64>, axis: Axis) -> Result<Matrix6<f64>> {
    Ok(eliminate_passive(stiffness, &Vector6::ith(axis.index(), 1.0))?.matrix)
}

/// A passive hinge `R_x, R_y, R_z` at the end of the link: a trivial joint,
/// `K_jk - K_jp K_pk / K_pp` [R 3.23; Table 3.2 rows 4-6].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn with_hinge_at_end(stiffness: &Matrix6<f64>, axis: Axis) -> Result<Matrix6<f64>> {
    Ok(eliminate_passive(stiffness, &Vector6::ith(3 + axis.index(), 1.0))?.matrix)
}

/// A passive hinge at the root of a link of the given length (m): a quasi-trivial joint,
/// `J = [e x r; e]` with `r = (length, 0, 0)` from the joint to the end [R 3.22, Table 3.3].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn with_hinge_at_root(
    stiffness: &Matrix6<f64>,
    axis: Axis,
    length: f64,
) -> Result<Matrix6<f64>> {
    with_hinge_at(stiffness, axis, &Vector3::new(length, 0.0, 0.0))
}

/// A passive hinge anywhere: `r` (m) points from its axis to the end [R 3.18].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn with_hinge_at(
    stiffness: &Matrix6<f64>,
    axis: Axis,
    r: &Vector3<f64>,
) -> Result<Matrix6<f64>> {
    let unit = axis.unit();
    let turned = unit.cross(r);
    let column = Vector6::new(turned.x, turned.y, turned.z, unit.x, unit.y, unit.z);
    Ok(eliminate_passive(stiffness, &column)?.matrix)
}

/// A universal joint at the end: hinges about y and z.
///
/// # Errors
/// As [`eliminate_passive`].
pub fn with_universal_joint_at_end(stiffness: &Matrix6<f64>) -> Result<Matrix6<f64>> {
    with_hinge_at_end(&with_hinge_at_end(stiffness, Axis::Y)?, Axis::Z)
}

/// A spherical joint at the end: hinges about x, y and z [R section 3.6].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn with_spherical_joint_at_end(stiffness: &Matrix6<f64>) -> Result<Matrix6<f64>> {
    with_universal_joint_at_end(&with_hinge_at_end(stiffness, Axis::X)?)
}

/// Cantilever in its plane, at its end: `[EA/L, 0, 0; 12 EI/L^3, -6 EI/L^2; 4 EI/L]` [R Table 3.1].
/// `tension` is `EA` (N), `bending` `EI` (N m^2), the length in m.
///
/// # Errors
/// A number that is not positive and finite.
pub fn planar_beam(tension: f64, bending: f64, length: f64) -> Result<Matrix3<f64>> {
    for (what, value) in [
        ("tension EA", tension),
        ("bending EI", bending),
        ("length", length),
    ] {
        positive(&Place::of(Whole::Section), what, value)?;
    }
    let coupling = -6.0 * bending / length.powi(2);
    Ok(Matrix3::new(
        tension / length,
        0.0,
        0.0,
        0.0,
        12.0 * bending / length.powi(3),
        coupling,
        0.0,
        coupling,
        4.0 * bending / length,
    ))
}

/// A planar link with a passive slide along x: `K_jk - K_j1 K_1k / K_11` [R Table 3.1, 2nd row].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn planar_with_slide_along_x(stiffness: &Matrix3<f64>) -> Result<Matrix3<f64>> {
    Ok(eliminate_passive(stiffness, &Vector3::x())?.matrix)
}

/// A planar link with a passive slide along y: `K_jk - K_j2 K_2k / K_22` [R Table 3.1, 3rd row].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn planar_with_slide_along_y(stiffness: &Matrix3<f64>) -> Result<Matrix3<f64>> {
    Ok(eliminate_passive(stiffness, &Vector3::y())?.matrix)
}

/// A planar link with a passive hinge at its end: `K_jk - K_j3 K_3k / K_33` [R 3.4; Table 3.1, 4th
/// row].
///
/// # Errors
/// As [`eliminate_passive`].
pub fn planar_with_hinge_at_end(stiffness: &Matrix3<f64>) -> Result<Matrix3<f64>> {
    Ok(eliminate_passive(stiffness, &Vector3::z())?.matrix)
}

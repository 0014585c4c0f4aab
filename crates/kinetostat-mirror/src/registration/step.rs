//! A step of all points towards the path, along which they may slide.

use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};

use crate::registration::closest::Closest;
use crate::registration::motion::{FreeMotion, Motion};

/// Eigenvalues of the normal equations below this share of the largest determine nothing.
const UNDETERMINED: f64 = 1e-6;

/// Turn, shift and growth.
const UNKNOWNS: usize = 7;

type Unknowns = SVector<f64, UNKNOWNS>;

/// A step, and what it left as it was.
pub(crate) struct Step {
    pub motion: Motion,
    /// How far points move by it, mm: the shift and the turn at the mean distance from the middle.
    pub way_mm: f64,
    pub free: Vec<FreeMotion>,
}

/// The step from a motion to the next, by Gauss-Newton with the distances across the path; `None` where numbers are lost.
pub(crate) fn step(closest: &Closest, before: &Motion, with_scale: bool) -> Option<Step> {
    let size = closest.size_mm.max(f64::MIN_POSITIVE);
    let mut normal = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    let mut right = Unknowns::zeros();
    for point in closest.all.iter().filter(|point| point.weight > 0.0) {
        let lever = (point.moved - closest.middle) / size;
        let tangent = point.foot.tangent;
        let across = Matrix3::identity() - tangent * tangent.transpose();
        // Columns: turn about x, y, z, shift along x, y, z, and growth; all as ways in mm.
        let mut ways = SMatrix::<f64, 3, UNKNOWNS>::zeros();
        ways.view_mut((0, 0), (3, 3))
            .copy_from(&(-lever.cross_matrix()));
        ways.view_mut((0, 3), (3, 3))
            .copy_from(&Matrix3::identity());
        if with_scale {
            ways.set_column(6, &lever);
        }
        let gap = across * (point.foot.place_mm - point.moved);
        let seen = across * ways;
        normal += seen.transpose() * seen * point.weight;
        right += seen.transpose() * gap * point.weight;
    }
    if !normal
        .iter()
        .chain(right.iter())
        .all(|entry| entry.is_finite())
    {
        return None;
    }
    let eigen = normal.symmetric_eigen();
    let largest = eigen.eigenvalues[eigen.eigenvalues.imax()];
    let mut solution = Unknowns::zeros();
    let mut free = Vec::new();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        match *value > UNDETERMINED * largest {
            true => solution += vector * (vector.dot(&right) / value),
            // Growth that is not sought.
            false if !with_scale && vector[6].abs() > 0.5 => {}
            false => free.push(free_motion(&vector.into_owned(), closest)),
        }
    }
    let turn = Vector3::new(solution[0], solution[1], solution[2]) / size;
    let shift = Vector3::new(solution[3], solution[4], solution[5]);
    let growth = 1.0 + solution[6] / size;
    let rotation = UnitQuaternion::from_scaled_axis(turn);
    let motion = Motion {
        rotation: rotation * before.rotation,
        shift_mm: rotation * (before.shift_mm - closest.middle) * growth + closest.middle + shift,
        scale: before.scale * growth,
    };
    Some(Step {
        motion,
        way_mm: solution.norm(),
        free,
    })
}

/// What a direction of the unknowns is: turns are ways at the mean distance.
fn free_motion(vector: &Unknowns, closest: &Closest) -> FreeMotion {
    let turn = Vector3::new(vector[0], vector[1], vector[2]) / closest.size_mm;
    let shift = Vector3::new(vector[3], vector[4], vector[5]);
    if turn.norm() * closest.size_mm < 0.1 {
        return FreeMotion::Shift {
            along: signed(shift.normalize()),
        };
    }
    FreeMotion::Turn {
        through_mm: closest.middle + turn.cross(&shift) / turn.norm_squared(),
        along: signed(turn.normalize()),
    }
}

/// Of two opposite directions the one whose largest component is positive.
fn signed(direction: Vector3<f64>) -> Vector3<f64> {
    match direction[direction.iamax()] < 0.0 {
        true => -direction,
        false => direction,
    }
}

//! A step of all points towards the path, along which they may slide.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use crate::registration::closest::Closest;
use crate::registration::free::{UNKNOWNS, Unknowns, free_motions};
use crate::registration::motion::{FreeMotion, Motion};
use crate::registration::options::RegistrationOptions;

/// Eigenvalues of the normal equations below this share of the largest determine nothing.
const UNDETERMINED: f64 = 1e-6;

/// A step, and what it left as it was.
pub(crate) struct Step {
    pub motion: Motion,
    /// Motion of the points by it, mm: the shift and the turn at the mean distance from the middle.
    pub way_mm: f64,
    pub free: Vec<FreeMotion>,
}

/// The step from a motion to the next, by Gauss-Newton with the distances across the path; `None` where numbers are lost.
pub(crate) fn step(
    closest: &Closest,
    before: &Motion,
    options: RegistrationOptions,
) -> Option<Step> {
    let size = closest.size_mm.max(f64::MIN_POSITIVE);
    let mut normal = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    let mut right = Unknowns::zeros();
    for point in closest.all.iter().filter(|point| point.weight > 0.0) {
        let lever = (point.moved - closest.middle) / size;
        let tangent = point.foot.tangent;
        let across = Matrix3::identity() - tangent * tangent.transpose();
        // Columns: turn about x, y, z, shift along x, y, z, and growth; all as ways in mm.
        let mut ways = SMatrix::<f64, 3, UNKNOWNS>::zeros();
        if !options.only_shift {
            ways.view_mut((0, 0), (3, 3))
                .copy_from(&(-lever.cross_matrix()));
        }
        ways.view_mut((0, 3), (3, 3))
            .copy_from(&Matrix3::identity());
        if options.with_scale {
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
    let mut open = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        match *value > UNDETERMINED * largest {
            true => solution += vector * (vector.dot(&right) / value),
            false => open += vector * vector.transpose(),
        }
    }
    if options.only_shift {
        // Turns are not sought, so that none is open.
        let shifts =
            SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_diagonal(&Unknowns::from_fn(|i, _| {
                f64::from(u8::from((3..6).contains(&i)))
            }));
        open = shifts * open * shifts;
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
        free: free_motions(open, closest, options.with_scale),
    })
}

//! Frames that bring computed poses nearest to measured ones.

use kinetostat::{Pose, linalg::SingularValues};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::measured_poses::explanation::Frame;
use crate::measured_poses::measurement::MeasuredPose;

/// The base frame that brings the computed poses nearest to the measured ones.
pub(crate) fn base(rows: &[MeasuredPose], computed: &[Pose]) -> Option<Frame> {
    if rows.len() < 2 {
        return None;
    }
    if let Some(turns) = rows.iter().map(|r| r.rotation).collect::<Option<Vec<_>>>() {
        let rotation = mean(
            turns
                .iter()
                .zip(computed)
                .map(|(t, c)| t * c.rotation.inverse()),
        );
        let n = rows.len() as f64;
        let shift = rows
            .iter()
            .zip(computed)
            .map(|(r, c)| r.position - rotation * c.translation.vector)
            .sum::<Vector3<f64>>()
            / n;
        return Some(Frame::Base(Pose::from_parts(shift.into(), rotation)));
    }
    // Positions alone: the rotation between two clouds of points [Kabsch].
    if rows.len() < 4 {
        return None;
    }
    let n = rows.len() as f64;
    let there = rows.iter().map(|r| r.position).sum::<Vector3<f64>>() / n;
    let here = computed
        .iter()
        .map(|c| c.translation.vector)
        .sum::<Vector3<f64>>()
        / n;
    let mut h = Matrix3::zeros();
    for (r, c) in rows.iter().zip(computed) {
        h += (r.position - there) * (c.translation.vector - here).transpose();
    }
    let rotation = nearest_rotation(&h)?;
    let shift = there - rotation * here;
    Some(Frame::Base(Pose::from_parts(shift.into(), rotation)))
}

/// The frame behind the tool that brings the computed poses nearest to the measured ones.
pub(crate) fn tool(rows: &[MeasuredPose], computed: &[Pose]) -> Option<Frame> {
    if rows.len() < 2 {
        return None;
    }
    let n = rows.len() as f64;
    let turns = rows.iter().map(|r| r.rotation).collect::<Option<Vec<_>>>();
    let rotation = turns.map_or_else(UnitQuaternion::identity, |turns| {
        mean(
            turns
                .iter()
                .zip(computed)
                .map(|(t, c)| c.rotation.inverse() * t),
        )
    });
    let shift = rows
        .iter()
        .zip(computed)
        .map(|(r, c)| c.rotation.inverse() * (r.position - c.translation.vector))
        .sum::<Vector3<f64>>()
        / n;
    Some(Frame::Tool(Pose::from_parts(shift.into(), rotation)))
}

/// The rotation nearest to several ones.
fn mean(turns: impl Iterator<Item = UnitQuaternion<f64>>) -> UnitQuaternion<f64> {
    let sum = turns.fold(Matrix3::zeros(), |s, q| {
        s + q.to_rotation_matrix().into_inner()
    });
    nearest_rotation(&sum).unwrap_or_default()
}

fn nearest_rotation(m: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let own = SingularValues::of(m);
    // Points on a line leave a turn about it open.
    if own.rank(1e-9) < 2 {
        return None;
    }
    let u = Matrix3::from_iterator(own.left.iter().copied());
    let v_t = Matrix3::from_iterator(own.right.iter().copied()).transpose();
    let mut sign = Matrix3::identity();
    sign[(2, 2)] = (u * v_t).determinant().signum();
    let rotation = Rotation3::from_matrix_unchecked(u * sign * v_t);
    Some(UnitQuaternion::from_rotation_matrix(&rotation))
}

//! Frames that bring computed poses nearest to measured ones.

use kinetostat::Pose;
use kinetostat_machining::{nearest_rotation, rigid_motion};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

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
    let there: Vec<Vector3<f64>> = rows.iter().map(|r| r.position).collect();
    let here = computed.iter().map(|c| c.translation.vector);
    rigid_motion(&here.collect::<Vec<_>>(), &there).map(Frame::Base)
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

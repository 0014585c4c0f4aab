//! Motion of the tool by one actuator.

use kinetostat::{Mechanism, Pose, PostureRequest, Twist, spatial::pose_residual};
use nalgebra::Vector3;

/// Motion of the tool per m or rad of one actuator, the others held; base axes. None where it cannot move by itself.
#[must_use]
pub fn actuator_twist(m: &Mechanism, commands: &[f64], index: usize) -> Option<Twist> {
    let step = 1e-4;
    let at = |by: f64| {
        let mut moved = commands.to_vec();
        moved[index] += by;
        m.posture(PostureRequest::commands(&moved))
            .ok()
            .map(|p| *p.target())
    };
    let twist = pose_residual(&at(step)?, &at(-step)?);
    Some(Twist(twist.0 / (2.0 * step)))
}

/// The point nearest to the base's origin on the axis of a pure rotation of the tool, m; none if it is none.
#[must_use]
pub fn point_on_axis(tool: &Pose, twist: &Twist) -> Option<Vector3<f64>> {
    let (v, w) = (twist.linear(), twist.angular());
    let turn = w.norm();
    if turn < 1e-6 || v.dot(&w).abs() > 1e-6 * turn * (v.norm() + turn) {
        return None;
    }
    let axis = w / turn;
    let point = tool.translation.vector + w.cross(&v) / (turn * turn);
    Some(point - axis * axis.dot(&point))
}

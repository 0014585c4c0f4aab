//! Axes of the flange: z of the model's tool frame points out of it, and the last link of a URDF may have it along x.
//!
//! ROS-Industrial puts x of `flange` and z of `tool0` along the last joint (REP 199).

use kinetostat::Pose;
use kinetostat_model::schema::{Axis, AxisName, Placement};

use crate::log::Log;
use crate::urdf::robot::Robot;

/// Frame of the tip link in the tool frame of the model, for the axis of the link that points out of the flange;
/// `None` if they are the same.
pub(crate) fn tip_in_tool(flange_z: AxisName) -> Option<Placement> {
    use AxisName::{MinusX, MinusY, MinusZ, X, Y, Z};
    let (x, y) = match flange_z {
        X => (Z, Y),
        Y => (X, Z),
        Z => return None,
        MinusX => (MinusZ, Y),
        MinusY => (X, MinusZ),
        MinusZ => (X, MinusY),
    };
    Some(Placement {
        x_axis: Some(Axis::Named(x)),
        y_axis: Some(Axis::Named(y)),
        ..Placement::default()
    })
}

/// Tool frame whose z axis points out of the flange, for the frame of the tip link.
pub(crate) fn tool_frame(tip: &Pose, tip_in_tool: &Placement) -> Pose {
    let turn = tip_in_tool.pose().unwrap_or_else(|_| Pose::identity());
    tip * turn.inverse()
}

/// Remarks a tip whose x axis points out of the flange by its name.
pub(crate) fn remark_flange(robot: &Robot, tip: usize, log: &mut Log) {
    let link = &robot.links[tip];
    let is_flange = |name: &str| name.to_lowercase().contains("flange");
    let fixed = robot.joints.iter().find(|j| j.child.1 == link.name);
    let by_joint = fixed.is_some_and(|j| j.word == "fixed" && is_flange(&j.name));
    if link.name.ends_with("tool0") || !(is_flange(&link.name) || by_joint) {
        return;
    }
    log.notice(
        &link.at,
        format!(
            "the tip '{}' looks like a flange of ROS, whose x axis points out: tools lie along z of the model's tool frame",
            link.name
        ),
        "give --flange-z x if it is so, --flange-z z if z points out",
    );
}

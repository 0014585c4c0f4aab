//! Tool and work object that a robot's program states, for the machine of a run.

use kinetostat::Pose;
use kinetostat_formats::{FrameUse, tool_number};
use nalgebra::{Isometry3, Vector3};

use crate::job::robot::own_angles::OwnAngles;
use crate::job::robot::read_program::RobotRead;

/// Tool and work object as the program states them.
#[derive(Clone, Debug)]
pub(crate) struct RobotFrames {
    /// Number and name of every tool, and where it is in the flange, m.
    pub(crate) tools: Vec<(u32, String, Option<Pose>)>,
    /// Name of the work object in whose axes the path is, and where it is in the robot's base, m; `None`: the path is in axes of
    /// the base.
    pub(crate) work_object: Option<(String, Option<Pose>)>,
    /// Direction from the tool's tip to its holder, in axes of the tool.
    pub(crate) tool_axis: Vector3<f64>,
    /// True if that axis is a default, and the language has no convention for it.
    pub(crate) axis_is_open: bool,
    /// The program states how the tool stands.
    pub(crate) states_orientation: bool,
    /// Orientation of the tool in the program, in the angles of its controller.
    pub(crate) own_angles: Option<OwnAngles>,
    /// True for a converted program: it already contains the job's data on part and tool.
    pub(crate) converted: bool,
}

impl RobotFrames {
    pub(crate) fn of(read: &RobotRead<'_>) -> Self {
        let named = |frame: &FrameUse| (frame.name.clone(), frame.known().map(in_metres));
        Self {
            tools: (read.path.tools.iter().enumerate())
                .map(|(index, tool)| {
                    let (name, pose) = named(tool);
                    (tool_number(&read.path.tools, index), name, pose)
                })
                .collect(),
            work_object: read.path.work_object.as_ref().map(named),
            tool_axis: read.path.path.tool_axis,
            axis_is_open: read.axis_is_open(),
            states_orientation: (read.path.path.moves.iter())
                .any(|motion| motion.tool_turn.is_some()),
            own_angles: OwnAngles::of(read),
            converted: false,
        }
    }
}

pub(crate) fn in_metres(frame: &Isometry3<f64>) -> Pose {
    Pose::from_parts((1e-3 * frame.translation.vector).into(), frame.rotation)
}

//! Tool and work object that a robot's program states, for the machine of a run.

use kinetostat::Pose;
use kinetostat_formats::FrameUse;
use nalgebra::Isometry3;

use crate::job::robot::read_program::RobotRead;

/// What the program states of tool and work object.
#[derive(Clone, Debug)]
pub(crate) struct RobotFrames {
    /// Name of the tool, and where it is in the flange, m.
    pub(crate) tool: Option<(String, Option<Pose>)>,
    /// Name of the work object in whose axes the path is, and where it is in the robot's base, m; `None`: the path is in axes of
    /// the base.
    pub(crate) work_object: Option<(String, Option<Pose>)>,
}

impl RobotFrames {
    pub(crate) fn of(read: &RobotRead<'_>) -> Self {
        let named = |frame: &FrameUse| (frame.name.clone(), frame.known().map(in_metres));
        Self {
            tool: read.path.tool.as_ref().map(named),
            work_object: read.path.work_object.as_ref().map(named),
        }
    }
}

fn in_metres(frame: &Isometry3<f64>) -> Pose {
    Pose::from_parts((1e-3 * frame.translation.vector).into(), frame.rotation)
}

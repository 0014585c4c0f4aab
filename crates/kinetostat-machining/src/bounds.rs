//! Limits of a run, ratings of the drives, the tools as they were given and the workspace.

use kinetostat::Pose;
use nalgebra::Vector3;

use crate::limits::Limits;

/// References with which the figures of a run are compared.
#[derive(Clone, Debug, Default)]
pub struct Bounds {
    /// Limits beyond which a program is refused.
    pub limits: Limits,
    /// Largest force (N) or torque (N m) of every drive, in the order of the actuators; empty where
    /// no rating is known.
    pub ratings: Vec<Option<f64>>,
    /// The tools as they were given; empty where the platform's own point is the tool by construction.
    pub tools: Vec<ToolGiven>,
    /// Line and radius (mm) of the widest zone at a corner at feed, where a program states zones.
    pub widest_zone: Option<(usize, f64)>,
    /// True if nobody stated the placement of the part.
    pub is_unplaced: bool,
    /// Workspace of the machine without its tool: smallest and largest coordinates, base axes, m.
    pub workspace: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// A tool as a question states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolGiven {
    /// Number of the tool, if the question numbers its tools.
    pub number: Option<u32>,
    /// Flange from tip, m.
    pub pose: Pose,
    /// True if the question states a tool.
    pub stated: bool,
}

impl ToolGiven {
    /// Length along z of the flange if it points there, else the distance of the tip, mm.
    pub(crate) fn length_mm(&self) -> f64 {
        let tip = self.pose.translation.vector * 1e3;
        if tip.xy().norm() <= 1e-9 {
            tip.z
        } else {
            tip.norm()
        }
    }
}

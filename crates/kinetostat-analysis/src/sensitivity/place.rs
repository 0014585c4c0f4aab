//! Commanded place of the tool while the machine changes.

use kinetostat::{Mechanism, Pose, Posture, PostureRequest, Result};
use nalgebra::{UnitQuaternion, Vector3};

/// A place that a changed machine is commanded for again.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum CommandedPlace {
    /// A pose of the tool, base from tool.
    Pose(Pose),
    /// A position (m) whose orientation follows, nearest to this one.
    Position(Vector3<f64>, UnitQuaternion<f64>),
    /// Commands, m or rad.
    Commands(Vec<f64>),
}

impl CommandedPlace {
    /// The machine commanded for it, next to a posture where there is one.
    ///
    /// # Errors
    /// As [`Mechanism::posture`].
    pub fn posture(&self, machine: &Mechanism, near: Option<&Posture>) -> Result<Posture> {
        let request = match self {
            Self::Pose(pose) => PostureRequest::pose(pose),
            Self::Position(position, wanted) => PostureRequest::position(position, wanted),
            Self::Commands(commands) => PostureRequest::commands(commands),
        };
        match near {
            Some(near) => machine.posture(request.near(near)),
            None => machine.posture(request),
        }
    }
}

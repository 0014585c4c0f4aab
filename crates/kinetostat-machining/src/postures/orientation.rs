//! Treatment of the orientation of a requested pose.

use kinetostat::{Error, Mechanism, Pose, Posture, PostureRequest, Wrench};

use crate::load::law::ProgramLoad;
use crate::placement::Placement;

/// Treatment of the orientation of a requested pose.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Orientation {
    /// True if the tool only keeps near to it; otherwise it is held.
    pub follows: bool,
    /// The load is fixed in the tool and turns with it.
    pub load_turns: bool,
}

impl Orientation {
    pub fn of(placement: &Placement, load: &ProgramLoad) -> Self {
        Self {
            follows: placement.orientation_follows,
            load_turns: placement.orientation_follows && load.in_tool_axes(),
        }
    }

    /// The machine commanded for a pose, or for its position.
    pub fn posture(
        self,
        mechanism: &Mechanism,
        pose: &Pose,
        near: Option<&Posture>,
    ) -> Result<Posture, Error> {
        let (position, rotation) = (&pose.translation.vector, &pose.rotation);
        match (self.follows, near) {
            (false, None) => mechanism.posture(pose),
            (false, Some(near)) => mechanism.posture(PostureRequest::pose(pose).near(near)),
            (true, None) => mechanism.posture(PostureRequest::position(position, rotation)),
            (true, Some(near)) => {
                mechanism.posture(PostureRequest::position(position, rotation).near(near))
            }
        }
    }

    /// The load that was given for the orientation of `pose`, where the tool has another one.
    pub(crate) fn load(self, wrench: &Wrench, pose: &Pose, posture: &Posture) -> Wrench {
        if !self.load_turns {
            return *wrench;
        }
        let turn = posture.target().rotation * pose.rotation.inverse();
        wrench.rotated(&turn.to_rotation_matrix())
    }
}

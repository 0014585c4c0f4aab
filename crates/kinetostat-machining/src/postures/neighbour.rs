//! Many points of a path, one after the other from the
//! neighbour's state, in chunks of fixed size: the answer of a point does not depend on the number of
//! threads.

use std::iter::Flatten;
use std::vec::IntoIter;

use kinetostat::batch::AlongPath;
use kinetostat::compensation::{target_under_load, target_under_load_following};
use kinetostat::machine::MechanismState;
use kinetostat::{
    Directions, Error, Mechanism, MechanismEquilibrium, Pose, Posture, PostureRequest, Wrench,
};
use rayon::prelude::*;

use crate::load::law::ProgramLoad;
use crate::placement::Placement;

/// Points that share a chain of starting values: so many that the first of each run in it, which has no neighbour, takes little
/// of the time.
pub(crate) const CHUNK: usize = 256;

/// Posture and state of the last point solved in a chunk, one memory per kind of query.
#[derive(Default)]
pub(crate) struct Neighbour {
    last: Option<(Posture, MechanismState)>,
}

pub(crate) const NEAR: f64 = AlongPath::NEAR;

impl Neighbour {
    /// The next one is solved next to a posture.
    pub fn stand_at(&mut self, posture: &Posture) {
        self.last = Some((posture.clone(), posture.rest_state()));
    }

    fn near(&self, pose: &Pose) -> Option<&(Posture, MechanismState)> {
        self.last.as_ref().filter(|(posture, _)| {
            let length = posture.mechanism().size();
            (posture.target().translation.vector - pose.translation.vector).norm() < NEAR * length
        })
    }

    fn posture(
        &self,
        mechanism: &Mechanism,
        pose: &Pose,
        orientation: Orientation,
    ) -> Result<Posture, Error> {
        let near = self.near(pose).map(|(posture, _)| posture);
        let posture = orientation.posture(mechanism, pose, near)?;
        posture.within_limits()?;
        Ok(posture)
    }

    fn start(&self, posture: &Posture, pose: &Pose) -> MechanismState {
        self.near(pose)
            .map_or_else(|| posture.rest_state(), |(_, state)| state.clone())
    }

    /// The posture whose tool is at `pose` under `wrench`.
    pub fn target(
        &mut self,
        mechanism: &Mechanism,
        pose: &Pose,
        wrench: &Wrench,
        orientation: Orientation,
        corrected: Directions,
    ) -> Result<Posture, Error> {
        let answer = if orientation.follows {
            let near = self.near(pose).map(|(posture, _)| posture);
            let near = orientation.posture(mechanism, pose, near)?;
            let start = self.start(&near, pose);
            let wrench = orientation.load(wrench, pose, &near);
            let (position, rotation) = (&pose.translation.vector, &pose.rotation);
            target_under_load_following(&near, position, rotation, &wrench, start)?
        } else {
            let (near, state) = match self.near(pose) {
                Some(found) => found.clone(),
                None => {
                    let posture = mechanism.posture(pose)?;
                    let state = posture.rest_state();
                    (posture, state)
                }
            };
            target_under_load(&near, pose, wrench, corrected, state)?
        };
        answer.0.within_limits()?;
        self.last = Some(answer.clone());
        Ok(answer.0)
    }

    /// The pose to command so that the tool's tip is at that of `pose` under `wrench`, with its orientation; and the tool's pose
    /// then.
    pub fn target_and_tool(
        &mut self,
        mechanism: &Mechanism,
        pose: &Pose,
        wrench: &Wrench,
    ) -> Result<(Pose, Pose), Error> {
        let held = Orientation::default();
        let posture = self.target(mechanism, pose, wrench, held, Directions::POSITION)?;
        let target = *posture.target();
        let tool = self
            .last
            .as_ref()
            .map(|(_, state)| state.platforms[mechanism.tool()]);
        Ok((target, tool.unwrap_or(target)))
    }

    /// Pose of the tool when commanded to `pose` under `wrench`.
    pub fn rest(
        &mut self,
        mechanism: &Mechanism,
        pose: &Pose,
        wrench: &Wrench,
        orientation: Orientation,
    ) -> Result<(Posture, Pose), Error> {
        let posture = self.posture(mechanism, pose, orientation)?;
        let start = self.start(&posture, pose);
        let wrench = orientation.load(wrench, pose, &posture);
        let state = posture.rest_under(&wrench, start)?;
        let tool = state.platforms[mechanism.tool()];
        self.last = Some((posture.clone(), state));
        Ok((posture, tool))
    }

    /// Equilibrium as found by `rest`, with stiffness and stability.
    pub fn equilibrium(
        &mut self,
        mechanism: &Mechanism,
        pose: &Pose,
        wrench: &Wrench,
        orientation: Orientation,
    ) -> Result<(Posture, MechanismEquilibrium), Error> {
        let posture = self.posture(mechanism, pose, orientation)?;
        let start = self.start(&posture, pose);
        let wrench = orientation.load(wrench, pose, &posture);
        let equilibrium = posture.deflected_from(&wrench, start)?;
        self.last = Some((posture.clone(), equilibrium.state.clone()));
        Ok((posture, equilibrium))
    }
}

/// Runs `work` over all items in chunks of [`CHUNK`], each chunk with memories of its own, on all
/// cores; answers in order.
pub(crate) fn in_chunks<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&mut [Neighbour; 2], &[T]) -> Vec<R> + Sync,
) -> Flatten<IntoIter<Vec<R>>> {
    let chunks = items.par_chunks(CHUNK);
    // Answers stay where they were made: they are large.
    let answers: Vec<Vec<R>> = chunks
        .map(|items| work(&mut Default::default(), items))
        .collect();
    answers.into_iter().flatten()
}

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

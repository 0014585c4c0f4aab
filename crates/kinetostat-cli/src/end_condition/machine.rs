//! A machine of several limbs or platforms, commanded for a place.

use kinetostat::{
    Mechanism, MechanismEquilibrium, Pose, Posture, PostureRequest, machine::NearSingularity,
};
use kinetostat_analysis::movable::MovableDirections;
use kinetostat_analysis::outline::chain_outline;
use kinetostat_machining::{Warning, WarningCode};
use nalgebra::Vector3;

use crate::end_condition::coordinates::{CoordinateName, coordinates_of, values_of};
use crate::end_condition::moves::Moves;
use crate::place::query::PlaceQuery;
use crate::place::reachable::Followed;
use crate::ui::failure::Answer;

/// A machine commanded for a place.
pub(crate) struct CommandedMachine {
    pub(crate) mechanism: Mechanism,
    pub(crate) target: Pose,
    /// Commands, where the place is given by them.
    pub(crate) joints: Option<Vec<f64>>,
    pub(crate) followed: Option<Followed>,
    pub(crate) moves: Moves,
}

impl CommandedMachine {
    pub(crate) fn of(query: &PlaceQuery) -> Answer<Self> {
        let posture = query.posture()?;
        Ok(Self {
            moves: Moves {
                subject: "machine",
                place: query.target,
                directions: MovableDirections::of(&posture)?,
            },
            mechanism: query.mechanism.clone(),
            target: query.target,
            joints: query.joints.clone(),
            followed: query.followed.clone(),
        })
    }

    /// Commanded for its place.
    pub(crate) fn posture(&self) -> Answer<Posture> {
        let m = &self.mechanism;
        Ok(match (&self.joints, &self.followed) {
            (Some(joints), _) => m.posture(PostureRequest::commands(joints))?,
            (None, Some(f)) => m.posture(PostureRequest::joints(&self.target, f.limbs.clone()))?,
            (None, None) => m.posture(&self.target)?,
        })
    }

    /// Coordinates of all limbs, one limb after the other.
    pub(crate) fn coordinates(&self, posture: &Posture) -> Vec<CoordinateName> {
        let limbs = self.mechanism.limbs().iter().zip(posture.limbs());
        limbs
            .flat_map(|(limb, joints)| {
                coordinates_of(&limb.actual, &joints.commands)
                    .into_iter()
                    .map(|c| CoordinateName {
                        name: format!("{}: {}", limb.name, c.name),
                        ..c
                    })
            })
            .collect()
    }

    /// Values of all coordinates, in their units.
    pub(crate) fn values(&self, posture: &Posture, e: &MechanismEquilibrium) -> Vec<f64> {
        let limbs = self.mechanism.limbs().iter().zip(posture.limbs());
        limbs
            .zip(&e.limbs)
            .flat_map(|((limb, joints), own)| {
                values_of(&limb.actual, &joints.commands, &own.coordinates)
            })
            .collect()
    }

    /// Every limb from its start to its end and back, one after the other, m.
    pub(crate) fn outline(&self, posture: &Posture, e: &MechanismEquilibrium) -> Vec<Vector3<f64>> {
        let limbs = self.mechanism.limbs().iter().zip(posture.limbs());
        limbs
            .zip(&e.limbs)
            .flat_map(|((limb, joints), own)| {
                let base = &e.state.platforms[limb.from];
                let there = chain_outline(&limb.actual, base, &joints.commands, &own.coordinates);
                let back: Vec<_> = there.iter().rev().skip(1).copied().collect();
                there.into_iter().chain(back)
            })
            .collect()
    }

    /// Singular postures within a distance (m).
    pub(crate) fn near_singular(&self, posture: &Posture, within: f64) -> Answer<Vec<Warning>> {
        let within = within.max(0.1 * self.moves.directions.length);
        let list = posture.near_singularities(within)?;
        let reported = |s: &NearSingularity| Warning::new(WarningCode::NearSingular, s.in_words());
        Ok(list.iter().map(reported).collect())
    }
}

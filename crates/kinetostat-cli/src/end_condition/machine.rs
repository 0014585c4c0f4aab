//! A machine of several limbs or platforms, commanded for a place, with everything that acts on it.

use kinetostat::{Mechanism, MechanismEquilibrium, MotionKind, Posture, machine::NearSingularity};
use kinetostat_analysis::movable::MovableDirections;
use kinetostat_analysis::outline::chain_outline;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode};
use nalgebra::Vector3;

use crate::end_condition::arguments::EndArgs;
use crate::end_condition::chain::node_force;
use crate::end_condition::coordinates::{CoordinateName, coordinates_of, values_of};
use crate::end_condition::moves::Moves;
use crate::end_condition::subject::{Subject, motion_description};
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failing};

/// A machine commanded for a place.
pub(crate) struct CommandedMachine {
    pub(crate) posture: Posture,
    pub(crate) moves: Moves,
}

impl CommandedMachine {
    /// Builds the machine with the constant forces on nodes of its limbs.
    pub(crate) fn of(query: &PlaceQuery, args: &EndArgs) -> Answer<Self> {
        let mut posture = query.posture()?;
        let directions = MovableDirections::of(&posture)?;
        if !args.load.is_empty() {
            let mut mechanism = query.mechanism.clone();
            for text in &args.load {
                mechanism = with_node_force(&mechanism, text)?;
            }
            posture = query.standing_in(&mechanism)?;
        }
        Ok(Self {
            posture,
            moves: Moves {
                subject: "machine",
                place: query.target,
                directions,
            },
        })
    }

    /// Singular postures within a distance (m).
    pub(crate) fn near_singular(&self, within: f64) -> Answer<Vec<Warning>> {
        let within = within.max(0.1 * self.moves.directions.length);
        let list = self.posture.near_singularities(within)?;
        let reported =
            |s: &NearSingularity| Warning::new(WarningCode::NearSingular, s.description());
        Ok(list.iter().map(reported).collect())
    }
}

/// The machine with one more dead force on a node of a limb, written `LIMB:NODE=FX,FY,FZ`.
fn with_node_force(mechanism: &Mechanism, text: &str) -> Answer<Mechanism> {
    let limbs = mechanism.limbs();
    let named = limbs.iter().find_map(|limb| {
        let rest = text.trim_start().strip_prefix(limb.name.as_str())?;
        Some((limb, rest.trim_start().strip_prefix(':')?))
    });
    let Some((limb, own)) = named else {
        let names: Vec<&str> = limbs.iter().map(|limb| limb.name.as_str()).collect();
        return Err(ErrorCode::Value.failure(format!(
                "--load '{text}': this model has several limbs, so name the limb before its node, as in --load {}:tip=0,0,-100. It has: {}",
                names.first().copied().unwrap_or_default(),
                names.join(", ")
            ),
        ));
    };
    let before = format!("{}:", limb.name);
    let load = node_force(&limb.actual, "--load", &before, own)?;
    Ok(mechanism.with_load(&limb.name, load)?)
}

impl Subject for CommandedMachine {
    type Equilibrium = MechanismEquilibrium;

    /// Coordinates of all limbs, one limb after the other.
    fn coordinates(&self) -> Vec<CoordinateName> {
        let limbs = self.posture.mechanism().limbs().iter();
        let limbs = limbs.zip(self.posture.limbs());
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

    fn values(&self, e: &MechanismEquilibrium) -> Vec<f64> {
        let limbs = self.posture.mechanism().limbs().iter();
        let limbs = limbs.zip(self.posture.limbs()).zip(&e.limbs);
        limbs
            .flat_map(|((limb, joints), own)| {
                values_of(&limb.actual, &joints.commands, &own.coordinates)
            })
            .collect()
    }

    /// Outline of every limb from its start to its end and back, one after the other, m.
    fn outline(&self, e: &MechanismEquilibrium) -> Vec<Vector3<f64>> {
        let limbs = self.posture.mechanism().limbs().iter();
        let limbs = limbs.zip(self.posture.limbs()).zip(&e.limbs);
        limbs
            .flat_map(|((limb, joints), own)| {
                let base = &e.state.platforms[limb.from];
                let there = chain_outline(&limb.actual, base, &joints.commands, &own.coordinates);
                let back: Vec<_> = there.iter().rev().skip(1).copied().collect();
                there.into_iter().chain(back)
            })
            .collect()
    }

    fn motion_description(&self, motion: &[f64]) -> String {
        let axes = ["x", "y", "z"];
        let slides = axes.map(|axis| (format!("the tool along {axis}"), MotionKind::Prismatic));
        let turns = axes.map(|axis| (format!("the tool about {axis}"), MotionKind::Revolute));
        let parts: Vec<_> = slides.into_iter().chain(turns).collect();
        let length = self.posture.mechanism().natural_length();
        motion_description(&parts, motion, length)
    }
}

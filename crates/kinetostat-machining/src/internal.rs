//! Internals for this crate's own tests, in `tests/machining/internal`. They are no part of the interface and may change
//! without notice.

use kinetostat::{Mechanism, Pose};

use crate::free_turn::closed_form::SixAxisArm;
use crate::free_turn::error::TurnError;
use crate::free_turn::search::Problem;
use crate::free_turn::task::TurnTask;
use crate::joints::Arm;
use crate::limits::{Limit, apart};
use crate::profile::{Begins, Place, SinceRapid, limited};
use crate::result::joints::ArmConfiguration;
use crate::run::merged_warnings::{MergedWarnings, same_words};
use crate::warning::Warning;

/// The configuration of a machine at joint values, rad; `None` if it is no arm of six axes with a wrist in one point.
#[must_use]
pub fn configuration_at(mechanism: &Mechanism, commands: &[f64]) -> Option<ArmConfiguration> {
    Arm::of(mechanism)?.configuration(commands)
}

/// A figure beyond a limit as it is stated beside what is allowed.
#[must_use]
pub fn figure_beyond(limit: &Limit, found: f64, allowed: f64) -> String {
    let (found, _) = apart(found, allowed, limit.stated());
    found
}

/// Way (mm), value and whether it counts: the same places, and others between, with values that change by at most `rate` per mm;
/// `None` where these do. `begins_with_nothing`: at the first place the value is 0.
#[must_use]
pub fn limited_values(
    places: &[(f64, f64, bool)],
    rate: f64,
    begins_with_nothing: bool,
) -> Option<Vec<(f64, f64)>> {
    let places = places.iter().enumerate();
    let places: Vec<Place<1>> = places
        .map(|(i, &(at_mm, value, counts))| Place {
            move_index: 0,
            share: i as f64,
            at_mm,
            value: [value],
            counts,
        })
        .collect();
    let begins = match begins_with_nothing {
        true => Begins::WithNothing(SinceRapid {
            before_mm: 0.0,
            in_all_mm: places.last().map_or(0.0, |last| last.at_mm),
        }),
        false => Begins::Anyhow,
    };
    let found = limited(&places, &[rate], begins)?.into_iter();
    Some(found.map(|p| (p.place.at_mm, p.value[0])).collect())
}

/// Joint values, rad, of the ways of an arm to a pose of its tool that its closed form finds, each somewhere on its circle; `None` if it is
/// no arm of six axes with a wrist in one point.
#[must_use]
pub fn ways_of_arm(mechanism: &Mechanism, pose: &Pose) -> Option<Vec<[f64; 6]>> {
    let arm = SixAxisArm::of(mechanism)?;
    Some(arm.ways(pose).into_iter().flatten().collect())
}

/// A posture among those that the free turn of a tool is chosen from.
#[derive(Clone, Copy, Debug)]
pub struct TurnPosture {
    /// Number of the turn in the band.
    pub turn: u32,
    /// Number of the configuration.
    pub configuration: u8,
    /// Joint values, rad.
    pub joints: [f64; 6],
    /// Share of half its range by which the joint nearest to a limit is off the middle.
    pub share_of_range: f64,
    /// Smallest singular value.
    pub singular_value: f64,
    /// m/N.
    pub compliance: f64,
}

/// Way in mm and all postures of every station of a task.
///
/// # Errors
/// As [`choose_turns`](crate::choose_turns).
pub fn turn_postures(task: &TurnTask<'_>) -> Result<Vec<(f64, Vec<TurnPosture>)>, TurnError> {
    let problem = Problem::of(task)?;
    let stations = problem.stations.iter().zip(&problem.nodes);
    let listed = stations.map(|(station, nodes)| {
        let nodes = nodes.iter().map(|node| TurnPosture {
            turn: node.turn,
            configuration: node.configuration,
            joints: node.joints,
            share_of_range: node.share_of_range,
            singular_value: node.singular_value,
            compliance: node.compliance,
        });
        (station.at, nodes.collect())
    });
    Ok(listed.collect())
}

/// Warnings of a long program from those of its parts, each with the index of its part.
#[must_use]
pub fn merged_warnings(of_parts: &[(usize, Warning)]) -> Vec<Warning> {
    let mut merged = MergedWarnings::default();
    for (part, warning) in of_parts {
        merged.say(*part, warning);
    }
    merged.finish()
}

/// True if two warnings differ only in their numbers.
#[must_use]
pub fn are_same_words(one: &str, other: &str) -> bool {
    same_words(one, other)
}

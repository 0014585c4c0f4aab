//! Check of the way between two stations, in small steps.

use crate::free_turn::nodes::{Node, Postures, Refused};
use crate::free_turn::serial::Joints;
use crate::free_turn::shortest::joint_turns;
use crate::free_turn::stations::Station;
use crate::free_turn::way::Way;

/// A place at which the way was looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Looked {
    /// Line of the program.
    pub line: usize,
    /// Joint values, rad.
    pub joints: Joints,
    /// Smallest singular value.
    pub singular_value: f64,
}

/// A posture at a station, with the turn of the tool.
#[derive(Clone, Copy)]
pub(crate) struct Stand<'s> {
    pub station: &'s Station,
    /// deg, without jumps of 360 from one station to the next.
    pub turn_deg: f64,
    pub node: &'s Node,
}

/// Settings for checking the way between stations.
pub(crate) struct Between<'t, 'a> {
    pub way: &'t Way<'a>,
    pub postures: &'t Postures<'a>,
    pub free: [bool; 6],
    pub joint_step: f64,
    pub checks: usize,
}

impl Between<'_, '_> {
    /// Places between two stations: evenly, and where moves meet, as way in mm with the section.
    fn places(&self, from: &Station, to: &Station) -> Vec<(f64, usize)> {
        let length = to.at - from.at;
        let pieces = self.checks + 1;
        let even = (1..pieces).map(|piece| from.at + length * piece as f64 / pieces as f64);
        let sections = from.place.move_index..=to.place.move_index;
        let ends = self.way.sections[sections]
            .iter()
            .map(|section| section.from);
        let mut places: Vec<f64> = even.chain(ends).collect();
        places.retain(|at| *at > from.at && *at < to.at);
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
            .into_iter()
            .map(|at| (at, self.way.section_at(at)))
            .collect()
    }

    /// Follows the arm from a posture at one station to a posture at the next; what was seen, or where and why it may not go on.
    pub fn look(&self, start: Stand<'_>, end: Stand<'_>) -> Result<Vec<Looked>, (usize, Refused)> {
        let (from, to) = (start.station, end.station);
        let (a, b) = (start.node, end.node);
        let length = to.at - from.at;
        if length <= 0.0 || to.gap.is_none_or(|gap| !gap.known) {
            return Ok(Vec::new());
        }
        let turn_deg = end.turn_deg - start.turn_deg;
        let whole = joint_turns(&self.free, &a.joints, &b.joints);
        let mut seen = Vec::new();
        for (at, section) in self.places(from, to) {
            let share = (at - from.at) / length;
            let place = self.way.place(section, at);
            let pose = self
                .way
                .turned(&place.pose, start.turn_deg + share * turn_deg);
            let mut even = a.joints;
            for (joint, turn) in even.iter_mut().zip(whole) {
                *joint += share * turn;
            }
            let refused = |why| (place.line, why);
            let found = self.postures.arm.serial.near(&pose, &even);
            let joints = found.ok_or(refused(Refused::Singular))?;
            // Elsewhere than between its neighbours: the arm would have to leave the way.
            let strays = (0..6).any(|joint| (joints[joint] - even[joint]).abs() > self.joint_step);
            if strays || self.postures.configuration_of(&joints) != Some(a.configuration) {
                return Err(refused(Refused::Singular));
            }
            let singular_value = self.postures.allowed(&joints).map_err(refused)?;
            seen.push(Looked {
                line: place.line,
                joints,
                singular_value,
            });
        }
        Ok(seen)
    }
}

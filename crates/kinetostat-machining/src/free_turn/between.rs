//! What happens between two stations: the way from one to the other, followed in small steps.

use crate::free_turn::nodes::{Node, Postures, Refused};
use crate::free_turn::serial::Joints;
use crate::free_turn::shortest::joint_turns;
use crate::free_turn::stations::{Station, Turns};
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

/// How and with what the way between stations is looked at.
pub(crate) struct Between<'t, 'a> {
    pub way: &'t Way<'a>,
    pub turns: &'t Turns,
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
    pub fn look(
        &self,
        (from, a): (&Station, &Node),
        (to, b): (&Station, &Node),
    ) -> Result<Vec<Looked>, (usize, Refused)> {
        let length = to.at - from.at;
        if length <= 0.0 || to.gap.is_none_or(|gap| !gap.known) {
            return Ok(Vec::new());
        }
        let turn_deg = self.turns.steps(a.turn, b.turn) as f64 * self.turns.step_deg;
        let whole = joint_turns(&self.free, &a.joints, &b.joints);
        let mut seen = Vec::new();
        for (at, section) in self.places(from, to) {
            let share = (at - from.at) / length;
            let place = self.way.place(section, at);
            let pose = self
                .way
                .turned(&place.pose, self.turns.deg(a.turn) + share * turn_deg);
            let mut start = a.joints;
            for (joint, turn) in start.iter_mut().zip(whole) {
                *joint += share * turn;
            }
            let refused = |why| (place.line, why);
            let found = self.postures.arm.serial.near(&pose, &start);
            let joints = found.ok_or(refused(Refused::Singular))?;
            // Elsewhere than between its neighbours: the arm would have to leave the way.
            let strays = (0..6).any(|joint| (joints[joint] - start[joint]).abs() > self.joint_step);
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

//! Warnings about rotary axes along a path: angles beyond their limits, and angles that are not determined.

use nalgebra::Vector3;

use crate::number::larger;
use crate::path::moves::{Knowledge, Move, MoveKind, Path, Warning};
use crate::path::rotary::RotaryAxes;
use crate::path::tool_turn::{RotaryTurn, StatedBy};

/// Directions that differ by less are one.
const SAME: f64 = 1e-7;

/// Turns below this are none, deg.
const TURNS_DEG: f64 = 1e-3;

/// One finding in several blocks: its first line, how many more, what is said there.
struct Several {
    line: usize,
    more: usize,
    text: String,
}

impl Path {
    /// Rotary axes whose words send them beyond their limits; and those that turn away from where the tool lies along them: a direction
    /// says no angle there, and the controller may have another one. Each with the first line.
    ///
    /// ```
    /// use kinetostat_program::*;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let head = |letter, direction| RotaryAxis {
    ///     letter,
    ///     carries: Carries::Tool,
    ///     direction,
    ///     point_mm: Vector3::zeros(),
    ///     limits_deg: Some([-60.0, 60.0]),
    /// };
    /// let axes = vec![head('C', Vector3::z_axis()), head('A', Vector3::x_axis())];
    /// let mut reading = ReadOptions::default();
    /// reading.rotary = Some(RotaryAxes { axes, tool_at_zero: UnitQuaternion::identity() }.into());
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5 A0 C0\nG43.4 H1 Z5\nG1 A30 C40 F100\nC70\nC65\n")?;
    /// let found = interpret(&program, &reading)?.rotary_findings();
    /// assert_eq!((found.len(), found[0].line), (1, 5));
    /// assert!(found[0].text.starts_with("axis C is sent to 70 deg, and it reaches -60 to 60 deg"));
    /// # Ok::<(), ProgramError>(())
    /// ```
    #[must_use]
    pub fn rotary_findings(&self) -> Vec<Warning> {
        let turns = self.moves.iter().filter_map(|motion| {
            let turn = motion.tool_turn.as_ref()?.rotary.as_ref()?;
            (motion.known != Knowledge::Nothing).then_some((motion, turn))
        });
        let (mut beyond, mut open) = (Vec::new(), Vec::new());
        let mut before = StatedBy::Angles;
        for (motion, turn) in turns {
            note_beyond(motion, turn, &mut beyond);
            // The angle is known after words have stated it.
            if before == StatedBy::Direction {
                note_open(motion, turn, &self.tool_axis, &mut open);
            }
            before = turn.stated;
        }
        let mut found: Vec<Warning> = (beyond.into_iter().chain(open))
            .map(|(_, several)| {
                Warning::new(
                    several.line,
                    match several.more {
                        0 => several.text,
                        1 => format!("{} (and in 1 more block)", several.text),
                        n => format!("{} (and in {n} more blocks)", several.text),
                    },
                )
            })
            .collect();
        found.sort_by_key(|warning| warning.line);
        found
    }
}

fn note(all: &mut Vec<(char, Several)>, letter: char, line: usize, text: impl FnOnce() -> String) {
    match all.iter_mut().find(|(known, _)| *known == letter) {
        Some((_, several)) => several.more += 1,
        None => all.push((
            letter,
            Several {
                line,
                more: 0,
                text: text(),
            },
        )),
    }
}

/// A stated angle beyond the limits of its axis.
fn note_beyond(motion: &Move, turn: &RotaryTurn, found: &mut Vec<(char, Several)>) {
    if turn.stated != StatedBy::Angles {
        return;
    }
    let Some((axis, angle)) = turn.axes.angle_outside(&turn.end_deg) else {
        return;
    };
    let [least, largest] = axis.limits_deg.unwrap_or_default();
    note(found, axis.letter, motion.line, || {
        format!(
            "axis {} is sent to {} deg, and it reaches {least} to {largest} deg (limits_deg of [[rotary_axis]], or of its joint): the controller will stop there",
            axis.letter,
            plain(angle)
        )
    });
}

/// A cut that turns an axis away from where the tool lies along it.
fn note_open(
    motion: &Move,
    turn: &RotaryTurn,
    tool_axis: &Vector3<f64>,
    found: &mut Vec<(char, Several)>,
) {
    let evenly = turn.stated == StatedBy::Direction && turn.great_circle.is_none();
    if !evenly || motion.kind != MoveKind::Feed || motion.known != Knowledge::Whole {
        return;
    }
    for (index, axis) in turn.axes.axes.iter().enumerate() {
        let (from, to) = (turn.start_deg[index], turn.end_deg[index]);
        if (to - from).abs() > TURNS_DEG
            && lies_along(&turn.axes, &turn.start_deg, index, tool_axis)
        {
            note(found, axis.letter, motion.line, || {
                format!(
                    "at the start of this block the tool lies along axis {0}, and no direction says its angle there: it is taken to stay at {1} deg until then and to turn evenly to {2} deg in the block. Where the controller has it elsewhere the tool goes another way",
                    axis.letter,
                    plain(from),
                    plain(to)
                )
            });
        }
    }
}

/// True if the tool lies along an axis: its rotation leaves the direction of the tool in the part.
fn lies_along(
    axes: &RotaryAxes,
    angles_deg: &[f64],
    index: usize,
    tool_axis: &Vector3<f64>,
) -> bool {
    let stands = axes.tool_direction_at(angles_deg, tool_axis);
    let moved = [90.0, 180.0].map(|by| {
        let mut angles = angles_deg.to_vec();
        angles[index] += by;
        (axes.tool_direction_at(&angles, tool_axis) - stands).norm()
    });
    larger(moved[0], moved[1]) < SAME
}

/// An angle in words, with at most three digits behind the point.
fn plain(angle: f64) -> String {
    let text = format!("{angle:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}

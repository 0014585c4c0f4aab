//! Angle and time of the tool's rotation in the part during a move.

use crate::number::larger;
use crate::path::moves::{FeedMode, Move};
use crate::path::rotary::Carries;

impl Move {
    /// Rotation of the tool in the part, in degrees: the travel of rotary axes by their words, or else the angle between the
    /// two orientations. For several axes it is the root of the sum of squares, as controllers count the feed of a block in
    /// which nothing else moves (NIST RS274/NGC, 2.1.2.5). Zero in a program of positions.
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
    ///     limits_deg: None,
    /// };
    /// let axes = vec![head('C', Vector3::z_axis()), head('A', Vector3::x_axis())];
    /// let mut reading = ReadOptions::default();
    /// reading.rotary = Some(RotaryAxes { axes, tool_at_zero: UnitQuaternion::identity() }.into());
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5 A0 C0\nG43.4 H1 Z5\nG1 A30 C40 F100\n")?;
    /// let path = interpret(&program, &reading)?;
    /// let turn = path.moves.last().unwrap();
    /// assert!(turn.turns_in_place());
    /// assert_eq!(turn.turn_deg(), 50.0);
    /// # Ok::<(), ProgramError>(())
    /// ```
    #[must_use]
    pub fn turn_deg(&self) -> f64 {
        let Some(turn) = &self.tool_turn else {
            return 0.0;
        };
        match &turn.rotary {
            Some(rotary) => {
                let squares = rotary.ways_deg().into_iter().map(|way| way * way);
                squares.sum::<f64>().sqrt()
            }
            None => turn.start.angle_to(&turn.end).to_degrees(),
        }
    }

    /// Time of a rotation in place at its programmed feed, in s: `F` of G94 is in degrees per minute if only rotary axes move.
    /// `None` if the program does not state it, and for robots, whose rotation speeds are their own.
    pub(crate) fn turn_seconds(&self) -> Option<f64> {
        let feed = self.feed?;
        let turn = self.tool_turn.as_ref()?;
        match feed.mode {
            FeedMode::InverseTime => Some(60.0 / feed.value),
            FeedMode::PerMinute if turn.rotary.is_some() => {
                Some(60.0 * self.turn_deg() * self.words.mm_per_unit / feed.value)
            }
            _ => None,
        }
    }

    /// The longer of the way of the tip, and that of a point of the tool so far from it, in mm.
    pub(crate) fn way_with_turn_mm(&self, lever_mm: f64) -> f64 {
        larger(self.length_mm(), self.turn_deg().to_radians() * lever_mm)
    }

    /// Motion of the machine per length within which its deflection is a power series (in mm), or per radian for rotations, if the tool
    /// rotated on the whole move as fast as between two shares: the sum over all axes, a table with the distance of the tip from it.
    pub(crate) fn turn_ratio(&self, radius_mm: f64, between: [f64; 2]) -> f64 {
        let Some(turn) = &self.tool_turn else {
            return 0.0;
        };
        let Some(rotary) = &turn.rotary else {
            return turn.start.angle_to(&turn.end);
        };
        let ways = match &rotary.great_circle {
            Some(circle) => circle.fastest_deg(between),
            None => rotary.ways_deg(),
        };
        let each = rotary.axes.axes.iter().zip(ways).map(|(axis, way)| {
            let far = (self.start - axis.point_mm).norm();
            let far = larger(far, (self.end - axis.point_mm).norm());
            let carries = match axis.carries {
                Carries::Part => larger(1.0, far / radius_mm),
                Carries::Tool => 1.0,
            };
            way.to_radians() * carries
        });
        each.sum()
    }
}

//! Orientation of the tool on moves and paths; angle and time of its rotation.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::number::larger;
use crate::path::moves::{FeedMode, Move, Path};
use crate::path::rotary::Carries;

impl Move {
    /// The orientation of the tool at a share of the move, part axes from tool axes; `None` in a program of positions.
    ///
    /// ```
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG1 X9 F600\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// assert!(path.moves[1].orientation(0.5).is_none()); // in X, Y and Z alone
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn orientation(&self, share: f64) -> Option<UnitQuaternion<f64>> {
        self.tool_turn.as_ref().map(|turn| turn.at(share))
    }

    /// Motion of the part by a table at a share of the move, from its place with all rotary axes at zero, in the axes of the part there,
    /// mm; `None` if no table turns it.
    ///
    /// ```
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG1 X9 F600\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// assert!(path.moves[1].part_turn(0.5).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn part_turn(&self, share: f64) -> Option<Isometry3<f64>> {
        self.tool_turn.as_ref()?.part(share)
    }

    /// True if the tool rotates in place: the move has no length, and two orientations.
    ///
    /// ```
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG1 X0 F600\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// assert!(!path.moves[1].turns_in_place()); // it stands
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn turns_in_place(&self) -> bool {
        let turn = self.tool_turn.as_ref();
        let turns = turn.is_some_and(|turn| match &turn.rotary {
            Some(rotary) => rotary.start_deg != rotary.end_deg,
            None => turn.start.angle_to(&turn.end) > 1e-6,
        });
        !self.has_length() && turns
    }
}

impl Path {
    /// Direction of the tool at a share of a move, from its tip to its holder, part axes: z in a program of positions.
    ///
    /// ```
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    /// use nalgebra::Vector3;
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG1 X9 F600\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// assert_eq!(path.tool_direction(1, 0.5), Vector3::z());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn tool_direction(&self, move_index: usize, share: f64) -> Vector3<f64> {
        let orientation = self.moves[move_index].orientation(share);
        orientation.map_or_else(Vector3::z, |orientation| orientation * self.tool_axis)
    }
}

impl Path {
    /// A path of moves that a program of another language than G-code makes, with the direction from the tool's tip to its
    /// holder in axes of the tool. All axes count as stated; nothing else is known of it.
    ///
    /// ```
    /// use kinetostat_program::Path;
    /// use nalgebra::Vector3;
    ///
    /// let path = Path::of_moves(Vec::new(), -Vector3::z());
    /// assert_eq!(path.stated, [true; 3]);
    /// ```
    #[must_use]
    pub fn of_moves(moves: Vec<Move>, tool_axis: Vector3<f64>) -> Self {
        Self {
            moves,
            tool_axis,
            stated: [true; 3],
            ..Self::default()
        }
    }
}

/// Angle and time of the tool's rotation in the part during a move.
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

//! Orientation of the tool on moves and paths.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::path::moves::{Move, Path};

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

//! Settings of the reading that a program does not state.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::Vector3;

use crate::path::rotary::RotaryAxes;

/// Unit of length of the coordinate words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Units {
    /// G21.
    Millimetres,
    /// G20.
    Inches,
}

impl Units {
    /// Millimetres in one unit.
    pub fn mm_per_unit(self) -> f64 {
        match self {
            Units::Millimetres => 1.0,
            Units::Inches => 25.4,
        }
    }
}

/// Execution of blocks marked with `/`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BlockDelete {
    /// The machine's switch is off: the blocks are run (the default).
    #[default]
    Run,
    /// The machine's switch is on: the blocks are carried along and not run.
    Skip,
}

/// Treatment of axes other than X, Y, Z and the extruder E.
///
/// A rotary table or head (A B C) and a second set of slides (U V W) change where the tool stands in the
/// part and in the machine, and there is no model of them here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OtherAxes {
    /// The first block with such a word is refused (the default).
    #[default]
    Refused,
    /// The user says that they stand still while the tool cuts, or that their motion does not change
    /// where the tool stands in the part. Their words are carried, and shared out over the pieces of a
    /// divided block; a warning names the first block that moves one of them.
    StandStill,
    /// Words of A, B and C are carried, whatever they turn: for a program that is written flat ([`crate::expand`]) and read again
    /// with the axes of its machine. Words of U, V and W are refused.
    Carried,
}

/// Whose places X, Y and Z are while rotary axes stand at an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ToolCentrePoint {
    /// The tool's tip in the part between G43.4 and G49, the machine's slides elsewhere.
    #[default]
    ByCode,
    /// The tool's tip in the part all along.
    Throughout,
}

/// Settings of the reading that the program cannot supply.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Units in force before the first G20 or G21. With `None` (the default) a program that moves before it has named its units
    /// is read in millimetres, with a warning. A program that names its units before anything moves is read in its own.
    pub units: Option<Units>,
    /// Origins of G54, G55, G56, G57, G58, G59, G59.1, G59.2, G59.3 in the part frame, in mm; those that
    /// are not stated are zero: the program's coordinates are the part's. A program that uses one of them beside stated
    /// ones is warned of.
    pub work_offsets_mm: [Option<Vector3<f64>>; 9],
    /// Tool position before the first block, in mm, part frame.
    ///
    /// `None` (the default) means unknown. An axis is then unknown until the program states it (an
    /// absolute word or G92), and until all axes that the program ever states are known its blocks
    /// are carried unchanged: a correction written into `G1 Z5` as the first block would send the
    /// tool across the machine to an X and Y that nobody asked for. An axis that the program never
    /// states is taken as zero and never written.
    pub start_position_mm: Option<Vector3<f64>>,
    /// Tool point in the part frame, in mm, when the machine is at its zero and no tool length is in force: G53 and
    /// the reference points count from there. `None` (the default): not known, and the position after G28, G30 and
    /// G53 is not known until the program states it.
    pub machine_zero_mm: Option<Vector3<f64>>,
    /// Reference points of G28 and G30, in mm, machine coordinates. `None` (the default): not known.
    pub reference_points_mm: [Option<Vector3<f64>>; 2],
    /// Largest difference of an arc's radii at start and end, in mm; 0.005 by default, as common
    /// controllers have it. Within it the radius changes evenly from one to the other.
    pub arc_tolerance_mm: f64,
    /// Execution of blocks marked with `/`.
    pub block_delete: BlockDelete,
    /// Treatment of words of the axes A B C U V W.
    pub other_axes: OtherAxes,
    /// The rotary axes of the machine. Their words turn tool and part; words of others are read as [`OtherAxes`] says.
    pub rotary: Option<Arc<RotaryAxes>>,
    /// Whose places X, Y and Z are while they stand at an angle.
    pub tool_centre_point: ToolCentrePoint,
    /// The program was run once for Fanuc's controllers ([`crate::Dialect::Fanuc`]). What only the controller has stays as it is written, with a
    /// warning: canned cycles, one hole in a block over which the tool stands, and calls of subprograms (M98, G65) that are in none of
    /// the files, which are taken not to move the tool.
    pub of_fanuc_run: bool,
    /// Numbers of such subprograms that move the tool: their calls are refused.
    pub moving_calls: BTreeSet<u32>,
    /// Numbers of the tools that the field of corrections knows, each with its length. `None` (the
    /// default) means one tool for the whole program: a second tool is warned of. With a list, a tool
    /// outside it is refused, and so is a tool change beside a motion.
    pub tools: Option<Vec<u32>>,
    /// For such a list: true if the field knows the tool that is in the spindle before the program names one. If not,
    /// a block that cuts before that is refused.
    pub tool_before_first: bool,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            units: None,
            work_offsets_mm: [None; 9],
            start_position_mm: None,
            machine_zero_mm: None,
            reference_points_mm: [None; 2],
            arc_tolerance_mm: 0.005,
            block_delete: BlockDelete::Run,
            other_axes: OtherAxes::Refused,
            rotary: None,
            tool_centre_point: ToolCentrePoint::ByCode,
            of_fanuc_run: false,
            moving_calls: BTreeSet::new(),
            tools: None,
            tool_before_first: true,
        }
    }
}

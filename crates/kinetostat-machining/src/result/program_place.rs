//! Places of a run for questions beside it: where machines that are not as drawn have their tool, for instance.

use kinetostat::{Pose, Wrench};

/// A place at which a run was solved, as poses of the machine.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ProgramPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Index of its move in the path.
    pub move_index: usize,
    /// Share of that move, 0 to 1.
    pub share: f64,
    /// Number of its tool; `None` if the run has one tool for all blocks.
    pub tool: Option<u32>,
    /// Commanded pose of the program as it is: base from tool, m.
    pub programmed: Pose,
    /// Desired pose of the tool: the programmed one, or that in the part as it was measured
    /// ([`crate::WeightCorrection`]).
    pub wanted: Pose,
    /// Commanded pose of the written program; `programmed` without one.
    pub commanded: Pose,
    /// Desired pose of the tool when the written program has turned the part; `wanted` unless a table turns it otherwise.
    pub wanted_as_commanded: Pose,
    /// Wrench on the tool: base axes, about its tip, N and N m.
    pub wrench: Wrench,
    /// Distance of the tool from where it should be, with the program as it is, mm of the program.
    pub error_before_mm: f64,
    /// Distance with the written program.
    pub error_after_mm: f64,
    /// Metres in the machine per millimetre of the program.
    pub metres_per_mm: f64,
    /// Compliance of the tool's tip about the equilibrium there while the tool may turn as it likes, program axes, um/N of the
    /// machine: row by row, the symmetric part. `None` if nothing holds the tool, or the machine has no equilibrium.
    pub compliance_um_per_n: Option<[[f64; 3]; 3]>,
}

//! A program corrected by a field that was not solved along it: a table of corrections, or what was measured.

use kinetostat_program::{
    Corrected, CorrectionField, CorrectionMap, FieldCheck, MachineProgram, Monitor, NoCorrection,
    Path, WriteError, WriteOptions, verify_against_field,
};

use crate::number::mean_length;
use crate::result::tolerance;
use crate::warning::{Warning, WarningCode};
use kinetostat::number::{larger, smaller};

/// The program as it will be written, and how far it is from the table.
#[derive(Clone, Debug)]
pub struct FieldCorrection {
    /// The program with its corrections, or without any where it keeps the tolerance as it is.
    pub written: Corrected,
    /// Deviations from the field of the written program and of the program as it is.
    pub against: FieldCheck,
    /// True if the uncorrected program keeps the tolerance.
    pub keeps_as_it_is: bool,
    /// The largest correction that the field asks for, mm, and its line; written or not.
    pub largest_correction: (f64, Option<usize>),
}

/// Corrects a program by a field, or leaves it as it is where that keeps the tolerance: what is written could be farther off.
///
/// # Errors
/// As [`MachineProgram::write`].
pub fn correct_by_field(
    program: &dyn MachineProgram,
    field: &dyn CorrectionField,
    writing: &WriteOptions,
    monitor: &dyn Monitor,
) -> Result<FieldCorrection, WriteError> {
    let written = program.write(field, writing, monitor)?;
    let against = verify_against_field(program.path(), &written, field, writing, monitor)?;
    let a = &written.accounting;
    let mut made = FieldCorrection {
        keeps_as_it_is: written.bytes != program.bytes()
            && tolerance::keeps_as_it_is(
                against.before.distance_mm.max(against.before_at_ends_mm),
                against.after.distance_mm,
                writing.tolerance_mm,
                against.allowed_mm,
            ),
        largest_correction: (a.largest_correction_mm, a.largest_correction_line),
        written,
        against,
    };
    if made.keeps_as_it_is {
        // Measured deviation, so that the warning has the figure of the result.
        let before = made.against.before;
        made.largest_correction = (before.distance_mm, before.line);
        made.written = program.write(&NoCorrection, writing, monitor)?;
    }
    Ok(made)
}

/// A table so many times as wide as the program, and no smaller than this (mm), may have its nodes in micrometres.
const WIDE_SHARE: f64 = 50.0;

/// See [`WIDE_SHARE`].
const WIDE_MM: f64 = 10_000.0;

/// Nodes that may be in micrometres: along every axis along which both reach, the table is far wider.
#[must_use]
pub fn wide_table(path: &Path, field: &CorrectionMap) -> Option<Warning> {
    let [low, high] = field.bounds_mm();
    let feeds = || {
        let moves = path.moves.iter();
        moves.filter(|m| m.is_known_feed())
    };
    let mut found = None;
    for axis in 0..3 {
        let places = || feeds().flat_map(|m| [0.0, 0.25, 0.5, 0.75, 1.0].map(|s| m.point(s)[axis]));
        let least = places().fold(f64::INFINITY, smaller);
        let program = places().fold(f64::NEG_INFINITY, larger) - least;
        let table = high[axis] - low[axis];
        if !(program > 0.0 && table > 0.0) {
            continue;
        }
        if table < WIDE_SHARE * program || table < WIDE_MM {
            return None;
        }
        found.get_or_insert((axis, table, program));
    }
    let (axis, table, program) = found?;
    Some(Warning::new(
        WarningCode::WideTable,
        format!(
            "the table reaches over {} in {}, the program over {}: are its nodes in micrometres? Positions and corrections are in millimetres",
            mean_length(table),
            ["x", "y", "z"][axis],
            mean_length(program)
        ),
    ))
}

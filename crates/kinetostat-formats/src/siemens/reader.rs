//! The reader of SINUMERIK programs.

use crate::error::ProgramError;
use crate::model::language::Language;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::stated_value::told_of_values;
use crate::options::ReadOptions;
use crate::siemens::scan::scan;
use crate::siemens::walker::Scan;
use crate::text::source::SourceFile;

/// Reads programs of the SINUMERIK 840D and its kin (`.mpf`, `.spf`), each file for itself.
///
/// Poses are in the axes of the part: those of the settable frame (G54, G505, ...), which is the work object; programmable frames
/// (TRANS, ROT) are applied. Where these frames are, and the tools (`T1`), the options say. Where a direction of the tool is
/// stated (A3, B3, C3, or A2, B2, C2) the orientation turns Z into it by the shortest way. R parameters and variables of a
/// program that runs straight on are followed, and so are angles of the rotary axes that [`ReadOptions::rotary_axes`] names; jumps, loops, calls and cycles are refused: [`crate::expand_siemens`] runs them.
/// Rapids to places of the machine (SUPA, G53) and from places that are not known stay as they are.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, read_siemens};
///
/// let text = "N10 G17 G90 G94 G71\nN20 T1 D1 M6\nN30 G54\nN40 TRANS X100\nN50 G0 X0 Y0 Z5\nN60 G1 Z-2 F600\n\
///     N70 G3 X10 Y10 CR=10\nM30\n";
/// let program = read_siemens(vec![SourceFile::new("part.mpf", text)], &ReadOptions::default()).unwrap();
/// let last = &program.motions[2];
/// assert_eq!(last.target.pose().unwrap().position_mm.as_slice(), [110.0, 10.0, -2.0]);
/// assert_eq!((last.work_object.name.as_str(), last.speed.mm_per_s), ("G54", Some(10.0)));
/// let MotionKind::Arc { angle_rad, .. } = last.kind else { panic!() };
/// assert!((angle_rad.to_degrees() - 90.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_siemens(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_siemens(files, options).without_faults()
}

/// Reads a program; the motions that could be read are returned beside the errors.
pub(crate) fn parse_siemens(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let Scan {
        motions,
        faults,
        mut findings,
        outside_calls,
        unjudged_feed_on,
        rotary,
        ..
    } = scan(&files, options);
    findings.extend(
        (files.first().into_iter()).flat_map(|file| told_of_values(&options.values, file.bytes())),
    );
    let parsed = Parsed::of(Language::Siemens, files, motions, findings, faults);
    let mut parsed = parsed.with_calls(outside_calls, &options.moving_calls);
    parsed.program.slash_blocks = options.slash_blocks;
    parsed.program.rotary = rotary;
    parsed.program.unjudged_feed_on = unjudged_feed_on;
    parsed
}

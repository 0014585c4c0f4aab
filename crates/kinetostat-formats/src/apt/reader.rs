//! The reader of APT and CLDATA.

use crate::apt::dialect::Dialect;
use crate::apt::file_reader::{Found, Reader};
use crate::apt::lines::statements_of;
use crate::apt::state::{State, unit_of};
use crate::error::ProgramError;
use crate::model::language::Language;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::ReadOptions;
use crate::text::source::SourceFile;

const MOST_BYTES: usize = 1 << 28;

/// Reads APT and CLDATA (`.apt`, `.cls`, `.aptsource`), each file for itself, as SOLIDWORKS CAM, Siemens NX, CATIA and others
/// write them.
///
/// Places are those of `GOTO`, in mm; the tool's axis is the last one that was stated, and the turn about it is free: the
/// orientation turns Z into the axis by the shortest way. Arcs are [`MotionKind::Arc`](crate::MotionKind::Arc). The work object is `MSYS` in the
/// part's axes; where the part is, the options say (`PART`), and where the tool is (`TOOL:5`). Holes of cycles, ends that
/// only geometry states and helices of several turns are refused, or stay as written with
/// [`crate::UnknownTargets::LeftAsWritten`].
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, read_apt};
///
/// let text = "PARTNO/1\nUNIT/MM\nTRNTYP/WORLD,0,0,0\nRAPID/\nGOTO/10.,0,25.\nFEDRAT/600.,MMPM\nGOTO/10.,0,-2.5\n\
///     CIRCLE/0,0,-2.5,0,0,1.\nGOTO/0,10.,-2.5\n";
/// let program = read_apt(vec![SourceFile::new("part.apt", text)], &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions[1].speed.mm_per_s, Some(10.0));
/// let MotionKind::Arc { angle_rad, .. } = program.motions[2].kind else { panic!() };
/// assert!((angle_rad.to_degrees() - 90.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_apt(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_apt(files, options).without_faults()
}

/// Reads APT files; the motions that could be read are returned beside the errors.
pub(crate) fn parse_apt(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let frames = options.frames.iter();
    let mut program = Found {
        options,
        frames: frames
            .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
            .collect(),
        faults: Vec::new(),
        findings: Vec::new(),
        motions: Vec::new(),
    };
    for (index, file) in files.iter().enumerate() {
        if let Some(fault) = ProgramError::too_large(file, MOST_BYTES) {
            program.faults.push(fault);
            continue;
        }
        let statements = statements_of(file.bytes());
        let dialect = Dialect::of(file, &statements);
        let (unit, others) = unit_of(file, &statements);
        let mut reader = Reader {
            program: &mut program,
            file,
            index,
            dialect,
            unit_mm: unit.unwrap_or(1.0),
            state: State::new(),
        };
        let written_by = match unit {
            Some(_) => format!("written by {}", dialect.name()),
            None => format!(
                "written by {}; no unit is stated: taken as mm",
                dialect.name()
            ),
        };
        reader.finding(&(0..0), written_by);
        for span in others {
            reader.fault(
                &span,
                "the unit is not known, or another one than before",
                "state MM or INCH once",
            );
        }
        for statement in &statements {
            reader.statement(statement);
        }
        reader.end_circle();
        reader.raw_text(&statements);
    }
    let Found {
        motions,
        findings,
        faults,
        ..
    } = program;
    Parsed::of(Language::Apt, files, motions, findings, faults)
}

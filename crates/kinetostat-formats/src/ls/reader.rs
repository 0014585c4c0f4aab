//! The reader of FANUC TP programs.

use crate::error::ProgramError;
use crate::ls::found::Reader;
use crate::ls::positions::Positions;
use crate::ls::run::{Files, Run};
use crate::model::language::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ExternalAxes, ReadOptions};
use crate::text::source::SourceFile;

/// Reads FANUC TP programs as text (`.ls`): one, or the first and those that it calls.
///
/// The programs are run as the controller runs them: loops, branches, jumps and calls with the values that the files and the options
/// state ([`ReadOptions::values`]: `R[1]`, `DI[3]`, `PR[2,3]`). A statement that runs several times gives as many motions. A branch on a
/// value that only the controller knows is passed over where its arms neither move the tool nor change the frame or the tool, and refused
/// with its line otherwise.
///
/// The frames and tools of positions are checked against `UFRAME_NUM` and `UTOOL_NUM` where these are known from the
/// text; what they are, the options say (`UF:2`, `UT:1`; `UF:0` and `UT:0` are the world and the flange), or the program, where it
/// gives them values that are known from its text (`UTOOL[1]=PR[9]`). Motions to position registers, offset by registers whose values
/// are not known, or ended by signals are refused, or stay as written with
/// [`crate::UnknownTargets::LeftAsWritten`]; coordinated motion is refused.
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, read_ls};
/// use nalgebra::Isometry3;
///
/// let text = "/PROG GROOVE\n/ATTR\nLINE_COUNT = 3;\n/MN\n\
///    1:  UFRAME_NUM=2 ;\n   2:  UTOOL_NUM=1 ;\n   3:L P[1] 20mm/sec FINE ;\n\
/// /POS\nP[1]{\n   GP1:\n\tUF : 2, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\
/// \tX =   100.000  mm,\tY =      .000  mm,\tZ =     5.000  mm,\n\
/// \tW =   180.000 deg,\tP =      .000 deg,\tR =      .000 deg\n};\n/END\n";
/// let mut options = ReadOptions::default();
/// options.frames.insert("UF:2".into(), Isometry3::translation(0.0, 0.0, 100.0));
/// let program = read_ls(vec![SourceFile::new("GROOVE.LS", text)], &options).unwrap();
/// let motion = &program.motions[0];
/// assert_eq!(motion.speed.mm_per_s, Some(20.0));
/// assert_eq!(motion.base_pose().unwrap().translation.z, 105.0);
/// assert_eq!(motion.target.pose().unwrap().configuration.text, "N U T, 0, 0, 0");
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_ls(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_ls(files, options).without_faults()
}

/// Reads all that can be read of FANUC TP programs.
pub(crate) fn parse_ls(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let read = with_run(&files, options, |run| {
        let run = run.whole();
        Read {
            motions: run.motions,
            declarations: run.reader.declarations,
            findings: run.reader.findings,
            outside_calls: run.outside_calls,
            ran: run.ran_beside,
            faults: run.reader.faults,
            external_axes_may_move: options.external_axes != ExternalAxes::Refused,
            moving_calls: &options.moving_calls,
        }
    });
    Parsed::of_robot(Language::FanucLs, files, read)
}

/// Gives a run that has not begun to a function.
pub(super) fn with_run<T>(
    files: &[SourceFile],
    options: &ReadOptions,
    with: impl FnOnce(Run<'_, '_>) -> T,
) -> T {
    let mut reader = Reader {
        options,
        faults: Vec::new(),
        findings: Vec::new(),
        declarations: Vec::new(),
    };
    let (mut layouts, mut positions, mut programs) = (Vec::new(), Vec::new(), Vec::new());
    for (index, file) in files.iter().enumerate() {
        let layout = reader.layout_of(file);
        let section = layout.positions.clone().unwrap_or_default();
        let found = Positions::of(file.bytes(), section, index, &mut reader.declarations);
        for (span, reason, remedy) in layout.faults.iter().chain(&found.faults) {
            reader.fault(file, span.clone(), *reason, *remedy);
        }
        programs.push(reader.program_of(file, index, &layout, &found));
        layouts.push(layout);
        positions.push(found);
    }
    let all = Files {
        names: reader.names_of(files, &layouts),
        files,
        layouts: &layouts,
        programs: &programs,
        positions: &positions,
    };
    let outside_calls = all.outside_calls();
    with(Run::new(reader, &all, outside_calls))
}

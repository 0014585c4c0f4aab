//! The reader of FANUC TP programs.

use std::collections::BTreeMap;

use crate::error::ProgramError;
use crate::ls::ends::{Ends, MotionPlace};
use crate::ls::flow::{Flow, Last};
use crate::ls::found::Reader;
use crate::ls::order::Order;
use crate::ls::positions::Positions;
use crate::ls::program::Place;
use crate::ls::step::Step;
use crate::model::language::Language;
use crate::model::motion::Runs;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ExternalAxes, ReadOptions};
use crate::text::source::SourceFile;

/// Reads FANUC TP programs as text (`.ls`): one, or the first and those that it calls.
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
    let mut reader = Reader {
        options,
        faults: Vec::new(),
        findings: Vec::new(),
        outside_calls: Vec::new(),
        motions: Vec::new(),
        declarations: Vec::new(),
        ends: Ends::of(options),
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
    reader.link_calls(&files, &layouts, &mut programs);
    let flow = Flow::of(&programs, &reader.ends.frames);
    reader.given_frames(&files, &layouts, (&programs, &flow));
    let order = Order::of(&programs);
    let mut indices: BTreeMap<Place, usize> = BTreeMap::new();
    for (program, at) in &order.motions {
        let Step::Motion(motion) = &programs[*program].steps[*at] else {
            continue;
        };
        let declarations = std::mem::take(&mut reader.declarations);
        let site = MotionPlace {
            declarations: &declarations,
            file: &files[*program],
            index: *program,
            line: &layouts[*program].lines[*at],
            positions: &positions[*program],
            before: flow.before[*program][*at],
            registers: flow.registers(flow.before[*program][*at]),
        };
        let found = reader.motion_of(motion, &site);
        let before = site.before;
        reader.declarations = declarations;
        let Some(mut motion) = found else {
            continue;
        };
        motion.runs = match before {
            Some(_) => programs[*program].runs[*at].max(order.runs[*program]),
            // Behind END or ABORT, and no jump leads there.
            None => Runs::Elsewhere,
        };
        let last = before.map(|state| match state.last {
            Last::Entry => flow.entry[*program].unwrap_or(Last::Unknown),
            last => last,
        });
        motion.follows = match last {
            Some(Last::Motion(place)) => indices.get(&place).copied(),
            _ => None,
        };
        indices.insert((*program, *at), reader.motions.len());
        reader.motions.push(motion);
    }
    finish(reader, files)
}

/// The program with what a person should know of it.
fn finish(reader: Reader<'_>, files: Vec<SourceFile>) -> Parsed {
    let read = Read {
        motions: reader.motions,
        declarations: reader.declarations,
        findings: reader.findings,
        outside_calls: reader.outside_calls,
        faults: reader.faults,
        external_axes_may_move: reader.options.external_axes != ExternalAxes::Refused,
        moving_calls: &reader.options.moving_calls,
    };
    Parsed::of_robot(Language::FanucLs, files, read)
}

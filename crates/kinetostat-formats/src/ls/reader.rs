//! The reader of FANUC TP programs: the instructions of the files, and the programs that they call.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::ProgramError;
use crate::ls::lines::{Layout, words_of};
use crate::ls::motion::End;
use crate::ls::positions::{Held, Positions};
use crate::ls::program::Program;
use crate::ls::run::{Files, Reader, Run};
use crate::ls::step::{Step, name_from, positions_read, step_of};
use crate::ls::table::row;
use crate::model::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::{OutsideCall, RobotProgram};
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

const MOST_BYTES: usize = 1 << 28;

impl Reader<'_> {
    pub(super) fn layout_of(&mut self, file: &SourceFile) -> Layout {
        if file.bytes().len() > MOST_BYTES {
            self.fault(file, 0..0, "the file is larger than 256 MiB", "divide it");
            return Layout::default();
        }
        let layout = Layout::of(file.bytes());
        if !layout.has_instructions {
            self.fault(
                file,
                0..0,
                "there is no section /MN in the file",
                "give a TP program as the controller prints it (.ls)",
            );
        } else if !layout.has_end {
            let end = file.bytes().len();
            self.fault(
                file,
                end..end,
                "the file ends before its section /END: a part of it may be lost",
                "give the whole file",
            );
        }
        layout
    }

    /// The instructions of a file; positions that are read besides motions keep their values.
    pub(super) fn program_of(
        &mut self,
        file: &SourceFile,
        index: usize,
        layout: &Layout,
        positions: &Positions,
    ) -> Program {
        if let Some(stated) = &layout.line_count
            && stated.value != layout.lines.len() as f64
        {
            let (line, count) = (file.line_of(stated.span.start), layout.lines.len());
            let message = format!("LINE_COUNT says {}, there are {count} lines", stated.value);
            self.finding(index, line, message);
        }
        let mut steps = Vec::with_capacity(layout.lines.len());
        let mut kept = BTreeSet::new();
        let mut all_kept = false;
        for line in &layout.lines {
            let step = step_of(file.bytes(), &line.text);
            match &step {
                Step::Motion(motion) => {
                    let via = motion.via.iter().map(|(_, via)| via);
                    let mut ends = via.chain([&motion.target]);
                    all_kept |= ends.any(|end| matches!(end, End::Computed(..)));
                }
                _ => match positions_read(file.bytes(), &line.text) {
                    Some(numbers) => kept.extend(numbers),
                    None => all_kept = true,
                },
            }
            steps.push(step);
        }
        for (number, position) in &positions.all {
            if let (Held::Pose(declaration), true) =
                (&position.held, all_kept || kept.contains(number))
            {
                self.declarations[*declaration].keeps_value = true;
            }
        }
        let program = Program::of(steps);
        for (at, reason, remedy) in &program.faults {
            self.fault(file, layout.lines[*at].whole.clone(), *reason, *remedy);
        }
        program
    }
}

// Programs that a statement makes run beside the motions, or at another time: at the end of a motion (`TB .10sec,CALL X`), while a
// condition is watched (`MONITOR X`, `WHEN DI[1]=ON,CALL X`), behind an error (`ERROR_PROG=X`, `RESUME_PROG=X`).
//
// Source: FANUC Robotics, SYSTEM R-J3iB/R-30iA HandlingTool, setup and operations manual: time before and after, condition monitor,
// automatic error recovery.

impl Reader<'_> {
    /// Programs by their names in capitals.
    pub(super) fn names_of(
        &mut self,
        files: &[SourceFile],
        layouts: &[Layout],
    ) -> BTreeMap<Vec<u8>, usize> {
        let mut names: BTreeMap<Vec<u8>, usize> = BTreeMap::new();
        for (index, layout) in layouts.iter().enumerate() {
            let name = files[index].part(&layout.name).to_ascii_uppercase();
            let first = *names.entry(name).or_insert(index);
            if first != index {
                let reason = "another file holds a program of this name";
                self.fault(
                    &files[index],
                    layout.name.clone(),
                    reason,
                    "give one of them",
                );
            }
        }
        names
    }
}

impl Files<'_> {
    /// The program of a name.
    pub(super) fn named(&self, name: &[u8]) -> Option<usize> {
        self.names.get(&name.to_ascii_uppercase()).copied()
    }

    /// Programs that are in none of the files and are called, or run beside the motions.
    pub(super) fn outside_calls(&self) -> Vec<OutsideCall> {
        let mut found = Vec::new();
        for (index, program) in self.programs.iter().enumerate() {
            let file = &self.files[index];
            for (at, step) in program.steps.iter().enumerate() {
                let line = &self.layouts[index].lines[at];
                let named = match step.action() {
                    Step::Call(call) => vec![call.name.clone()],
                    _ => run_beside(file.bytes(), &line.text),
                };
                for name in named {
                    let name = name.as_ref().map(|name| file.part(name));
                    if name.and_then(|name| self.named(name)).is_none() {
                        found.push(OutsideCall {
                            file: index,
                            line: file.line_of(line.whole.start),
                            name: name.map(crate::error::excerpt),
                        });
                    }
                }
            }
        }
        found
    }
}

/// The names of such programs in a statement; none where a register says it.
fn run_beside(bytes: &[u8], text: &Range<usize>) -> Vec<Option<Range<usize>>> {
    let blanks = |from: usize| {
        let part = bytes.get(from..text.end).unwrap_or_default();
        from + part.len() - part.trim_ascii_start().len()
    };
    let start = blanks(text.start);
    let Some(row) = row(bytes.get(start..text.end).unwrap_or_default()) else {
        return Vec::new();
    };
    let behind = start + row.name.len();
    match row.name {
        // `MONITOR END X` ends it.
        "MONITOR" => {
            let from = blanks(behind);
            let part = bytes.get(from..text.end).unwrap_or_default();
            let ends = part.starts_with(b"END") && part.get(3).is_some_and(u8::is_ascii_whitespace);
            match ends || part.is_empty() {
                true => Vec::new(),
                false => vec![name_from(bytes, from..text.end)],
            }
        }
        "ERROR_PROG" | "RESUME_PROG" => {
            let equals = bytes.get(behind..text.end).unwrap_or_default();
            let equals = equals.iter().position(|byte| *byte == b'=');
            let name = equals.map(|at| name_from(bytes, behind + at + 1..text.end));
            name.into_iter().collect()
        }
        "J" | "L" | "C" | "WHEN" => {
            let words = words_of(bytes, &(start..text.end)).into_iter();
            let calls = words.filter(|word| bytes[word.span.clone()] == *b"CALL");
            calls
                .map(|word| name_from(bytes, word.span.end..text.end))
                .collect()
        }
        _ => Vec::new(),
    }
}

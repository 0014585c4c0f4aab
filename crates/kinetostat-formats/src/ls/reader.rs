//! The reader of FANUC TP programs.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::ProgramError;
use crate::ls::ends::{Ends, MotionPlace};
use crate::ls::flow::{Flow, Last};
use crate::ls::lines::Layout;
use crate::ls::motion::{End, MotionText, Way};
use crate::ls::order::Order;
use crate::ls::positions::{Held, Positions};
use crate::ls::program::{Place, Program};
use crate::ls::step::{Step, positions_read, step_of};
use crate::model::external::moving_axis;
use crate::model::findings::{left_as_written, unknown_frames};
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::parsed::{Parsed, sort_faults};
use crate::model::program::{Finding, Language, RobotProgram};
use crate::model::site::{Declaration, MotionSite};
use crate::model::stated_axes::StatedAxes;
use crate::options::{ExternalAxes, ReadOptions};
use crate::text::source::SourceFile;

/// Most bytes of a file.
const MOST_BYTES: usize = 1 << 28;

/// Reads FANUC TP programs as text (`.ls`): one, or the first and those that it calls.
///
/// The frames and tools of positions are checked against `UFRAME_NUM` and `UTOOL_NUM` where these are known from the
/// text; what they are, the options say (`UF:2`, `UT:1`; `UF:0` and `UT:0` are the world and the flange). Motions to
/// position registers, offset by registers or ended by signals are refused, or stay as written with
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
        motions: Vec::new(),
        declarations: Vec::new(),
        ends: Ends::of(options),
    };
    let (mut layouts, mut positions, mut programs) = (Vec::new(), Vec::new(), Vec::new());
    for (index, file) in files.iter().enumerate() {
        let layout = reader.layout(file);
        let section = layout.positions.clone().unwrap_or_default();
        let found = Positions::of(file.bytes(), section, index, &mut reader.declarations);
        for (span, reason, remedy) in layout.faults.iter().chain(&found.faults) {
            reader.fault(file, span.clone(), *reason, *remedy);
        }
        programs.push(reader.program(file, index, &layout, &found));
        layouts.push(layout);
        positions.push(found);
    }
    reader.link(&files, &layouts, &mut programs);
    let flow = Flow::of(&programs);
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
        };
        let found = reader.motion(motion, &site);
        let before = site.before;
        reader.declarations = declarations;
        let Some(mut motion) = found else {
            continue;
        };
        motion.runs = programs[*program].runs[*at].max(order.runs[*program]);
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
    reader.finish(files)
}

struct Reader<'o> {
    options: &'o ReadOptions,
    faults: Vec<ProgramError>,
    findings: Vec<Finding>,
    motions: Vec<Motion>,
    declarations: Vec<Declaration>,
    ends: Ends<'o>,
}

impl Reader<'_> {
    fn fault(
        &mut self,
        file: &SourceFile,
        span: std::ops::Range<usize>,
        reason: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        self.faults
            .push(ProgramError::at(file, span, reason, remedy));
    }

    fn layout(&mut self, file: &SourceFile) -> Layout {
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

    fn finding(&mut self, file: usize, line: usize, message: impl Into<String>) {
        self.findings.push(Finding {
            file,
            line,
            message: message.into(),
        });
    }

    /// The instructions of a file; positions that are read besides motions keep their values.
    fn program(
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
                Step::Refused((reason, remedy)) => {
                    self.fault(file, line.whole.clone(), *reason, *remedy);
                }
                Step::Motion(motion) => {
                    let unknown = End::Register("which position it goes to, a register says");
                    all_kept |= motion.target == unknown;
                }
                Step::Run => {
                    let line = file.line_of(line.whole.start);
                    self.finding(index, line, "another task starts: it is not followed");
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

    /// Finds the programs that are called.
    fn link(&mut self, files: &[SourceFile], layouts: &[Layout], programs: &mut [Program]) {
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
        for (index, program) in programs.iter_mut().enumerate() {
            let file = &files[index];
            for (at, step) in program.steps.iter().enumerate() {
                let step = match step {
                    Step::Perhaps(step) => step,
                    step => step,
                };
                let Step::Call(name) = step else {
                    continue;
                };
                let called = name.as_ref().map(|name| file.part(name));
                match called.and_then(|name| names.get(&name.to_ascii_uppercase())) {
                    Some(to) => {
                        program.called.insert(at, *to);
                    }
                    None => {
                        let line = file.line_of(layouts[index].lines[at].whole.start);
                        let message = match called {
                            Some(name) => format!(
                                "`{}` is in none of these files: it is carried, and if it moves the tool, that is not seen",
                                crate::error::excerpt(name)
                            ),
                            None => "what is called, a register says: it is carried, and if it moves the tool, that is not seen".to_owned(),
                        };
                        self.finding(index, line, message);
                    }
                }
            }
        }
    }

    fn motion(&mut self, text: &MotionText, place: &MotionPlace<'_>) -> Option<Motion> {
        let file = place.file;
        let end = self.ends.end(&text.target, place, text.displaced);
        let via = text.via.as_ref().map(|(span, end)| {
            let found = self.ends.end(end, place, text.displaced);
            // With what stands between the two positions.
            let span = span.start..text.target_span.start.max(span.end);
            found.map(|found| (span, found))
        });
        let (end, via) = match (end, via.transpose()) {
            (Ok(end), Ok(via)) => (end, via),
            (Err((reason, remedy)), _) | (_, Err((reason, remedy))) => {
                self.fault(file, place.line.whole.clone(), reason, remedy);
                return None;
            }
        };
        if let Some((_, via)) = &via
            && (via.frame, via.tool) != (end.frame, end.tool)
        {
            let (reason, remedy) = (
                "the two positions of the circle have different frames or tools",
                "teach both in one frame and with one tool",
            );
            self.fault(file, place.line.whole.clone(), reason, remedy);
            return None;
        }
        Some(Motion {
            file: place.index,
            line: file.line_of(place.line.whole.start),
            span: place.line.whole.clone(),
            kind: match (text.way, &via) {
                (Way::Joint, _) => MotionKind::Joint,
                (Way::Linear, _) | (Way::Circular, None) => MotionKind::Linear,
                (Way::Circular, Some((_, via))) => MotionKind::Circular {
                    via: via.target.clone(),
                },
            },
            target: end.target,
            speed: text.speed.clone(),
            zone: text.zone,
            tool: self.ends.frame_use("UT", end.tool),
            work_object: self.ends.frame_use("UF", end.frame),
            runs: Runs::Once,
            follows: None,
            site: MotionSite {
                keyword: text.keyword.clone(),
                target_span: text.target_span.clone(),
                target: end.site,
                via: via.map(|(span, via)| (span, via.site)),
                speed: text.speed_site.clone(),
                zone: text.zone_span.clone(),
                external: end.external,
                external_moved_behind: false,
                indivisible: text.indivisible,
            },
        })
    }

    fn finish(mut self, files: Vec<SourceFile>) -> Parsed {
        if self.options.external_axes == ExternalAxes::Refused {
            let moving = moving_axis(&files, &self.motions, Language::FanucLs);
            self.faults.extend(moving);
        }
        sort_faults(&mut self.faults, &files);
        self.findings.extend(unknown_frames(&self.motions));
        self.findings.extend(left_as_written(&self.motions));
        self.findings
            .sort_by_key(|finding| (finding.file, finding.line));
        Parsed {
            program: RobotProgram {
                language: Language::FanucLs,
                files,
                motions: self.motions,
                findings: self.findings,
                declarations: self.declarations,
                rotary: StatedAxes::default(),
            },
            faults: self.faults,
        }
    }
}

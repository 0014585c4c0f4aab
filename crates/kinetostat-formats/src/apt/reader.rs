//! The reader of APT and CLDATA.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::apt::arc::Circle;
use crate::apt::dialect::Dialect;
use crate::apt::lines::{Statement, statements_of};
use crate::apt::numbers::{Argument, all_numbers, arguments_of};
use crate::apt::places::{Frames, frame_use, pose_text, work_object};
use crate::apt::spindle::spindle_of;
use crate::apt::state::{State, feed_of, system_of, unit_of};
use crate::apt::table::row;
use crate::error::ProgramError;
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::program::{Finding, Language, RobotProgram};
use crate::model::site::{MotionSite, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::{CutterCompensation, ReadOptions, UnknownTargets};
use crate::table::Treatment;
use crate::text::number::NumberText;
use crate::text::source::SourceFile;

/// Most bytes of a file.
const MOST_BYTES: usize = 1 << 28;

/// Reads APT and CLDATA (`.apt`, `.cls`, `.aptsource`), each file for itself, as SOLIDWORKS CAM, Siemens NX, CATIA and others
/// write them.
///
/// Places are those of `GOTO`, in mm; the tool's axis is the last one that was stated, and the turn about it is free: the
/// orientation turns Z into the axis by the shortest way. Arcs are [`MotionKind::Arc`]. The work object is `MSYS` in the
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
        if file.bytes().len() > MOST_BYTES {
            let fault =
                ProgramError::at(file, 0..0, "the file is larger than 256 MiB", "divide it");
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
    }
    let mut faults = program.faults;
    if !faults.is_empty() {
        let place = |fault: &ProgramError| {
            let file = files.iter().position(|file| file.name() == fault.file);
            (file, fault.span.start, fault.line)
        };
        faults.sort_by_key(place);
        return Err(faults);
    }
    let (mut findings, motions) = (program.findings, program.motions);
    findings.sort_by_key(|finding| (finding.file, finding.line));
    Ok(RobotProgram {
        language: Language::Apt,
        files,
        motions,
        findings,
        declarations: Vec::new(),
    })
}

struct Found<'o> {
    options: &'o ReadOptions,
    frames: Frames,
    faults: Vec<ProgramError>,
    findings: Vec<Finding>,
    motions: Vec<Motion>,
}

struct Reader<'r, 'o> {
    program: &'r mut Found<'o>,
    file: &'r SourceFile,
    index: usize,
    dialect: Dialect,
    unit_mm: f64,
    state: State,
}

const POINTS: &str = "let the CAM system write points: GOTO/x,y,z or GOTO/x,y,z,i,j,k";
const LEAVE: &str = "leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or let the CAM system write points";

impl Reader<'_, '_> {
    fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &'static str) {
        let fault = ProgramError::at(self.file, span.clone(), reason, remedy);
        self.program.faults.push(fault);
    }

    fn finding(&mut self, span: &Range<usize>, message: String) {
        self.program.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }

    fn statement(&mut self, statement: &Statement) {
        let span = &statement.span;
        let word = self.file.part(&statement.word).to_ascii_uppercase();
        if statement.assigns {
            // Geometry and numbers move nothing; what drives along them is refused.
            return;
        }
        let is_motion = matches!(
            &word[..],
            b"GOTO" | b"PAINT" | b"FEDRAT" | b"SPINDL" | b"COOLNT" | b"PPRINT"
        );
        if !is_motion {
            self.end_circle();
        }
        let understood = row(&word).is_some_and(|row| row.treatment == Treatment::Understood);
        if understood
            && !statement.slash
            && !statement.arguments.is_empty()
            && !matches!(&word[..], b"TLON" | b"SPINDL")
        {
            let remedy = "write it as WORD/arguments";
            self.state.place = None;
            return self.fault(span, "no slash stands behind the word", remedy);
        }
        match &word[..] {
            b"GOTO" => self.goto(statement),
            b"GODLTA" => self.step(statement),
            b"GOHOME" => self.home(statement),
            b"FROM" => self.from(statement),
            b"RAPID" => self.state.rapid = Some(span.clone()),
            b"FEDRAT" => match feed_of(self.file, statement, self.unit_mm) {
                Some(feed) => (self.state.feed, self.state.mm_per_turn) = feed,
                None => self.fault(span, "the feed has no number", "state it: FEDRAT/600,MMPM"),
            },
            b"SPINDL" => self.state.spindle = spindle_of(self.file, statement, self.state.spindle),
            b"CIRCLE" => self.circle(statement),
            b"TLON" => {
                let reason = "the end of the arc is where it meets a line, which is not computed";
                self.unknown(statement, reason);
            }
            b"CYCLE" => {
                let first = self.first_word(statement);
                self.state.in_cycle = !matches!(&first[..], b"OFF" | b"INIT");
            }
            b"CUTCOM" | b"TLCOMP" => self.compensation(statement),
            b"TLAXIS" => match self.numbers(statement) {
                Some(numbers) => self.axis(span, &numbers),
                None => self.fault(span, "the axis is not three numbers", POINTS),
            },
            b"MSYS" => {
                let numbers = self.numbers(statement).unwrap_or_default();
                let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
                match system_of(&values, self.unit_mm) {
                    Some(system) => {
                        self.state.system = Some(system);
                        // What follows is in other axes.
                        self.state.place = None;
                    }
                    None => self.fault(
                        span,
                        "MSYS is not an origin and two axes at right angles",
                        "state nine numbers",
                    ),
                }
            }
            b"TRNTYP" if self.first_word(statement) != b"WORLD" => self.fault(
                span,
                "the places that follow are in other axes than the part's",
                "let the CAM system write them in the part's axes (TRNTYP/WORLD)",
            ),
            b"LOAD" | b"LOADTL" | b"TOOLNO" | b"TOOL PATH" => self.tool(statement, &word),
            b"UNIT" | b"UNITS"
                if (self.program.motions.last()).is_some_and(|last| last.file == self.index) =>
            {
                self.fault(
                    span,
                    "the unit is stated behind a motion",
                    "state it before",
                );
            }
            _ => match row(&word).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => self.fault(span, reason, remedy),
                Some(_) => {}
                None if word.starts_with(b"CSI_") => {}
                None => self.fault(
                    span,
                    "the word is not known, and may move the tool",
                    "take the statement out, or make it a comment ($$)",
                ),
            },
        }
    }

    /// A CIRCLE that no GOTO follows.
    fn end_circle(&mut self) {
        if let Some(circle) = self.state.circle.take() {
            self.fault(&circle.span, "no GOTO follows that ends the arc", POINTS);
        }
    }

    fn first_word(&self, statement: &Statement) -> Vec<u8> {
        let text = self.file.part(&statement.arguments);
        let first = text.split(|byte| *byte == b',').next().unwrap_or_default();
        first.trim_ascii().to_ascii_uppercase()
    }

    fn numbers(&self, statement: &Statement) -> Option<Vec<NumberText>> {
        all_numbers(&arguments_of(self.file.bytes(), &statement.arguments))
    }

    fn compensation(&mut self, statement: &Statement) {
        let on = self.first_word(statement) != b"OFF";
        if on && self.program.options.cutter_compensation == CutterCompensation::Refused {
            self.fault(
                &statement.span,
                "the controller moves the path aside by the tool's radius",
                "if the places are those of the tool's centre, say so (cutter_compensation = \"centre_path\" under [robot] in a job file)",
            );
        }
    }

    fn tool(&mut self, statement: &Statement, word: &[u8]) {
        let arguments = arguments_of(self.file.bytes(), &statement.arguments);
        let last = arguments.last();
        let number = arguments.iter().find_map(Argument::number);
        let name = match (word, last, number) {
            (b"TOOL PATH", Some(Argument::Word(name)), _) => {
                String::from_utf8_lossy(self.file.part(name)).into_owned()
            }
            (_, _, Some(number)) => format!("{}", number.value),
            _ => return,
        };
        self.state.tool = format!("TOOL:{name}");
    }

    fn axis(&mut self, span: &Range<usize>, numbers: &[NumberText]) {
        let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        match OrientationText::Axis.rotation_of(&values) {
            Some(_) => self.state.axis = Vector3::from_row_slice(&values),
            None => self.fault(span, "the tool's axis has not the length 1", "mend it"),
        }
    }

    /// Places and, where stated, the axis: three or six numbers.
    fn pose(&mut self, statement: &Statement) -> Option<(Vec<NumberText>, Vector3<f64>)> {
        let span = &statement.span;
        match self.numbers(statement) {
            Some(numbers) if matches!(numbers.len(), 3 | 6) => {
                if numbers.len() == 6 {
                    self.axis(span, &numbers[3..]);
                }
                let place = Vector3::from_fn(|i, _| numbers[i].value * self.unit_mm);
                Some((numbers, place))
            }
            Some(numbers) => {
                let reason = format!("a place has 3 or 6 numbers, here are {}", numbers.len());
                self.fault(span, reason, POINTS);
                None
            }
            None => {
                self.fault(span, "a place is stated by other than numbers", POINTS);
                None
            }
        }
    }

    fn goto(&mut self, statement: &Statement) {
        let Some((numbers, place)) = self.pose(statement) else {
            self.state.circle = None;
            self.state.place = None;
            return;
        };
        let circle = self.state.circle.take();
        if self.state.in_cycle {
            let reason =
                "it is a hole of a cycle: from here the controller drills as the cycle says";
            self.unknown(statement, reason);
            return;
        }
        let mut kind = MotionKind::Linear;
        if let Some(circle) = &circle {
            let known = self.state.place;
            match known.map(|from| circle.angle(&from, &place)) {
                _ if circle.times => {
                    let reason = "it is a helix of several turns, whose way is not followed";
                    self.unknown_with(statement, reason, Some(circle));
                    self.state.place = Some(place);
                    return;
                }
                None => {
                    let reason = "where its arc begins is not known";
                    self.unknown_with(statement, reason, Some(circle));
                    self.state.place = Some(place);
                    return;
                }
                Some(Err(reason)) => {
                    self.fault(&circle.span, reason, "let the CAM system write it again");
                    self.state.place = Some(place);
                    return;
                }
                Some(Ok(angle_rad)) => {
                    kind = MotionKind::Arc {
                        centre_mm: circle.centre_mm,
                        axis: circle.axis,
                        angle_rad,
                    };
                }
            }
        }
        let text = pose_text(self.index, numbers, None);
        self.push(
            statement,
            kind,
            place,
            TargetSite::Literal(text),
            circle.as_ref(),
        );
    }

    fn step(&mut self, statement: &Statement) {
        let numbers = self.numbers(statement).filter(|numbers| numbers.len() == 3);
        let (Some(numbers), false) = (numbers, self.state.in_cycle) else {
            self.fault(
                &statement.span,
                "the step is not three numbers, or is in a cycle",
                POINTS,
            );
            return;
        };
        let by = Vector3::from_fn(|i, _| numbers[i].value * self.unit_mm);
        match self.state.place {
            Some(from) => {
                // It is written as a place where it changes: no number says that now.
                let text = pose_text(self.index, numbers, Some(f64::NAN));
                self.push(
                    statement,
                    MotionKind::Linear,
                    from + by,
                    TargetSite::Literal(text),
                    None,
                );
            }
            None => self.unknown(statement, "where its step begins is not known"),
        }
    }

    fn home(&mut self, statement: &Statement) {
        let stated = self.numbers(statement).filter(|numbers| numbers.len() == 3);
        match stated {
            Some(numbers) => {
                let place = Vector3::from_fn(|i, _| numbers[i].value * self.unit_mm);
                let text = pose_text(self.index, numbers, None);
                self.push(
                    statement,
                    MotionKind::Linear,
                    place,
                    TargetSite::Literal(text),
                    None,
                );
            }
            None => self.unknown(statement, "where home is, the file does not say"),
        }
    }

    fn from(&mut self, statement: &Statement) {
        self.state.place = self.pose(statement).map(|(_, place)| place);
        self.state.last = None;
    }

    fn circle(&mut self, statement: &Statement) {
        match Circle::of(self.file, statement, self.dialect, self.unit_mm) {
            Ok(circle) => self.state.circle = Some(circle),
            Err(reason) => self.fault(&statement.span, reason, "let the CAM system write points"),
        }
    }

    /// A motion whose end or way is not known: refused, or left as it is written.
    fn unknown(&mut self, statement: &Statement, reason: &'static str) {
        self.unknown_with(statement, reason, None);
    }

    fn unknown_with(
        &mut self,
        statement: &Statement,
        reason: &'static str,
        circle: Option<&Circle>,
    ) {
        if self.program.options.unknown_targets == UnknownTargets::Refused {
            let span = circle.map_or(&statement.span, |circle| &circle.span);
            self.fault(&span.clone(), reason, LEAVE);
            self.state.rapid = None;
            self.state.place = None;
            return;
        }
        self.finding(
            &statement.span,
            format!("it stays as it is written: {reason}"),
        );
        let site = TargetSite::Fixed("its end or its way is not known");
        self.push(
            statement,
            MotionKind::Linear,
            Vector3::zeros(),
            site,
            circle,
        );
        if let Some(motion) = self.program.motions.last_mut() {
            motion.target = Target::Unknown {
                reason: reason.to_owned(),
            };
        }
        self.state.place = None;
    }

    /// The feed in force; one by turns of the spindle is known while those are.
    fn feed(&self) -> Speed {
        let mut feed = self.state.feed.clone();
        let turns = self.state.spindle.rpm().filter(|rpm| *rpm > 0.0);
        let by_turns = self.state.mm_per_turn.zip(turns);
        if let Some((mm_per_turn, rpm)) = by_turns {
            feed.mm_per_s = Some(mm_per_turn * rpm / 60.0);
        }
        feed
    }

    fn push(
        &mut self,
        statement: &Statement,
        kind: MotionKind,
        place: Vector3<f64>,
        target: TargetSite,
        circle: Option<&Circle>,
    ) {
        let axis = self.state.axis;
        let orientation = OrientationText::Axis.rotation_of(axis.as_slice());
        let target_span = match &target {
            TargetSite::Literal(text) => text.whole.clone(),
            _ => statement.arguments.clone(),
        };
        let speed = match self.state.rapid.take() {
            Some(span) => Speed {
                mm_per_s: None,
                text: String::from_utf8_lossy(self.file.part(&span)).into_owned(),
            },
            None => self.feed(),
        };
        let arc_lines = circle.map(|circle| {
            let fixed =
                TargetSite::Fixed("an arc with other ends is none about its written centre");
            (circle.lines.clone(), fixed)
        });
        self.program.motions.push(Motion {
            file: self.index,
            line: self.file.line_of(statement.span.start),
            span: statement.span.clone(),
            kind,
            target: Target::Pose(PoseTarget {
                position_mm: place,
                orientation: orientation.unwrap_or_else(UnitQuaternion::identity),
                configuration: Configuration::default(),
                external: Vec::new(),
            }),
            speed,
            zone: Zone::Unstated,
            tool: frame_use(&self.program.frames, &self.state.tool),
            work_object: work_object(&self.program.frames, self.state.system.as_ref()),
            runs: Runs::Once,
            follows: self.state.last,
            site: MotionSite {
                keyword: statement.word.clone(),
                target_span,
                target,
                via: arc_lines,
                speed: None,
                zone: None,
                indivisible: None,
            },
        });
        self.state.place = Some(place);
        self.state.last = Some(self.program.motions.len() - 1);
    }
}

//! The reader of Heidenhain conversational programs.

use std::collections::BTreeSet;
use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector2, Vector3};

use crate::apt::places::{Frames, frame_use};
use crate::error::{ProgramError, note};
use crate::heidenhain::blocks::{Block, blocks_of};
use crate::heidenhain::datum::{Bend, Change, Datum, axis_of, change};
use crate::heidenhain::ends::{Ends, Shape, Went};
use crate::heidenhain::flow::{Step, label_name, labels_of, order, step_of};
use crate::heidenhain::path_words::{FeedWord, Odd, PathWords};
use crate::heidenhain::state::{Pole, State};
use crate::heidenhain::table::{Function, function, row};
use crate::heidenhain::words::{Value, Word};
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::program::{Finding, Language, RobotProgram};
use crate::model::site::{MotionSite, PoseText, SpeedSite, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::{CutterCompensation, ReadOptions, UnknownTargets};
use crate::table::Treatment;
use crate::text::number::{NumberText, Width};
use crate::text::source::SourceFile;

/// Most bytes of a file.
const MOST_BYTES: usize = 1 << 28;

/// Reads Heidenhain conversational programs (`.h`), each file for itself.
///
/// Places are those that the blocks state, in mm in the axes of the control's preset: datum shifts, mirror images, rotations and
/// scalings are followed. What is not stated stays as it was. Circles are [`MotionKind::Arc`]. The work object is `PRESET`, the tool
/// `TOOL:5`; where they are, the options say. Places of the machine (`M91`) and retractions (`M140`) are carried. A program that
/// repeats, jumps, counts or calls drilling cycles is refused: [`crate::expand_heidenhain`] writes it flat.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, read_heidenhain};
///
/// let text = "0 BEGIN PGM PART MM\n1 TOOL CALL 5 Z S3000\n2 L X+20 Y+0 Z+2 R0 FMAX M3\n3 L Z-2 F300\n4 CC X+0 Y+0\n\
///     5 C X+0 Y+20 DR+ F600\n6 L IZ+10 FMAX M30\n7 END PGM PART MM\n";
/// let program = read_heidenhain(vec![SourceFile::new("part.h", text)], &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions[0].speed.text, "FMAX");
/// assert_eq!(program.motions[2].speed.mm_per_s, Some(10.0));
/// let MotionKind::Arc { angle_rad, .. } = program.motions[2].kind else { panic!() };
/// assert!((angle_rad.to_degrees() - 90.0).abs() < 1e-9);
/// assert_eq!(program.motions[3].target.pose().unwrap().position_mm.as_slice(), [0.0, 20.0, 8.0]);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_heidenhain(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    let mut found = interpret(&files, options);
    if !found.faults.is_empty() {
        let place = |fault: &ProgramError| {
            let file = files.iter().position(|file| file.name() == fault.file);
            (file, fault.span.start, fault.line)
        };
        found.faults.sort_by_key(place);
        return Err(found.faults);
    }
    let mut findings = found.findings;
    findings.sort_by_key(|finding| (finding.file, finding.line));
    Ok(RobotProgram {
        language: Language::Heidenhain,
        files,
        motions: found.motions,
        findings,
        declarations: Vec::new(),
    })
}

/// A motion as it is programmed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Way {
    pub block: Block,
    pub shape: Shape,
    /// In the programmed axes, mm.
    pub start: [Option<f64>; 3],
    pub end: [Option<f64>; 3],
    pub datum: Datum,
    pub unit_mm: f64,
    /// In force, as programmed; none in rapid traverse or where it is not known.
    pub feed: Option<f64>,
    /// The motion at whose end the pole was set from where the tool was.
    pub pole_from: Option<usize>,
}

/// What a program says.
pub(crate) struct Found {
    pub faults: Vec<ProgramError>,
    pub findings: Vec<Finding>,
    pub motions: Vec<Motion>,
    /// Of each motion.
    pub ways: Vec<Way>,
}

/// Reads files, with all that is refused beside what is understood.
pub(crate) fn interpret(files: &[SourceFile], options: &ReadOptions) -> Found {
    let mut found = Found {
        faults: Vec::new(),
        findings: Vec::new(),
        motions: Vec::new(),
        ways: Vec::new(),
    };
    let frames = options.frames.iter();
    let frames: Frames = frames
        .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
        .collect();
    for (index, file) in files.iter().enumerate() {
        if file.bytes().len() > MOST_BYTES {
            let fault =
                ProgramError::at(file, 0..0, "the file is larger than 256 MiB", "divide it");
            found.faults.push(fault);
            continue;
        }
        let mut reader = Reader {
            found: &mut found,
            options,
            frames: &frames,
            file,
            index,
            unit_mm: 1.0,
            state: State::new(),
            pole_from: None,
            remarked: BTreeSet::new(),
        };
        reader.file();
    }
    found
}

struct Reader<'r> {
    found: &'r mut Found,
    options: &'r ReadOptions,
    frames: &'r Frames,
    file: &'r SourceFile,
    index: usize,
    unit_mm: f64,
    state: State,
    pole_from: Option<usize>,
    /// Functions of the machine's builder that were remarked on.
    remarked: BTreeSet<u32>,
}

const EXPAND: &str = "write the program flat first (--expand)";
const LEAVE: &str =
    "leave such motions as written by an option, or let the CAM system write L blocks";
const BY_PARAMETER: &str = "a Q parameter says its value";
const FIVE_AXES: &str =
    "programs whose rotary axes turn are not corrected yet: divide the program there";

impl Reader<'_> {
    fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &'static str) {
        let file = self.file;
        note(&mut self.found.faults, || {
            ProgramError::at(file, span.clone(), reason, remedy)
        });
    }

    fn finding(&mut self, span: &Range<usize>, message: String) {
        self.found.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }

    fn file(&mut self) {
        let bytes = self.file.bytes();
        let blocks = blocks_of(bytes);
        let first_of = |block: &Block| {
            let is_begin = bytes.get(block.text.start).map(u8::to_ascii_uppercase) == Some(b'B');
            is_begin
                && block
                    .words(bytes)
                    .first()
                    .is_some_and(|word| word.is("BEGIN"))
        };
        let Some(first) = blocks.iter().position(first_of) else {
            let end = bytes.len().min(60);
            return self.fault(
                &(0..end),
                "no block BEGIN PGM begins a program",
                "give a program of Heidenhain's conversational language, whole",
            );
        };
        let (labels, twice) = labels_of(bytes, &blocks);
        for index in twice {
            let text = blocks[index].text.clone();
            self.fault(
                &text,
                "there is a label of this name above",
                "name it otherwise",
            );
        }
        let calls = |block: &Block| {
            let is_call = bytes.get(block.text.start).map(u8::to_ascii_uppercase) == Some(b'C');
            is_call && matches!(step_of(bytes, block), Step::Call(_))
        };
        let ordered = match labels.is_empty() || !blocks.iter().any(calls) {
            true => None,
            false => Some(order(first, blocks.len(), &labels, |at| {
                step_of(bytes, &blocks[at])
            })),
        };
        let mut last = first;
        match ordered {
            None => {
                for (at, block) in blocks.iter().enumerate().skip(first) {
                    last = at;
                    if self.block(block) {
                        break;
                    }
                }
            }
            Some(Ok(order)) => {
                for at in order {
                    if at > last {
                        last = at;
                    }
                    if self.block(&blocks[at]) {
                        break;
                    }
                }
            }
            Some(Err((at, reason))) => {
                let text = blocks[at].text.clone();
                self.fault(&text, reason, EXPAND);
                // The other faults, in the order of lines.
                for block in blocks.iter().skip(first) {
                    self.block(block);
                }
            }
        }
        let left = blocks.iter().skip(last + 1);
        let left = left.filter(|block| {
            let words = block.words(bytes);
            words.first().is_some_and(|word| !word.is("END"))
        });
        if let Some(block) = left.clone().next() {
            let span = block.text.clone();
            self.finding(
                &span,
                "what stands from here on does not run: it stays as it is written".to_owned(),
            );
        }
    }

    /// Follows a block; whether the program ends behind it.
    fn block(&mut self, block: &Block) -> bool {
        let words = block.words(self.file.bytes());
        let Some(first) = words.first() else {
            return false;
        };
        let span = first.span.start..words[words.len() - 1].span.end;
        let letters = first.letters;
        if block.skipped {
            self.fault(
                &span,
                "the block is skipped or not, as a switch of the machine says",
                "take the sign `/` away, or the block out",
            );
        }
        match letters.letters() {
            b"L" | b"LN" | b"LP" | b"C" | b"CP" | b"CR" | b"CT" | b"CTP" | b"M" | b"F" => {
                return self.path(block, &words, &span);
            }
            b"STOP" => return self.path(block, &words, &span),
            b"CC" => self.pole(&words, &span),
            b"BEGIN" => self.begin(&words, &span),
            b"END" => return true,
            b"TOOL" => self.tool(&words, &span),
            b"CYCL" | b"CYCLE" => self.cycle(block, &words, &span),
            b"TRANS" => self.trans(&words, &span),
            b"PLANE" => {
                let flat = words[1..]
                    .iter()
                    .all(|word| word.value().unwrap_or(0.0) == 0.0);
                if !flat
                    || words
                        .iter()
                        .any(|word| matches!(word.value, Value::Parameter { .. }))
                {
                    self.fault(
                        &span,
                        "it tilts the plane in which the places are",
                        "write the program in the axes of the part, or divide it there",
                    );
                }
            }
            b"FUNCTION" => {
                let known = [
                    "TCPM",
                    "RESET",
                    "MODE",
                    "S",
                    "FEED",
                    "PARAXCOMP",
                    "DWELL",
                    "COUNT",
                ];
                let named = words.get(1);
                if !named.is_some_and(|word| known.iter().any(|name| word.is(name))) {
                    self.fault(
                        &span,
                        "what this function moves is not known",
                        "take it out",
                    );
                }
            }
            b"CALL" => match words.get(1) {
                Some(word) if word.is("LBL") => {
                    if words.get(2).is_some_and(|word| word.is("REP")) {
                        self.fault(&span, "it runs a part of the program again", EXPAND);
                    } else if label_name(self.file.bytes(), word).is_none() {
                        self.fault(&span, "the label has no number and no name", "state it");
                    }
                }
                _ => self.fault(
                    &span,
                    "it runs another program",
                    "give the programs together and write them flat (--expand)",
                ),
            },
            b"FN"
                if first
                    .whole()
                    .is_some_and(|number| (9..=12).contains(&number)) =>
            {
                self.fault(&span, "it jumps where a Q parameter says", EXPAND);
            }
            b"FN"
                if first
                    .whole()
                    .is_some_and(|number| matches!(number, 17 | 25)) =>
            {
                self.fault(
                    &span,
                    "it writes data of the control, which may move the coordinates",
                    "take it into a program of its own",
                );
            }
            b"X" | b"Y" | b"Z" | b"IX" | b"IY" | b"IZ" => {
                self.fault(
                    &span,
                    "the block has coordinates and no L",
                    "write L before them",
                );
            }
            letters => match row(letters).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => self.fault(&span, reason, remedy),
                Some(_) => {}
                None => self.fault(
                    &span,
                    "the statement is not known, and may move the tool",
                    "take it out, or make it a comment (;)",
                ),
            },
        }
        false
    }

    fn begin(&mut self, words: &[Word], span: &Range<usize>) {
        let unit =
            words
                .iter()
                .skip(1)
                .rev()
                .find_map(|word| match (word.is("MM"), word.is("INCH")) {
                    (true, _) => Some(1.0),
                    (_, true) => Some(25.4),
                    _ => None,
                });
        // The name may be glued to the unit's word or missing: MM is the control's own.
        self.unit_mm = unit.unwrap_or(1.0);
        if self.unit_mm != 1.0 {
            self.finding(
                span,
                "lengths are in inches, and F is taken as tenths of an inch in a minute".to_owned(),
            );
        } else if unit.is_none() {
            self.finding(span, "no unit is stated: taken as mm".to_owned());
        }
    }

    fn tool(&mut self, words: &[Word], span: &Range<usize>) {
        let Some(call) = words.get(1).filter(|word| word.is("CALL")) else {
            // TOOL DEF.
            return;
        };
        if words[1..]
            .iter()
            .any(|word| matches!(word.value, Value::Parameter { .. }))
        {
            return self.fault(span, BY_PARAMETER, EXPAND);
        }
        let side = |word: &&Word| (word.is("X") || word.is("Y")) && word.value == Value::None;
        if let Some(side) = words[2..].iter().find(side) {
            return self.fault(
                &side.span.clone(),
                "the tool's axis is not Z",
                "let the CAM system write the program with the tool's axis Z",
            );
        }
        if let Some(feed) = words.iter().find(|word| word.is("F")).and_then(Word::value) {
            self.state.tool_feed = Some(feed);
            self.state.feed = Some(feed);
            self.state.feed_text = format!("F{feed}");
        }
        let name = match &call.value {
            Value::Number(number) => format!("TOOL:{}", number.value),
            Value::Text(text) => {
                format!("TOOL:{}", String::from_utf8_lossy(self.file.part(text)))
            }
            _ => return,
        };
        let longer = words[2..].iter().any(|word| word.is("DL") || word.is("DR"));
        if name != self.state.tool || longer {
            self.state.tool = name;
            self.state.lost();
        }
    }

    fn pole(&mut self, words: &[Word], span: &Range<usize>) {
        let mut at = self.state.pole.map(|pole| pole.at);
        let here = self.state.in_plane();
        let mut relative = words.len() == 1;
        if relative {
            at = here;
        }
        let mut stated = [None; 2];
        for word in &words[1..] {
            let value = match (axis_of(word), &word.value) {
                (Some((axis @ 0..=1, step)), Value::Number(number)) => {
                    relative |= step;
                    let from = match step {
                        true => here.map(|here| here[axis]),
                        false => Some(0.0),
                    };
                    Some((axis, from.map(|from| from + number.value * self.unit_mm)))
                }
                (_, Value::Parameter { .. }) => {
                    self.state.pole = None;
                    return self.fault(span, BY_PARAMETER, EXPAND);
                }
                _ => None,
            };
            match value {
                Some((axis, value)) => stated[axis] = value,
                None => {
                    self.state.pole = None;
                    return self.fault(
                        span,
                        "the pole is not stated by X and Y",
                        "circles in other planes are not followed: let the CAM system write L blocks",
                    );
                }
            }
        }
        let x = stated[0].or(at.map(|at| at.x));
        let y = stated[1].or(at.map(|at| at.y));
        self.state.radius_mm = None;
        self.pole_from = self.state.last.filter(|_| relative);
        self.state.pole = match (x, y) {
            (Some(x), Some(y)) => Some(Pole {
                at: Vector2::new(x, y),
                relative,
            }),
            _ => None,
        };
    }

    fn cycle(&mut self, block: &Block, words: &[Word], span: &Range<usize>) {
        let Some(kind) = words.get(1) else {
            return self.fault(span, "the cycle has no number", "state it");
        };
        if kind.is("CALL") {
            let place = self.state.place;
            return self.called(block, words, span, place);
        }
        if kind.is("END") {
            return;
        }
        let number = kind.number().filter(|_| kind.is("DEF"));
        let Some(number) = number else {
            return self.fault(span, "the cycle has no number", "state it");
        };
        let text = String::from_utf8_lossy(self.file.part(&number.span)).into_owned();
        let mut parts = text.splitn(2, ['.', ',']);
        let mut part = || parts.next().and_then(|text| text.parse::<u32>().ok());
        let (cycle, part) = (part().unwrap_or(0), part().unwrap_or(0));
        let state = &mut self.state;
        match (cycle, part) {
            (7 | 8 | 10 | 11, _) => match change(cycle, part, &words[2..], self.unit_mm) {
                Change::Kept => {}
                Change::Shift(shifts) => {
                    let now = state.datum.shift_mm;
                    let target = |(axis, value, adds): (usize, f64, bool)| match adds {
                        true => (axis, now[axis] + value),
                        false => (axis, value),
                    };
                    let shifts: Vec<(usize, f64)> = shifts.into_iter().map(target).collect();
                    let differs = shifts.iter().any(|(axis, to)| now[*axis] != *to);
                    let bent = state.datum.bend != Bend::None;
                    if bent && differs {
                        return self.fault(
                            span,
                            "the datum moves while the coordinates are mirrored, turned or scaled",
                            "shift the datum before, or let the CAM system write the places as they are",
                        );
                    }
                    for (axis, to) in shifts {
                        state.shift(axis, to);
                    }
                }
                Change::Bend(bend) => {
                    let other =
                        std::mem::discriminant(&bend) != std::mem::discriminant(&state.datum.bend);
                    if other && bend != Bend::None && state.datum.bend != Bend::None {
                        return self.fault(
                            span,
                            "a second of mirror image, rotation and scaling acts beside the first",
                            "reset the first before, or let the CAM system write the places as they are",
                        );
                    }
                    state.bend(bend);
                }
                Change::Refused(reason) => self.fault(
                    span,
                    reason,
                    "write the program flat first (--expand), or the values as numbers",
                ),
            },
            (19, 1..) => {
                let tilts = |word: &Word| match word.value {
                    Value::Parameter { .. } => true,
                    _ => word.value().unwrap_or(0.0) != 0.0,
                };
                if words[2..].iter().any(tilts) {
                    self.fault(
                        span,
                        "it tilts the plane in which the places are",
                        "write the program in the axes of the part, or divide it there",
                    );
                }
            }
            (247, _) => {
                let named = words.iter().skip(2).filter_map(Word::value).next_back();
                self.state.preset = match named {
                    Some(number) => format!("PRESET:{number}"),
                    None => "PRESET".to_owned(),
                };
                self.state.lost();
            }
            (12 | 26 | 220 | 221 | 235 | 400..=499, _) => self.fault(
                span,
                "the cycle moves the tool or the coordinates where it is defined",
                "take it into a program of its own",
            ),
            _ => {}
        }
    }

    fn trans(&mut self, words: &[Word], span: &Range<usize>) {
        let is = |at: usize, name: &str| words.get(at).is_some_and(|word| word.is(name));
        let shifts = match (is(1, "DATUM"), is(2, "AXIS"), is(2, "RESET")) {
            (true, true, _) => change(7, 1, &words[3..], self.unit_mm),
            (true, _, true) => Change::Shift((0..3).map(|axis| (axis, 0.0, false)).collect()),
            _ => Change::Refused("how it moves the coordinates is not followed"),
        };
        match shifts {
            Change::Shift(shifts) if self.state.datum.keeps_axes() => {
                for (axis, to, adds) in shifts {
                    let from = match adds {
                        true => self.state.datum.shift_mm[axis],
                        false => 0.0,
                    };
                    self.state.shift(axis, from + to);
                }
            }
            Change::Refused(reason) => {
                self.fault(span, reason, "use TRANS DATUM AXIS with numbers")
            }
            _ => self.fault(
                span,
                "the datum moves while the coordinates are turned",
                "shift it before",
            ),
        }
    }

    /// A path block, or one of functions alone; whether the program ends behind it.
    fn path(&mut self, block: &Block, words: &[Word], span: &Range<usize>) -> bool {
        // Blocks of functions alone have no word before.
        let alone = words[0].is("M") || words[0].is("F");
        let own: Vec<Word>;
        let words = match alone {
            true => {
                let mut all = vec![Word {
                    span: span.start..span.start,
                    letters: crate::text::name::Name::empty(),
                    value: Value::None,
                }];
                all.extend_from_slice(words);
                own = all;
                &own[..]
            }
            false => words,
        };
        let parsed = match PathWords::of(words) {
            Ok(parsed) => parsed,
            Err(odd) => {
                let (at, reason, remedy) = match odd {
                    Odd::Parameter(at) => (at, BY_PARAMETER, EXPAND),
                    Odd::Unknown(at) => (
                        at,
                        "the word is not known here, or has no number",
                        "write the block as the control shows it",
                    ),
                    Odd::Twice(at) => (at, "the word is there twice", "take one out"),
                };
                self.fault(&words[at].span.clone(), reason, remedy);
                self.state.lost();
                return false;
            }
        };
        let acts = self.functions(words, &parsed);
        match parsed.feed {
            FeedWord::Number(_, value) => {
                self.state.feed = Some(value);
                self.state.feed_text = format!("F{value}");
            }
            FeedWord::Auto => {
                self.state.feed = self.state.tool_feed;
                self.state.feed_text = "FAUTO".to_owned();
            }
            FeedWord::Other => {
                self.state.feed = None;
                self.state.feed_text = "F".to_owned();
            }
            FeedWord::None | FeedWord::Max => {}
        }
        if parsed.aside
            && self.options.cutter_compensation == CutterCompensation::Refused
            && !self.state.aside
        {
            self.fault(
                span,
                "the control moves the path aside by the tool's radius",
                "say by an option that the places are those of the tool's centre, if they are",
            );
        }
        if let Some(at) = parsed.compensation {
            self.state.aside = !words[at].is("R");
        }
        if parsed.rotary.iter().any(|angle| *angle != 0.0) {
            self.fault(span, "a rotary axis turns the part or the tool", FIVE_AXES);
        }
        self.moved(block, words, &parsed, span, &acts);
        acts.ends
    }

    fn functions(&mut self, words: &[Word], parsed: &PathWords) -> Acts {
        let mut acts = Acts::default();
        for (at, number) in &parsed.functions {
            let span = words[*at].span.clone();
            match function(*number) {
                Function::AtStart => {}
                Function::AtEnd => acts.ends |= matches!(number, 2 | 30),
                Function::Machine => acts.machine = true,
                Function::Retracts => acts.retracts = true,
                Function::Calls if *number == 89 => self.state.calls = true,
                Function::Calls => acts.calls = true,
                Function::PerTurn => self.state.per_turn = true,
                Function::PerMinute => self.state.per_turn = false,
                Function::Refused(reason) => self.fault(&span, reason, "take it out"),
                Function::Unknown => {
                    if self.remarked.insert(*number) {
                        self.finding(
                            &span,
                            format!(
                                "M{number} is the machine builder's: taken as one that does not move the tool"
                            ),
                        );
                    }
                }
            }
        }
        acts.calls |= self.state.calls && parsed.moves();
        if parsed.functions.iter().any(|(_, number)| *number == 99) {
            self.state.calls = false;
        }
        acts
    }

    /// Where a block goes.
    fn moved(
        &mut self,
        block: &Block,
        words: &[Word],
        parsed: &PathWords,
        span: &Range<usize>,
        acts: &Acts,
    ) {
        let rapid = parsed.feed == FeedWord::Max;
        if acts.retracts {
            self.unknown(
                block,
                words,
                span,
                "the tool goes back along its axis",
                Carried::Yes,
            );
            self.state.place[2] = None;
            for axis in 0..2 {
                if parsed.axes[axis].is_some() {
                    self.state.place[axis] = None;
                }
            }
            self.state.direction = None;
            return;
        }
        if !parsed.moves() {
            if acts.calls {
                let place = self.state.place;
                self.called(block, words, span, place);
            }
            return;
        }
        if acts.machine {
            self.unknown(
                block,
                words,
                span,
                "its places are those of the machine",
                Carried::Yes,
            );
            for axis in 0..3 {
                let by_angle = parsed.radius.is_some() || parsed.angle.is_some();
                if parsed.axes[axis].is_some() || by_angle {
                    self.state.place[axis] = None;
                }
            }
            self.state.direction = None;
            return;
        }
        if let [Some(x), Some(y), Some(z)] = parsed.axis {
            let axis = Vector3::new(x, y, z);
            match OrientationText::Axis.rotation_of(axis.as_slice()) {
                Some(_) => self.state.axis = axis,
                None => self.fault(span, "the tool's axis has not the length 1", "mend it"),
            }
        }
        let mut ends = Ends {
            state: &mut self.state,
            unit_mm: self.unit_mm,
        };
        match ends.of(words, parsed) {
            Ok(went) if acts.calls => self.called(block, words, span, went.end),
            Ok(went) => self.goes(block, words, span, &went, rapid),
            Err((reason, remedy)) => {
                self.fault(span, reason, remedy);
                self.state.lost();
            }
        }
    }

    /// The motion of a block whose end is known as far as its words say it.
    fn goes(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        went: &Went,
        rapid: bool,
    ) {
        let start = self.state.place;
        let [x, y, z] = went.end;
        let whole = x.zip(y).zip(z).map(|((x, y), z)| Vector3::new(x, y, z));
        let is_arc = went.arc.is_some();
        let Some(place) = whole.filter(|_| !is_arc || start[2].is_some()) else {
            let reason = "where the tool is, is not wholly known here";
            let carried = match rapid {
                true => Carried::Yes,
                false => Carried::IfLeft,
            };
            self.unknown(block, words, span, reason, carried);
            self.ends_at(went.end);
            self.state.place = went.end;
            self.state.direction = None;
            return;
        };
        let datum = self.state.datum;
        let kind = match &went.arc {
            Some(arc) => MotionKind::Arc {
                centre_mm: datum.preset(&Vector3::new(
                    arc.centre.x,
                    arc.centre.y,
                    start[2].unwrap_or(place.z),
                )),
                axis: datum.direction(&Vector3::z()),
                angle_rad: arc.angle * datum.sense(),
            },
            None => MotionKind::Linear,
        };
        let flat = Vector2::new(place.x, place.y);
        let came = self.state.in_plane().map(|from| flat - from);
        self.state.direction = match &went.arc {
            Some(arc) => arc.last_direction(&flat),
            None => came.and_then(|way| way.try_normalize(1e-9)),
        };
        let axis = datum.direction(&self.state.axis);
        let orientation = OrientationText::Axis.rotation_of(axis.as_slice());
        let text = PoseText {
            file: self.index,
            whole: span.clone(),
            position: [0, 1, 2].map(|i| NumberText {
                span: span.start..span.start,
                value: place[i],
            }),
            orientation: Vec::new(),
            convention: OrientationText::Axis,
            width: Width::Free,
        };
        let target = Target::Pose(PoseTarget {
            position_mm: datum.preset(&place),
            orientation: orientation.unwrap_or_else(UnitQuaternion::identity),
            configuration: Configuration::default(),
            external: Vec::new(),
        });
        self.push(
            block,
            words,
            span,
            kind,
            (target, TargetSite::Literal(text)),
            (went.shape, went.end, rapid),
        );
        self.state.place = went.end;
    }

    /// What is known of the end of the last motion, which stays as it is written.
    fn ends_at(&mut self, end: [Option<f64>; 3]) {
        let last = self.found.ways.last_mut();
        if let Some(way) = last.filter(|way| way.shape == Shape::Unknown) {
            way.end = end;
        }
    }

    /// A cycle is called at the end of a block.
    fn called(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        end: [Option<f64>; 3],
    ) {
        let reason = "a cycle is called: from here the control drills or mills by itself";
        if self.options.unknown_targets == UnknownTargets::Refused {
            self.fault(
                span,
                reason,
                "write drilling cycles flat first (--expand), or leave such motions as written by an option",
            );
        } else {
            self.unknown(block, words, span, reason, Carried::IfLeft);
            self.ends_at(end);
        }
        self.state.place = [end[0], end[1], None];
        self.state.direction = None;
        self.state.last = None;
    }

    /// A motion whose end is not known: refused, or carried as it is written.
    fn unknown(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        reason: &'static str,
        carried: Carried,
    ) {
        let refused = self.options.unknown_targets == UnknownTargets::Refused;
        if carried == Carried::IfLeft {
            if refused {
                return self.fault(span, reason, LEAVE);
            }
            self.finding(span, format!("it stays as it is written: {reason}"));
        }
        let target = Target::Unknown {
            reason: reason.to_owned(),
        };
        let site = TargetSite::Fixed("its end is not known");
        let parts = (Shape::Unknown, [None; 3], true);
        self.push(
            block,
            words,
            span,
            MotionKind::Linear,
            (target, site),
            parts,
        );
    }

    fn push(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        kind: MotionKind,
        (target, site): (Target, TargetSite),
        (shape, end, rapid): (Shape, [Option<f64>; 3], bool),
    ) {
        let speed = match rapid {
            true => Speed {
                mm_per_s: None,
                text: "FMAX".to_owned(),
            },
            false => self.state.speed(self.unit_mm),
        };
        let known = speed.mm_per_s.is_some();
        let is_arc = matches!(kind, MotionKind::Arc { .. });
        let fixed = TargetSite::Fixed("an arc with other ends is none about its written centre");
        self.found.motions.push(Motion {
            file: self.index,
            line: self.file.line_of(block.lines.start),
            span: span.clone(),
            kind,
            target,
            zone: Zone::Unstated,
            tool: frame_use(self.frames, &self.state.tool),
            work_object: frame_use(self.frames, &self.state.preset),
            runs: Runs::Once,
            follows: self.state.last,
            site: MotionSite {
                keyword: words[0].span.clone(),
                target_span: span.clone(),
                target: site,
                via: is_arc.then_some((span.start..span.start, fixed)),
                speed: known.then(|| SpeedSite {
                    span: span.start..span.start,
                    before: String::new(),
                    after: String::new(),
                }),
                zone: None,
                indivisible: None,
            },
            speed,
        });
        self.found.ways.push(Way {
            block: block.clone(),
            shape,
            start: self.state.place,
            end,
            datum: self.state.datum,
            unit_mm: self.unit_mm,
            feed: self.state.feed.filter(|_| known),
            pole_from: self.pole_from,
        });
        self.state.last = Some(self.found.motions.len() - 1);
    }
}

/// Whether a motion to an end that is not known may stay whatever the options say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Carried {
    Yes,
    IfLeft,
}

/// What the functions of a block do.
#[derive(Debug, Default)]
struct Acts {
    ends: bool,
    machine: bool,
    retracts: bool,
    calls: bool,
}

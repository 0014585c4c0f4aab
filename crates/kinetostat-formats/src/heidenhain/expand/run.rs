//! The run of a program: its labels, its jumps, its parameters, its holes; what it does, block by block.

use std::collections::BTreeMap;

use crate::error::ProgramError;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::expand::drill::{Hole, Retract, Stroke};
use crate::heidenhain::expand::expression::{Parameters, value_of};
use crate::heidenhain::expand::program::Program;
use crate::heidenhain::flow::label_name;
use crate::heidenhain::numbering::is_numbered;
use crate::heidenhain::path_words::{FeedWord, PathWords};
use crate::heidenhain::words::{Value, Word, words_of};
use crate::options::{ReadOptions, UnknownTargets};
use crate::text::edits::Edits;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;

/// Most blocks of a flat program.
const MOST_BLOCKS: usize = 5_000_000;
/// Most bytes of it.
const MOST_BYTES: usize = 1 << 28;
/// Most blocks that run one after another without one that is written.
const MOST_SILENT: usize = 1_000_000;
/// Most blocks that run.
const MOST_STEPS: usize = 20_000_000;
/// Deepest nesting of calls and repeats.
const DEEPEST: usize = 20;

/// Runs a Heidenhain program once and writes it flat: labels that are called and repeated, other programs (given behind the first
/// one), jumps and Q parameters, drilling by cycles 200, 201, 203 and 1. Each line says where it is from. A program
/// without anything of that comes back byte for byte.
///
/// Coordinates that parameters say are written with 4 decimals in mm (5 in inches), as the control resolves them. Holes become
/// `L` blocks along the tool's axis, their dwell cycle 9; the feed of before is stated again behind them. Other cycles that are
/// called are refused, or stay as written with [`crate::UnknownTargets::LeftAsWritten`].
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, expand_heidenhain};
///
/// let text = "0 BEGIN PGM A MM\n1 LBL 1\n2 L IX+10 F300\n3 CALL LBL 1 REP 2/2\n4 END PGM A MM\n";
/// let flat = expand_heidenhain(vec![SourceFile::new("a.h", text)], &ReadOptions::default()).unwrap();
/// let expected = "0 BEGIN PGM A MM\n1 L IX+10 F300\n2 L IX+10 F300\n3 L IX+10 F300\n4 END PGM A MM\n";
/// assert_eq!(String::from_utf8_lossy(flat.file.bytes()), expected);
/// assert_eq!(flat.origins[3], (0, 3));
/// ```
///
/// # Errors
/// What cannot be followed, by file and line: the run ends there.
pub fn expand_heidenhain(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    expand_within(files, options, MOST_BLOCKS)
}

/// The same with at most so many blocks.
///
/// # Errors
/// As there.
pub fn expand_within(
    files: Vec<SourceFile>,
    options: &ReadOptions,
    most_blocks: usize,
) -> Result<FlatText, Vec<ProgramError>> {
    let programs: Vec<Program<'_>> = files.iter().map(Program::of).collect();
    let Some(main) = programs.first() else {
        let none = SourceFile::new("", "");
        let fault = ProgramError::at(&none, 0..0, "no file is given", "give a program");
        return Err(vec![fault]);
    };
    if !main.needs() {
        return Ok(unchanged(main.file));
    }
    let mut run = Run {
        options,
        programs: &programs,
        unit_mm: main.unit_mm(),
        number: is_numbered(main.file.bytes()).then_some(0),
        ending: main.file.line_ending(),
        parameters: Values(BTreeMap::new()),
        frames: Vec::new(),
        output: Vec::with_capacity(main.file.bytes().len()),
        origins: Vec::new(),
        cycle: None,
        pecking: [None; 6],
        rapid_out: false,
        modal: false,
        feed: None,
        feed_lost: false,
        steps: 0,
        silent: 0,
        most_blocks,
    };
    let outcome = run.whole();
    let Run {
        output, origins, ..
    } = run;
    outcome.map_err(|fault| vec![fault])?;
    let changed = output != main.file.bytes();
    let file = SourceFile::new(main.file.name(), output);
    Ok(FlatText {
        file,
        origins,
        changed,
    })
}

fn unchanged(file: &SourceFile) -> FlatText {
    // What follows the last line ending is a line only where something stands there.
    let bytes = file.bytes();
    let count = match bytes.last() {
        None | Some(b'\n') => file.line_count() - 1,
        Some(_) => file.line_count(),
    };
    FlatText {
        file: file.clone(),
        origins: (1..=count).map(|line| (0, line)).collect(),
        changed: false,
    }
}

/// Values of parameters; none where the machine alone knows it.
struct Values(BTreeMap<String, f64>);

impl Parameters for Values {
    fn value(&self, name: &str) -> Option<f64> {
        self.0.get(name).copied()
    }
}

/// What is running.
enum Frame {
    /// A subprogram: the block that called it.
    Sub { caller: usize },
    /// A part that runs again: the block that says so, how often still.
    Again { by: usize, left: u64 },
    /// Another program: the file and block that called it.
    Program { file: usize, caller: usize },
}

struct Run<'p> {
    options: &'p ReadOptions,
    programs: &'p [Program<'p>],
    unit_mm: f64,
    /// The next number, where blocks have one.
    number: Option<u64>,
    ending: &'static [u8],
    parameters: Values,
    frames: Vec<Frame>,
    output: Vec<u8>,
    origins: Vec<(usize, usize)>,
    /// The number of the cycle that a call runs.
    cycle: Option<u32>,
    /// Numbers of cycle 1 by their lines.
    pecking: [Option<f64>; 6],
    /// Q208 is MAX.
    rapid_out: bool,
    /// M89 is on.
    modal: bool,
    /// The feed in force, as written.
    feed: Option<String>,
    /// A hole has left another feed behind.
    feed_lost: bool,
    steps: usize,
    silent: usize,
    most_blocks: usize,
}

/// Where the run goes on.
enum Next {
    Block,
    At(usize, usize),
    End,
}

type Fault = ProgramError;

/// Parameters of the drilling cycles.
const OWN: [&str; 15] = [
    "Q200", "Q201", "Q202", "Q203", "Q204", "Q205", "Q206", "Q208", "Q210", "Q211", "Q212", "Q213",
    "Q256", "Q379", "Q395",
];

impl<'p> Run<'p> {
    fn fault(&self, at: (usize, usize), reason: impl Into<String>, remedy: &str) -> Fault {
        let program = &self.programs[at.0];
        let text = program
            .blocks
            .get(at.1)
            .map_or(0..0, |block| block.text.clone());
        ProgramError::at(program.file, text, reason, remedy)
    }

    fn whole(&mut self) -> Result<(), Fault> {
        let programs = self.programs;
        let begin = programs[0].begin.unwrap_or(0);
        let mut at = (0, 0);
        // What stands before the program stays.
        while at.1 < begin {
            let text = &programs[0].blocks[at.1];
            self.raw(programs[0].file.part(&text.lines), at)?;
            at.1 += 1;
        }
        if let (Some(_), Some(number)) = (self.number, &programs[0].blocks[begin].number) {
            let digits = String::from_utf8_lossy(programs[0].file.part(number)).into_owned();
            self.number = Some(digits.parse().unwrap_or(0));
        }
        loop {
            self.steps += 1;
            self.silent += 1;
            let fewer = self.most_blocks.saturating_mul(4);
            if self.steps > MOST_STEPS.min(fewer) || self.silent > MOST_SILENT {
                return Err(self.fault(
                    at,
                    "the program runs more than a million blocks that write nothing, or 20 million in all",
                    "end the loop",
                ));
            }
            if at.1 >= programs[at.0].blocks.len() {
                return match self.frames.is_empty() {
                    true => Ok(()),
                    false => Err(self.fault(
                        (at.0, at.1.saturating_sub(1)),
                        "the file ends in a subprogram",
                        "end it with LBL 0",
                    )),
                };
            }
            match self.block(at)? {
                Next::Block => at.1 += 1,
                Next::At(file, block) => at = (file, block),
                Next::End => break,
            }
        }
        // The last block of the program.
        let main = &programs[0];
        let is_end = |block: &&Block| {
            block
                .words(main.file.bytes())
                .first()
                .is_some_and(|word| word.is("END"))
        };
        if let Some(end) = main.blocks.iter().rposition(|block| is_end(&block)) {
            self.write(main.file.part(&main.blocks[end].text), (0, end))?;
        }
        Ok(())
    }

    /// Bytes as they are, with their line ends.
    fn raw(&mut self, bytes: &[u8], at: (usize, usize)) -> Result<(), Fault> {
        let program = &self.programs[at.0];
        let line = program.file.line_of(program.blocks[at.1].lines.start);
        let lines = bytes.iter().filter(|byte| **byte == b'\n').count();
        let lines = lines + usize::from(!bytes.ends_with(b"\n"));
        let full = self.origins.len() + lines > self.most_blocks;
        if full || self.output.len() + bytes.len() > MOST_BYTES {
            return Err(self.fault(
                at,
                "the flat program has more than 5 million blocks, or 256 MiB",
                "repeat fewer times, or divide the program",
            ));
        }
        self.output.extend_from_slice(bytes);
        self.origins
            .extend((0..lines).map(|further| (at.0, line + further)));
        Ok(())
    }

    /// A block: its text without number and line end.
    fn write(&mut self, text: &[u8], at: (usize, usize)) -> Result<(), Fault> {
        self.silent = 0;
        let mut bytes = Vec::with_capacity(text.len() + 12);
        if let Some(number) = self.number {
            bytes.extend(format!("{number} ").bytes());
            self.number = Some(number + 1);
        }
        bytes.extend_from_slice(text);
        bytes.extend_from_slice(self.ending);
        self.raw(&bytes, at)
    }

    fn block(&mut self, at: (usize, usize)) -> Result<Next, Fault> {
        let program = &self.programs[at.0];
        let (file, block) = (program.file, &program.blocks[at.1]);
        let words = block.words(file.bytes());
        let Some(first) = words.first() else {
            let text = file.part(&block.text);
            if !text.is_empty() || self.number.is_none() {
                self.write(text, at)?;
            }
            return Ok(Next::Block);
        };
        if block.skipped {
            return Err(self.fault(
                at,
                "the block is skipped or not, as a switch of the machine says",
                "take the sign `/` away, or the block out",
            ));
        }
        match first.letters.letters() {
            b"BEGIN" if at.0 == 0 => self.write(file.part(&block.text), at)?,
            b"BEGIN" => {
                if program.unit_mm() != self.unit_mm {
                    return Err(self.fault(
                        at,
                        "the program that is called has another unit",
                        "write both in one unit",
                    ));
                }
            }
            b"END" => return self.program_ends(at),
            b"LBL" => {
                let is_end = first.value() == Some(0.0);
                let sub = self
                    .frames
                    .iter()
                    .rposition(|frame| matches!(frame, Frame::Sub { .. } | Frame::Program { .. }));
                if let (true, Some(sub)) = (is_end, sub)
                    && let Frame::Sub { caller } = self.frames[sub]
                {
                    self.frames.truncate(sub);
                    return Ok(Next::At(at.0, caller + 1));
                }
            }
            b"CALL" => return self.call(at, &words),
            b"FN" => return self.function(at, &words),
            b"Q" | b"QL" | b"QR" => self.assign(at, &words)?,
            b"QS" => {}
            b"CYCL" | b"CYCLE" => self.cycle(at, &words)?,
            _ => return self.path(at, &words),
        }
        Ok(Next::Block)
    }

    /// END PGM: the program that called goes on.
    fn program_ends(&mut self, at: (usize, usize)) -> Result<Next, Fault> {
        let open = self
            .frames
            .iter()
            .rposition(|frame| matches!(frame, Frame::Program { .. }));
        let in_sub = |frames: &[Frame]| frames.iter().any(|f| matches!(f, Frame::Sub { .. }));
        let from = open.map_or(0, |open| open + 1);
        if in_sub(&self.frames[from..]) {
            return Err(self.fault(at, "the program ends in a subprogram", "end it with LBL 0"));
        }
        let Some(open) = open else {
            return Ok(Next::End);
        };
        let Frame::Program { file, caller } = self.frames[open] else {
            return Ok(Next::End);
        };
        self.frames.truncate(open);
        Ok(Next::At(file, caller + 1))
    }

    fn enter(&mut self, at: (usize, usize), frame: Frame) -> Result<(), Fault> {
        if self.frames.len() >= DEEPEST {
            return Err(self.fault(
                at,
                "calls and repeats are nested more than 20 deep",
                "nest them less deeply",
            ));
        }
        self.frames.push(frame);
        Ok(())
    }

    fn label(&self, at: (usize, usize), word: Option<&Word>) -> Result<usize, Fault> {
        let program = &self.programs[at.0];
        let name = word
            .filter(|word| word.is("LBL"))
            .and_then(|word| label_name(program.file.bytes(), word));
        let to = name.as_ref().and_then(|name| program.labels.get(name));
        to.copied().ok_or_else(|| {
            let name = name.map_or_else(|| "of this name".to_owned(), |name| format!("LBL {name}"));
            self.fault(
                at,
                format!("there is no {name}"),
                "write the label, or take this out",
            )
        })
    }

    fn call(&mut self, at: (usize, usize), words: &[Word]) -> Result<Next, Fault> {
        let what = words.get(1);
        if what.is_some_and(|word| word.is("PGM")) {
            return self.call_program(at, &words[1]);
        }
        let to = self.label(at, what)?;
        let Some(again) = words.get(2) else {
            self.enter(at, Frame::Sub { caller: at.1 })?;
            return Ok(Next::At(at.0, to));
        };
        let text = self.programs[at.0].file.part(&again.span).to_vec();
        let count = match again.is("REP") {
            true => value_of(&text[3.min(text.len())..], &self.parameters).ok(),
            false => None,
        };
        let count = count.filter(|count| count.fract() == 0.0 && (1.0..=65_534.0).contains(count));
        let Some(count) = count else {
            return Err(self.fault(
                at,
                "how often it repeats is not a whole number from 1 to 65534",
                "write CALL LBL 1 REP 2",
            ));
        };
        // Is it the repeat that is running?
        if let Some(Frame::Again { by, left }) = self.frames.last_mut()
            && *by == at.1
        {
            if *left == 0 {
                self.frames.pop();
                return Ok(Next::Block);
            }
            *left -= 1;
            return Ok(Next::At(at.0, to));
        }
        let left = count as u64 - 1;
        self.enter(at, Frame::Again { by: at.1, left })?;
        Ok(Next::At(at.0, to))
    }

    fn call_program(&mut self, at: (usize, usize), word: &Word) -> Result<Next, Fault> {
        let program = &self.programs[at.0];
        let block = &program.blocks[at.1];
        let from = word.span.start + b"PGM".len();
        let text = program.file.part(&(from..block.text.end));
        let text = text.split(|byte| *byte == b';').next().unwrap_or_default();
        let name = String::from_utf8_lossy(text).trim().to_owned();
        let found = (self.programs.iter()).position(|program| program.is_named(&name));
        let Some(found) = found.filter(|_| !name.is_empty()) else {
            return Err(self.fault(
                at,
                format!("the program `{name}` that it calls is not among the files"),
                "give its file together with this one",
            ));
        };
        let Some(begin) = self.programs[found].begin else {
            return Err(self.fault(
                at,
                format!("`{name}` has no block BEGIN PGM"),
                "give a program",
            ));
        };
        self.enter(
            at,
            Frame::Program {
                file: at.0,
                caller: at.1,
            },
        )?;
        Ok(Next::At(found, begin))
    }

    /// Puts values into parameters: `Q1 = ...`, more of them in a cycle.
    fn assign(&mut self, at: (usize, usize), words: &[Word]) -> Result<(), Fault> {
        let bytes = self.programs[at.0].file.bytes();
        let is_name = |word: &Word| {
            matches!(word.letters.letters(), b"Q" | b"QL" | b"QR") && word.whole().is_some()
        };
        let starts: Vec<usize> = (0..words.len().saturating_sub(1))
            .filter(|index| is_name(&words[*index]) && begins_value(&words[index + 1], bytes))
            .collect();
        if starts.is_empty() {
            return Err(self.fault(at, "no parameter gets a value here", "write Q1 = ..."));
        }
        for (order, index) in starts.iter().enumerate() {
            let next = starts.get(order + 1).copied().unwrap_or(words.len());
            let name = &words[*index];
            let key = format!(
                "{}{}",
                String::from_utf8_lossy(name.letters.letters()),
                name.whole().unwrap_or(0)
            );
            // Comments between are no words.
            let parts = words[index + 1..next]
                .iter()
                .map(|word| &bytes[word.span.clone()]);
            let text = parts.collect::<Vec<_>>().join(&b' ');
            let text = text.strip_prefix(b"=").unwrap_or(&text).trim_ascii();
            if key == "Q208" {
                self.rapid_out = text.eq_ignore_ascii_case(b"MAX");
            }
            if ["MAX", "FMAX", "AUTO", "FAUTO"]
                .iter()
                .any(|w| text.eq_ignore_ascii_case(w.as_bytes()))
            {
                self.parameters.0.remove(&key);
                continue;
            }
            let value = value_of(text, &self.parameters);
            let value = value.map_err(|reason| {
                self.fault(at, reason, "state the value as a number: FN 0: Q1 = +5")
            })?;
            self.parameters.0.insert(key, value);
        }
        Ok(())
    }

    fn function(&mut self, at: (usize, usize), words: &[Word]) -> Result<Next, Fault> {
        let bytes = self.programs[at.0].file.bytes();
        match words[0].whole() {
            Some(0..=8 | 13) => self.assign(at, &words[1..])?,
            Some(9..=12) => return self.jump(at, words),
            Some(14) => {
                return Err(self.fault(
                    at,
                    "the program ends here with an error of its own",
                    "mend the values that lead here",
                ));
            }
            Some(17 | 25) | None => {
                return Err(self.fault(
                    at,
                    "it writes data of the control, which may move the coordinates",
                    "take it into a program of its own",
                ));
            }
            Some(_) => {
                // What only the machine knows has no value behind it.
                let mut reads = false;
                for pair in words[1..].windows(2) {
                    if begins_value(&pair[1], bytes) && pair[0].whole().is_some() {
                        let letters =
                            String::from_utf8_lossy(pair[0].letters.letters()).into_owned();
                        let key = format!("{letters}{}", pair[0].whole().unwrap_or(0));
                        self.parameters.0.remove(&key);
                        reads = true;
                    }
                    for word in pair.iter().filter(|_| reads) {
                        // `SYSREAD Q11`.
                        if let Value::Parameter { name, .. } = &word.value {
                            let key = String::from_utf8_lossy(&bytes[name.clone()]);
                            self.parameters.0.remove(&key.to_ascii_uppercase());
                        }
                    }
                }
                if let Some(Value::Parameter { name, .. }) = words
                    .iter()
                    .find(|word| word.is("SYSREAD"))
                    .map(|word| &word.value)
                {
                    let key = String::from_utf8_lossy(&bytes[name.clone()]).to_ascii_uppercase();
                    self.parameters.0.remove(&key);
                }
                let block = &self.programs[at.0].blocks[at.1];
                self.write(self.programs[at.0].file.part(&block.text), at)?;
            }
        }
        Ok(Next::Block)
    }

    fn jump(&mut self, at: (usize, usize), words: &[Word]) -> Result<Next, Fault> {
        let bytes = self.programs[at.0].file.bytes();
        let place = |name: &str| words.iter().position(|word| word.is(name));
        let (Some(from), Some(goes)) = (place("IF"), place("GOTO")) else {
            return Err(self.fault(
                at,
                "the jump is not whole",
                "write IF .. EQU .. GOTO LBL ..",
            ));
        };
        let compares = ["EQU", "NE", "GT", "LT"];
        let by = compares.iter().find_map(|name| Some((*name, place(name)?)));
        let behind = |index: usize| words[index].span.start + words[index].letters.letters().len();
        let is_true = match by {
            Some((name, at_word)) if from < at_word && at_word < goes => {
                let value = |text: &[u8]| {
                    value_of(text, &self.parameters).map_err(|reason| {
                        self.fault(at, reason, "state the value as a number: FN 0: Q1 = +5")
                    })
                };
                let left = value(&bytes[behind(from)..words[at_word].span.start])?;
                let right = value(&bytes[behind(at_word)..words[goes].span.start])?;
                match name {
                    "EQU" => left == right,
                    "NE" => left != right,
                    "GT" => left > right,
                    _ => left < right,
                }
            }
            _ => {
                return Err(self.fault(
                    at,
                    "what it compares is not known",
                    "compare with EQU, NE, GT or LT",
                ));
            }
        };
        let to = self.label(at, words.get(goes + 1))?;
        Ok(match is_true {
            true => Next::At(at.0, to),
            false => Next::Block,
        })
    }

    fn cycle(&mut self, at: (usize, usize), words: &[Word]) -> Result<(), Fault> {
        let file = self.programs[at.0].file;
        let Some(kind) = words.get(1) else {
            return self.substituted(at, words).map(|_| ());
        };
        if kind.is("CALL") {
            let plain = words.len() == 2 || words[2].is("M");
            if !plain {
                return Err(self.fault(
                    at,
                    "the cycle is called at places of its own",
                    "call it with M99 or CYCL CALL",
                ));
            }
            let text = self.text(at, words)?;
            let rest = match text
                .windows(4)
                .position(|part| part.eq_ignore_ascii_case(b"CALL"))
            {
                Some(call) => text[call + 4..].trim_ascii().to_vec(),
                None => Vec::new(),
            };
            if self.is_left(at)? {
                return self.write(&text, at);
            }
            if rest.first().is_some_and(|byte| *byte != b';') {
                self.write(&rest, at)?;
            }
            return self.drill(at);
        }
        let number = kind.number().filter(|_| kind.is("DEF"));
        let Some(number) = number else {
            self.substituted(at, words)?;
            return Ok(());
        };
        let text = String::from_utf8_lossy(file.part(&number.span)).into_owned();
        let mut parts = text.splitn(2, ['.', ',']);
        let mut part = || parts.next().and_then(|text| text.parse::<u32>().ok());
        let (cycle, part) = (part().unwrap_or(0), part().unwrap_or(0));
        let has_values = words
            .windows(2)
            .any(|pair| pair[0].is("Q") && begins_value(&pair[1], file.bytes()));
        if matches!(cycle, 200 | 201 | 203) {
            // What a cycle before said, says nothing of this one.
            for name in OWN {
                self.parameters.0.remove(name);
            }
            self.rapid_out = false;
        }
        if has_values {
            self.assign(at, &words[2..])?;
        }
        match cycle {
            // They act where they are defined.
            7..=11 | 13 | 14 | 19 | 20 | 26 | 32 | 39 | 220..=299 | 400..=499
                if !(240..=246).contains(&cycle) && !(250..=290).contains(&cycle) =>
            {
                self.substituted(at, words)?;
            }
            200 | 201 | 203 => {
                self.cycle = Some(cycle);
                self.modal = false;
            }
            1 => {
                if part == 0 {
                    self.pecking = [None; 6];
                    self.cycle = Some(1);
                    self.modal = false;
                }
                let flat = self.text(at, words)?;
                let flat_words = words_of(&flat, &(0..flat.len()));
                let value = flat_words.iter().skip(2).find_map(Word::value);
                if let Some(slot) = self.pecking.get_mut(part as usize) {
                    *slot = value;
                }
            }
            _ => {
                self.cycle = Some(cycle);
                self.modal = false;
                self.substituted(at, words)?;
            }
        }
        Ok(())
    }

    /// Whether the cycle that is called stays a cycle.
    fn is_left(&self, at: (usize, usize)) -> Result<bool, Fault> {
        match self.cycle {
            None => Err(self.fault(at, "no cycle is defined that could be called", "define it before")),
            Some(1 | 200 | 201 | 203) => Ok(false),
            Some(number) if self.options.unknown_targets == UnknownTargets::Refused => Err(self
                .fault(
                    at,
                    format!("cycle {number} is called, and what it does is not followed"),
                    "leave such motions as written by an option, or let the CAM system write L blocks",
                )),
            Some(_) => Ok(true),
        }
    }

    /// The blocks of a hole.
    fn drill(&mut self, at: (usize, usize)) -> Result<(), Fault> {
        let value = |name: &str| self.parameters.value(name).unwrap_or(0.0);
        let cycle = self.cycle.unwrap_or(0);
        if cycle != 1 && value("Q395") != 0.0 {
            return Err(self.fault(
                at,
                "the depth is that of the drill's full diameter (Q395), which its tip says",
                "state the depth of the tip: Q395=+0",
            ));
        }
        let hole = match cycle {
            1 => Hole::pecked(&self.pecking, self.unit_mm),
            _ => {
                let retract = match self.rapid_out {
                    true => Retract::Rapid,
                    false => Retract::Feed(value("Q208")),
                };
                Hole::drilled(cycle, value, retract, self.unit_mm)
            }
        };
        let strokes = hole.strokes();
        let strokes =
            strokes.map_err(|reason| self.fault(at, reason, "mend the cycle's values"))?;
        for stroke in strokes {
            let (letters, value, feed) = match stroke {
                Stroke::To(to, feed) => ("Z", to, feed),
                Stroke::By(by, feed) => ("IZ", by, feed),
                Stroke::Dwell(seconds) => {
                    self.write(b"CYCL DEF 9.0 DWELL TIME", at)?;
                    let text = format!("CYCL DEF 9.1 DWELL {}", trimmed(seconds, 3));
                    self.write(text.as_bytes(), at)?;
                    continue;
                }
            };
            let feed = match feed {
                Some(feed) => {
                    self.feed_lost = true;
                    format!("F{}", trimmed(feed, 3))
                }
                None => "FMAX".to_owned(),
            };
            let text = format!("L {letters}{} R0 {feed}", self.length(value));
            self.write(text.as_bytes(), at)?;
        }
        Ok(())
    }

    /// A length with its sign, as finely as the control resolves it.
    fn length(&self, value: f64) -> String {
        let decimals = match self.unit_mm == 1.0 {
            true => 4,
            false => 5,
        };
        let text = trimmed(value, decimals);
        match text.starts_with('-') {
            true => text,
            false => format!("+{text}"),
        }
    }

    /// The text of a block with values in place of its parameters.
    fn text(&self, at: (usize, usize), words: &[Word]) -> Result<Vec<u8>, Fault> {
        let program = &self.programs[at.0];
        let block = &program.blocks[at.1];
        let bytes = program.file.bytes();
        let mut edits = Edits::default();
        for (index, word) in words.iter().enumerate() {
            let (span, sign, name) = match &word.value {
                Value::Parameter { span, sign, name } => (span.clone(), *sign, name.clone()),
                // `= Q5` without a sign.
                Value::Number(number)
                    if matches!(word.letters.letters(), b"Q" | b"QL" | b"QR")
                        && index > 0
                        && begins_value(&words[index - 1], bytes) =>
                {
                    (word.span.clone(), 1.0, word.span.start..number.span.end)
                }
                _ => continue,
            };
            let key: Vec<u8> = bytes[name]
                .iter()
                .filter(|byte| !byte.is_ascii_whitespace())
                .map(u8::to_ascii_uppercase)
                .collect();
            let key = String::from_utf8_lossy(&key).into_owned();
            let Some(value) = self.parameters.value(&key) else {
                return Err(self.fault(
                    at,
                    format!("{key} has no value that the program states"),
                    "state it before: FN 0: Q1 = +5",
                ));
            };
            let plain = ["F", "S", "M", "CALL", "DEF"]
                .iter()
                .any(|letters| word.is(letters));
            let text = match plain {
                true => trimmed(sign * value, 3),
                false => self.length(sign * value),
            };
            edits.replace(span, text);
        }
        let text = edits.applied_to_part(bytes, &block.text);
        text.ok_or_else(|| {
            self.fault(
                at,
                "its words overlap",
                "write the block as the control shows it",
            )
        })
    }

    fn substituted(&mut self, at: (usize, usize), words: &[Word]) -> Result<Vec<u8>, Fault> {
        let text = self.text(at, words)?;
        self.write(&text, at)?;
        Ok(text)
    }

    /// The radius of a tool that the program defines and takes is Q108 from there on.
    fn tool(&mut self, words: &[Word], text: &[u8]) {
        let Some(kind) = words.get(1) else {
            return;
        };
        let Some(name) = label_name(text, kind) else {
            return;
        };
        let key = format!("TOOL {name}");
        if kind.is("DEF") {
            match words.iter().find(|word| word.is("R")).and_then(Word::value) {
                Some(radius) => self.parameters.0.insert(key, radius),
                None => self.parameters.0.remove(&key),
            };
            return;
        }
        let larger = words.iter().any(|word| word.is("DR"));
        match self.parameters.0.get(&key).copied().filter(|_| !larger) {
            Some(radius) => self.parameters.0.insert("Q108".to_owned(), radius),
            None => self.parameters.0.remove("Q108"),
        };
    }

    /// Any other block: its values, its calls of a cycle, the feed behind a hole.
    fn path(&mut self, at: (usize, usize), words: &[Word]) -> Result<Next, Fault> {
        // Most blocks are written as they are.
        let plain = |word: &Word| {
            !matches!(word.value, Value::Parameter { .. })
                && !matches!(
                    word.letters.letters(),
                    b"M" | b"F" | b"FAUTO" | b"FU" | b"FZ" | b"FT" | b"TOOL"
                )
        };
        if !self.modal && !self.feed_lost && words.iter().all(plain) {
            let program = &self.programs[at.0];
            let text = program.file.part(&program.blocks[at.1].text);
            self.write(text, at)?;
            return Ok(Next::Block);
        }
        let mut text = self.text(at, words)?;
        let flat = words_of(&text, &(0..text.len()));
        if flat.first().is_some_and(|word| word.is("TOOL")) {
            self.tool(&flat, &text);
            if flat.get(1).is_some_and(|word| word.is("CALL"))
                && let Some(word) = flat.iter().find(|word| word.is("F"))
            {
                self.feed = Some(String::from_utf8_lossy(&text[word.span.clone()]).into_owned());
                self.feed_lost = false;
            }
            self.write(&text, at)?;
            return Ok(Next::Block);
        }
        let moves = matches!(
            flat.first().map(|word| word.letters),
            Some(letters) if matches!(letters.letters(), b"L" | b"LN" | b"LP" | b"C" | b"CP" | b"CR" | b"CT" | b"CTP")
        );
        let numbers = |number: u32| {
            flat.iter()
                .position(|word| word.is("M") && word.whole() == Some(number))
        };
        let ends = numbers(2).or(numbers(30)).is_some();
        let parsed = PathWords::of(&flat).ok().filter(|_| moves);
        let goes = parsed.as_ref().is_some_and(PathWords::moves);
        let (once, on) = (numbers(99), numbers(89));
        let calls = once.is_some() || (goes && (self.modal || on.is_some()));
        let left = calls && self.is_left(at)?;
        if on.is_some() {
            self.modal = true;
        }
        if once.is_some() {
            self.modal = false;
        }
        let mut edits = Edits::default();
        if let Some(parsed) = &parsed {
            let first = flat
                .iter()
                .position(|word| word.is("M"))
                .unwrap_or(flat.len());
            match parsed.feed {
                FeedWord::Number(word, _) => {
                    let span = flat[word].span.clone();
                    self.feed = Some(String::from_utf8_lossy(&text[span]).into_owned());
                    self.feed_lost = false;
                }
                FeedWord::Auto => {
                    self.feed = Some("FAUTO".to_owned());
                    self.feed_lost = false;
                }
                FeedWord::Other => self.feed = None,
                FeedWord::None if self.feed_lost && goes => {
                    if let Some(feed) = &self.feed {
                        let behind = flat[first.saturating_sub(1)].span.end;
                        edits.replace(behind..behind, format!(" {feed}"));
                    }
                    self.feed_lost = false;
                }
                FeedWord::None | FeedWord::Max => {}
            }
        }
        let mut bare = false;
        if !left {
            for index in [once, on].into_iter().flatten() {
                let from = match index {
                    0 => 0,
                    _ => flat[index - 1].span.end,
                };
                let end = flat[index].span.end;
                // The word behind may stand against it.
                let against = flat
                    .get(index + 1)
                    .is_some_and(|next| next.span.start == end);
                let gap = match against {
                    true => " ",
                    false => "",
                };
                edits.replace(from..end, gap);
                bare = true;
            }
        }
        text = edits.applied_to(&text).ok_or_else(|| {
            self.fault(
                at,
                "its words overlap",
                "write the block as the control shows it",
            )
        })?;
        // What is left of `L FMAX M99` does nothing.
        let rest = words_of(&text, &(0..text.len()));
        let idle = |word: &Word| {
            ["L", "FMAX", "F", "R", "MAX"]
                .iter()
                .any(|letters| word.is(letters))
        };
        let nothing = bare && !goes && rest.iter().all(idle);
        match nothing {
            true => self.feed_lost |= self.feed.is_some(),
            false => self.write(&text, at)?,
        }
        if calls && !left {
            self.drill(at)?;
        }
        match ends {
            true if self
                .frames
                .iter()
                .any(|frame| matches!(frame, Frame::Program { .. })) =>
            {
                Err(self.fault(
                    at,
                    "a program that is called ends the whole program",
                    "take M2 or M30 out of the program that is called",
                ))
            }
            true => Ok(Next::End),
            false => Ok(Next::Block),
        }
    }
}

/// Whether a word is the sign before a value.
fn begins_value(word: &Word, bytes: &[u8]) -> bool {
    bytes.get(word.span.start) == Some(&b'=')
}

/// A number with at most so many decimals.
fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    match text {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}

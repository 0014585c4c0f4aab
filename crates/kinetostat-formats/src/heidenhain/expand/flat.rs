//! A program run once and written flat, block by block.

use std::ops::Range;

use crate::error::ProgramError;
use crate::flat_run::{Behind, BlockId, MOST_STEPS, RefusedRun, Runs, Written, with_corners};
use crate::heidenhain::blocks::{STRAY, STRAY_REMEDY, is_numbered};
use crate::heidenhain::expand::aside::led_aside;
use crate::heidenhain::expand::corners::written_out;
use crate::heidenhain::expand::run::{DEEPEST, Fault, Frame, Next, Program, Run};
use crate::heidenhain::expand::values::{Values, begins_value};
use crate::heidenhain::flow::NOT_ALONE;
use crate::heidenhain::words::{EXPONENT, Value, Word, exponent};
use crate::model::stated_value::{SLASHED, SlashBlocks, told_of_values};
use crate::options::ReadOptions;
use crate::text::source::{FlatText, SourceFile};

/// Runs a Heidenhain program once and writes it flat: labels that are called and repeated, other programs (given behind the first
/// one), jumps and Q parameters, drilling by cycles 200, 201, 203 and 1, corners that are rounded (RND, between two lines or a line and an
/// arc about a pole) or broken (CHF, between two lines, whose number is how much it takes of each), contours with RL or RR whose tool has its radius in `TOOL DEF` (outside
/// corners become arcs, inside corners end where the tool touches both sides). Each line says where it is from. A program
/// without anything of that comes back byte for byte.
///
/// Coordinates that parameters say are written with 4 decimals in mm (5 in inches), as the control resolves them. Holes become
/// `L` blocks along the tool's axis, their dwell cycle 9; the feed of before is stated again behind them. Other cycles that are
/// called are refused, or stay as written with [`crate::UnknownTargets::LeftAsWritten`]. Parameters that the machine alone knows (`FN 18`)
/// have the values of [`ReadOptions::values`].
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
/// What cannot be followed, by file and line. Behind a line that is refused the run goes on, unless what runs, or a value, depends on it.
pub fn expand_heidenhain(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    expand_within(files, options, MOST_STEPS)
}

/// Expands a program with a limit of the executed blocks.
///
/// # Errors
/// The same errors as without the limit.
pub fn expand_within(
    files: Vec<SourceFile>,
    options: &ReadOptions,
    most_steps: u64,
) -> Result<FlatText, Vec<ProgramError>> {
    run_within(&files, options, most_steps).map_err(|refused| refused.faults)
}

/// Expands a program; a refused program is returned with the part that was written.
pub(crate) fn run_or_refused(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, RefusedRun> {
    run_within(files, options, MOST_STEPS)
}

fn run_within(
    files: &[SourceFile],
    options: &ReadOptions,
    most_steps: u64,
) -> Result<FlatText, RefusedRun> {
    let out = |flat| {
        let flat = written_out(flat, files, options)?;
        led_aside(flat, files, options)
    };
    let programs: Vec<Program<'_>> = files.iter().map(Program::of).collect();
    let Some(main) = programs.first() else {
        let none = SourceFile::new("", "");
        let fault = ProgramError::at(&none, 0..0, "no file is given", "give a program");
        return Err(vec![fault].into());
    };
    let equal: Vec<ProgramError> = main.equal_labels().collect();
    if !equal.is_empty() {
        return Err(equal.into());
    }
    if !main.needs(options.slash_blocks) {
        return with_corners(FlatText::unchanged(main.file, 0), Vec::new(), out);
    }
    let parameters = Values::of(options)
        .map_err(|(reason, remedy)| vec![ProgramError::at(main.file, 0..0, reason, remedy)])?;
    let findings = told_of_values(&options.values, main.file.bytes());
    let mut run = Run {
        options,
        files,
        programs: &programs,
        unit_mm: main.unit_mm(),
        number: is_numbered(main.file.bytes()).then_some(0),
        parameters,
        frames: Vec::new(),
        written: Written::new(main.file),
        at: Some(BlockId { file: 0, block: 0 }),
        cycle: None,
        pecking: [None; 6],
        axis: "Z",
        rapid_out: false,
        modal: false,
        feed: None,
        feed_lost: false,
        cycle_refused: false,
    };
    run.begin();
    run.run(most_steps);
    run.written.into_flat(main.file, Vec::new(), findings, out)
}

impl Runs for Run<'_> {
    fn files(&self) -> &[SourceFile] {
        self.files
    }

    fn written(&mut self) -> &mut Written {
        &mut self.written
    }

    fn at(&self) -> Option<BlockId> {
        self.at
    }

    fn running(&self) -> Vec<BlockId> {
        let mut file = self.at.map_or(0, |at| at.file);
        let mut running: Vec<BlockId> = self.at.into_iter().collect();
        for frame in self.frames.iter().rev() {
            let block = match frame {
                Frame::Sub { caller } => *caller,
                Frame::Again { by, .. } => *by,
                Frame::Program {
                    file: calls,
                    caller,
                    ..
                } => {
                    file = *calls;
                    *caller
                }
            };
            running.push(BlockId { file, block });
        }
        running.reverse();
        running
    }

    fn span_of(&self, at: BlockId) -> Range<usize> {
        let block = self.programs[at.file].blocks.get(at.block);
        block.map_or(0..0, |block| block.text.clone())
    }

    fn step(&mut self, at: BlockId) -> Result<(), Fault> {
        if at.block >= self.programs[at.file].blocks.len() {
            let block = at.block.saturating_sub(1);
            return self.file_ends(BlockId { block, ..at });
        }
        match self.block(at)? {
            Next::Block => self.at = Some(at.next()),
            Next::At(to) => self.at = Some(to),
            Next::End => self.last_block(),
        }
        Ok(())
    }

    /// Effect of a refused block on the blocks after it: none, unless it may change the control flow or a parameter.
    fn behind(&self, at: BlockId) -> Behind {
        let program = &self.programs[at.file];
        let Some(block) = program.blocks.get(at.block) else {
            return Behind::Nothing;
        };
        if self.frames.len() >= DEEPEST {
            return Behind::Nothing;
        }
        let words = block.words(program.file.bytes());
        let Some(first) = words.first() else {
            return Behind::Same;
        };
        let depends = match first.letters.letters() {
            b"BEGIN" | b"END" | b"LBL" | b"Q" | b"QL" | b"QR" => true,
            b"FN" => matches!(first.whole(), Some(0..=14) | None),
            _ => words
                .iter()
                .any(|word| word.is("M") && matches!(word.whole(), Some(2 | 30))),
        };
        match depends {
            true => Behind::Depends,
            false => Behind::Same,
        }
    }

    fn pass(&mut self, at: BlockId, has_written: bool) {
        let program = &self.programs[at.file];
        let block = &program.blocks[at.block];
        let words = block.words(program.file.bytes());
        if let [cycle, define, ..] = words.as_slice()
            && (cycle.is("CYCL") || cycle.is("CYCLE"))
            && define.is("DEF")
        {
            self.cycle_refused = true;
        }
        if !has_written {
            self.write(program.file.part(&block.text), at);
        }
        self.at = Some(at.next());
    }
}

impl Run<'_> {
    /// Goes to BEGIN PGM: what stands before the program stays.
    pub(crate) fn begin(&mut self) {
        let program = &self.programs[0];
        let begin = program.begin.unwrap_or(0);
        let before = program.blocks[..begin].last();
        let end = before.map_or(0, |block| block.lines.end);
        self.written.copy(program.file, 0, &(0..end));
        if let (Some(_), Some(number)) = (self.number, &program.blocks[begin].number) {
            let digits = String::from_utf8_lossy(program.file.part(number));
            self.number = Some(digits.parse().unwrap_or(0));
        }
        self.at = Some(BlockId {
            file: 0,
            block: begin,
        });
    }

    /// Handles the end of a file after its last block.
    fn file_ends(&mut self, last: BlockId) -> Result<(), Fault> {
        let (reason, remedy) = match self.frames.last() {
            None => {
                self.at = None;
                return Ok(());
            }
            Some(Frame::Program { .. }) => (
                "no block END PGM ends the program that is called",
                "give the whole program",
            ),
            Some(_) => ("the file ends in a subprogram", "end it with LBL 0"),
        };
        Err(self.fault(last, reason, remedy))
    }

    /// Writes the last block of the program.
    fn last_block(&mut self) {
        self.at = None;
        let main = &self.programs[0];
        let bytes = main.file.bytes();
        let is_end = |at: &usize| {
            let words = main.blocks[*at].words(bytes);
            words.first().is_some_and(|word| word.is("END"))
        };
        let mut blocks = main.begin.unwrap_or(0)..main.blocks.len();
        if let Some(end) = blocks.find(is_end) {
            let at = BlockId {
                file: 0,
                block: end,
            };
            self.write(main.file.part(&main.blocks[end].text), at);
        }
    }

    fn block(&mut self, at: BlockId) -> Result<Next, Fault> {
        let program = &self.programs[at.file];
        let (file, block) = (program.file, &program.blocks[at.block]);
        let words = block.words(file.bytes());
        let Some(first) = words.first() else {
            let text = file.part(&block.text);
            if !text.is_empty() || self.number.is_none() {
                self.write(text, at);
            }
            return Ok(Next::Block);
        };
        match self.options.slash_blocks {
            SlashBlocks::Refused if block.skipped => {
                return Err(self.fault(at, SLASHED.0, SLASHED.1));
            }
            SlashBlocks::Skipped if block.skipped => {
                self.write(file.part(&block.text), at);
                return Ok(Next::Block);
            }
            _ => {}
        }
        if exponent(&words).is_some() {
            return Err(self.fault(at, EXPONENT.0, EXPONENT.1));
        }
        match first.letters.letters() {
            b"BEGIN" if at.file == 0 => self.write(file.part(&block.text), at),
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
            b"LBL" if words.len() > 1 => {
                return Err(self.fault(at, NOT_ALONE.0, NOT_ALONE.1));
            }
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
                    let block = caller + 1;
                    return Ok(Next::At(BlockId { block, ..at }));
                }
            }
            b"CALL" => return self.call(at, &words),
            b"FN" => return self.function(at, &words),
            b"Q" | b"QL" | b"QR" => self.assign(at, &words)?,
            b"QS" => {}
            // The Q parameters of the block are results of the probing.
            b"TCH" => self.write(file.part(&block.text), at),
            b"CYCL" | b"CYCLE" if block.no_parameter(file.bytes()).is_some() => {
                return Err(self.fault(at, STRAY, STRAY_REMEDY));
            }
            b"CYCL" | b"CYCLE" => self.cycle(at, &words)?,
            _ => return self.path(at, &words),
        }
        Ok(Next::Block)
    }

    fn function(&mut self, at: BlockId, words: &[Word]) -> Result<Next, Fault> {
        let bytes = self.programs[at.file].file.bytes();
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
                // A value that only the machine knows is unknown after the read.
                let mut reads = false;
                for pair in words[1..].windows(2) {
                    if begins_value(&pair[1], bytes) && pair[0].whole().is_some() {
                        let letters =
                            String::from_utf8_lossy(pair[0].letters.letters()).into_owned();
                        let key = format!("{letters}{}", pair[0].whole().unwrap_or(0));
                        self.parameters.read_from_machine(&key);
                        reads = true;
                    }
                    for word in pair.iter().filter(|_| reads) {
                        // `SYSREAD Q11`.
                        if let Value::Parameter { name, .. } = &word.value {
                            let key = String::from_utf8_lossy(&bytes[name.clone()]);
                            self.parameters.read_from_machine(&key.to_ascii_uppercase());
                        }
                    }
                }
                if let Some(Value::Parameter { name, .. }) = words
                    .iter()
                    .find(|word| word.is("SYSREAD"))
                    .map(|word| &word.value)
                {
                    let key = String::from_utf8_lossy(&bytes[name.clone()]).to_ascii_uppercase();
                    self.parameters.read_from_machine(&key);
                }
                let block = &self.programs[at.file].blocks[at.block];
                self.write(self.programs[at.file].file.part(&block.text), at);
            }
        }
        Ok(Next::Block)
    }
}

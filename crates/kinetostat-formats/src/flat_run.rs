//! The run of a program that is written flat, the same for all languages: what it has written, its bounds, and what is refused by it and by the
//! reader of the flat text.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::ProgramError;
use crate::text::source::{Edits, Finding, FlatText, SourceFile};

/// Position of a block, which is a line or several: the index of its file, and its own in that file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct BlockId {
    pub file: usize,
    pub block: usize,
}

impl BlockId {
    /// The block after this one.
    pub(crate) fn next(self) -> Self {
        Self {
            block: self.block + 1,
            ..self
        }
    }
}

/// Limit of the executed lines.
pub(crate) const MOST_STEPS: u64 = 20_000_000;
/// Limit of consecutive executed lines without output.
const MOST_SILENT: u64 = 1_000_000;
/// Limit of the written lines.
const MOST_LINES: usize = 5_000_000;
/// Limit of the written bytes.
const MOST_BYTES: usize = 1 << 28;

/// Reason and remedy of a program that runs, and cannot be written flat.
pub(crate) fn not_flat(why: &str) -> (String, &'static str) {
    (
        format!("the program cannot be written flat: {why}"),
        "read the program without expanding it",
    )
}

/// The bounds in words.
const BOUNDS: &str = "it has run more than 20 million blocks, or more than a million blocks that write nothing, or has written more than 5 million blocks or 256 MiB";

/// The flat program as it grows, and what is refused.
#[derive(Default)]
pub(crate) struct Written {
    pub bytes: Vec<u8>,
    /// File and line (from 1) of each line.
    pub origins: Vec<(usize, usize)>,
    ending: &'static [u8],
    steps: u64,
    silent: u64,
    /// Lines that were gone back to, each with the last line from where.
    back_to: BTreeMap<BlockId, usize>,
    pub faults: FaultsOfRun,
    /// A limit was reached: the output is incomplete.
    is_endless: bool,
}

impl Written {
    /// Nothing yet, with the line ends of a file.
    pub(crate) fn new(file: &SourceFile) -> Self {
        Self {
            bytes: Vec::with_capacity(file.bytes().len()),
            ending: file.line_ending(),
            ..Self::default()
        }
    }

    /// Adds a text and a line end; the text may be of several lines.
    pub(crate) fn line(&mut self, text: &[u8], file: usize, line: usize) {
        self.silent = 0;
        self.bytes.extend_from_slice(text);
        self.bytes.extend_from_slice(self.ending);
        let further = text.iter().filter(|byte| **byte == b'\n').count();
        self.origins
            .extend((0..=further).map(|further| (file, line + further)));
    }

    /// Adds a text of a line of a file, and of those behind it, where the last one ended.
    pub(crate) fn part(&mut self, text: &[u8], file: usize, line: usize) {
        for (further, text) in text.split_inclusive(|byte| *byte == b'\n').enumerate() {
            if self.bytes.last().is_none_or(|byte| *byte == b'\n') {
                self.origins.push((file, line + further));
            }
            self.bytes.extend_from_slice(text);
        }
    }

    /// Adds a part of a file, by its index, with its own line ends.
    pub(crate) fn copy(&mut self, file: &SourceFile, index: usize, part: &Range<usize>) {
        let bytes = file.part(part);
        let first = file.line_of(part.start);
        let lines = bytes.split_inclusive(|byte| *byte == b'\n').count();
        self.bytes.extend_from_slice(bytes);
        self.origins
            .extend((0..lines).map(|line| (index, first + line)));
    }

    /// True if the output is larger than any program.
    pub(crate) fn is_full(&self) -> bool {
        self.origins.len() > MOST_LINES || self.bytes.len() > MOST_BYTES
    }

    /// Notes where a line goes, if it goes back.
    pub(crate) fn goes_back(&mut self, from: BlockId, to: usize) {
        if to <= from.block {
            let begin = BlockId { block: to, ..from };
            let last = self.back_to.entry(begin).or_insert(from.block);
            *last = from.block.max(*last);
        }
    }

    /// The line that goes back to the beginning of the widest loop around a line.
    fn end_of_loop(&self, at: BlockId) -> Option<BlockId> {
        let loops = self.back_to.iter();
        let around = loops
            .filter(|(from, to)| from.file == at.file && (from.block..=**to).contains(&at.block));
        let widest = around.max_by_key(|(from, to)| **to - from.block);
        widest.map(|(_, to)| BlockId { block: *to, ..at })
    }

    /// The flat program of a file, with its corners written out by `out`; refused with all that was refused before and by the run.
    pub(crate) fn into_flat(
        self,
        file: &SourceFile,
        mut faults: Vec<ProgramError>,
        findings: Vec<Finding>,
        out: impl FnOnce(FlatText) -> Result<FlatText, Vec<ProgramError>>,
    ) -> Result<FlatText, RefusedRun> {
        faults.extend(self.faults.into_faults());
        if self.is_endless {
            // Reading millions of blocks of a loop would take gigabytes, and adds no information.
            return Err(faults.into());
        }
        let flat = FlatText {
            changed: self.bytes != file.bytes(),
            file: SourceFile::new(file.name(), self.bytes),
            origins: self.origins,
            findings,
        };
        with_corners(flat, faults, out)
    }
}

/// A program that is run line by line.
pub(crate) trait Runs {
    fn files(&self) -> &[SourceFile];

    fn written(&mut self) -> &mut Written;

    /// The line that runs; none at the end.
    fn at(&self) -> Option<BlockId>;

    /// The lines that run, from that of the main program to the innermost of what is called.
    fn running(&self) -> Vec<BlockId>;

    /// The bytes of a line in its file.
    fn span_of(&self, at: BlockId) -> Range<usize>;

    /// Runs a line, and goes to the next one.
    ///
    /// # Errors
    /// Why it is refused.
    fn step(&mut self, at: BlockId) -> Result<(), ProgramError>;

    /// Effect of a refused line on the lines after it.
    fn behind(&self, at: BlockId) -> Behind;

    /// Goes behind a line that is refused; where it has written nothing, it is written as it stands.
    fn pass(&mut self, at: BlockId, has_written: bool);

    /// Notes a fault; whether the run goes on.
    fn refuse(&mut self, fault: ProgramError, behind: Behind) -> bool {
        let file = (self.files().iter()).position(|file| file.name() == fault.file);
        self.written().faults.add(file.unwrap_or(0), fault, behind)
    }

    /// Runs it to its end, by so many lines at most: behind a line that is refused, too, unless what runs, or a value, depends on it.
    fn run(&mut self, most_steps: u64) {
        while let Some(at) = self.at() {
            let written = self.written();
            let lines = written.origins.len();
            written.steps += 1;
            written.silent += 1;
            let silent = written.silent > MOST_SILENT;
            if written.steps > most_steps || silent || written.is_full() {
                written.is_endless = true;
                let fault = self.endless(at);
                self.refuse(fault, Behind::Nothing);
                return;
            }
            if let Err(fault) = self.step(at) {
                let behind = self.behind(at);
                if !self.refuse(fault, behind) {
                    return;
                }
                let has_written = self.written().origins.len() > lines;
                self.pass(at, has_written);
            }
        }
    }

    /// Error of a run that does not end: at the line that jumps back to the start of the outermost running loop, if there is one.
    fn endless(&mut self, at: BlockId) -> ProgramError {
        let mut running = self.running().into_iter();
        let last = running.find_map(|place| self.written().end_of_loop(place));
        let (place, reason, remedy) = match last {
            Some(last) => (
                last,
                format!("the loop that goes back here does not end: {BOUNDS}"),
                "check its condition, or divide the program",
            ),
            None => (
                at,
                format!("the program does not end: {BOUNDS}"),
                "repeat fewer times, or divide the program",
            ),
        };
        let span = self.span_of(place);
        ProgramError::at(&self.files()[place.file], span, reason, remedy)
    }
}

/// Suffix to the remedy of the last executed line.
const NOT_RUN: &str = " (the lines behind this one were not run: what they do depends on it)";

/// Limit of the faults of one run: a loop of refused lines must end.
const MOST_FAULTS: usize = 100_000;

/// Error of a program that is not expanded.
pub struct RefusedRun {
    pub faults: Vec<ProgramError>,
    /// Output written nevertheless, with refused lines unchanged.
    pub flat: Option<Box<FlatText>>,
}

impl From<Vec<ProgramError>> for RefusedRun {
    fn from(faults: Vec<ProgramError>) -> Self {
        Self { faults, flat: None }
    }
}

/// Effect of a refused line on the rest of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Behind {
    /// The rest does not depend on the line.
    Same,
    /// The rest depends on it.
    Depends,
    /// The rest is not run.
    Nothing,
}

/// Faults of a run by the file and the place there, each line once.
#[derive(Default)]
pub(crate) struct FaultsOfRun {
    found: BTreeMap<(usize, usize), ProgramError>,
    count: usize,
}

impl FaultsOfRun {
    /// Adds one, of a file by its index; whether the run goes on.
    pub(crate) fn add(&mut self, file: usize, fault: ProgramError, behind: Behind) -> bool {
        let known = self.found.entry((file, fault.line)).or_insert(fault);
        if behind == Behind::Depends {
            known.remedy.push_str(NOT_RUN);
        }
        self.count += 1;
        behind == Behind::Same && self.count < MOST_FAULTS
    }

    /// Faults in the order of files and lines.
    pub(crate) fn into_faults(self) -> Vec<ProgramError> {
        self.found.into_values().collect()
    }
}

/// A flat program with changes, which add so many lines before or behind lines of it, counted from 1.
///
/// # Errors
/// Changes that overlap; what to do.
pub(crate) fn edited(
    flat: FlatText,
    edits: Edits,
    added: &BTreeMap<usize, usize>,
    files: &[SourceFile],
    remedy: &str,
) -> Result<FlatText, Vec<ProgramError>> {
    let Some(bytes) = edits.applied_to(flat.file.bytes()) else {
        let overlap = "its words overlap";
        return Err(vec![ProgramError::of_flat(
            &flat, files, 0, overlap, remedy,
        )]);
    };
    let lines = flat.origins.iter().enumerate();
    let origins = lines.flat_map(|(index, origin)| {
        let added = added.get(&(index + 1)).map_or(0, |added| *added);
        std::iter::repeat_n(*origin, 1 + added)
    });
    Ok(FlatText {
        file: SourceFile::new(flat.file.name(), bytes),
        origins: origins.collect(),
        changed: true,
        findings: flat.findings,
    })
}

/// A flat program with its corners written out by `written_out`; refused with all that was refused before.
pub(crate) fn with_corners(
    flat: FlatText,
    mut faults: Vec<ProgramError>,
    written_out: impl FnOnce(FlatText) -> Result<FlatText, Vec<ProgramError>>,
) -> Result<FlatText, RefusedRun> {
    let kept = flat.clone();
    let flat = match written_out(flat) {
        Ok(flat) if faults.is_empty() => return Ok(flat),
        Ok(flat) => flat,
        Err(of_corners) => {
            faults.extend(of_corners);
            kept
        }
    };
    Err(RefusedRun {
        faults,
        flat: Some(Box::new(flat)),
    })
}

impl RefusedRun {
    /// With what `read` refuses of the flat program, in the order of the files that are given and their lines. A line that the run
    /// refuses is told once.
    pub(crate) fn with_reading(
        self,
        files: &[SourceFile],
        read: impl FnOnce(SourceFile) -> Vec<ProgramError>,
    ) -> Vec<ProgramError> {
        let mut faults = self.faults;
        if let Some(flat) = self.flat {
            let index = |fault: &ProgramError| files.iter().position(|f| f.name() == fault.file);
            let told: BTreeSet<(Option<usize>, usize)> = faults
                .iter()
                .map(|fault| (index(fault), fault.line))
                .collect();
            let mut known = BTreeSet::new();
            for fault in read(flat.file.clone()) {
                let fault = fault.at_source(&flat.origins, files);
                let place = (index(&fault), fault.line);
                // Lines that run again are told once.
                if !told.contains(&place) && known.insert((place, fault.reason.clone())) {
                    faults.push(fault);
                }
            }
        }
        faults.sort_by_key(|fault| {
            let file = files.iter().position(|file| file.name() == fault.file);
            (file, fault.line, fault.span.start)
        });
        faults
    }
}

//! The reader of Heidenhain conversational programs.

use std::collections::BTreeSet;

use crate::apt::file_reader::Frames;
use crate::error::{ProgramError, note};
use crate::heidenhain::blocks::{Block, OtherEnd, blocks_of, other_end};
use crate::heidenhain::flow::{NAME_IT, Step, label_twice, labels_of, order, step_of};
use crate::heidenhain::reading::walker::{EXPAND, Found, Reader, has_corners};
use crate::heidenhain::state::State;
use crate::model::Language;
use crate::model::parsed::Parsed;
use crate::model::program::{RobotProgram, StatedAxes};
use crate::options::ReadOptions;
use crate::standing::Standing;
use crate::text::source::{BEHIND_END, Finding, SourceFile};
use crate::turned_axis::{CountShown, shown_by_both};

const MOST_BYTES: usize = 1 << 28;

/// Reads Heidenhain conversational programs (`.h`), each file for itself.
///
/// Places are those that the blocks state, in mm in the axes of the control's preset: datum shifts, mirror images, rotations and
/// scalings are followed, and so are angles of the rotary axes that [`ReadOptions::rotary_axes`] names. What is not stated stays as it was. Circles are [`crate::MotionKind::Arc`]. The work object is `PRESET`, the tool
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
    parse_heidenhain(files, options).without_faults()
}

/// Reads a program; the motions that could be read are returned beside the errors.
pub(crate) fn parse_heidenhain(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let found = interpret(&files, options);
    let (motions, findings) = (found.motions, found.findings);
    let parsed = Parsed::of(Language::Heidenhain, files, motions, findings, found.faults);
    let mut parsed = parsed.with_calls(found.outside_calls, &options.moving_calls);
    parsed.program.unjudged_feed_on = found.unjudged_feed_on;
    parsed.program.slash_blocks = options.slash_blocks;
    parsed.program.rotary = StatedAxes {
        letters: options.rotary_axes.clone(),
        motions: found.axes,
        ..StatedAxes::default()
    };
    parsed
}

/// Reads files, with all that is refused beside what is understood.
///
/// How rotary axes count may show behind the words to which it matters: those programs are read twice.
pub(crate) fn interpret(files: &[SourceFile], options: &ReadOptions) -> Found {
    let first = interpret_once(files, options, &[]);
    match first.shown.iter().any(|shown| shown.asks_again()) {
        true => {
            let shown = first.shown;
            Found {
                shown: shown.clone(),
                ..interpret_once(files, options, &shown)
            }
        }
        false => first,
    }
}

/// Reads once with the known ways of counting of the rotary axes.
fn interpret_once(files: &[SourceFile], options: &ReadOptions, shown: &[CountShown]) -> Found {
    let mut found = Found::default();
    let frames = options.frames.iter();
    let frames: Frames = frames
        .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
        .collect();
    for (index, file) in files.iter().enumerate() {
        if let Some(fault) = ProgramError::too_large(file, MOST_BYTES) {
            found.faults.push(fault);
            continue;
        }
        let mut reader = Reader {
            found: &mut found,
            options,
            frames: &frames,
            files,
            file,
            index,
            unit_mm: 1.0,
            state: State::new(Standing::of_letters(&options.rotary_axes, shown)),
            pole_from: None,
            poles: [0; 2],
            has_corners: has_corners(file.bytes()),
            line: None,
            corner: None,
            remarked: BTreeSet::new(),
        };
        reader.file();
        let shown = reader.state.standing.shown_counts();
        found.shown = shown_by_both(&found.shown, &shown);
    }
    found
}

impl Reader<'_> {
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
        for [first, index] in twice {
            let line = self.file.line_of(blocks[first].text.start);
            let text = blocks[index].text.clone();
            self.fault(&text, label_twice(line), NAME_IT);
        }
        if let Some(OtherEnd {
            fault,
            has_other_unit,
        }) = other_end(self.file, &blocks, first)
        {
            match has_other_unit {
                false => self.found.findings.push(Finding {
                    file: 0,
                    line: fault.line,
                    message: format!("{}: it is taken for one program", fault.reason),
                }),
                true => note(&mut self.found.faults, || fault),
            }
        }
        let slash = self.options.slash_blocks;
        let calls = |block: &Block| {
            let is_call = bytes.get(block.text.start).map(u8::to_ascii_uppercase) == Some(b'C');
            is_call && matches!(step_of(bytes, block, slash), Step::Call(_))
        };
        let ordered = match labels.is_empty() || !blocks.iter().any(calls) {
            true => None,
            false => Some(order(first, blocks.len(), &labels, |at| {
                step_of(bytes, &blocks[at], slash)
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
        self.settle_corner(None);
        let ends = |block: &Block| {
            let is_end = bytes.get(block.text.start).map(u8::to_ascii_uppercase) == Some(b'E');
            is_end
                && block
                    .words(bytes)
                    .first()
                    .is_some_and(|word| word.is("END"))
        };
        if !blocks[first..].iter().rev().any(ends) {
            let span = blocks.last().map_or(0..0, |block| block.text.clone());
            self.finding(
                &span,
                "no block END PGM ends the program: give the whole program, if this is a part of it".to_owned(),
            );
        }
        let left = blocks.iter().skip(last + 1);
        let left = left.filter(|block| {
            let words = block.words(bytes);
            words.first().is_some_and(|word| !word.is("END"))
        });
        if let Some(block) = left.clone().next() {
            let span = block.text.clone();
            self.finding(&span, BEHIND_END.to_owned());
        }
    }
}

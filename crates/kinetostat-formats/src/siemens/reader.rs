//! The reader of SINUMERIK programs: the walk over the blocks of a program that runs straight on.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Isometry3;

use crate::error::ProgramError;
use crate::model::Language;
use crate::model::parsed::{Parsed, stays_as_written};
use crate::model::program::{OutsideCall, RobotProgram};
use crate::model::stated_value::{SLASHED, SlashBlocks, told_of_values};
use crate::options::ReadOptions;
use crate::siemens::block::{Block, Item, What};
use crate::siemens::called::{called_by, key_of_call, program_name, whole_file};
use crate::siemens::declarations::define;
use crate::siemens::state::State;
use crate::siemens::steps_behind_frames::finding_of_steps;
use crate::siemens::table::{KEPT, row};
use crate::siemens::tokens::Token;
use crate::siemens::turned_axes::finding_of;
use crate::siemens::values::Variables;
use crate::siemens::walker::{Corners, Reader, Scan};
use crate::standing::Standing;
use crate::table::Treatment;
use crate::text::source::{BEHIND_END, SourceFile};
use crate::turned_axis::{CountShown, shown_by_both};

/// Reads programs of the SINUMERIK 840D and its kin (`.mpf`, `.spf`), each file for itself.
///
/// Poses are in the axes of the part: those of the settable frame (G54, G505, ...), which is the work object; programmable frames
/// (TRANS, ROT) are applied. Where these frames are, and the tools (`T1`), the options say. Where a direction of the tool is
/// stated (A3, B3, C3, or A2, B2, C2) the orientation turns Z into it by the shortest way. R parameters and variables of a
/// program that runs straight on are followed, and so are angles of the rotary axes that [`ReadOptions::rotary_axes`] names; jumps, loops, calls and cycles are refused: [`crate::expand_siemens`] runs them.
/// Rapids to places of the machine (SUPA, G53) and from places that are not known stay as they are.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, read_siemens};
///
/// let text = "N10 G17 G90 G94 G71\nN20 T1 D1 M6\nN30 G54\nN40 TRANS X100\nN50 G0 X0 Y0 Z5\nN60 G1 Z-2 F600\n\
///     N70 G3 X10 Y10 CR=10\nM30\n";
/// let program = read_siemens(vec![SourceFile::new("part.mpf", text)], &ReadOptions::default()).unwrap();
/// let last = &program.motions[2];
/// assert_eq!(last.target.pose().unwrap().position_mm.as_slice(), [110.0, 10.0, -2.0]);
/// assert_eq!((last.work_object.name.as_str(), last.speed.mm_per_s), ("G54", Some(10.0)));
/// let MotionKind::Arc { angle_rad, .. } = last.kind else { panic!() };
/// assert!((angle_rad.to_degrees() - 90.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_siemens(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_siemens(files, options).without_faults()
}

/// Reads a program; the motions that could be read are returned beside the errors.
pub(crate) fn parse_siemens(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let Scan {
        motions,
        faults,
        mut findings,
        outside_calls,
        unjudged_feed_on,
        rotary,
        ..
    } = scan(&files, options);
    findings.extend(
        (files.first().into_iter()).flat_map(|file| told_of_values(&options.values, file.bytes())),
    );
    let parsed = Parsed::of(Language::Siemens, files, motions, findings, faults);
    let mut parsed = parsed.with_calls(outside_calls, &options.moving_calls);
    parsed.program.slash_blocks = options.slash_blocks;
    parsed.program.rotary = rotary;
    parsed.program.unjudged_feed_on = unjudged_feed_on;
    parsed
}

/// Reads all files, each for itself.
pub(crate) fn scan(files: &[SourceFile], options: &ReadOptions) -> Scan {
    scan_with(files, options, Corners::Refused)
}

/// Scans a program with corners that are refused or followed.
///
/// Words may show the way of counting of a rotary axis after the words that depend on it: such programs are read twice.
pub(crate) fn scan_with(files: &[SourceFile], options: &ReadOptions, corners: Corners) -> Scan {
    let first = scan_once(files, options, corners, &[]);
    match first.shown.iter().any(|shown| shown.asks_again()) {
        true => {
            let shown = first.shown;
            Scan {
                shown: shown.clone(),
                ..scan_once(files, options, corners, &shown)
            }
        }
        false => first,
    }
}

/// Scans once with the known ways of counting of the rotary axes.
fn scan_once(
    files: &[SourceFile],
    options: &ReadOptions,
    corners: Corners,
    shown: &[CountShown],
) -> Scan {
    let mut out = Scan::default();
    out.rotary.letters.clone_from(&options.rotary_axes);
    let frames = options.frames.iter();
    let frames: BTreeMap<String, Isometry3<f64>> = frames
        .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
        .collect();
    for (index, file) in files.iter().enumerate() {
        if !whole_file(file, &mut out.faults) {
            continue;
        }
        let mut reader = Reader {
            changes_by_m6: has_change(file.bytes()),
            out: &mut out,
            options,
            frames: &frames,
            files,
            file,
            index,
            state: State::new(Standing::of_letters(&options.rotary_axes, shown)),
            variables: Variables::of(options),
            corners,
        };
        for line in 1..=file.line_count() {
            if reader.state.ended {
                reader.behind_end(line);
                break;
            }
            let range = file.range_of(line);
            match Block::of(file.bytes(), range) {
                Ok((block, tokens)) => reader.block(&block, &tokens),
                Err(broken) => reader.broken(broken),
            }
        }
        let shown = reader.state.standing.shown_counts();
        out.shown = shown_by_both(&out.shown, &shown);
        let plain = std::mem::take(&mut out.plain_turns);
        out.findings.extend(finding_of(index, &plain));
        let steps = std::mem::take(&mut out.steps_behind_frames);
        out.findings.extend(finding_of_steps(index, &steps));
    }
    out
}

/// True if the program has an M6 outside of remarks and texts: without it, T changes the tool.
pub(crate) fn has_change(bytes: &[u8]) -> bool {
    let is_change = |part: &[u8], at: usize| {
        let digits = part[at + 1..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit());
        let begins = !part[..at].last().is_some_and(u8::is_ascii_alphabetic);
        let number: Vec<u8> = digits.copied().collect();
        begins && part[at].eq_ignore_ascii_case(&b'M') && matches!(&number[..], b"6" | b"06")
    };
    bytes.split(|byte| *byte == b'\n').any(|line| {
        let code = line.split(|byte| *byte == b';').next().unwrap_or_default();
        let mut parts = code.split(|byte| *byte == b'"').step_by(2);
        parts.any(|part| (0..part.len()).any(|at| is_change(part, at)))
    })
}

impl Reader<'_> {
    /// The program has ended before a line: names the first block from there on.
    fn behind_end(&mut self, line: usize) {
        let file = self.file;
        let mut rest = (line..=file.line_count()).map(|line| file.range_of(line));
        let has_words = |range: &Range<usize>| {
            let is_head = file.part(range).trim_ascii_start().starts_with(b"%");
            let block = Block::of(file.bytes(), range.clone());
            !is_head && block.map_or(true, |(block, _)| !block.items.is_empty())
        };
        if let Some(range) = rest.find(has_words) {
            self.finding(&range, BEHIND_END.to_owned());
        }
    }

    fn block(&mut self, block: &Block, tokens: &[Token]) {
        let Some(first) = block.items.first() else {
            return;
        };
        if block.skip {
            match self.options.slash_blocks {
                SlashBlocks::Refused if self.is_harmless(block) => {}
                SlashBlocks::Refused => {
                    return self.fault(&block.span.clone(), SLASHED.0, SLASHED.1);
                }
                SlashBlocks::Run => self.slashed(block, "runs"),
                SlashBlocks::Skipped => {
                    self.slashed(block, "does not run");
                    return;
                }
            }
        }
        let statement = block.items.iter().find(|item| item.what == What::Statement);
        if let Some(item) = statement {
            let (item, alone) = (item.clone(), item.span == first.span);
            return self.statement(&item.span, &item.name, alone, tokens);
        }
        if let [cycle] = block.items.as_slice()
            && matches!(cycle.what, What::Name | What::Call(_))
            && KEPT.contains(&self.name(&cycle.name).as_str())
        {
            return self.kept_cycle(cycle);
        }
        if let Some(called) = called_by(self.file, &block.items) {
            return self.outside_call(called);
        }
        let stated = self.state.stated;
        let faults = self.out.faults.len();
        let words = self.words(block);
        if self.out.faults.len() > faults {
            // The effect of the block is unknown: its positions are taken as stated.
            self.state.lost = true;
            self.turn_axes(&words);
            for (axis, word) in words.axes.iter().enumerate() {
                if let Some(word) = word.as_ref().filter(|word| !word.step) {
                    self.state.place[axis] = Some(word.mm);
                }
            }
            return;
        }
        self.act(block, words, stated);
    }

    /// A cycle whose way is the control's own: it begins over the hole and ends above it.
    fn kept_cycle(&mut self, cycle: &Item) {
        let name = self.name(&cycle.name);
        let normal = self.state.normal;
        let is_over = (0..3).all(|axis| axis == normal || self.state.place[axis].is_some());
        if !is_over || self.state.oriented || self.state.steps {
            let reason = match (is_over, self.state.oriented) {
                (false, _) => "where the hole is that it drills is not known",
                (true, true) => "along which axis it drills under TRAORI is not followed",
                (true, false) => "under G91 the block behind it counts from where it ends",
            };
            return self.fault(
                &cycle.span,
                reason,
                "write G90 and the place over the hole before it",
            );
        }
        self.state.place[normal] = None;
        let line = self.file.line_of(cycle.span.start);
        self.out.unjudged_feed_on.get_or_insert(line);
        self.finding(&cycle.span, stays_as_written(&name));
    }

    /// A call of a subprogram, which is followed only by a run.
    fn outside_call(&mut self, called: &Item) {
        let name = self.name(&called.name);
        let key = key_of_call(name.as_bytes());
        let is_there = |file: &SourceFile| program_name(file.name()) == key;
        if self.files.iter().any(is_there) {
            return self.by_table("CALL", called);
        }
        self.out.outside_calls.push(OutsideCall {
            file: self.index,
            line: self.file.line_of(called.span.start),
            name: Some(name),
        });
    }

    /// Names the first block behind a slash, and what becomes of all of them.
    fn slashed(&mut self, block: &Block, does: &str) {
        let known = std::mem::replace(&mut self.state.slash_remarked, true);
        if !known {
            self.finding(
                &block.span,
                format!("the block behind a slash {does}, and so all of them, of whatever level (/0 to /9)"),
            );
        }
    }

    /// True if a block changes neither positions nor modal state.
    fn is_harmless(&self, block: &Block) -> bool {
        block.items.iter().all(|item| {
            let name = self.name(&item.name);
            let value = match &item.what {
                What::Value { value, .. } => self.variables.number(self.file.bytes(), value).ok(),
                _ => None,
            };
            match name.as_str() {
                "M" => value.is_some_and(|m| ![2.0, 6.0, 17.0, 30.0].contains(&m)),
                "MSG" | "STOPRE" | "S" | "H" => true,
                _ => false,
            }
        })
    }

    /// A statement that is read as a whole.
    fn statement(
        &mut self,
        span: &Range<usize>,
        name: &Range<usize>,
        alone: bool,
        tokens: &[Token],
    ) {
        let word = self.name(name);
        match word.as_str() {
            _ if !alone => self.fault(
                span,
                "it does not stand at the beginning of its block",
                "write it as a block of its own",
            ),
            "DEF" => {
                let from = tokens
                    .iter()
                    .position(|token| token.span == *name)
                    .unwrap_or(0);
                if let Err(broken) = define(self.file.bytes(), &tokens[from..], &mut self.variables)
                {
                    self.broken(broken);
                }
            }
            "PROC" => {
                let parameters = tokens.iter().any(|token| token.is(b'('))
                    && !tokens
                        .windows(2)
                        .any(|pair| pair[0].is(b'(') && pair[1].is(b')'));
                if parameters {
                    self.fault(
                        span,
                        "the values of its parameters come from the program that calls it",
                        "give that program with it, and let it be written flat: --expand",
                    );
                }
            }
            _ => match row(&word).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => self.fault(span, reason, remedy),
                Some(_) => {}
                None => self.fault(
                    span,
                    "what it sets, is not followed",
                    "write it as single assignments",
                ),
            },
        }
    }
}

//! The walk over the blocks of a program that runs straight on.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3};

use crate::error::{ProgramError, note};
use crate::model::motion::Motion;
use crate::model::program::Finding;
use crate::options::ReadOptions;
use crate::siemens::block::{Block, What};
use crate::siemens::declarations::define;
use crate::siemens::reader::whole_file;
use crate::siemens::state::{Coordinate, State};
use crate::siemens::table::row;
use crate::siemens::tokens::{Broken, Token};
use crate::siemens::values::Variables;
use crate::table::Treatment;
use crate::text::source::SourceFile;

/// What a program's files hold.
#[derive(Debug, Default)]
pub(crate) struct Scan {
    pub motions: Vec<Motion>,
    /// Of each motion.
    pub written: Vec<Written>,
    pub findings: Vec<Finding>,
    pub faults: Vec<ProgramError>,
}

/// How a motion is written, for the writer.
#[derive(Debug, Clone)]
pub(crate) struct Written {
    /// The line without its ending.
    pub line: Range<usize>,
    /// Where its words begin.
    pub words_at: usize,
    /// X, Y, Z of its end; of the point on a CIP.
    pub axes: [Option<Coordinate>; 3],
    pub via: [Option<Coordinate>; 3],
    /// Words that an end elsewhere makes void.
    pub arc_words: Vec<Range<usize>>,
    pub direction_words: Vec<Range<usize>>,
    /// What acts at its end.
    pub at_end: Vec<Range<usize>>,
    pub code: super::state::Code,
    pub code_word: Option<Range<usize>>,
    /// A code was stated in a block between the motion before and this one.
    pub code_stated: bool,
    /// The feed in force, if it is known, as written.
    pub feed: Option<super::state::Feed>,
    pub feed_word: Option<(Range<usize>, Option<Range<usize>>)>,
    pub feed_stated: bool,
    /// From the axes of its numbers to those of the part.
    pub frame: Isometry3<f64>,
    pub unit_mm: f64,
    /// In the frame's axes, mm.
    pub start: [Option<f64>; 3],
    pub end: [Option<f64>; 3],
    /// It goes to a place of the machine.
    pub machine: bool,
    /// G91 is in force.
    pub steps: bool,
}

/// Reads all files, each for itself.
pub(crate) fn scan(files: &[SourceFile], options: &ReadOptions) -> Scan {
    let mut out = Scan::default();
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
            file,
            index,
            state: State::new(),
            variables: Variables::default(),
        };
        for line in 1..=file.line_count() {
            if reader.state.ended {
                break;
            }
            let range = file.range_of(line);
            match Block::of(file.bytes(), range) {
                Ok((block, tokens)) => reader.block(&block, &tokens),
                Err(broken) => reader.broken(broken),
            }
        }
    }
    out
}

/// Whether M6 stands anywhere: tools change at T where it does not.
pub(crate) fn has_change(bytes: &[u8]) -> bool {
    bytes.windows(3).enumerate().any(|(at, part)| {
        let is_m6 = matches!(part, [b'M' | b'm', b'6', _]) && !part[2].is_ascii_digit();
        let is_m06 = matches!(part, [b'M' | b'm', b'0', b'6']);
        let ends = !bytes.get(at + 3).is_some_and(u8::is_ascii_digit);
        is_m6 || is_m06 && ends
    }) || bytes.ends_with(b"M6")
}

pub(crate) struct Reader<'r> {
    pub out: &'r mut Scan,
    pub options: &'r ReadOptions,
    pub frames: &'r BTreeMap<String, Isometry3<f64>>,
    pub file: &'r SourceFile,
    pub index: usize,
    pub state: State,
    pub variables: Variables,
    pub changes_by_m6: bool,
}

impl Reader<'_> {
    pub(crate) fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        note(&mut self.out.faults, || {
            ProgramError::at(self.file, span.clone(), reason, remedy)
        });
        self.state.lost = true;
    }

    pub(crate) fn broken(&mut self, broken: Broken) {
        self.fault(&broken.span, broken.reason, broken.remedy);
    }

    pub(crate) fn finding(&mut self, span: &Range<usize>, message: String) {
        self.out.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }

    /// The text of a name in capitals.
    pub(crate) fn name(&self, span: &Range<usize>) -> String {
        String::from_utf8_lossy(self.file.part(span)).to_ascii_uppercase()
    }

    fn block(&mut self, block: &Block, tokens: &[Token]) {
        let Some(first) = block.items.first() else {
            return;
        };
        if block.skip && !self.is_harmless(block) {
            return self.fault(
                &block.span.clone(),
                "whether the block runs, depends on a switch at the machine (/)",
                "take the slash out, or the block",
            );
        }
        let statement = block.items.iter().find(|item| item.what == What::Statement);
        if let Some(item) = statement {
            let (item, alone) = (item.clone(), item.span == first.span);
            return self.statement(&item.span, &item.name, alone, tokens);
        }
        let (code, feed) = (self.state.code_stated, self.state.feed_stated);
        let faults = self.out.faults.len();
        let words = self.words(block);
        if self.out.faults.len() > faults {
            // What the block does is not known: its places are taken as stated.
            self.state.lost = true;
            for (axis, word) in words.axes.iter().enumerate() {
                if let Some(word) = word.as_ref().filter(|word| !word.step) {
                    self.state.place[axis] = Some(word.mm);
                }
            }
            return;
        }
        self.act(block, words, (code, feed));
    }

    /// Whether a block changes neither places nor what follows.
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

    /// The first stated number of an expression, or a fault.
    pub(crate) fn number(
        &mut self,
        span: &Range<usize>,
        value: &super::expression::Expression,
    ) -> Option<f64> {
        match self.variables.number(self.file.bytes(), value) {
            Ok(value) if value.abs() < FARTHEST => Some(value),
            Ok(_) => {
                self.fault(span, "its value is larger than 10 km", "mend it");
                None
            }
            Err(why) => {
                self.fault(
                    span,
                    why,
                    "give it a value in the program, or write the number",
                );
                None
            }
        }
    }

    /// The direction into which angles turn Z.
    pub(crate) fn turned(&self, angles: [f64; 3]) -> Option<Vector3<f64>> {
        use nalgebra::UnitQuaternion as Q;
        let [a, b, c] = angles.map(f64::to_radians);
        let about = |axis: &nalgebra::Unit<Vector3<f64>>, angle| Q::from_axis_angle(axis, angle);
        let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
        let turn = match self.state.angles? {
            super::state::Angles::Euler => about(&z, a) * about(&x, b) * about(&z, c),
            super::state::Angles::Rpy => about(&z, c) * about(&y, b) * about(&x, a),
        };
        Some(turn * Vector3::z())
    }
}

/// Larger than any number of a program, mm or degrees.
const FARTHEST: f64 = 1e7;

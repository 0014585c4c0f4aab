//! Programs with subprograms, variables and cycles, run once and written flat.
//!
//! Takes the bytes of a program, its library of subprograms and what a machine knows (reference points, diameters of tools);
//! gives a program of plain blocks, each with the line that it came from, and its path. Codes that can move the tool and are
//! not followed are refused by line. The words are those of LinuxCNC and, where they differ in form, of Fanuc.

mod coordinates;
pub(crate) mod expand;
mod expression;
mod flat;
mod radius;
pub(crate) mod run;
mod source;
mod translate;

use std::collections::BTreeMap;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Path, Warning};
use crate::reading::options::ReadOptions;
use crate::text::program::Program;

/// Reason and remedy.
pub(crate) type Wrong = (String, &'static str);

/// Refuses with a reason and a remedy.
pub(crate) fn wrong<T, E: From<Wrong>>(
    reason: impl Into<String>,
    remedy: &'static str,
) -> Result<T, E> {
    Err((reason.into(), remedy).into())
}

/// Reason for which a block is refused.
pub(crate) enum Trouble {
    /// Reading a block found it.
    Block(ProgramError),
    /// The compensation found it: of the line that runs.
    Line(Wrong),
}

impl From<ProgramError> for Trouble {
    fn from(error: ProgramError) -> Self {
        Self::Block(error)
    }
}

impl From<Wrong> for Trouble {
    fn from(wrong: Wrong) -> Self {
        Self::Line(wrong)
    }
}

/// Default limit of the blocks of a flat program.
const MOST_BLOCKS: usize = 5_000_000;

/// Origin comments in flat blocks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum OriginComments {
    /// Nothing is added; [`crate::Expanded::origins`] knows it.
    #[default]
    Left,
    /// At the end of each block, as in `(line 12)` or `(drill, line 3)`.
    Written,
}

/// The controller whose meaning a word has where controllers disagree.
///
/// ```
/// use kinetostat_program::{Dialect, ExpandOptions, NoSubprograms, expand};
///
/// let text = "G21 G90 F100\nG0 X0 Y0 Z10\nG81 X5 Y5 R2 Z-3\nM30\n";
/// let mut options = ExpandOptions::default();
/// // G98 or G99 is not stated: where the tool goes behind the hole depends on the controller.
/// assert!(expand(text, &options, &NoSubprograms).is_err());
/// options.dialect = Dialect::Fanuc;
/// let flat = expand(text, &options, &NoSubprograms)?;
/// assert!(String::from_utf8_lossy(flat.program.bytes()).ends_with("G1 Z-3\nG0 Z10\nM30\n"));
/// # Ok::<(), kinetostat_program::ProgramError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Dialect {
    /// A word that they read differently is refused, with both readings.
    #[default]
    Undecided,
    /// LinuxCNC 2.9.
    LinuxCnc,
    /// Fanuc's milling controllers, and those that follow them (Haas).
    Fanuc,
}

/// Settings of the expansion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExpandOptions {
    /// Options for reading the flat program.
    pub reading: ReadOptions,
    /// Maximum number of blocks of the flat program: endless loops are refused by their line.
    pub most_blocks: usize,
    /// Origin comments in flat blocks.
    pub origin_comments: OriginComments,
    /// The controller that the program is written for.
    pub dialect: Dialect,
    /// Values of numbered parameters before the program, as a controller keeps them.
    pub parameters: BTreeMap<u32, f64>,
    /// Diameters of tools by their numbers, mm: the radius of G41 and G42. A tool that is not named here is refused there. A
    /// negative diameter puts the tool on the other side.
    pub tool_diameters_mm: BTreeMap<u32, f64>,
}

impl Default for ExpandOptions {
    fn default() -> Self {
        Self {
            reading: ReadOptions::default(),
            most_blocks: MOST_BLOCKS,
            origin_comments: OriginComments::default(),
            dialect: Dialect::default(),
            parameters: BTreeMap::new(),
            tool_diameters_mm: BTreeMap::new(),
        }
    }
}

impl ExpandOptions {
    /// The options with those of the reading that follow from the dialect.
    pub(crate) fn of_dialect(&self) -> Self {
        let mut own = self.clone();
        own.reading.of_fanuc_run |= self.dialect == Dialect::Fanuc;
        own
    }
}

/// Source of a flat block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Origin {
    /// Line of its file, counted from 1.
    pub line: usize,
    /// Index in [`Expanded::files`]: 0 is the program itself.
    pub file: usize,
}

/// A program that was run once and written flat.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Expanded {
    /// Plain blocks.
    pub program: Program,
    /// Path of the flat program.
    pub path: Path,
    /// Source of each line of the flat program.
    pub origins: Vec<Origin>,
    /// Warnings about blocks, by their lines in the flat program, in addition to the warnings of the path.
    pub warnings: Vec<Warning>,
    /// Names of the files that blocks came from; the first is the program and has none.
    pub files: Vec<String>,
}

/// Error of a flat block, mapped to its source line.
pub(crate) fn of_source(error: ProgramError, line: usize, file: &str) -> ProgramError {
    let (reason, remedy) = while_expanding(&error);
    let reason = match file {
        "" => reason,
        name => format!("in the subprogram '{name}': {reason}"),
    };
    ProgramError {
        line,
        reason,
        remedy,
        ..error
    }
}

/// Reason and remedy of an error; the remedy of what is only read with `--expand`, which is under way here, is another one.
fn while_expanding(error: &ProgramError) -> (String, String) {
    let remedy = match error.kind {
        ProgramErrorKind::ControlStructure => {
            "write it in a line of its own, as in IF [#1 GT 0] GOTO 10"
        }
        ProgramErrorKind::Variables => {
            "write a value as a letter and an expression in brackets, as in X[#1 + 2]"
        }
        ProgramErrorKind::Subprogram => {
            "this call is not followed: write M98 and P, an O word with call, or the blocks of the subprogram"
        }
        _ => return (error.reason.clone(), error.remedy.clone()),
    };
    let what = error.reason.split(';').next().unwrap_or_default();
    (what.to_owned(), remedy.to_owned())
}

/// `line 12` of the flat program as the line that it came from.
pub(crate) fn in_source_lines(
    text: &str,
    origins: &[Origin],
    files: &BTreeMap<usize, String>,
) -> String {
    const WORD: &str = "line ";
    let mut made = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(WORD) {
        let (before, behind) = rest.split_at(at + WORD.len());
        made.push_str(before);
        let digits = behind.bytes().take_while(u8::is_ascii_digit).count();
        let (number, behind) = behind.split_at(digits);
        let origin = number.parse::<usize>().ok();
        match origin.and_then(|line| origins.get(line.checked_sub(1)?)) {
            Some(origin) => {
                made.push_str(&origin.line.to_string());
                match files.get(&origin.file).map_or("", String::as_str) {
                    "" => {}
                    file => made.push_str(&format!(" of the subprogram '{file}'")),
                }
            }
            None => made.push_str(number),
        }
        rest = behind;
    }
    made + rest
}

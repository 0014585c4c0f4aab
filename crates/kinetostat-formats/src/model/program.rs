//! A program of any language, and the rotary axis positions that it states.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::model::language::Language;
use crate::model::motion::Motion;
use crate::model::outside_call::{OutsideCall, by_name};
use crate::model::site::Declaration;
use crate::model::stated_value::StatedValue;
use crate::text::source::{Finding, SourceFile};

/// Text of a loop that nothing leaves, among the statements that ran.
pub(crate) const ENDLESS: &str = "A LOOP WITHOUT END";

/// Word before the accelerations with which a motion states that it runs, among the statements that ran.
pub(crate) const ACCELERATION: &str = "ACCELERATION";

/// A statement beside the motions that ran.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RanStatement {
    /// An index of the files.
    pub file: usize,
    pub span: Range<usize>,
    /// How many motions ran before it.
    pub motions: usize,
    /// With values in place of names, or what the run says of itself; none where it is as it is written.
    pub text: Option<Vec<u8>>,
}

/// A program as it was read: its files byte for byte, and what moves in them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RobotProgram {
    /// Language of the program.
    pub language: Language,
    /// Files of the program in the order given.
    pub files: Vec<SourceFile>,
    /// Each motion statement once, in the order in which they first run; those that nothing calls at the end.
    pub motions: Vec<Motion>,
    /// Findings in order of files and lines.
    pub findings: Vec<Finding>,
    pub(crate) declarations: Vec<Declaration>,
    /// Values that the caller stated for what only the controller knows.
    pub(crate) values: BTreeMap<String, StatedValue>,
    /// Calls that no file defines.
    pub(crate) outside_calls: Vec<OutsideCall>,
    /// First line of a feed whose way is the controller's own.
    pub(crate) unjudged_feed_on: Option<usize>,
    /// Statements beside the motions in the order in which they ran, of languages that are run.
    pub(crate) ran: Vec<RanStatement>,
    /// What it says of the rotary axes of a machine.
    pub(crate) rotary: StatedAxes,
    /// Setting with which blocks with a slash were read.
    pub(crate) slash_blocks: crate::model::stated_value::SlashBlocks,
}

impl RobotProgram {
    /// True if angles of rotary axes define the tool orientation anywhere ([`crate::ReadOptions::rotary_axes`]).
    ///
    /// ```
    /// use kinetostat_formats::{ReadOptions, SourceFile, read_heidenhain};
    ///
    /// let text = "BEGIN PGM A MM\nL X+0 Y+0 Z+5 A+0 FMAX\nM128\nL X+9 A+20 F100\nEND PGM A MM\n";
    /// let mut options = ReadOptions::default();
    /// options.rotary_axes = vec!['A'];
    /// let program = read_heidenhain(vec![SourceFile::new("a.h", text)], &options).unwrap();
    /// assert!(program.states_axis_angles());
    /// ```
    #[must_use]
    pub fn states_axis_angles(&self) -> bool {
        self.rotary.has_angles()
    }

    /// Names that it calls and none of its files holds, each with its first line: they are taken not to move the tool and not to change
    /// what is in force ([`crate::ReadOptions::moving_calls`]).
    ///
    /// ```
    /// use kinetostat_formats::{ReadOptions, SourceFile, read_ls};
    ///
    /// let text = "/PROG A\n/MN\n   1:  CALL SPINDLE_ON ;\n/POS\n/END\n";
    /// let program = read_ls(vec![SourceFile::new("a.ls", text)], &ReadOptions::default()).unwrap();
    /// assert_eq!(program.calls_taken_to_stay(), [("SPINDLE_ON", 3)]);
    /// ```
    #[must_use]
    pub fn calls_taken_to_stay(&self) -> Vec<(&str, usize)> {
        let named = by_name(&self.outside_calls).into_iter();
        named.filter_map(|of| Some((of.name?, of.line()))).collect()
    }

    /// Lines of a file, counted from 1, that hold a part of a motion or of a declared target.
    pub(crate) fn lines_of_targets(&self, file: usize) -> BTreeSet<usize> {
        let motions = self.motions.iter().filter(|motion| motion.file == file);
        let declared = self.declarations.iter().filter(|d| d.text.file == file);
        // The pose on a circle may stand in a statement of its own.
        let spans = motions
            .flat_map(|motion| {
                [
                    Some(&motion.span),
                    motion.site.via.as_ref().map(|(span, _)| span),
                ]
            })
            .flatten()
            .chain(declared.map(|declaration| &declaration.statement));
        let source = &self.files[file];
        spans
            .flat_map(|span| {
                let last = span.end.saturating_sub(1).max(span.start);
                source.line_of(span.start)..=source.line_of(last)
            })
            .collect()
    }
}

/// Statement of the rotary axis positions at a motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum AxesStated {
    /// Angles by their words up to this block: positions at the start and the end, deg, in the order of the letters. Coordinates are those of the
    /// tool tip in the part.
    Angles { start: Vec<f64>, end: Vec<f64> },
    /// The angles are unknown, or positions are not those of the tool tip.
    Open,
}

/// Rotary axis data of a program.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct StatedAxes {
    /// Letters of the axes whose words are followed.
    pub letters: Vec<char>,
    /// Motions of programs whose words of rotary axes are followed; a motion that is not here states a direction of the tool, or
    /// takes over the one of before.
    pub motions: BTreeMap<usize, AxesStated>,
    /// The motions in which the axes turn evenly, where others lead the tool's axis on a great circle.
    pub even: BTreeSet<usize>,
}

impl StatedAxes {
    /// True if angles define the tool orientation anywhere.
    pub(crate) fn has_angles(&self) -> bool {
        let mut all = self.motions.iter();
        all.any(|(_, stated)| matches!(stated, AxesStated::Angles { .. }))
    }
}

//! A program of any language, the rotary axis positions that it states, and its calls of what is in none of the files.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::error::ProgramError;
use crate::model::Language;
use crate::model::motion::Motion;
use crate::model::site::Declaration;
use crate::model::stated_value::StatedValue;
use crate::text::number::in_words;
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

    /// Finding on the first call of what is in none of its files, or of what only the run computes: that may move the tool.
    #[must_use]
    pub fn first_outside_call(&self) -> Option<Finding> {
        let calls = outside_calls(self.language, &self.outside_calls).into_iter();
        calls.min_by_key(|finding| (finding.file, finding.line))
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

/// A call of what is in none of the files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OutsideCall {
    /// An index of the files.
    pub file: usize,
    pub line: usize,
    /// Displayed name; `None` if the run computes it.
    pub name: Option<String>,
}

/// Calls of one name in one file, with their lines in order.
pub(crate) struct CallsOfOne<'c> {
    pub file: usize,
    pub name: Option<&'c str>,
    pub lines: Vec<usize>,
}

/// Findings on calls that no file defines: each name once, with its lines and the assumption.
pub(crate) fn outside_calls(language: Language, calls: &[OutsideCall]) -> Vec<Finding> {
    let all = by_name(calls).into_iter().map(|of| Finding {
        file: of.file,
        line: of.line(),
        message: of.message(language, None),
    });
    all.collect()
}

/// Calls by file and name, in the order of the first ones.
pub(crate) fn by_name(calls: &[OutsideCall]) -> Vec<CallsOfOne<'_>> {
    let mut found: Vec<CallsOfOne<'_>> = Vec::new();
    let mut known: BTreeMap<(usize, Option<&str>), usize> = BTreeMap::new();
    for call in calls {
        let (file, name) = (call.file, call.name.as_deref());
        let index = *known.entry((file, name)).or_insert(found.len());
        match found.get_mut(index) {
            Some(of) => of.lines.push(call.line),
            None => found.push(CallsOfOne {
                file,
                name,
                lines: vec![call.line],
            }),
        }
    }
    for of in &mut found {
        of.lines.sort_unstable();
        of.lines.dedup();
    }
    found
}

impl CallsOfOne<'_> {
    /// The first line.
    pub(crate) fn line(&self) -> usize {
        self.lines.first().copied().unwrap_or(1)
    }

    /// Message on the calls; `becomes` names their replacement in the output, if they are not carried.
    pub(crate) fn message(&self, language: Language, becomes: Option<&str>) -> String {
        let all = match self.lines.len() {
            1 => String::new(),
            _ => format!(" ({})", in_words(&self.lines)),
        };
        let modes = language.modes_of_motions();
        match self.name {
            Some(name) => format!(
                "`{name}` is in none of the files: {}taken not to move the tool and not to change speed, tool or frame{modes}; state it under [calls] if it moves, or give its file{all}",
                becomes.map_or_else(String::new, |becomes| format!("{becomes}, and "))
            ),
            None => format!(
                "what is called is computed: {}, and if it moves the tool{modes}, that is not seen{all}",
                becomes.unwrap_or("it is carried")
            ),
        }
    }
}

/// Calls that are stated to move the tool.
pub(crate) struct StatedToMove {
    pub faults: Vec<ProgramError>,
    /// Names that nothing calls.
    pub findings: Vec<Finding>,
}

/// Checks calls against the caller's list of those that move the tool; each of them is refused with its line.
pub(crate) fn stated_to_move(
    files: &[SourceFile],
    calls: &[OutsideCall],
    moving_calls: &BTreeSet<String>,
) -> StatedToMove {
    let is = |call: &OutsideCall, stated: &String| {
        let name = call.name.as_ref();
        name.is_some_and(|name| name.eq_ignore_ascii_case(stated))
    };
    let mut stated = StatedToMove {
        faults: Vec::new(),
        findings: Vec::new(),
    };
    for name in moving_calls {
        let mut of_name = calls.iter().filter(|call| is(call, name)).peekable();
        if of_name.peek().is_none() {
            stated.findings.push(Finding {
                file: 0,
                line: 1,
                message: format!(
                    "`{name}`, of which is stated that it moves the tool, is called nowhere, or its file is given: that changes nothing"
                ),
            });
        }
        stated.faults.extend(of_name.map(|call| {
            let source = &files[call.file];
            let reason = format!(
                "`{name}` moves the tool, as is stated, and none of the files says where to"
            );
            let remedy = "give its file as well, or divide the program at the call";
            ProgramError::at(source, source.range_of(call.line), reason, remedy)
        }));
    }
    stated
}

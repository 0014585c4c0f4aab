//! Calls of what is in none of the files: they are taken to leave the tool where it is, and in force what is, unless the caller says that
//! they move it. What a call is that the run computes is not known.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::ProgramError;
use crate::model::language::Language;
use crate::text::number::in_words;
use crate::text::source::{Finding, SourceFile};

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

//! Calls of what is in none of the files: they may move the tool, and how is not known here.

use std::collections::BTreeMap;

use crate::model::language::Language;
use crate::text::line_words::in_words;

/// A call of what is in none of the files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OutsideCall {
    /// An index of the files.
    pub file: usize,
    pub line: usize,
    /// As it is shown; none where the run computes it.
    pub name: Option<String>,
    /// Lines of motions whose speed it may have changed, in its file.
    pub speeds_behind: Vec<usize>,
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

    /// What is said of them, with what becomes of them: `it is carried`.
    pub(crate) fn message(&self, language: Language, becomes: &str) -> String {
        let what = match self.name {
            Some(name) => format!("`{name}` is in none of these files"),
            None => "what is called is computed".to_owned(),
        };
        let all = match self.lines.len() {
            1 => String::new(),
            _ => format!(" ({})", in_words(&self.lines)),
        };
        format!(
            "{what}: {becomes}, and if it moves the tool{}, that is not seen{all}",
            modes_of(language)
        )
    }
}

/// What else it may do: statements that stay in force behind it, of which no motion behind it says anything.
fn modes_of(language: Language) -> &'static str {
    match language {
        Language::Rapid => {
            ", or states how motions behind it go (`CirPathMode`, `SingArea`, `ConfL`, `ConfJ`, `AccSet`, `VelSet`)"
        }
        Language::Krl => {
            ", or states how motions behind it go (`$ORI_TYPE`, `$CIRC_TYPE`, `$ACC`, `$APO`)"
        }
        _ => "",
    }
}

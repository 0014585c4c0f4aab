//! What of a program is in doubt, by lines.

use std::collections::BTreeMap;

use crate::text::finding::Finding;
use crate::text::line_words::in_words;

/// Lines by what is in doubt, each with its file.
#[derive(Debug, Default)]
pub(super) struct Doubts(pub(super) BTreeMap<(&'static str, usize), Vec<usize>>);

impl Doubts {
    /// Each once in every file, with its lines.
    pub(super) fn into_findings(self) -> Vec<Finding> {
        let found = self.0.into_iter().map(|((what, file), mut lines)| {
            lines.sort_unstable();
            lines.dedup();
            let all = match lines.len() {
                1 => String::new(),
                _ => format!(" ({})", in_words(&lines)),
            };
            Finding {
                file,
                line: lines.first().copied().unwrap_or(1),
                message: format!("{what}{all}"),
            }
        });
        let mut found: Vec<Finding> = found.collect();
        found.sort_by_key(|finding| (finding.file, finding.line));
        found
    }
}

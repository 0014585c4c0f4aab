//! What is said of files that are refused.

use kinetostat_formats::ProgramError;

/// A body of a file, whether it is written flat first, the line that is refused, and a part of what is said of it.
pub type Case<'a> = (bool, &'a str, usize, &'a str);

/// Lines and messages of what was found.
pub fn messages<T>(found: Result<T, Vec<ProgramError>>) -> Vec<(usize, String)> {
    let errors = found.err().unwrap_or_default();
    let said = errors.iter().map(|error| (error.line, error.to_string()));
    said.collect()
}

/// Each of the files is refused at its line with its words, and nothing else is said but for one more line at most.
pub fn all_are_refused(cases: &[Case<'_>], said: impl Fn(&str, bool) -> Vec<(usize, String)>) {
    let mut odd = Vec::new();
    for (flat, body, line, part) in cases {
        let found = said(body, *flat);
        let hit = found
            .iter()
            .any(|(at, message)| at == line && message.contains(part));
        if !hit || found.len() > 2 {
            odd.push(format!("{body:?}, line {line}, {part:?}: {found:?}"));
        }
    }
    assert!(odd.is_empty(), "{odd:#?}");
}

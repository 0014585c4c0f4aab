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

/// Such a file would be one line, and all behind its first comment would be part of that.
#[test]
fn lines_that_end_with_a_carriage_return_alone_are_refused() {
    use kinetostat_formats::{Language, ReadOptions, SourceFile, expand, read};

    let options = ReadOptions::default();
    for language in Language::ALL {
        let file = || SourceFile::new("part.x", "BEGIN PGM A MM\rL X+5\rEND PGM A MM\r");
        let read = messages(read(language, vec![file()], &options));
        let flat = messages(expand(language, vec![file()], &options));
        let says = |found: &[(usize, String)]| {
            let part = "`BEGIN PGM A MM`: the lines of the file end with a carriage return alone";
            found.len() == 1 && found[0].0 == 1 && found[0].1.contains(part)
        };
        assert_eq!(says(&read), language != Language::Poses, "{read:?}");
        assert!(says(&flat) || language == Language::Poses, "{flat:?}");
    }
}

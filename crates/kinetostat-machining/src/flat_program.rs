//! A program that was run once and written flat: which line of which file a flat line came from, and saying so.

use std::collections::BTreeSet;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::counted;

/// A program with subprograms, variables and cycles that was run once and written flat. A run goes along the flat program;
/// all its lines are lines of that.
///
/// ```
/// use kinetostat_machining::FlatProgram;
///
/// let files = ["plate.ngc", "hole.ngc"].map(String::from).to_vec();
/// // The second flat line came from line 12 of the program, the third from line 3 of the subprogram.
/// let flat = FlatProgram::new(files, 3, vec![(0, 1), (0, 12), (1, 3)]);
/// assert_eq!(flat.source_of(3), Some(("hole.ngc", 3)));
/// assert_eq!(flat.source_of(4), None);
/// assert_eq!(
///     flat.with_sources("line 2: too deep"),
///     "line 12 of plate.ngc (line 2 of the flat program): too deep"
/// );
/// assert_eq!(
///     flat.with_sources("on the lines 1, 2 and 3"),
///     "on the lines 1, 12 of plate.ngc and 3 of hole.ngc (lines 1, 2 and 3 of the flat program)"
/// );
/// let lines = flat.lines_in("the worst is at line 3, then line 2");
/// assert_eq!(lines.into_iter().collect::<Vec<_>>(), [2, 3]);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct FlatProgram {
    /// File name of the flat program, with its folder where it keeps the name of its source; `None` if it was not written.
    #[serde(default)]
    pub name: Option<String>,
    /// Number of its blocks; of a program that was converted, of its motions.
    pub blocks: usize,
    /// The language into which the program was converted before it was run; `None` if it keeps its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub language: Option<String>,
    /// Names of the files that were run, the program first.
    pub files: Vec<String>,
    /// Folders, diameters and parameters that were stated, one sentence each.
    #[serde(default)]
    pub settings: Vec<String>,
    /// For each flat line the file (an index of `files`) and the line there, from 1. Not in the JSON: its lines have
    /// theirs beside them.
    #[serde(skip)]
    sources: Arc<[(u32, u32)]>,
}

impl FlatProgram {
    /// A flat program of `blocks` blocks. `sources` has for each of its lines the file, an index of `files`, and the line there,
    /// counted from 1.
    #[must_use]
    pub fn new(files: Vec<String>, blocks: usize, sources: Vec<(u32, u32)>) -> Self {
        Self {
            name: None,
            blocks,
            language: None,
            files,
            settings: Vec::new(),
            sources: sources.into(),
        }
    }

    /// File and line that a line of the flat program came from; `None` for a line that it has not.
    #[must_use]
    pub fn source_of(&self, line: usize) -> Option<(&str, usize)> {
        let (file, line) = self.sources.get(line.checked_sub(1)?)?;
        Some((self.files.get(*file as usize)?.as_str(), *line as usize))
    }

    /// Text for the origin of a line of the flat program; `None` for a line that it does not have.
    ///
    /// ```
    /// use kinetostat_machining::FlatProgram;
    ///
    /// let flat = FlatProgram::new(vec!["plate.ngc".to_owned()], 2, vec![(0, 1), (0, 7)]);
    /// assert_eq!(flat.place_of(2).as_deref(), Some("plate.ngc, line 7"));
    /// assert_eq!(flat.place_of(3), None);
    /// ```
    #[must_use]
    pub fn place_of(&self, line: usize) -> Option<String> {
        let (file, line) = self.source_of(line)?;
        Some(format!("{file}, line {line}"))
    }

    /// Sentence on the lines to which a run refers.
    ///
    /// ```
    /// use kinetostat_machining::FlatProgram;
    ///
    /// let flat = FlatProgram::new(vec!["plate.ngc".to_owned()], 2, vec![(0, 1), (0, 7)]);
    /// let says = "plate.ngc was run once and written flat, 2 blocks; lines are those of the flat program";
    /// assert_eq!(flat.description(), says);
    /// ```
    #[must_use]
    pub fn description(&self) -> String {
        let [program, called] = match self.files.split_first() {
            Some((program, called)) => [program.clone(), called.join(", ")],
            None => [String::new(), String::new()],
        };
        let with = match called.as_str() {
            "" => String::new(),
            called => format!(" with {called}"),
        };
        let unit = match self.language {
            None => "block",
            Some(_) => "motion",
        };
        let blocks = counted(self.blocks, unit);
        let done = match &self.language {
            None => "run once and written flat".to_owned(),
            Some(language) => format!("written flat in {language}"),
        };
        let named = self.name.as_ref();
        let named = named.map_or_else(String::new, |name| format!(", {name}"));
        format!("{program}{with} was {done}, {blocks}; lines are those of the flat program{named}")
    }

    /// A message about lines of the flat program that names the lines that they came from, too. Text of the program itself,
    /// between backticks, stays as it is.
    #[must_use]
    pub fn with_sources(&self, text: &str) -> String {
        self.replaced(text, |word, said, numbers| {
            let small = word.to_ascii_lowercase();
            format!("{word} {said} ({small} {numbers} of the flat program)")
        })
    }

    /// Rewrites a message to the lines of the files alone: for a flat program that is not written to a file.
    ///
    /// ```
    /// use kinetostat_machining::FlatProgram;
    ///
    /// let flat = FlatProgram::new(vec!["plate.ngc".to_owned()], 2, vec![(0, 1), (0, 7)]);
    /// assert_eq!(flat.in_sources("line 2: too deep"), "line 7 of plate.ngc: too deep");
    /// ```
    #[must_use]
    pub fn in_sources(&self, text: &str) -> String {
        self.replaced(text, |word, said, _| format!("{word} {said}"))
    }

    /// A text in which `say` makes something else of the lines that it names: of the word, the lines of the files and the numbers.
    fn replaced(&self, text: &str, say: impl Fn(&str, &str, &str) -> String) -> String {
        let mut out = String::with_capacity(text.len());
        let mut rest = text;
        while let Some(found) = next_line(rest) {
            out.push_str(&rest[..found.start]);
            let own = &rest[found.start..found.end];
            match self.in_files(&found.numbers) {
                // `line 12`, or `lines 12, 15 and 20`, with what stands between the numbers.
                Some(said) => {
                    let (word, numbers) = own.split_at(found.word);
                    out.push_str(&say(word, &said, numbers.trim_start()));
                }
                None => out.push_str(own),
            }
            rest = &rest[found.end..];
        }
        out.push_str(rest);
        out
    }

    /// Lines of the flat program that a text names without the line that they came from.
    #[must_use]
    pub fn lines_in(&self, text: &str) -> BTreeSet<usize> {
        let mut lines = BTreeSet::new();
        let mut rest = text;
        while let Some(found) = next_line(rest) {
            let numbers = found.numbers.iter().map(|number| number.line);
            lines.extend(numbers.filter(|line| self.source_of(*line).is_some()));
            rest = &rest[found.end..];
        }
        lines
    }
}

impl FlatProgram {
    /// The lines of files that lines of the flat program came from, as in `3 and 5 of hole.ngc`; `None` if one has none.
    fn in_files(&self, numbers: &[Number]) -> Option<String> {
        let mut said = String::new();
        let mut last = None;
        for number in numbers {
            let (file, line) = self.source_of(number.line)?;
            if let Some(before) = last.filter(|before| *before != file) {
                said.push_str(&format!(" of {before}"));
            }
            said.push_str(&format!("{}{line}", number.after));
            last = Some(file);
        }
        Some(format!("{said} of {}", last?))
    }
}

/// `line 12`, or `lines 12, 15 and 20`, in a text.
struct Named {
    start: usize,
    end: usize,
    /// Letters of the word.
    word: usize,
    numbers: Vec<Number>,
}

/// A number in a list, with what stands before it.
struct Number {
    after: &'static str,
    line: usize,
}

/// Separators between the numbers of a list.
const BETWEEN: [&str; 4] = [", ", " and ", " to ", " or "];

/// The number that a text begins with, and what stands behind it.
fn number_of(text: &str) -> Option<(usize, &str)> {
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    let line = text[..digits].parse().ok()?;
    Some((line, &text[digits..]))
}

/// The list that a text begins with, and what stands behind it.
fn numbers_of(text: &str) -> Option<(Vec<Number>, &str)> {
    let (line, mut behind) = number_of(text)?;
    let mut numbers = vec![Number { after: "", line }];
    let next = |behind| {
        BETWEEN.into_iter().find_map(|after| {
            let (line, rest) = number_of(str::strip_prefix(behind, after)?)?;
            Some((Number { after, line }, rest))
        })
    };
    while let Some((number, rest)) = next(behind) {
        numbers.push(number);
        behind = rest;
    }
    Some((numbers, behind))
}

/// The next line that a text names; not one of a file that it names besides (`line 3 of hole.ngc`, `part.toml, line 3`), and not
/// what stands between backticks.
fn next_line(text: &str) -> Option<Named> {
    let mut quoted = false;
    let mut before = ' ';
    for (start, character) in text.char_indices() {
        let begins = !before.is_alphanumeric() && !quoted;
        before = character;
        if character == '`' {
            quoted = !quoted;
        }
        if !begins || !matches!(character, 'l' | 'L') {
            continue;
        }
        let Some(after) = text[start + 1..].strip_prefix("ine") else {
            continue;
        };
        // A text for a person may be broken between the word and its number.
        let (several, after) = match after.strip_prefix('s') {
            Some(after) => (true, after),
            None => (false, after),
        };
        let number = after.trim_start();
        if number.len() == after.len() {
            continue;
        }
        let list = match several {
            true => numbers_of(number),
            false => {
                number_of(number).map(|(line, behind)| (vec![Number { after: "", line }], behind))
            }
        };
        let Some((numbers, behind)) = list else {
            continue;
        };
        let of_another_file = text[..start].strip_suffix(", ").is_some_and(|named| {
            let name = named.rsplit(char::is_whitespace).next();
            name.is_some_and(|name| name.contains('.'))
        });
        if behind.trim_start().starts_with("of ") || of_another_file {
            continue;
        }
        let end = text.len() - behind.len();
        return Some(Named {
            start,
            end,
            word: "line".len() + usize::from(several),
            numbers,
        });
    }
    None
}

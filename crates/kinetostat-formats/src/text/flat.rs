//! A program run once and written flat, with where each of its lines is from.

use crate::model::program::Language;
use crate::text::source::SourceFile;

/// A program that was run once and written flat.
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, expand_heidenhain};
///
/// let text = "BEGIN PGM A MM\nFN 0: Q1 = +5\nL X+Q1 F200\nEND PGM A MM\n";
/// let flat = expand_heidenhain(vec![SourceFile::new("a.h", text)], &ReadOptions::default()).unwrap();
/// assert_eq!(flat.file.bytes(), b"BEGIN PGM A MM\nL X+5 F200\nEND PGM A MM\n");
/// assert_eq!(flat.origins, [(0, 1), (0, 3), (0, 4)]);
/// assert!(flat.changed);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FlatText {
    /// The flat program, under the name of the first file.
    pub file: SourceFile,
    /// For every line of it: the file (an index of those given) and its line, counted from 1.
    pub origins: Vec<(usize, usize)>,
    /// Whether anything was to be flattened; without, the bytes are those of the first file.
    pub changed: bool,
}

/// Longest line that a comment is added to, bytes.
const LONGEST: usize = 120;

impl FlatText {
    /// The same program, in which every block says in a comment the line that it is from, as in `;line 12` or `;drill.spf, line 3`.
    /// Lines without a block stay, and so do long ones, those that the next line goes on with, and blocks of Heidenhain that are
    /// a comment or begin and end the program.
    ///
    /// ```
    /// use kinetostat_formats::{Language, ReadOptions, SourceFile, expand_siemens};
    ///
    /// let file = SourceFile::new("a.mpf", "R1=5\n;begins\nG1 X=R1 F200\nM30\n");
    /// let flat = expand_siemens(vec![file], &ReadOptions::default()).unwrap();
    /// let said = flat.with_origins(Language::Siemens, &["a.mpf".to_owned()]);
    /// assert_eq!(said.file.bytes(), b";begins\nG1 X=5 F200 ;line 3\nM30 ;line 4\n");
    /// ```
    #[must_use]
    pub fn with_origins(&self, language: Language, names: &[String]) -> Self {
        let mut bytes = Vec::with_capacity(2 * self.file.bytes().len());
        let lines = self.file.bytes().split_inclusive(|byte| *byte == b'\n');
        for (index, line) in lines.enumerate() {
            let text = line.trim_ascii_end();
            let end = &line[text.len()..];
            bytes.extend_from_slice(text);
            let origin = self.origins.get(index);
            if let Some((file, from)) = origin.filter(|_| is_block(language, text)) {
                let named = names.get(*file).filter(|_| *file > 0);
                let named = named.map_or_else(String::new, |name| format!("{name}, "));
                bytes.extend_from_slice(format!(" ;{named}line {from}").as_bytes());
            }
            bytes.extend_from_slice(end);
        }
        Self {
            file: SourceFile::new(self.file.name(), bytes),
            ..self.clone()
        }
    }
}

/// Whether a line is a block that a comment may stand behind.
fn is_block(language: Language, text: &[u8]) -> bool {
    let text = text.trim_ascii_start();
    let upper = text.to_ascii_uppercase();
    let words = upper.split(|byte| byte.is_ascii_whitespace());
    let mut words = words.skip_while(|word| word.iter().all(u8::is_ascii_digit));
    let (first, second) = (words.next().unwrap_or_default(), words.next());
    let own = match language {
        Language::Heidenhain => {
            let ends = matches!(first, b"BEGIN" | b"END") && second == Some(b"PGM");
            first.is_empty() || first.starts_with(b"*") || ends || text.ends_with(b"~")
        }
        _ => text.is_empty() || text.starts_with(b"%"),
    };
    !own && text.len() <= LONGEST && !text.contains(&b';')
}

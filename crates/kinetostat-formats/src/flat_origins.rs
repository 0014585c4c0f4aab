//! Comments in a flat program with the lines that its blocks are from.

use crate::model::language::Language;
use crate::text::source::{FlatText, SourceFile};

/// Longest line that a comment is added to, bytes.
const LONGEST: usize = 120;

impl FlatText {
    /// Adds the source line of every block as a comment, as in `;line 12` or `;drill.spf, line 3`.
    /// Lines without a block stay, and so do long ones, those that the next line goes on with, and blocks of Heidenhain that are
    /// a comment or begin and end the program.
    ///
    /// ```
    /// use kinetostat_formats::{Language, SourceFile, expand_siemens};
    ///
    /// let file = SourceFile::new("a.mpf", "G90\n;begins\nG1 X5 F200\nM30\n");
    /// let flat = expand_siemens(&[file]).unwrap();
    /// let said = flat.with_origins(Language::Siemens, &["a.mpf".to_owned()]);
    /// assert_eq!(said.file.bytes(), b"G90 ;line 1\n;begins\nG1 X5 F200 ;line 3\nM30 ;line 4\n");
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

/// True if a line is a block that a comment may follow.
fn is_block(language: Language, text: &[u8]) -> bool {
    let text = text.trim_ascii_start();
    language.takes_origin(text) && text.len() <= LONGEST && !text.contains(&b';')
}

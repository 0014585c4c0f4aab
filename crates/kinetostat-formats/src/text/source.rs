//! A file of a program: its name, its bytes, where its lines begin.

use std::ops::Range;

/// Byte order mark that some editors write before the text.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Finding on the first block after the end of a program.
pub(crate) const BEHIND_END: &str =
    "what stands from here on does not run: it stays as it is written";

/// Start of the text of a file.
pub(crate) fn beginning(bytes: &[u8]) -> usize {
    match bytes.starts_with(BYTE_ORDER_MARK) {
        true => BYTE_ORDER_MARK.len(),
        false => 0,
    }
}

/// A file of a program as it was read; nothing in it is ever changed.
///
/// ```
/// use kinetostat_formats::SourceFile;
///
/// let file = SourceFile::new("part.mod", "MODULE Part\r\n  ! nothing\r\nENDMODULE");
/// assert_eq!((file.name(), file.line_count()), ("part.mod", 3));
/// assert_eq!(file.line_of(file.bytes().len() - 1), 3);
/// assert_eq!(file.line(2), Some(&b"  ! nothing"[..]));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceFile {
    name: String,
    bytes: Vec<u8>,
    line_starts: Vec<usize>,
}

impl SourceFile {
    /// A file with the name that messages and written files have.
    pub fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        let bytes = bytes.into();
        let ends = (bytes.iter().enumerate()).filter(|(_, byte)| **byte == b'\n');
        let line_starts = std::iter::once(0)
            .chain(ends.map(|(at, _)| at + 1))
            .collect();
        Self {
            name: name.into(),
            bytes,
            line_starts,
        }
    }

    /// Name of the file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// All of it.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Number of its lines; what follows the last line ending is one, even if it is empty.
    #[must_use]
    pub fn line_count(&self) -> usize {
        self.line_starts.len()
    }

    /// The line in which a byte stands, counted from 1.
    #[must_use]
    pub fn line_of(&self, at: usize) -> usize {
        self.line_starts.partition_point(|start| *start <= at)
    }

    /// A line, counted from 1, without its line ending.
    #[must_use]
    pub fn line(&self, line: usize) -> Option<&[u8]> {
        let start = *self.line_starts.get(line.checked_sub(1)?)?;
        let next = self.line_starts.get(line).map_or(self.bytes.len(), |n| *n);
        let text = &self.bytes[start..next];
        let text = text.strip_suffix(b"\n").unwrap_or(text);
        Some(text.strip_suffix(b"\r").unwrap_or(text))
    }

    /// Start of a line, counted from 1; the end of the file after the last one.
    pub(crate) fn start_of(&self, line: usize) -> usize {
        let start = self.line_starts.get(line.saturating_sub(1));
        start.map_or(self.bytes.len(), |start| *start)
    }

    /// The bytes of a line, counted from 1, without its line ending.
    pub(crate) fn range_of(&self, line: usize) -> Range<usize> {
        let start = self.start_of(line);
        start..start + self.line(line).map_or(0, <[u8]>::len)
    }

    /// The bytes of a range; none where it is outside.
    pub(crate) fn part(&self, span: &Range<usize>) -> &[u8] {
        self.bytes.get(span.clone()).unwrap_or_default()
    }

    /// Line ending of the first line; inserted lines use it, too.
    pub(crate) fn line_ending(&self) -> &'static [u8] {
        let first = self.bytes.iter().position(|byte| *byte == b'\n');
        match first.is_some_and(|at| at > 0 && self.bytes[at - 1] == b'\r') {
            true => b"\r\n",
            false => b"\n",
        }
    }

    /// The blanks with which the line of a byte begins.
    pub(crate) fn indentation(&self, at: usize) -> &[u8] {
        let line = self.line(self.line_of(at)).unwrap_or_default();
        let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t');
        let blanks = line.iter().take_while(|byte| is_blank(byte)).count();
        &line[..blanks]
    }

    /// The blanks with which the line of a byte begins, as far as they stand before the byte.
    pub(crate) fn indentation_before(&self, at: usize) -> &[u8] {
        let blanks = self.indentation(at);
        let before = at.saturating_sub(self.range_of(self.line_of(at)).start);
        &blanks[..before.min(blanks.len())]
    }
}

//! Texts of programs: a file with its lines, its replaced ranges, findings on it, and the text of a program that was run once and written flat.

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

/// Start of the line after that of a byte.
pub(crate) fn next_line(bytes: &[u8], at: usize) -> usize {
    let end = bytes[at..].iter().position(|byte| *byte == b'\n');
    end.map_or(bytes.len(), |end| at + end + 1)
}

/// The words of a text in one line.
pub(crate) fn in_one_line(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    text.split_whitespace().collect::<Vec<_>>().join(" ")
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

// Replaced and inserted ranges of a file; what lies between comes back byte for byte.

/// Replacements in one text. An empty range inserts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Edits(Vec<(Range<usize>, Vec<u8>)>);

impl Edits {
    /// Puts `bytes` in place of a range. Ranges must not overlap; insertions at one place keep their order.
    pub(crate) fn replace(&mut self, span: Range<usize>, bytes: impl Into<Vec<u8>>) {
        self.0.push((span, bytes.into()));
    }

    /// True if nothing is to be replaced.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True where a byte of a range is replaced.
    pub(crate) fn touches(&self, span: &Range<usize>) -> bool {
        let mut all = self.0.iter();
        all.any(|(own, _)| own.start < span.end && span.start < own.end)
    }

    /// Adds those of another.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.0.append(&mut other.0);
    }

    /// The text with all replacements; `None` where two overlap or one lies outside.
    pub(crate) fn applied_to(mut self, text: &[u8]) -> Option<Vec<u8>> {
        self.0.sort_by_key(|(span, _)| (span.start, span.end));
        let added: usize = self.0.iter().map(|(_, bytes)| bytes.len()).sum();
        let mut output = Vec::with_capacity(text.len() + added);
        let mut at = 0;
        for (span, bytes) in &self.0 {
            output.extend_from_slice(text.get(at..span.start)?);
            output.extend_from_slice(bytes);
            at = span.end;
        }
        output.extend_from_slice(text.get(at..)?);
        Some(output)
    }

    /// Edits of a part of the text, relative to that part: for a copy of a statement.
    pub(crate) fn applied_to_part(self, text: &[u8], part: &Range<usize>) -> Option<Vec<u8>> {
        let moved = |(span, bytes): (Range<usize>, Vec<u8>)| {
            let start = span.start.checked_sub(part.start)?;
            Some((start..span.end.checked_sub(part.start)?, bytes))
        };
        let moved: Option<Vec<_>> = self.0.into_iter().map(moved).collect();
        Self(moved?).applied_to(text.get(part.clone())?)
    }
}

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
    /// Origin of every line: the file (an index of those given) and its line, counted from 1.
    pub origins: Vec<(usize, usize)>,
    /// True if the program was expanded; otherwise the bytes are those of the first file.
    pub changed: bool,
    /// Assumptions on uncertain source text, by file and line of the program as given.
    pub findings: Vec<Finding>,
}

impl FlatText {
    /// A file, by its index, in which nothing is to be flattened.
    pub(crate) fn unchanged(file: &SourceFile, index: usize) -> Self {
        let count = file.bytes().split_inclusive(|byte| *byte == b'\n').count();
        Self {
            file: file.clone(),
            origins: (1..=count).map(|line| (index, line)).collect(),
            changed: false,
            findings: Vec::new(),
        }
    }
}

/// Something that a person should know of a program that was taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// An index of [`RobotProgram::files`](crate::RobotProgram::files).
    pub file: usize,
    /// Line of the file, counted from 1.
    pub line: usize,
    /// Text of the finding.
    pub message: String,
}

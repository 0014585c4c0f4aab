//! Errors of a program or of writing, reported with a remedy.

use std::ops::Range;

use thiserror::Error;

use crate::text::source::{FlatText, SourceFile};

/// Refused text of a program: position, text, reason, remedy.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}, line {line}: `{found}`: {reason}; {remedy}")]
#[non_exhaustive]
pub struct ProgramError {
    /// Name of the file.
    pub file: String,
    /// Line of the file, counted from 1.
    pub line: usize,
    /// Bytes of the file that are meant, counted from 0.
    pub span: Range<usize>,
    /// Text found there, shortened and without control characters.
    pub found: String,
    /// Reason for the refusal.
    pub reason: String,
    /// Remedy for the user.
    pub remedy: String,
}

impl ProgramError {
    /// An error at bytes of a file.
    pub(crate) fn at(
        file: &SourceFile,
        span: Range<usize>,
        reason: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            file: file.name().to_owned(),
            line: file.line_of(span.start),
            found: excerpt(file.part(&span)),
            span,
            reason: reason.into(),
            remedy: remedy.into(),
        }
    }

    /// A name that is declared twice; `others`: what to give alone.
    pub(crate) fn twice(file: &SourceFile, span: Range<usize>, others: &str) -> Self {
        let remedy = format!("give the {others} that run together only, or rename one");
        Self::at(file, span, "the name is declared twice", remedy)
    }

    /// Two programs that a call names alike, each with its file and its first block.
    pub(crate) fn named_alike(
        file: &SourceFile,
        begin: Range<usize>,
        other: &SourceFile,
        other_begin: Range<usize>,
    ) -> Self {
        let reason = format!(
            "a call cannot tell this program from that of the same name in {}, line {}",
            other.name(),
            other.line_of(other_begin.start)
        );
        Self::at(file, begin, reason, "give one of them alone, or rename one")
    }

    /// Error of a file that is larger than so many bytes.
    pub(crate) fn too_large(file: &SourceFile, most_bytes: usize) -> Option<Self> {
        let reason = || format!("the file is larger than {} MiB", most_bytes >> 20);
        (file.bytes().len() > most_bytes).then(|| Self::at(file, 0..0, reason(), "divide it"))
    }

    /// Error at a place of an expanded program, reported at its line of the source files.
    pub(crate) fn of_flat(
        flat: &FlatText,
        files: &[SourceFile],
        at: usize,
        reason: impl Into<String>,
        remedy: &str,
    ) -> Self {
        let line = flat.file.line_of(at);
        let origin = flat.origins.get(line.saturating_sub(1)).copied();
        let (from, line) = origin.unwrap_or((0, line));
        let source = files.get(from).unwrap_or(&flat.file);
        Self::at(source, source.range_of(line), reason, remedy)
    }

    /// Shows, of a fault of a program that was written flat, the line of the file that its block came from, where the words that are meant
    /// do not stand there as they are; `origins` are those of the flat program.
    ///
    /// ```
    /// use kinetostat_formats::{ReadOptions, SourceFile, expand_heidenhain, read_heidenhain};
    ///
    /// let files = vec![SourceFile::new("a.h", "BEGIN PGM A MM\nFN 0: Q1 = +5\nL X+Q1 RL F200\nEND PGM A MM\n")];
    /// let flat = expand_heidenhain(files.clone(), &ReadOptions::default()).unwrap();
    /// let faults = read_heidenhain(vec![flat.file.clone()], &ReadOptions::default()).unwrap_err();
    /// let mut fault = faults[0].clone();
    /// assert_eq!(fault.found, "L X+5 RL F200");
    /// fault.show_source(&flat.origins, &files);
    /// assert_eq!(fault.found, "L X+Q1 RL F200");
    /// ```
    pub fn show_source(&mut self, origins: &[(usize, usize)], files: &[SourceFile]) {
        let origin = self.line.checked_sub(1).and_then(|line| origins.get(line));
        let Some((source, line)) =
            origin.and_then(|(file, line)| files.get(*file).map(|source| (source, *line)))
        else {
            return;
        };
        let own = excerpt(source.line(line).unwrap_or_default());
        let words = self.found.trim_end_matches("...");
        if !own.is_empty() && !own.contains(words) {
            self.found = own;
        }
    }

    /// Converts an error of an expanded program to its line of the source files.
    pub(crate) fn at_source(mut self, origins: &[(usize, usize)], files: &[SourceFile]) -> Self {
        self.show_source(origins, files);
        let origin = self.line.checked_sub(1).and_then(|line| origins.get(line));
        if let Some((source, line)) =
            origin.and_then(|(file, line)| files.get(*file).map(|source| (source, *line)))
        {
            let range = source.range_of(line);
            let found = self.found.as_bytes();
            let at = source.part(&range).windows(found.len().max(1));
            let at = at.into_iter().position(|part| part == found);
            self.span = match at {
                Some(at) => range.start + at..range.start + at + found.len(),
                None => range,
            };
            self.file = source.name().to_owned();
            self.line = line;
        }
        self
    }
}

/// Limit of the errors that are noted of a program: a file of errors only must not fill the memory.
const MOST_ERRORS: usize = 100_000;

/// Adds an error, up to a number that nobody reads.
pub(crate) fn note(errors: &mut Vec<ProgramError>, error: impl FnOnce() -> ProgramError) {
    if errors.len() < MOST_ERRORS {
        errors.push(error());
    }
}

/// Longest excerpt of a program quoted in a message, in characters.
const EXCERPT_CHARACTERS: usize = 60;

/// Text of a program made safe to print on a terminal: in one line, bytes that are not text and control characters (a
/// comment may hold escape codes) are shown as `?` or by their number.
pub(crate) fn excerpt(bytes: &[u8]) -> String {
    // A character has four bytes at most.
    let text =
        String::from_utf8_lossy(&bytes[..bytes.len().min(5 * EXCERPT_CHARACTERS)]).into_owned();
    let mut shown = String::new();
    let (mut count, mut blank) = (0, false);
    for character in text.trim().chars() {
        if character.is_ascii_whitespace() {
            blank = true;
            continue;
        }
        if count >= EXCERPT_CHARACTERS {
            shown.push_str("...");
            break;
        }
        if std::mem::take(&mut blank) {
            shown.push(' ');
            count += 1;
        }
        if character.is_control() {
            shown.push_str(&format!("\\x{:02x}", u32::from(character)));
        } else {
            shown.push(character);
        }
        count += 1;
    }
    shown
}

/// Error that prevents a corrected program from being written.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// A motion cannot take what it is given.
    #[error("{file}, line {line}: {reason}; {remedy}")]
    Motion {
        /// Name of the file.
        file: String,
        /// Line of the motion, counted from 1.
        line: usize,
        /// Reason for the error.
        reason: String,
        /// Remedy for the user.
        remedy: String,
    },
    /// A piece speaks of a motion that the program does not have.
    #[error(
        "a piece is of motion {motion}, the program has {motions} motions: take the pieces of this very program"
    )]
    NoSuchMotion {
        /// The motion of the piece, counted from 0.
        motion: usize,
        /// Number of motions.
        motions: usize,
    },
    /// A line would be longer than the options allow.
    #[error(
        "{file}: line {line} would be written with {bytes} bytes, {limit} are allowed; write its statement on several lines"
    )]
    LineTooLong {
        /// Name of the file.
        file: String,
        /// Line of the written file, counted from 1.
        line: usize,
        /// Bytes the line would have, without its line ending.
        bytes: usize,
        /// `WriteOptions::max_line_bytes`.
        limit: usize,
    },
    /// No name or number is free for additional poses.
    #[error(
        "{file}: no name or number is free for a further pose; give fewer pieces, or divide the program"
    )]
    NoFreeName {
        /// Name of the first file.
        file: String,
    },
    /// Two changes want the same bytes: a fault of this library.
    #[error("two changes of {file} overlap; nothing was written, please report this")]
    Overlap {
        /// Name of the file.
        file: String,
    },
}

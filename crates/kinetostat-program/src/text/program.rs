//! A program as it was written: every byte, divided into lines and words.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::library::{acting_word, only_definitions};
use crate::text::{Line, LineKind, Word, first_line, syntax};

/// First words of the comment that marks a program as compensated.
pub const COMPENSATED_MARK: &str = "kinetostat: compensated program";

/// First word of every comment of that header (one that begins with `MSG`, `DEBUG` or `LOG` would be a command to some
/// controllers). [`Program::is_marked_compensated`] looks for it at the start of any comment: some may have been removed.
pub const HEADER_PREFIX: &str = "kinetostat: ";

/// Longest line that is read, in bytes without the line ending. Controllers take far less (about
/// 250); a longer line is no G-code but another kind of file.
pub const MAX_READ_LINE_BYTES: usize = 65_536;

/// A G-code program, kept byte for byte.
///
/// The syntax is separate from its meaning: [`Program::read`] finds lines and words and refuses what
/// this crate cannot follow at all (subroutines, variables, control structure, files that are no
/// text); [`crate::interpret`] says where the tool goes.
#[derive(Debug, Clone, Default)]
pub struct Program {
    bytes: Vec<u8>,
    lines: Vec<Line>,
    words: Vec<Word>,
    mark_line: Option<usize>,
    semicolon_comments: bool,
    /// Number of the first line: 1, but where lines before were read elsewhere.
    first_number: usize,
    /// Position in a longer program; `None` for a whole one.
    part: Option<PartOfText>,
}

/// Position of the lines in a longer program.
#[derive(Debug, Clone)]
pub(crate) struct PartOfText {
    /// Numbers of the lines that are written: the others are there for what they tell of these.
    pub core: Range<usize>,
    /// The line ending that the first line of the whole program has.
    pub usual_ending: Vec<u8>,
    /// Every motion of the whole program has its own motion word.
    pub repeats_motion: bool,
}

impl Program {
    /// Divides a file into lines and words.
    ///
    /// # Errors
    ///
    /// The first construct that cannot be followed, with its line: bytes that are no text, lines
    /// longer than [`MAX_READ_LINE_BYTES`], malformed numbers, variables and expressions, control
    /// structure, subroutines and calls, checksums.
    pub fn read(bytes: impl Into<Vec<u8>>) -> Result<Program, ProgramError> {
        let (program, faults) = Self::read_with_faults(bytes.into());
        match faults.into_iter().next() {
            Some(first) => Err(first),
            None => Ok(program),
        }
    }

    /// Reads the program, with the faults of all lines in order. Words before the fault of a refused line are kept,
    /// so that its modes are not missed in the lines that follow.
    pub(crate) fn read_with_faults(bytes: Vec<u8>) -> (Program, Vec<ProgramError>) {
        let mut reader = Reader::new(bytes);
        let mut faults = reader.read();
        if !faults.is_empty()
            && let Some(library) = only_definitions(&reader.program.bytes)
        {
            faults = vec![library];
        }
        (reader.program, faults)
    }

    /// The program, byte for byte as it was read.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Number of lines; a last line without a line ending counts, an empty rest does not.
    pub fn line_count(&self) -> usize {
        self.lines.len()
    }

    /// Number of blocks: lines with at least one word; of a part of a longer program those that are its own.
    pub fn block_count(&self) -> usize {
        self.own_lines()
            .filter(|(_, line)| !line.words.is_empty())
            .count()
    }

    /// Text of a line without its line ending; `line` is counted from 1. `None` beyond the end.
    pub fn line_bytes(&self, line: usize) -> Option<&[u8]> {
        let line = self.line(line)?;
        Some(&self.bytes[line.start as usize..line.end as usize])
    }

    /// Lines of the whole program before the first of these.
    pub(crate) fn lines_before(&self) -> usize {
        self.first_number.saturating_sub(1)
    }

    /// Number of a line by its place among these.
    pub(crate) fn number_of(&self, index: usize) -> usize {
        self.lines_before() + index + 1
    }

    /// Place of a line among these by its number.
    pub(crate) fn index_of(&self, number: usize) -> Option<usize> {
        number.checked_sub(self.lines_before() + 1)
    }

    /// A line by its number.
    pub(crate) fn line(&self, number: usize) -> Option<&Line> {
        self.lines.get(self.index_of(number)?)
    }

    /// Numbers of the lines that are its own: of a whole program all of them.
    pub(crate) fn own_numbers(&self) -> Range<usize> {
        match &self.part {
            Some(part) => part.core.clone(),
            None => self.first_number..self.first_number + self.lines.len(),
        }
    }

    /// The lines that are its own, with their numbers.
    pub(crate) fn own_lines(&self) -> impl Iterator<Item = (usize, &Line)> {
        let own = self.own_numbers();
        let all = self.lines.iter().enumerate();
        let numbered = all.map(|(index, line)| (self.number_of(index), line));
        numbered.filter(move |(number, _)| own.contains(number))
    }

    /// The bytes of the lines that are its own, and a byte order mark before them.
    pub fn own_bytes(&self) -> &[u8] {
        if self.part.is_none() {
            return &self.bytes;
        }
        let mut own = self.own_lines().map(|(_, line)| line);
        let (Some(first), begins) = (own.next(), self.begins()) else {
            return &[];
        };
        let last = own.last().unwrap_or(first);
        let from = if begins { 0 } else { first.start as usize };
        &self.bytes[from..last.next as usize]
    }

    /// True if nothing of the program comes before its own lines.
    pub(crate) fn begins(&self) -> bool {
        self.own_numbers().start == 1
    }

    /// Position in a longer program.
    pub(crate) fn part(&self) -> Option<&PartOfText> {
        self.part.as_ref()
    }

    /// Sets its position in a longer program.
    pub(crate) fn set_part(&mut self, part: PartOfText) {
        self.part = Some(part);
    }

    /// Sets the style of the comments, true for `;`, of the whole program.
    pub(crate) fn set_semicolons(&mut self, semicolons: bool) {
        self.semicolon_comments = semicolons;
    }

    /// True if a comment marks the program as one that was written with corrections.
    pub fn is_marked_compensated(&self) -> bool {
        self.mark_line.is_some()
    }

    /// Line of that mark, counted from 1.
    pub(crate) fn mark_line(&self) -> Option<usize> {
        self.mark_line
    }

    /// True if the file has comments that begin with `;`.
    pub(crate) fn uses_semicolons(&self) -> bool {
        self.semicolon_comments
    }

    pub(crate) fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// Numbers of all T words, whether their blocks are run or not.
    ///
    /// ```
    /// use kinetostat_program::Program;
    ///
    /// let program = Program::read("T3 M6\nG1 X1 (T9)\nT1\n")?;
    /// assert_eq!(program.tool_numbers().into_iter().collect::<Vec<_>>(), [1, 3]);
    /// # Ok::<(), kinetostat_program::ProgramError>(())
    /// ```
    #[must_use]
    pub fn tool_numbers(&self) -> BTreeSet<u32> {
        let words = self.lines().iter().flat_map(|line| self.words(line));
        let called = words.filter(|word| word.letter == b'T');
        let whole =
            |value: f64| value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0;
        called
            .filter(|word| whole(word.value))
            .map(|word| word.value as u32)
            .collect()
    }

    /// True if one of these G codes is in the program, in a block that is run or not.
    #[must_use]
    pub fn has_g_code(&self, codes: &[f64]) -> bool {
        let mut words = self.lines().iter().flat_map(|line| self.words(line));
        words.any(|word| word.letter == b'G' && codes.contains(&word.value))
    }

    /// Letters, in capitals, and numbers of a line in their order; `line` is counted from 1.
    ///
    /// ```
    /// use kinetostat_program::Program;
    ///
    /// let program = Program::read("G21 G90\nN5 G4 P1.50 (cool down)\n")?;
    /// let words: Vec<(char, f64)> = program.words_on(2).collect();
    /// assert_eq!(words, [('N', 5.0), ('G', 4.0), ('P', 1.5)]);
    /// # Ok::<(), kinetostat_program::ProgramError>(())
    /// ```
    pub fn words_on(&self, line: usize) -> impl Iterator<Item = (char, f64)> {
        let words = self.line(line).map_or(&[][..], |line| self.words(line));
        words
            .iter()
            .map(|word| (char::from(word.letter), word.value))
    }

    pub(crate) fn words(&self, line: &Line) -> &[Word] {
        &self.words[line.words.start as usize..line.words.end as usize]
    }

    /// The line without its line ending.
    pub(crate) fn content(&self, line: &Line) -> Range<usize> {
        line.start as usize..line.end as usize
    }

    /// The line ending, empty at the end of a file that has none there.
    pub(crate) fn ending(&self, line: &Line) -> &[u8] {
        &self.bytes[line.end as usize..line.next as usize]
    }

    /// The line ending that the first line has; what inserted lines use where theirs is open.
    pub(crate) fn usual_ending(&self) -> &[u8] {
        if let Some(part) = &self.part {
            return &part.usual_ending;
        }
        match self.lines.first() {
            Some(line) if line.end < line.next => self.ending(line),
            _ => b"\n",
        }
    }

    /// Number of bytes of the byte order mark.
    pub(crate) fn first_byte(&self) -> usize {
        match self.begins() {
            true => byte_order_mark(&self.bytes),
            false => 0,
        }
    }
}

fn byte_order_mark(bytes: &[u8]) -> usize {
    if bytes.starts_with(b"\xef\xbb\xbf") {
        3
    } else {
        0
    }
}

/// Reader state that lines leave for later ones.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ReaderState {
    pub lines: usize,
    tape_marks: usize,
    closed: usize,
    blocks: usize,
}

/// Divides bytes into lines and words, all of a file or line by line.
#[derive(Default)]
pub(crate) struct Reader {
    program: Program,
    tokens: Vec<Spanned>,
    tape_marks: usize,
    /// Line of the closing tape mark.
    closed: usize,
    blocks: usize,
    /// Line ending of lines that are added.
    added_ending: Vec<u8>,
}

impl Reader {
    pub(crate) fn new(bytes: Vec<u8>) -> Self {
        Self {
            program: Program {
                bytes,
                first_number: 1,
                ..Program::default()
            },
            added_ending: b"\n".to_vec(),
            ..Self::default()
        }
    }

    /// Reads what follows lines that were read elsewhere.
    pub(crate) fn following(state: &ReaderState) -> Self {
        let mut reader = Self::new(Vec::new());
        reader.program.first_number = state.lines + 1;
        (reader.tape_marks, reader.closed) = (state.tape_marks, state.closed);
        reader.blocks = state.blocks;
        reader
    }

    /// Goes on behind the lines that were read, and keeps none of them.
    pub(crate) fn keep_nothing(&mut self) {
        let program = &mut self.program;
        program.first_number += program.lines.len();
        program.bytes.clear();
        program.lines.clear();
        program.words.clear();
        program.mark_line = None;
    }

    /// Makes room for so many lines of so many bytes in all, so that nothing is moved as they are read.
    pub(crate) fn reserve(&mut self, lines: usize, bytes: usize) {
        self.program.bytes.reserve(bytes);
        self.program.lines.reserve(lines);
        self.program.words.reserve(5 * lines);
    }

    /// Reader state after the lines that were read.
    pub(crate) fn state(&self) -> ReaderState {
        ReaderState {
            lines: self.program.lines_before() + self.program.lines.len(),
            tape_marks: self.tape_marks,
            closed: self.closed,
            blocks: self.blocks,
        }
    }

    /// Reads the next line, given with its line ending; a byte order mark may stand before the first of a program.
    pub(crate) fn next_line(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let first = self.program.lines_before() + self.program.lines.len() == 0;
        let mark = if first { byte_order_mark(text) } else { 0 };
        let start = self.program.bytes.len() + mark;
        self.program.bytes.extend_from_slice(text);
        let (length, _) = first_line(&text[mark..]);
        let fault = self.read_line(start..start + length, self.program.bytes.len());
        fault.map_or(Ok(()), Err)
    }

    fn read(&mut self) -> Vec<ProgramError> {
        let mut faults = Vec::new();
        if let Err(fault) = self.check_size() {
            return vec![fault];
        }
        let mut start = byte_order_mark(&self.program.bytes);
        while start < self.program.bytes.len() {
            let (length, ending) = first_line(&self.program.bytes[start..]);
            let ending = ending.len();
            let content = start..start + length;
            faults.extend(self.read_line(content, start + length + ending));
            start += length + ending;
        }
        faults
    }

    /// Program read so far.
    pub(crate) fn program(&self) -> &Program {
        &self.program
    }

    pub(crate) fn into_program(self) -> Program {
        self.program
    }

    /// Lines that are added end as the first line of another file does.
    pub(crate) fn with_ending_of(self, file: &[u8]) -> Self {
        let added_ending = match first_line(file).1 {
            [] => b"\n".to_vec(),
            ending => ending.to_vec(),
        };
        Self {
            added_ending,
            ..self
        }
    }

    /// Adds a line (without its line ending) behind the last.
    pub(crate) fn add_line(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let start = self.program.bytes.len();
        self.program.bytes.extend_from_slice(text);
        self.program.bytes.extend_from_slice(&self.added_ending);
        let fault = self.read_line(start..start + text.len(), self.program.bytes.len());
        fault.map_or(Ok(()), Err)
    }

    /// True if a block was read.
    pub(crate) fn has_blocks(&self) -> bool {
        self.blocks > 0
    }

    /// True if the closing tape mark was read.
    pub(crate) fn is_closed(&self) -> bool {
        self.tape_marks == 2
    }

    fn check_size(&self) -> Result<(), ProgramError> {
        let bytes = &self.program.bytes;
        let problem = if bytes.len() == byte_order_mark(bytes) {
            (
                "the file is empty",
                "give a program with at least one block",
            )
        } else if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            ("the file is UTF-16 text", "save it as ASCII or UTF-8")
        } else if u32::try_from(bytes.len()).is_err() {
            ("the file is larger than 4 GiB", "divide the program")
        } else {
            return Ok(());
        };
        Err(ProgramError {
            kind: ProgramErrorKind::Malformed,
            line: 1,
            span: 0..bytes.len().min(2),
            found: "first bytes of the file".to_owned(),
            reason: problem.0.to_owned(),
            remedy: problem.1.to_owned(),
        })
    }

    fn read_line(&mut self, content: Range<usize>, next: usize) -> Option<ProgramError> {
        let number = self.program.lines_before() + self.program.lines.len() + 1;
        let first_word = self.program.words.len();
        let mut fault = None;
        let (kind, block_delete) = if self.tape_marks == 2 {
            fault = self.block_after_end(number, &content);
            (LineKind::AfterEnd, false)
        } else {
            let mut tokens = std::mem::take(&mut self.tokens);
            tokens.clear();
            let result = self.read_tokens(number, content.clone(), &mut tokens);
            let kept = result.unwrap_or_else(|found| {
                let before = tokens
                    .iter()
                    .take_while(|token| content.start + token.span.end <= found.span.start);
                self.keep_words(&content, before);
                fault = Some(found);
                (LineKind::Words, false)
            });
            self.tokens = tokens;
            kept
        };
        self.program.lines.push(Line {
            start: content.start as u32,
            end: content.end as u32,
            next: next as u32,
            words: first_word as u32..self.program.words.len() as u32,
            kind,
            block_delete,
        });
        fault
    }

    /// The fault of a line after the closing tape mark that a controller might run.
    fn block_after_end(&mut self, number: usize, content: &Range<usize>) -> Option<ProgramError> {
        let text = &self.program.bytes[content.clone()];
        let span = acting_word(text, &mut self.tokens)?;
        Some(ProgramError {
            kind: ProgramErrorKind::Ambiguous,
            line: number,
            span: content.start + span.start..content.start + span.end,
            found: excerpt(text),
            reason: format!(
                "the block follows the closing tape mark % on line {}: some controllers run on, some stop",
                self.closed
            ),
            remedy: "remove the blocks after %, or the % before them".to_owned(),
        })
    }

    fn keep_words<'t>(
        &mut self,
        content: &Range<usize>,
        tokens: impl IntoIterator<Item = &'t Spanned>,
    ) {
        for spanned in tokens {
            if let Token::Word {
                letter,
                number,
                value,
            } = &spanned.token
            {
                self.program.words.push(Word {
                    letter: *letter,
                    start: (content.start + spanned.span.start) as u32,
                    number: (content.start + number.start) as u32,
                    end: (content.start + number.end) as u32,
                    value: *value,
                });
            }
        }
    }

    fn read_tokens(
        &mut self,
        number: usize,
        content: Range<usize>,
        tokens: &mut Vec<Spanned>,
    ) -> Result<(LineKind, bool), ProgramError> {
        let text = &self.program.bytes[content.clone()];
        let refuse = |span: Range<usize>, reason: &str, remedy: &str| ProgramError {
            kind: ProgramErrorKind::Malformed,
            line: number,
            span: content.start + span.start..content.start + span.end,
            found: excerpt(text),
            reason: reason.to_owned(),
            remedy: remedy.to_owned(),
        };
        if text.len() > MAX_READ_LINE_BYTES {
            return Err(refuse(
                0..text.len(),
                &format!(
                    "the line has {} bytes, at most {MAX_READ_LINE_BYTES} are read",
                    text.len()
                ),
                "check that the file is a G-code program",
            ));
        }
        if let Some(at) = text.iter().position(|byte| *byte < 0x20 && *byte != b'\t') {
            return Err(refuse(
                at..at + 1,
                &format!(
                    "byte 0x{:02x} is no text: the file is binary or damaged",
                    text[at]
                ),
                "give the program as a text file",
            ));
        }
        tokens_of(text, tokens);
        let comments = Comments::of(text, tokens);
        self.program.semicolon_comments |= comments.semicolon;
        if comments.mark {
            self.program.mark_line.get_or_insert(number);
        }

        let mut significant: Vec<&Spanned> = Vec::with_capacity(tokens.len());
        for spanned in tokens.iter() {
            match spanned.token {
                Token::Parenthesis { closed: false } => {
                    return Err(refuse(
                        spanned.span.clone(),
                        "a comment is opened with ( and not closed on its line",
                        "close the comment with )",
                    ));
                }
                Token::Blank | Token::Semicolon | Token::Parenthesis { .. } => {}
                _ => significant.push(spanned),
            }
        }
        let block_delete = matches!(significant.first(), Some(s) if s.token == Token::Other(b'/'));
        if block_delete {
            significant.remove(0);
        }
        if let Some(tape) = significant.iter().find(|s| s.token == Token::Other(b'%')) {
            if significant.len() > 1 || block_delete {
                return Err(refuse(
                    tape.span.clone(),
                    "a tape mark % appears among words",
                    "put % on a line of its own",
                ));
            }
            if self.tape_marks == 0 && self.blocks > 0 {
                // A lone % at the end is a closing mark without its opening one.
                self.tape_marks = 1;
            }
            self.tape_marks += 1;
            self.closed = number;
            return Ok((LineKind::Tape, false));
        }
        if significant.is_empty() {
            return Ok((LineKind::Words, block_delete));
        }
        let checked =
            syntax::check(text, &significant, self.blocks == 0).map_err(|found| ProgramError {
                kind: found.kind,
                ..refuse(found.span, &found.reason, found.remedy)
            })?;
        self.blocks += 1;
        self.keep_words(&content, significant[..checked.words].iter().copied());
        Ok((checked.kind, block_delete))
    }
}

/// Style and mark found in the comments of a line.
#[derive(Default)]
struct Comments {
    semicolon: bool,
    mark: bool,
}

impl Comments {
    fn of(text: &[u8], tokens: &[Spanned]) -> Self {
        let mut found = Self::default();
        for spanned in tokens {
            match spanned.token {
                Token::Semicolon => found.semicolon = true,
                Token::Parenthesis { .. } => {}
                _ => continue,
            }
            let comment = text[spanned.span.start + 1..spanned.span.end].trim_ascii_start();
            found.mark |= comment.starts_with(HEADER_PREFIX.as_bytes());
        }
        found
    }
}

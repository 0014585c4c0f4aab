//! A place among the tokens, and the words that begin or end something.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::token::{Kind, TokenFile};
use crate::text::Name;

/// Words that begin a statement or end a block: a statement before them has no semicolon.
#[rustfmt::skip]
const KEYWORDS: [&str; 36] = [
    "BACKWARD", "CASE", "CONST", "DEFAULT", "ELSE", "ELSEIF", "ENDFOR", "ENDFUNC", "ENDIF", "ENDMODULE",
    "ENDPROC", "ENDRECORD", "ENDTEST", "ENDTRAP", "ENDWHILE", "ERROR", "EXIT", "FOR", "FUNC", "GOTO", "IF",
    "LOCAL", "MODULE", "PERS", "PROC", "RAISE", "RECORD", "RETRY", "RETURN", "TASK", "TEST", "TRAP",
    "TRYNEXT", "UNDO", "VAR", "WHILE",
];

/// Position of the parser, and the errors so far.
pub(super) struct Parser<'f, 'a> {
    pub(super) file: &'f TokenFile<'a>,
    pub(super) at: usize,
    pub(super) faults: &'f mut Vec<ProgramError>,
    /// The end of the file was noted where the end of a block was missing.
    pub(super) cut_off: bool,
}

impl Parser<'_, '_> {
    pub(super) fn fault(&mut self, tokens: Range<usize>, reason: &str, remedy: &str) {
        let span = self.file.span(&tokens);
        let source = self.file.source;
        note(self.faults, || {
            ProgramError::at(source, span, reason, remedy)
        });
    }

    pub(super) fn kind(&self) -> Option<Kind> {
        self.file.tokens.get(self.at).map(|token| token.kind)
    }

    pub(super) fn word_is(&self, at: usize, capitals: &str) -> bool {
        let is_word = self
            .file
            .tokens
            .get(at)
            .is_some_and(|token| token.kind == Kind::Word);
        is_word && self.file.word(at).eq_ignore_ascii_case(capitals.as_bytes())
    }

    pub(super) fn is(&self, capitals: &str) -> bool {
        self.word_is(self.at, capitals)
    }

    pub(super) fn takes(&mut self, capitals: &str) -> bool {
        let found = self.is(capitals);
        self.at += usize::from(found);
        found
    }

    pub(super) fn takes_symbol(&mut self, symbol: u8) -> bool {
        let found = self.kind() == Some(Kind::Symbol(symbol));
        self.at += usize::from(found);
        found
    }

    pub(super) fn is_keyword(&self, at: usize) -> bool {
        KEYWORDS.iter().any(|word| self.word_is(at, word))
    }

    /// An identifier; of one that is none, the fault is noted.
    pub(super) fn name(&mut self) -> Option<(Name, usize)> {
        let at = self.at;
        if self.kind() != Some(Kind::Word) {
            self.fault(at..at + 1, "a name is missing here", "write the name");
            return None;
        }
        self.at += 1;
        let name = Name::of(self.file.word(at)).filter(|name| name.letters().len() <= 32);
        if name.is_none() {
            self.fault(
                at..at + 1,
                "the name has more than 32 characters",
                "shorten it everywhere",
            );
        }
        name.map(|name| (name, at))
    }

    /// Skips past the next semicolon, or to a keyword if it is missing.
    pub(super) fn rest_of_statement(&mut self, start: usize) -> Range<usize> {
        loop {
            match self.kind() {
                Some(Kind::Symbol(b';')) => {
                    self.at += 1;
                    return start..self.at;
                }
                Some(Kind::OpenText) => {
                    self.fault(
                        self.at..self.at + 1,
                        "the text is not closed on its line",
                        "close it with \"",
                    );
                    self.at += 1;
                    while self.kind().is_some() && !self.is_keyword(self.at) {
                        self.at += 1;
                    }
                    return start..self.at;
                }
                Some(Kind::Word)
                    if self.at > start && self.is_keyword(self.at) && !self.after_backslash() => {}
                Some(_) => {
                    self.at += 1;
                    continue;
                }
                None => {}
            }
            let end = self.at.max(start + 1);
            self.fault(
                start..end,
                "no semicolon ends the statement",
                "end it with ;",
            );
            return start..self.at;
        }
    }

    /// `\Default:=` is the name of an argument.
    pub(super) fn after_backslash(&self) -> bool {
        let before = self
            .at
            .checked_sub(1)
            .and_then(|at| self.file.tokens.get(at));
        before.is_some_and(|token| token.kind == Kind::Symbol(b'\\'))
    }

    /// An end that is missing; at the end of the file only the innermost is noted.
    pub(super) fn missing(&mut self, tokens: Range<usize>, reason: &str, remedy: &str) {
        if self.kind().is_some() || !std::mem::replace(&mut self.cut_off, true) {
            self.fault(tokens, reason, remedy);
        }
    }
}

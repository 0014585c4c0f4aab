//! Blocks of plain words, behind all blocks so far.

use crate::error::{ProgramError, excerpt};
use crate::expanding::radius::trouble::Trouble;
use crate::expanding::run::runner::Runner;
use crate::path::moves::MoveKind;
use crate::text::lex::{Spanned, Token, tokens_of};

impl Runner<'_> {
    /// Adds a block.
    pub fn add(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let origin = self.origin();
        self.flat
            .name_file(origin.file, &self.sources[origin.file].name);
        let added = self.coordinates.block(
            text,
            origin,
            &mut self.radius,
            &mut self.flat,
            self.options.dialect,
        );
        added.map_err(|trouble| match trouble {
            // Shows the text of the file: the user has not seen the flat block.
            Trouble::Block(error) if error.line == origin.line => ProgramError {
                found: excerpt(self.sources[origin.file].text(origin.line - 1)),
                ..error
            },
            Trouble::Block(error) => error,
            Trouble::Line((reason, remedy)) => self.refuse(&reason, remedy),
        })?;
        self.note_functions(text)
    }

    /// Adds the words of a translated block that are no motion.
    pub fn add_rest(&mut self, words: &[u8]) -> Result<(), ProgramError> {
        match words.trim_ascii() {
            [] => Ok(()),
            words => self.add(words),
        }
    }

    /// Keeps what a block leaves in force; a feed motion after M72 has put back "no feed" is refused, as LinuxCNC does.
    fn note_functions(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        self.functions.note(&tokens);
        let is_f = |one: &Spanned| matches!(one.token, Token::Word { letter: b'F', .. });
        self.no_feed &= !tokens.iter().any(is_f);
        let last = self.flat.interpreter.last_move();
        let is_new = last.is_some_and(|last| last.line == self.flat.blocks());
        match self.no_feed && is_new && last.is_some_and(|last| last.kind == MoveKind::Feed) {
            true => Err(self.refuse(
                "the modes that were put back are from before the first F: there is no feed",
                "write F before this block",
            )),
            false => Ok(()),
        }
    }
}

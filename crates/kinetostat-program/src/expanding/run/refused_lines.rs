//! A program is run on behind lines that are refused, to list them all.
//!
//! The understood words of a refused line are taken over: its end and its modes. A line on which the rest depends (branches, loops,
//! assignments, lines in other coordinates or with radius compensation) ends the list.

use std::collections::BTreeMap;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::expanding::run::runner::Runner;
use crate::expanding::source::statement::{Piece, Statement, Structure};
use crate::text::lex::{Spanned, Token, tokens_of};

/// End of the message of the last refused line.
const NOT_RUN: &str = " (the lines behind this one were not run: what they do depends on it)";

impl Runner<'_> {
    /// All lines that are refused, of the program and then of its subprograms, in the order of their lines.
    pub fn refused_lines(&mut self) -> Vec<ProgramError> {
        let mut found: BTreeMap<(usize, usize), ProgramError> = BTreeMap::new();
        loop {
            let steps = self.steps;
            let Err(mut fault) = self.run() else {
                break;
            };
            let at = (self.origin().file, fault.line);
            let goes_on = self.steps > steps && self.rest_is_independent();
            if !goes_on && self.is_more_behind() {
                fault.remedy.push_str(NOT_RUN);
            }
            if !goes_on || !self.is_arc_from_nowhere(&fault) {
                found.entry(at).or_insert(fault);
            }
            if !goes_on {
                break;
            }
            self.take_over_refused_line();
        }
        found.into_values().collect()
    }

    fn statement(&self) -> Option<&Statement> {
        let lines = &self.sources[self.frame().file].lines;
        lines.get(self.running()).map(|line| &line.statement)
    }

    fn running_text(&self) -> &[u8] {
        let source = &self.sources[self.frame().file];
        match source.lines.is_empty() {
            true => &[],
            false => source.text(self.running()),
        }
    }

    fn is_more_behind(&self) -> bool {
        let frame = self.frame();
        self.frames.len() > 1 || frame.next < self.sources[frame.file].lines.len()
    }

    /// True if the program can be run on after the line that was refused.
    fn rest_is_independent(&self) -> bool {
        let elsewhere =
            self.radius.refuses_cycles().is_some() || self.coordinates.interpreter().is_some();
        if elsewhere || self.flat.is_full() || self.has_run_too_long() {
            return false;
        }
        let file = self.frame().file;
        let line = self.running() + 1;
        let is_unread = self.sources[file].faults.iter().any(|f| f.line == line);
        match self.statement() {
            Some(Statement::Plain) if is_unread => !controls(self.running_text()),
            Some(Statement::Plain) => true,
            Some(Statement::Block(pieces)) => !pieces
                .iter()
                .any(|piece| matches!(piece, Piece::Assignment(..))),
            Some(Statement::Structure(_, Structure::Call(_))) => true,
            _ => false,
        }
    }

    /// Places behind a line whose end is not known prove nothing about an arc.
    fn is_arc_from_nowhere(&self, fault: &ProgramError) -> bool {
        fault.kind == ProgramErrorKind::Arc && self.flat.came_from_nowhere()
    }

    fn take_over_refused_line(&mut self) {
        let text = self.running_text();
        let (words, doubt) = match self.statement() {
            Some(Statement::Plain) => (text.to_vec(), calls(text)),
            Some(Statement::Block(pieces)) => {
                let plain = pieces.iter().filter_map(|piece| match piece {
                    Piece::Text(range) => text.get(range.clone()),
                    _ => None,
                });
                (plain.collect::<Vec<_>>().concat(), true)
            }
            _ => (Vec::new(), true),
        };
        let origin = self.origin();
        self.flat.take_over(&words, origin);
        if doubt {
            self.flat.doubt_places();
        }
    }
}

/// True if a line that could not be read decides which line comes next, or sets a parameter.
fn controls(text: &[u8]) -> bool {
    let text: Vec<u8> = text
        .iter()
        .filter(|byte| !byte.is_ascii_whitespace())
        .map(u8::to_ascii_uppercase)
        .collect();
    let bare = text.strip_prefix(b"/").unwrap_or(&text);
    let bare = match bare.strip_prefix(b"N") {
        Some(rest) => {
            let digits = rest.iter().take_while(|byte| byte.is_ascii_digit());
            &rest[digits.count()..]
        }
        None => bare,
    };
    let words: [&[u8]; 6] = [b"O", b"IF", b"WHILE", b"GOTO", b"END", b"DO"];
    text.contains(&b'=') || words.iter().any(|word| bare.starts_with(word))
}

/// True if a block calls a subprogram: the tool position after it is not known.
fn calls(text: &[u8]) -> bool {
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(text, &mut tokens);
    tokens.iter().any(|spanned| match spanned.token {
        Token::Word { letter, value, .. } => {
            (letter, value) == (b'M', 98.0) || (letter, value) == (b'G', 65.0)
        }
        _ => false,
    })
}

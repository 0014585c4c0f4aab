//! Statements, branches and loops of a routine.

use std::ops::Range;

use crate::interpreter::token::Kind;
use crate::interpreter::tree::{Choice, LoopKind, Statement};
use crate::rapid::parser::cursor::Parser;

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

/// Words between operands.
const OPERATORS: [&str; 6] = ["AND", "DIV", "MOD", "NOT", "OR", "XOR"];

impl Parser<'_, '_> {
    /// Statements up to a word that ends or divides a block.
    pub(super) fn block(&mut self, statements: &mut Vec<Statement>, depth: usize) {
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b';') => self.at += 1,
                Kind::Word if self.is_keyword(self.at) => {
                    if !self.structure(statements, depth) {
                        return;
                    }
                }
                _ => statements.extend(self.simple()),
            }
        }
    }

    /// A statement that a keyword begins; false where the keyword is the block's end.
    pub(super) fn structure(&mut self, statements: &mut Vec<Statement>, depth: usize) -> bool {
        let start = self.at;
        if depth >= DEEPEST
            && ["IF", "FOR", "WHILE", "TEST"]
                .iter()
                .any(|word| self.is(word))
        {
            self.fault(
                start..start + 1,
                "blocks are nested deeper than 100",
                "take the inner ones into a routine",
            );
            // Nothing behind it is read.
            self.at = self.file.tokens.len();
            return false;
        }
        if self.takes("IF") {
            statements.extend(self.branches(start, depth));
        } else if self.takes("FOR") {
            statements.push(self.repeated(start, LoopKind::Counting, depth));
        } else if self.takes("WHILE") {
            statements.push(self.repeated(start, LoopKind::While, depth));
        } else if self.takes("TEST") {
            statements.push(self.test(start, depth));
        } else if ["RETURN", "EXIT", "RAISE", "RETRY", "TRYNEXT", "GOTO"]
            .iter()
            .any(|word| self.is(word))
        {
            self.at += 1;
            let tokens = self.rest_of_statement(start);
            statements.push(Statement::Leaves { tokens });
        } else {
            return false;
        }
        true
    }

    /// Tokens up to one of the words, which is not taken; none where a semicolon or another keyword comes first.
    pub(super) fn up_to(&mut self, words: &[&str]) -> Option<Range<usize>> {
        let start = self.at;
        while let Some(kind) = self.kind() {
            if words.iter().any(|word| self.is(word)) {
                return Some(start..self.at);
            }
            if kind == Kind::Symbol(b';') || kind == Kind::Word && self.is_keyword(self.at) {
                return None;
            }
            self.at += 1;
        }
        None
    }

    pub(super) fn close(&mut self, start: usize, word: &str) {
        if !self.takes(word) {
            self.missing(
                start..start + 1,
                &format!("no {word} ends it"),
                &format!("end it with {word}"),
            );
        }
    }

    pub(super) fn repeated(&mut self, start: usize, kind: LoopKind, depth: usize) -> Statement {
        let header = self.up_to(&["DO"]);
        if header.is_none() {
            self.fault(
                start..self.at.max(start + 1),
                "DO is missing",
                "write DO behind the loop's condition",
            );
        }
        self.takes("DO");
        let mut block = Vec::new();
        self.block(&mut block, depth + 1);
        self.close(
            start,
            match kind {
                LoopKind::Counting => "ENDFOR",
                _ => "ENDWHILE",
            },
        );
        Statement::Loop {
            kind,
            header: header.unwrap_or(start..start),
            block,
            whole: start..self.at,
        }
    }

    pub(super) fn test(&mut self, start: usize, depth: usize) -> Statement {
        let header = self.up_to(&["CASE", "DEFAULT", "ENDTEST"]);
        let mut conditions: Vec<Range<usize>> = header.into_iter().collect();
        let mut blocks = Vec::new();
        let mut choice = Choice::AtMostOne;
        loop {
            let is_default = self.is("DEFAULT");
            if !is_default && !self.is("CASE") {
                break;
            }
            let case = self.at;
            while self
                .kind()
                .is_some_and(|kind| kind != Kind::Symbol(b':') && kind != Kind::Symbol(b';'))
            {
                self.at += 1;
            }
            conditions.push(case + 1..self.at);
            if !self.takes_symbol(b':') {
                self.fault(
                    case..case + 1,
                    "a colon is missing behind it",
                    "end it with :",
                );
            }
            if is_default {
                choice = Choice::OneOfAll;
            }
            let mut block = Vec::new();
            self.block(&mut block, depth + 1);
            blocks.push(block);
        }
        self.close(start, "ENDTEST");
        Statement::Branches {
            conditions,
            choice,
            blocks,
            whole: start..self.at,
        }
    }

    pub(super) fn branches(&mut self, start: usize, depth: usize) -> Option<Statement> {
        let mut conditions = vec![self.condition()];
        if !self.takes("THEN") {
            // One statement without THEN.
            let mut block = Vec::new();
            if self.is_keyword(self.at) {
                if !self.structure(&mut block, depth + 1) {
                    self.fault(
                        start..self.at.max(start + 1),
                        "THEN is missing",
                        "write THEN behind the condition",
                    );
                }
            } else {
                block.extend(self.simple());
            }
            return Some(Statement::Branches {
                conditions,
                choice: Choice::Compact,
                blocks: vec![block],
                whole: start..self.at,
            });
        }
        let mut blocks = Vec::new();
        let mut choice = Choice::AtMostOne;
        loop {
            let mut block = Vec::new();
            self.block(&mut block, depth + 1);
            blocks.push(block);
            if self.takes("ELSEIF") {
                let condition = self.condition();
                conditions.push(condition);
                if !self.takes("THEN") {
                    self.fault(
                        self.at..self.at + 1,
                        "THEN is missing before it",
                        "write THEN behind the condition",
                    );
                }
            } else if self.takes("ELSE") {
                choice = Choice::OneOfAll;
            } else {
                break;
            }
        }
        self.close(start, "ENDIF");
        Some(Statement::Branches {
            conditions,
            choice,
            blocks,
            whole: start..self.at,
        })
    }

    /// An expression: it ends at THEN, or where a word follows an operand.
    pub(super) fn condition(&mut self) -> Range<usize> {
        let start = self.at;
        let mut open = 0_usize;
        let mut operand = false;
        while let Some(kind) = self.kind() {
            match kind {
                Kind::Symbol(b'(' | b'[' | b'{') => {
                    open += 1;
                    operand = false;
                }
                Kind::Symbol(b')' | b']' | b'}') => {
                    open = open.saturating_sub(1);
                    operand = true;
                }
                Kind::Symbol(b';') => break,
                Kind::Word if OPERATORS.iter().any(|word| self.is(word)) => operand = false,
                Kind::Word if self.is_keyword(self.at) => break,
                Kind::Word if open == 0 && (operand || self.is("THEN")) => break,
                Kind::Symbol(b'%') if open == 0 && operand => break,
                Kind::Word | Kind::Number | Kind::Text => operand = true,
                _ => operand = false,
            }
            self.at += 1;
        }
        start..self.at
    }

    /// An assignment, a call, a label or a connection.
    pub(super) fn simple(&mut self) -> Option<Statement> {
        let start = self.at;
        let next = self.file.tokens.get(start + 1).map(|token| token.kind);
        if self.kind() == Some(Kind::Word) && next == Some(Kind::Symbol(b':')) {
            self.at += 2;
            return Some(Statement::Label { at: start });
        }
        let tokens = self.rest_of_statement(start);
        if tokens.is_empty() {
            self.at += 1;
            return None;
        }
        let begins = self.file.tokens.get(start).map(|token| token.kind);
        if !matches!(begins, Some(Kind::Word | Kind::Symbol(b'%'))) {
            self.fault(
                tokens,
                "no statement begins so",
                "mend it: the module must compile on the controller",
            );
            return None;
        }
        // The assignment follows the name, its components and its index; `\WObj:=` belongs to a call.
        let assign = tokens.clone().find(|at| {
            let kind = self.file.tokens[*at].kind;
            matches!(kind, Kind::Assign | Kind::Symbol(b'\\' | b','))
        });
        let is_assignment = |at: &usize| self.file.tokens[*at].kind == Kind::Assign;
        Some(match assign.filter(is_assignment) {
            Some(assign) => Statement::Assignment { tokens, assign },
            None => Statement::Call { tokens },
        })
    }
}

//! Statements of a program: each stands on a line of its own.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::{Choice, LoopKind, Routine, RoutineKind, Sight, Statement};
use crate::table::Treatment;
use crate::val3::expression::expression_of;
use crate::val3::instructions::{is_motion, row};
use crate::val3::xml::Draft;

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

/// Words before which a block ends.
const ENDS: [&str; 11] = [
    "ELSEIF",
    "ELSE",
    "ENDIF",
    "ENDWHILE",
    "ENDFOR",
    "UNTIL",
    "CASE",
    "DEFAULT",
    "BREAK",
    "ENDSWITCH",
    "END",
];

const MEND_IT: &str = "mend it: the program must compile on the controller";

/// The routine that the text of a program is.
pub(super) fn routine_of(
    file: &TokenFile<'_>,
    draft: Draft,
    faults: &mut Vec<ProgramError>,
) -> Routine {
    let mut lines: Vec<Range<usize>> = Vec::new();
    for at in draft.code.clone() {
        match lines.last_mut() {
            Some(line) if file.line_of(line.start) == file.line_of(at) => line.end = at + 1,
            _ => lines.push(at..at + 1),
        }
    }
    let mut parser = Parser {
        file,
        lines,
        at: 0,
        faults,
    };
    if !parser.takes("BEGIN") {
        parser.fault(
            draft.name_at..draft.name_at + 1,
            "no `begin` opens the text of the program",
        );
    }
    let first = parser.here().map_or(draft.code.end, |line| line.start);
    let mut body = Vec::new();
    loop {
        body.extend(parser.block(0));
        match parser.here() {
            Some(line) if !parser.is("END") => parser.fault(line, "nothing is open that it ends"),
            Some(_) => {
                if let Some(line) = parser.lines.get(parser.at + 1).cloned() {
                    parser.fault(line, "it stands behind the end of the program");
                }
                break;
            }
            None => {
                parser.fault(
                    draft.name_at..draft.name_at + 1,
                    "no `end` closes the text of the program",
                );
                break;
            }
        }
        parser.at += 1;
    }
    let last = parser.here().map_or(draft.code.end, |line| line.start);
    Routine {
        kind: RoutineKind::Procedure,
        sight: Sight::Everywhere,
        name: draft.name,
        name_at: draft.name_at,
        parameters: draft.parameters,
        data: draft.data,
        body,
        handlers: Vec::new(),
        whole: draft.whole,
        statements: first..last,
    }
}

struct Parser<'f, 'a> {
    file: &'f TokenFile<'a>,
    lines: Vec<Range<usize>>,
    at: usize,
    faults: &'f mut Vec<ProgramError>,
}

impl Parser<'_, '_> {
    fn here(&self) -> Option<Range<usize>> {
        self.lines.get(self.at).cloned()
    }

    fn is(&self, word: &str) -> bool {
        self.here()
            .is_some_and(|line| self.file.is_word(line.start, word))
    }

    fn takes(&mut self, word: &str) -> bool {
        let found = self.is(word);
        self.at += usize::from(found);
        found
    }

    fn fault(&mut self, tokens: Range<usize>, reason: &str) {
        let file = self.file;
        note(self.faults, || {
            ProgramError::at(file.source, file.span(&tokens), reason, MEND_IT)
        });
    }

    /// The closing line of what begins at a line.
    fn close(&mut self, start: usize, word: &str) {
        if !self.takes(word) {
            self.fault(start..start + 1, &format!("no `{word}` ends it"));
        }
    }

    /// An expression that is understood.
    fn checked(&mut self, tokens: &Range<usize>) -> Expression {
        let found = expression_of(self.file, tokens.clone());
        if found.node == Node::Unreadable {
            let place = if tokens.is_empty() {
                tokens.start.saturating_sub(1)..tokens.start
            } else {
                tokens.clone()
            };
            self.fault(place, "it is no expression that is understood here");
        }
        self.refuse_motions(tokens);
        found
    }

    fn refuse_motions(&mut self, tokens: &Range<usize>) {
        for at in tokens.clone().filter(|at| self.file.is(at + 1, b'(')) {
            let is_own = self.file.name(at).is_some_and(|name| {
                let refused = row(&name)
                    .is_some_and(|row| matches!(row.treatment, Treatment::Refused { .. }));
                refused || is_motion(&name)
            });
            if is_own {
                self.fault(
                    at..at + 1,
                    "it may move the tool, and stands within a statement",
                );
            }
        }
    }

    fn block(&mut self, depth: usize) -> Vec<Statement> {
        let mut statements = Vec::new();
        while let Some(line) = self.here() {
            if ENDS.iter().any(|word| self.is(word)) {
                break;
            }
            if depth >= DEEPEST {
                self.fault(line, "blocks are nested deeper than 100");
                // The text after it is not read.
                self.at = self.lines.len();
                break;
            }
            self.at += 1;
            statements.extend(self.statement(line, depth + 1));
        }
        statements
    }

    fn statement(&mut self, line: Range<usize>, depth: usize) -> Option<Statement> {
        let Range { start, end } = line;
        let is = |word: &str| self.file.is_word(start, word);
        let behind = start + 1..end;
        Some(match () {
            () if is("IF") => self.branches(line, depth),
            () if is("SWITCH") => self.switch(line, depth),
            () if is("WHILE") => self.repeated(LoopKind::While, line, depth),
            () if is("FOR") => self.repeated(LoopKind::Counting, line, depth),
            () if is("DO") => self.until(line, depth),
            () if is("RETURN") && behind.is_empty() => Statement::Leaves { tokens: line },
            () if is("CALL") => self.called(line, behind)?,
            // The name of the task, how often it runs, and its program.
            () if is("TASKCREATE") || is("TASKCREATESYNC") => {
                if !behind.clone().any(|at| self.file.is(at + 1, b'(')) {
                    self.fault(line.clone(), "it names no program");
                }
                Statement::Call { tokens: line }
            }
            () => self.simple(line)?,
        })
    }

    /// An assignment, or the call of a function.
    fn simple(&mut self, line: Range<usize>) -> Option<Statement> {
        let assign = line
            .clone()
            .find(|at| self.file.tokens[*at].kind == Kind::Assign);
        let Some(assign) = assign else {
            return self.called(line.clone(), line);
        };
        // The number of a motion is known to the controller alone.
        if self
            .file
            .name(assign + 1)
            .is_some_and(|name| is_motion(&name))
        {
            return self.called(line.clone(), assign + 1..line.end);
        }
        let place = self.checked(&(line.start..assign));
        self.checked(&(assign + 1..line.end));
        if !matches!(
            place.node,
            Node::Word(_) | Node::Field(..) | Node::Element(..) | Node::Unreadable
        ) {
            self.fault(line.start..assign, "nothing can be assigned to it");
        }
        Some(Statement::Assignment {
            tokens: line,
            assign,
        })
    }

    /// A line with one call; its arguments are read as those of an instruction.
    fn called(&mut self, line: Range<usize>, call: Range<usize>) -> Option<Statement> {
        let is_call = matches!(expression_of(self.file, call.clone()).node, Node::Call(..));
        if !is_call {
            self.fault(line, "no statement begins so");
            return None;
        }
        self.refuse_motions(&(call.start + 2..call.end));
        let tokens = if self.file.is_word(line.start, "CALL") {
            line
        } else {
            call
        };
        Some(Statement::Call { tokens })
    }

    fn condition(&mut self, line: &Range<usize>) -> Range<usize> {
        let has_then = line.len() > 1 && self.file.is_word(line.end - 1, "THEN");
        let tokens = line.start + 1..line.end - usize::from(has_then);
        self.checked(&tokens);
        tokens
    }

    fn branches(&mut self, line: Range<usize>, depth: usize) -> Statement {
        let start = line.start;
        let mut conditions = vec![self.condition(&line)];
        let mut choice = Choice::AtMostOne;
        let mut blocks = vec![self.block(depth)];
        while let Some(line) = self.here().filter(|_| choice == Choice::AtMostOne) {
            if self.takes("ELSEIF") {
                conditions.push(self.condition(&line));
            } else if line.len() == 1 && self.takes("ELSE") {
                choice = Choice::OneOfAll;
            } else {
                break;
            }
            blocks.push(self.block(depth));
        }
        self.close(start, "ENDIF");
        Statement::Branches {
            conditions,
            choice,
            blocks,
            whole: self.whole(start),
        }
    }

    fn switch(&mut self, line: Range<usize>, depth: usize) -> Statement {
        let mut conditions = vec![self.condition(&line)];
        let mut choice = Choice::AtMostOne;
        let mut blocks = Vec::new();
        while let Some(case) = self.here() {
            if self.takes("DEFAULT") {
                choice = Choice::OneOfAll;
                conditions.push(case.end..case.end);
            } else if self.takes("CASE") {
                conditions.push(case.start + 1..case.end);
            } else {
                break;
            }
            blocks.push(self.block(depth));
            if !self.takes("BREAK") && !self.is("ENDSWITCH") {
                self.fault(case, "no `break` ends the case");
            }
        }
        self.close(line.start, "ENDSWITCH");
        Statement::Branches {
            conditions,
            choice,
            blocks,
            whole: self.whole(line.start),
        }
    }

    fn repeated(&mut self, kind: LoopKind, line: Range<usize>, depth: usize) -> Statement {
        let (header, end) = match kind {
            LoopKind::Counting => {
                self.refuse_motions(&line);
                (line.start + 1..line.end, "ENDFOR")
            }
            _ => (self.condition(&line), "ENDWHILE"),
        };
        let block = self.block(depth);
        self.close(line.start, end);
        Statement::Loop {
            kind,
            header,
            block,
            whole: self.whole(line.start),
        }
    }

    fn until(&mut self, line: Range<usize>, depth: usize) -> Statement {
        let block = self.block(depth);
        let header = match self.here().filter(|_| self.is("UNTIL")) {
            Some(until) => self.condition(&until),
            None => line.clone(),
        };
        self.close(line.start, "UNTIL");
        Statement::Loop {
            kind: LoopKind::Until,
            header,
            block,
            whole: self.whole(line.start),
        }
    }

    /// The tokens from a line to the last that was taken.
    fn whole(&self, start: usize) -> Range<usize> {
        let last = self.at.checked_sub(1).and_then(|at| self.lines.get(at));
        start..last.map_or(start, |line| line.end)
    }
}

//! Branches and loops.

use std::ops::Range;

use crate::krl::parser::cursor::{Block, Parser};
use crate::krl::tree::{Least, Statement};

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

impl Parser<'_, '_> {
    pub(super) fn statement(&mut self, line: usize, tokens: &Range<usize>) {
        let Some(word) = self.file.name(tokens.start) else {
            return self.push(Statement::Simple(line));
        };
        let looped = |word: &'static str| Block::Loop {
            header: line,
            word,
            block: Vec::new(),
        };
        let letters = word.letters();
        let is_label = tokens.len() == 2 && self.file.is(tokens.start + 1, b':');
        match letters {
            _ if is_label => self.push(Statement::Label),
            b"IF" | b"SWITCH" => {
                let block = Block::Branches {
                    header: line,
                    is_switch: letters == b"SWITCH",
                    complete: false,
                    blocks: Vec::new(),
                    now: Vec::new(),
                };
                self.open(tokens, block);
            }
            b"ELSE" => self.next_branch(tokens, false, true),
            b"CASE" => self.next_branch(tokens, true, false),
            b"DEFAULT" => self.next_branch(tokens, true, true),
            b"ENDIF" => self.end_branches(tokens, false),
            b"ENDSWITCH" => self.end_branches(tokens, true),
            b"LOOP" => self.open(tokens, looped("LOOP")),
            b"FOR" => self.open(tokens, looped("FOR")),
            b"WHILE" => self.open(tokens, looped("WHILE")),
            b"REPEAT" => self.open(tokens, looped("REPEAT")),
            b"ENDLOOP" => self.end_loop(tokens, "LOOP"),
            b"ENDFOR" => self.end_loop(tokens, "FOR"),
            b"ENDWHILE" => self.end_loop(tokens, "WHILE"),
            b"UNTIL" => self.end_loop(tokens, "REPEAT"),
            b"EXIT" => self.push(Statement::Exit),
            b"RETURN" => self.push(Statement::Leaves(line)),
            b"GOTO" => {
                if let Some(routine) = &mut self.routine {
                    routine.jumps = true;
                }
                self.push(Statement::Leaves(line));
            }
            _ => self.push(Statement::Simple(line)),
        }
    }

    /// Ends the routine and what is open in it.
    pub(super) fn close(&mut self) {
        while let Some(block) = self.blocks.pop() {
            let header = match &block {
                Block::Branches { header, .. } | Block::Loop { header, .. } => *header,
            };
            if !self.lost {
                let tokens = self.file.lines[header].tokens.clone();
                self.fault(
                    &tokens,
                    "the block has no end",
                    "close it as the controller does",
                );
            }
            self.lost = true;
            let statement = finished(block);
            self.push(statement);
        }
        self.content.routines.extend(self.routine.take());
    }

    pub(super) fn open(&mut self, tokens: &Range<usize>, block: Block) {
        if self.blocks.len() == DEEPEST && !self.lost {
            self.lost = true;
            self.fault(
                tokens,
                "blocks are nested deeper than 100",
                "put what is deepest into a routine",
            );
        }
        if self.blocks.len() < DEEPEST {
            self.blocks.push(block);
        }
    }

    pub(super) fn next_branch(&mut self, tokens: &Range<usize>, of_switch: bool, is_last: bool) {
        match self.blocks.last_mut() {
            Some(Block::Branches {
                is_switch,
                complete,
                blocks,
                now,
                ..
            }) if *is_switch == of_switch => {
                blocks.push(std::mem::take(now));
                *complete |= is_last;
            }
            _ => self.misplaced(tokens),
        }
    }

    pub(super) fn misplaced(&mut self, tokens: &Range<usize>) {
        if !self.lost {
            self.lost = true;
            self.fault(
                tokens,
                "it closes no block that is open here",
                "close blocks in the order in which they are opened",
            );
        }
    }

    pub(super) fn end_branches(&mut self, tokens: &Range<usize>, of_switch: bool) {
        match self.blocks.pop() {
            Some(block @ Block::Branches { is_switch, .. }) if is_switch == of_switch => {
                let statement = finished(block);
                self.push(statement);
            }
            other => {
                self.blocks.extend(other);
                self.misplaced(tokens);
            }
        }
    }

    pub(super) fn end_loop(&mut self, tokens: &Range<usize>, opened: &str) {
        match self.blocks.pop() {
            Some(block @ Block::Loop { word, .. }) if word == opened => {
                let statement = finished(block);
                self.push(statement);
            }
            other => {
                self.blocks.extend(other);
                self.misplaced(tokens);
            }
        }
    }
}

fn finished(block: Block) -> Statement {
    match block {
        Block::Branches {
            header,
            is_switch,
            complete,
            mut blocks,
            now,
        } => {
            blocks.push(now);
            // What stands between SWITCH and the first CASE never runs.
            if is_switch && blocks.len() > 1 {
                blocks.remove(0);
            }
            Statement::Branches {
                header,
                complete,
                blocks,
            }
        }
        Block::Loop {
            header,
            word,
            block,
        } => {
            let least = match word {
                "LOOP" | "REPEAT" => Least::Once,
                _ => Least::Never,
            };
            Statement::Loop {
                header,
                least,
                block,
            }
        }
    }
}

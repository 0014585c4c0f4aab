//! Branches and loops.

use std::ops::Range;

use crate::krl::parser::cursor::{Block, JOINT_SPLINE, Parser};
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
            b"SPLINE" => self.begin_spline(line, tokens, "SPLINE"),
            b"PTP_SPLINE" => self.begin_spline(line, tokens, JOINT_SPLINE),
            b"ENDSPLINE" => self.end_spline(line, tokens),
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
            if !self.lost {
                self.no_end(&block);
            }
            self.lost = true;
            self.leave(block, None);
        }
        self.content.routines.extend(self.routine.take());
    }

    /// Refuses a block that is open where it must not be.
    fn no_end(&mut self, block: &Block) {
        let (header, word, end) = block.words();
        let tokens = self.file.lines[header].tokens.clone();
        let remedy = match word {
            "SPLINE" => "write ENDSPLINE behind its last segment".to_owned(),
            _ => format!("write {end} where it ends"),
        };
        let reason = format!("the block has no end: there is no {end} that closes it");
        self.fault(&tokens, reason, &remedy);
    }

    /// Puts a block that is closed, by the line of its end if there is one, among the statements around it.
    fn leave(&mut self, block: Block, end: Option<usize>) {
        let (header, word, block) = match block {
            Block::Spline {
                header,
                word,
                block,
            } => (header, word, block),
            other => {
                let statement = finished(other);
                return self.push(statement);
            }
        };
        if word == JOINT_SPLINE {
            return self.push(Statement::Simple(header));
        }
        // Without an end there is none: what is behind it is not said to be wrong in it.
        let words = end.map(|end| [header, end].map(Statement::Simple));
        let [first, last] = match words {
            Some([first, last]) => [Some(first), Some(last)],
            None => [None, None],
        };
        for statement in first.into_iter().chain(block).chain(last) {
            self.push(statement);
        }
    }

    fn begin_spline(&mut self, line: usize, tokens: &Range<usize>, word: &'static str) {
        // A block in another one is that one without its end.
        if let Some(open) = self
            .blocks
            .pop_if(|block| matches!(block, Block::Spline { .. }))
        {
            self.no_end(&open);
            self.leave(open, None);
        }
        let block = Block::Spline {
            header: line,
            word,
            block: Vec::new(),
        };
        self.open(tokens, block);
    }

    fn end_spline(&mut self, line: usize, tokens: &Range<usize>) {
        let open = self
            .blocks
            .pop_if(|block| matches!(block, Block::Spline { .. }));
        match open {
            Some(block) => self.leave(block, Some(line)),
            None => self.misplaced(tokens),
        }
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
            let remedy = match self.blocks.last().map(Block::words) {
                Some((header, word, end)) => {
                    let span = self.file.span(&self.file.lines[header].tokens);
                    let line = self.file.source.line_of(span.start);
                    format!("close the {word} of line {line} with {end} before it")
                }
                None => "remove it, or open its block before it".to_owned(),
            };
            self.fault(tokens, "it closes no block that is open here", &remedy);
        }
    }

    pub(super) fn end_branches(&mut self, tokens: &Range<usize>, of_switch: bool) {
        self.end(
            tokens,
            |block| matches!(block, Block::Branches { is_switch, .. } if *is_switch == of_switch),
        );
    }

    pub(super) fn end_loop(&mut self, tokens: &Range<usize>, opened: &str) {
        self.end(
            tokens,
            |block| matches!(block, Block::Loop { word, .. } if *word == opened),
        );
    }

    /// Ends the last block, if it is the one that is ended here.
    fn end(&mut self, tokens: &Range<usize>, is_meant: impl Fn(&Block) -> bool) {
        match self.blocks.pop() {
            Some(block) if is_meant(&block) => {
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
        // Its statements stand among those around it.
        Block::Spline { header, .. } => Statement::Simple(header),
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

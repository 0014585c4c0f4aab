//! State of the parser of a file at a line; branches and loops.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Choice, DatumNode, LoopKind, Preset, Routine, Statement};
use crate::krl::lex::assignment;
use crate::text::Name;

/// Deepest nesting of blocks.
const DEEPEST: usize = 100;

impl Parser<'_, '_> {
    pub(super) fn statement(&mut self, tokens: &Range<usize>) {
        let Some(word) = self.file.name(tokens.start) else {
            return self.push(Statement::Call {
                tokens: tokens.clone(),
            });
        };
        let looped = |word: &'static str| Block::Loop {
            header: tokens.clone(),
            word,
            block: Vec::new(),
        };
        let letters = word.letters();
        let is_label = tokens.len() == 2 && self.file.is(tokens.start + 1, b':');
        match letters {
            _ if is_label => self.push(Statement::Label { at: tokens.start }),
            b"IF" | b"SWITCH" => {
                let then = tokens.clone().find(|at| self.file.is_word(*at, "THEN"));
                let condition = tokens.start + 1..then.unwrap_or(tokens.end);
                let block = Block::Branches {
                    header: tokens.clone(),
                    is_switch: letters == b"SWITCH",
                    conditions: vec![condition],
                    is_complete: false,
                    blocks: Vec::new(),
                    now: Vec::new(),
                };
                self.open(tokens, block);
            }
            b"ELSE" => self.next_branch(tokens, None),
            b"CASE" => self.next_branch(tokens, Some(tokens.start + 1..tokens.end)),
            b"DEFAULT" => self.next_branch(tokens, Some(tokens.end..tokens.end)),
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
            b"SPLINE" => self.begin_spline(tokens, "SPLINE"),
            b"PTP_SPLINE" => self.begin_spline(tokens, JOINT_SPLINE),
            b"ENDSPLINE" => self.end_spline(tokens),
            b"EXIT" | b"RETURN" | b"GOTO" => self.push(Statement::Leaves {
                tokens: tokens.clone(),
            }),
            _ => {
                let second = tokens.start + 1;
                let is_place = b"=.[".iter().any(|byte| self.file.is(second, *byte));
                let assign = assignment(self.file, tokens).filter(|_| is_place);
                let tokens = tokens.clone();
                self.push(match assign {
                    Some(assign) => Statement::Assignment { tokens, assign },
                    None => Statement::Call { tokens },
                });
            }
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
        let tokens = header.clone();
        let remedy = match word {
            "SPLINE" => "write ENDSPLINE behind its last segment".to_owned(),
            _ => format!("write {end} where it ends"),
        };
        let reason = format!("the block has no end: there is no {end} that closes it");
        self.fault(&tokens, reason, &remedy);
    }

    /// Puts a block that is closed, by the tokens of its end if there is one, among the statements around it.
    fn leave(&mut self, block: Block, end: Option<Range<usize>>) {
        let Block::Spline {
            header,
            word,
            block,
        } = block
        else {
            let statement = finished(block, &end.unwrap_or_default());
            return self.push(statement);
        };
        if word == JOINT_SPLINE {
            return self.push(Statement::Call { tokens: header });
        }
        // Without an end there is none: what is behind it is not said to be wrong in it.
        let word = |tokens: Range<usize>| Statement::Call { tokens };
        let [first, last] = match end {
            Some(end) => [Some(word(header)), Some(word(end))],
            None => [None, None],
        };
        for statement in first.into_iter().chain(block).chain(last) {
            self.push(statement);
        }
    }

    fn begin_spline(&mut self, tokens: &Range<usize>, word: &'static str) {
        // A block in another one is that one without its end.
        if let Some(open) = self
            .blocks
            .pop_if(|block| matches!(block, Block::Spline { .. }))
        {
            self.no_end(&open);
            self.leave(open, None);
        }
        let block = Block::Spline {
            header: tokens.clone(),
            word,
            block: Vec::new(),
        };
        self.open(tokens, block);
    }

    fn end_spline(&mut self, tokens: &Range<usize>) {
        let open = self
            .blocks
            .pop_if(|block| matches!(block, Block::Spline { .. }));
        match open {
            Some(block) => self.leave(block, Some(tokens.clone())),
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

    /// ELSE of IF, or CASE and DEFAULT of SWITCH with the tokens of the values, none for DEFAULT.
    pub(super) fn next_branch(&mut self, tokens: &Range<usize>, case: Option<Range<usize>>) {
        match self.blocks.last_mut() {
            Some(Block::Branches {
                is_switch,
                conditions,
                is_complete,
                blocks,
                now,
                ..
            }) if *is_switch == case.is_some() => {
                blocks.push(std::mem::take(now));
                *is_complete |= case.as_ref().is_none_or(Range::is_empty);
                conditions.extend(case);
            }
            _ => self.misplaced(tokens),
        }
    }

    pub(super) fn misplaced(&mut self, tokens: &Range<usize>) {
        if !self.lost {
            self.lost = true;
            let remedy = match self.blocks.last().map(Block::words) {
                Some((header, word, end)) => {
                    let line = self.file.line_of(header.start);
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
                let statement = finished(block, tokens);
                self.push(statement);
            }
            other => {
                self.blocks.extend(other);
                self.misplaced(tokens);
            }
        }
    }
}

/// The statement that a block is, by the tokens of the line that closes it.
fn finished(block: Block, end: &Range<usize>) -> Statement {
    let whole = |header: &Range<usize>| header.start..header.end.max(end.end);
    match block {
        Block::Branches {
            header,
            is_switch,
            conditions,
            is_complete,
            mut blocks,
            now,
        } => {
            blocks.push(now);
            // Statements between SWITCH and the first CASE never run.
            if is_switch {
                blocks.remove(0);
            }
            Statement::Branches {
                conditions,
                choice: match is_complete {
                    true => Choice::OneOfAll,
                    false => Choice::AtMostOne,
                },
                blocks,
                whole: whole(&header),
            }
        }
        // Statements of the block belong to the surrounding ones.
        Block::Spline { header, .. } => Statement::Call { tokens: header },
        Block::Loop {
            header,
            word,
            block,
        } => {
            let kind = match word {
                "FOR" => LoopKind::Counting,
                "WHILE" => LoopKind::While,
                "REPEAT" => LoopKind::Until,
                _ => LoopKind::Endless,
            };
            let behind = |line: &Range<usize>| line.start + 1..line.end.max(line.start + 1);
            Statement::Loop {
                kind,
                header: match kind {
                    LoopKind::Until => behind(end),
                    LoopKind::Endless => header.clone(),
                    LoopKind::Counting | LoopKind::While => behind(&header),
                },
                block,
                whole: whole(&header),
            }
        }
    }
}

/// The content of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Content {
    pub data: Vec<DatumNode>,
    pub presets: Vec<Preset>,
    pub routines: Vec<Routine>,
    /// The name behind DEFDAT.
    pub list: Option<Name>,
}

/// A block that is not closed yet, with the tokens of the line that opens it.
pub(super) enum Block {
    Branches {
        header: Range<usize>,
        is_switch: bool,
        /// Condition of IF; selector of SWITCH, and the values of each CASE.
        conditions: Vec<Range<usize>>,
        is_complete: bool,
        blocks: Vec<Vec<Statement>>,
        now: Vec<Statement>,
    },
    Loop {
        header: Range<usize>,
        word: &'static str,
        block: Vec<Statement>,
    },
    /// SPLINE, or PTP_SPLINE, which is refused as a whole: nothing in it is looked at.
    Spline {
        header: Range<usize>,
        word: &'static str,
        block: Vec<Statement>,
    },
}

impl Block {
    /// The tokens of the line that opens it, with its word and the one that closes it.
    pub fn words(&self) -> (&Range<usize>, &'static str, &'static str) {
        match self {
            Self::Branches {
                header,
                is_switch: true,
                ..
            } => (header, "SWITCH", "ENDSWITCH"),
            Self::Branches { header, .. } => (header, "IF", "ENDIF"),
            Self::Loop { header, word, .. } => (
                header,
                word,
                match *word {
                    "LOOP" => "ENDLOOP",
                    "FOR" => "ENDFOR",
                    "WHILE" => "ENDWHILE",
                    _ => "UNTIL",
                },
            ),
            Self::Spline { header, word, .. } => (header, word, "ENDSPLINE"),
        }
    }
}

/// The joint motions of which one block is.
pub(super) const JOINT_SPLINE: &str = "PTP_SPLINE";

pub(super) struct Parser<'p, 'a> {
    pub file: &'p TokenFile<'a>,
    pub faults: &'p mut Vec<ProgramError>,
    pub content: Content,
    pub routine: Option<Routine>,
    pub blocks: Vec<Block>,
    pub in_list: bool,
    /// Blocks were not nested as they must be: one fault for a routine is enough.
    pub lost: bool,
    pub outside: bool,
}

impl Parser<'_, '_> {
    pub(super) fn fault(&mut self, tokens: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        let span = self.file.span(tokens);
        let source = self.file.source;
        note(self.faults, || {
            ProgramError::at(source, span, reason, remedy)
        });
    }

    pub(super) fn push(&mut self, statement: Statement) {
        match self.blocks.last_mut() {
            Some(Block::Branches { now, .. }) => now.push(statement),
            Some(Block::Loop { block, .. } | Block::Spline { block, .. }) => block.push(statement),
            None => {
                if let Some(routine) = &mut self.routine {
                    routine.body.push(statement);
                }
            }
        }
    }
}

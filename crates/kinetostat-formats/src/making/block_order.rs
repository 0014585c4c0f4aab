//! The lines of programs of blocks in the order in which they run.

use crate::heidenhain::blocks::{Block as Statement, blocks_of};
use crate::heidenhain::flow::{Step, labels_of, order, step_of};
use crate::model::slash_blocks::SlashBlocks;
use crate::siemens::block::{Block, What};
use crate::siemens::values::{Variables, whole};
use crate::text::source::SourceFile;

/// A line in the order of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Running {
    pub line: usize,
    /// The block runs exactly once, unconditionally.
    pub is_certain: bool,
    /// Part of the line that runs here.
    pub part: Part,
}

/// Part of a line that runs at a place of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Part {
    /// The rest of it: what stands on it behind the calls that are followed.
    Rest,
    /// A call and no more; what it calls stands behind it.
    Call,
    /// Text before the call of a routine (its name in capitals); the routine's lines follow.
    Before(String),
}

/// Running blocks of a Heidenhain program, with the labels that it calls.
pub(crate) fn running_blocks(source: &SourceFile) -> Vec<Running> {
    let bytes = source.bytes();
    let blocks = blocks_of(bytes);
    let begins = |block: &Statement| {
        let words = block.words(bytes);
        words.first().is_some_and(|word| word.is("BEGIN"))
    };
    let first = blocks.iter().position(begins).unwrap_or(0);
    let (labels, _) = labels_of(bytes, &blocks);
    let step = |at: usize| step_of(bytes, &blocks[at], SlashBlocks::Run);
    let ordered = order(first, blocks.len(), &labels, step).unwrap_or_default();
    let lines = |at: usize| {
        let lines = &blocks[at].lines;
        let is_followed = matches!(step(at), Step::Call(_));
        let last = source.line_of(lines.end.saturating_sub(1).max(lines.start));
        (source.line_of(lines.start)..=last).map(move |line| Running {
            line,
            is_certain: true,
            part: match is_followed {
                true => Part::Call,
                false => Part::Rest,
            },
        })
    };
    (0..first).chain(ordered).flat_map(lines).collect()
}

/// Running blocks of a SINUMERIK program with linear control flow: up to the block that ends it.
pub(crate) fn until_end(source: &SourceFile) -> Vec<Running> {
    let last = last_line(source).unwrap_or(source.line_count());
    let certain = |line: usize| Running {
        line,
        is_certain: true,
        part: Part::Rest,
    };
    (1..=last).map(certain).collect()
}

/// The line of the block that ends a program.
fn last_line(source: &SourceFile) -> Option<usize> {
    let variables = Variables::default();
    (1..=source.line_count()).find(|line| {
        let block = Block::of(source.bytes(), source.range_of(*line));
        block.is_ok_and(|(block, _)| {
            block.items.iter().any(|item| match &item.what {
                What::Name => source.part(&item.name).eq_ignore_ascii_case(b"RET"),
                What::Value { value, .. } if source.part(&item.name) == b"M" => {
                    let number = variables.number(source.bytes(), value).ok().and_then(whole);
                    matches!(number, Some(2 | 17 | 30))
                }
                _ => false,
            })
        })
    })
}

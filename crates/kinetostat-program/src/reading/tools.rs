//! Tool in the spindle, block by block.

use std::collections::BTreeSet;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Knowledge, Move, MoveKind, Path, ToolChange, Warning, WarningTopic};
use crate::reading::block::Block;
use crate::reading::options::ReadOptions;
use crate::text::program::Program;

/// Tool words of a program.
#[derive(Default)]
pub(crate) struct ToolWords {
    selected: Option<u32>,
    changed: Vec<ToolChange>,
    named: Vec<ToolChange>,
    lengths: Vec<ToolChange>,
    /// Line of the first M6 that no T has named a tool for.
    by_hand: Option<usize>,
}

impl ToolWords {
    pub fn note(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let line = block.line_number;
        let whole = |letter: u8| {
            let value = block.word(letter)?.value;
            (value.fract() == 0.0 && (0.0..1e9).contains(&value)).then_some(value as u32)
        };
        if let Some(word) = block.word(b'T')
            && whole(b'T').is_none()
        {
            return Err(block.refuse(
                ProgramErrorKind::Tool,
                None,
                &format!("T{} is no number of a tool", word.value),
                "write a whole number that is not negative, such as T2",
            ));
        }
        // D after G96 is the maximum speed of the spindle.
        let of_spindle = block.codes.speed_mode == Some(960);
        for letter in [b'D', b'H']
            .into_iter()
            .filter(|letter| !(of_spindle && *letter == b'D'))
        {
            if let (Some(word), None) = (block.word(letter), whole(letter)) {
                let letter = char::from(letter);
                return Err(block.refuse(
                    ProgramErrorKind::Tool,
                    Some(word),
                    &format!(
                        "{letter}{} is no number of an offset of the tool",
                        word.value
                    ),
                    &format!("write a whole number that is not negative, such as {letter}2"),
                ));
            }
        }
        if let Some(number) = whole(b'T') {
            self.selected = Some(number);
            push(&mut self.named, line, number);
        }
        let has = |tenths: u32| {
            let mut words = block.words.iter();
            words.any(|word| word.letter == b'M' && word.tenths() == tenths)
        };
        match (has(60), self.selected) {
            (true, Some(number)) => push(&mut self.changed, line, number),
            (true, None) => self.by_hand = self.by_hand.or(Some(line)),
            _ => {}
        }
        // M61 Q2 says which tool was put in by hand (LinuxCNC).
        if let (true, Some(number)) = (has(610), whole(b'Q')) {
            push(&mut self.changed, line, number);
        }
        if block.codes.tool_length == Some(430)
            && let Some(number) = whole(b'H').filter(|number| *number > 0)
        {
            push(&mut self.lengths, line, number);
        }
        Ok(())
    }

    /// Fills in the tools of a path and says what does not fit the tools that are known.
    pub fn finish(
        self,
        path: &mut Path,
        program: &Program,
        options: &ReadOptions,
    ) -> Result<(), ProgramError> {
        let lengths = self.lengths.clone();
        path.tool_changes = [self.changed, self.named, self.lengths]
            .into_iter()
            .find(|changes| !changes.is_empty())
            .unwrap_or_default();
        warn_of_other_lengths(path, &lengths);
        match &options.tools {
            None => {
                warn_of_tool_after_cuts(path, self.by_hand);
                warn_of_later_tools(path);
            }
            Some(known) => {
                refuse_unknown_tools(path, program, known)?;
                before_first_tool(path, program, options)?;
            }
        }
        Ok(())
    }
}

fn push(changes: &mut Vec<ToolChange>, line: usize, number: u32) {
    if changes.last().is_none_or(|last| last.number != number) {
        changes.push(ToolChange { line, number });
    }
}

/// `G43 H3` while tool 2 is in the spindle: which of the two has the length?
fn warn_of_other_lengths(path: &mut Path, lengths: &[ToolChange]) {
    let mut reported = BTreeSet::new();
    for length in lengths {
        let Some(tool) = path.tool_on(length.line) else {
            continue;
        };
        if tool != length.number && reported.insert((tool, length.number)) {
            path.warnings.push(Warning::of_corrections(length.line, format!(
                    "G43 H{} takes the length of another tool than T{tool}, which is in the spindle; corrections are those of tool {tool}",
                    length.number
                )));
        }
    }
}

/// Warning of a line from which on another tool may be in the spindle than the one that corrections are made for.
fn of_another_tool(line: usize, what: &str) -> Warning {
    Warning {
        topic: WarningTopic::OneTool,
        ..Warning::new(
            line,
            format!(
                "{what}, and corrections are made for one tool length and one load: from here on they may be those of another tool. Name each tool with its length (and its load) as [[tools]] in the job file, or correct the part of each tool as a program of its own"
            ),
        )
    }
}

/// Warns if the program cuts before its first tool change, with the tool that was in the spindle.
fn warn_of_tool_after_cuts(path: &mut Path, by_hand: Option<usize>) {
    let named = path.tool_changes.first().map(|change| change.line);
    let Some(line) = named.into_iter().chain(by_hand).min() else {
        return;
    };
    let mut cuts = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    if cuts.any(|m| m.line < line) {
        let what = "a tool is taken here after blocks were cut with the one in the spindle";
        path.warnings.push(of_another_tool(line, what));
    }
}

/// Every tool after the first, once.
fn warn_of_later_tools(path: &mut Path) {
    let Some(first) = path.tool_changes.first().map(|change| change.number) else {
        return;
    };
    let mut reported = BTreeSet::from([first]);
    for change in path.tool_changes.clone() {
        if reported.insert(change.number) {
            let what = format!("tool {} comes after tool {first}", change.number);
            path.warnings.push(of_another_tool(change.line, &what));
        }
    }
}

fn refuse_unknown_tools(path: &Path, program: &Program, known: &[u32]) -> Result<(), ProgramError> {
    for (index, change) in path.tool_changes.iter().enumerate() {
        let until = path
            .tool_changes
            .get(index + 1)
            .map_or(usize::MAX, |next| next.line);
        let is_used = path
            .moves
            .iter()
            .any(|motion| (change.line..until).contains(&motion.line));
        if is_used && !known.contains(&change.number) {
            return Err(Block::on(program, change.line)?.refuse(
                ProgramErrorKind::Tool,
                None,
                &format!(
                    "tool {} is not among the tools that are named",
                    change.number
                ),
                "give it in a table [[tools]] of the job file: number and length_mm",
            ));
        }
    }
    Ok(())
}

/// Blocks that move before a tool is named: those that cut need a tool that is known.
fn before_first_tool(
    path: &mut Path,
    program: &Program,
    options: &ReadOptions,
) -> Result<(), ProgramError> {
    // Moves that are carried without a correction need no tool, but cuts do.
    let unnamed = |motion: &&Move| {
        let matters = motion.known != Knowledge::Nothing || motion.kind == MoveKind::Feed;
        matters && path.tool_on(motion.line).is_none()
    };
    let cut = path
        .moves
        .iter()
        .filter(unnamed)
        .find(|m| m.kind == MoveKind::Feed);
    if let (Some(cut), false) = (cut, options.tool_before_first) {
        return Err(Block::on(program, cut.line)?.refuse(
            ProgramErrorKind::Tool, None,
            "the block cuts before the program has named a tool, and the tools are known by number only",
            "name the tool before it (T1 M6), or give the one that is in the spindle at the start as [tool] in the job file",
        ));
    }
    let Some(first) = path.moves.iter().find(unnamed).map(|motion| motion.line) else {
        return Ok(());
    };
    let text = match options.tool_before_first {
        true => {
            "the first blocks move before the program has named a tool; they are corrected for the one under [tool]"
        }
        false => {
            "the first blocks move, without a cut, before the program has named a tool; they are corrected for a tool without length"
        }
    };
    path.warnings.push(Warning::of_corrections(first, text));
    Ok(())
}

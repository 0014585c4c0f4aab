//! Execution order of moves, events and tool changes.

use kinetostat_program::Path;

use crate::making::MakeFinding;
use crate::making::events::{EventKind, SourceEvent};
use crate::making::names::plain;
use crate::making::step::StatedConfiguration;
use crate::model::Language;

/// Numbers of a motion: what acts before it, the motion, and what acts behind it.
const OF_A_MOTION: usize = 3;

/// Motions of a line that have numbers of their own.
const MOTIONS_OF_A_LINE: usize = 256;

/// The last number of a line is that of what acts behind all of its motions.
const OF_A_LINE: usize = OF_A_MOTION * MOTIONS_OF_A_LINE;

/// Statements that are left out are shown up to this many; of further ones the lines.
const MOST_SHOWN: usize = 20;

/// The number of what acts before the motions of a line.
pub(crate) fn before(line: usize) -> usize {
    OF_A_LINE * line
}

/// Order key of a motion, counted from 0 on its line.
pub(crate) fn at(line: usize, motion: usize) -> usize {
    of_motion(line, motion) + 1
}

/// Order key of events after all motions of a line.
pub(crate) fn behind(line: usize) -> usize {
    OF_A_LINE * line + OF_A_LINE - 1
}

/// Order key of events before the motion with this key.
pub(crate) fn before_motion(number: usize) -> usize {
    number - number % OF_A_MOTION
}

fn of_motion(line: usize, motion: usize) -> usize {
    OF_A_LINE * line + OF_A_MOTION * motion.min(MOTIONS_OF_A_LINE - 1)
}

/// Index of each motion on its line: the number of directly preceding motions with the same line.
pub(crate) fn counted_on_lines(lines: &[usize]) -> Vec<usize> {
    let mut last = None;
    let mut count = 0;
    let counted = lines.iter().map(|line| {
        count = match last.replace(*line) == Some(*line) {
            true => count + 1,
            false => 0,
        };
        count
    });
    counted.collect()
}

/// Events and changes of tools by numbers that ascend in the order in which they run.
#[derive(Default)]
pub(crate) struct Course {
    /// Order keys of all moves; `None` if the lines are the order.
    pub of_moves: Option<Vec<usize>>,
    pub events: Vec<(usize, SourceEvent)>,
    pub tools: Vec<(usize, u32)>,
    /// Events without a place among the moves.
    pub left_out: Vec<SourceEvent>,
    /// Language of the source, unless it is G-code.
    pub language: Option<Language>,
    /// Arm configurations of each move, if the source states them in the same language.
    pub configurations: Vec<StatedConfiguration>,
    /// Speeds of rotation and of external axes of each move, if the source states them in the same language.
    pub other_speeds: Vec<Option<Box<str>>>,
}

impl Course {
    /// Sets the places of events to those before the expansion of the program.
    pub(crate) fn show_places(&mut self, place: impl Fn(usize) -> Option<String>) {
        let placed = self.events.iter_mut().map(|(_, event)| event);
        for event in placed.chain(&mut self.left_out) {
            if let Some(place) = place(event.line) {
                event.place = place;
            }
        }
    }

    /// Course in the order of the lines.
    pub(crate) fn of_lines(path: &Path, events: &[SourceEvent]) -> Self {
        let in_order = path
            .moves
            .windows(2)
            .all(|pair| pair[0].line <= pair[1].line);
        let (mut placed, mut left_out) = (Vec::new(), Vec::new());
        match in_order {
            true => {
                placed = events
                    .iter()
                    .map(|event| (place_of(event, event.line), event.clone()))
                    .collect()
            }
            false => left_out = events.to_vec(),
        }
        // Events after a motion follow those before it.
        placed.sort_by_key(|(order, _)| *order);
        let changes = path.tool_changes.iter();
        Self {
            events: placed,
            tools: changes
                .map(|change| (before(change.line), change.number))
                .collect(),
            left_out,
            ..Self::default()
        }
    }

    /// The number of a move.
    pub(crate) fn of_move(&self, index: usize, line: usize) -> usize {
        let own = self.of_moves.as_ref().and_then(|all| all.get(index));
        own.copied().unwrap_or_else(|| at(line, 0))
    }

    /// The tool that is taken last up to a number.
    pub(crate) fn tool_at(&self, order: usize) -> Option<u32> {
        let after = self.tools.partition_point(|(from, _)| *from <= order);
        Some(self.tools.get(after.checked_sub(1)?)?.1)
    }

    /// Finding on the events that are left out.
    pub(crate) fn finding(&self) -> Option<MakeFinding> {
        let lost = || {
            let matter =
                |event: &&SourceEvent| !matches!(event.kind, EventKind::Comment | EventKind::End);
            self.left_out.iter().filter(matter)
        };
        let first = lost().next()?;
        let shown = lost()
            .take(MOST_SHOWN)
            .map(|event| format!("{}: {}", event.place, plain(&event.text)));
        let more = lost().skip(MOST_SHOWN).map(|event| event.place.clone());
        let all: Vec<String> = shown.chain(more).collect();
        Some(MakeFinding::of(
            first.line,
            format!(
                "these statements have no place among the motions (their routine is not called by a statement of its own, or its lines run in another order), and are left out: {}",
                all.join("; ")
            ),
        ))
    }
}

/// The number of an event on a line.
pub(crate) fn place_of(event: &SourceEvent, line: usize) -> usize {
    match (event.motion, event.is_behind) {
        (Some(motion), true) => of_motion(line, motion) + 2,
        (Some(motion), false) => of_motion(line, motion),
        (None, true) => behind(line),
        (None, false) => before(line),
    }
}

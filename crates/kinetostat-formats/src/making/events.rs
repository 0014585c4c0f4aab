//! What a source says beside its moves: spindle, coolant, tools, pauses, comments.

use crate::making::action::EventAction;
use crate::making::event_kind::EventKind;

/// Something that a source says on a line beside its moves.
///
/// ```
/// use kinetostat_formats::{EventKind, events_of_gcode};
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// let program = Program::read("G21 G90\nS8000 M3 (mill)\nG0 X0 Y0 Z5 M8\nG1 Z-1 F300\nM30\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let events = events_of_gcode(&program, &path);
/// let kinds: Vec<_> = events.iter().map(|event| (event.line, event.kind)).collect();
/// assert_eq!(kinds, [(2, EventKind::Spindle), (3, EventKind::Coolant), (5, EventKind::End)]);
/// assert_eq!(events[0].text, "S8000 M3 (mill)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SourceEvent {
    /// Line of the source, counted from 1, by which it finds its place among the moves.
    pub line: usize,
    /// What it is about.
    pub kind: EventKind,
    /// The words of the line that are no motion.
    pub text: String,
    /// Where that stands, for the note: `line 12`, or another file's line.
    pub place: String,
    /// What it does that other languages have, too, in order.
    pub actions: Vec<EventAction>,
    /// What its other words are about; none where the actions are all of it.
    pub rest: Option<EventKind>,
    /// It acts behind the motion of its line, not before.
    pub(crate) is_behind: bool,
    /// Which motion of its line that is, counted from 0; none for all of them.
    pub(crate) motion: Option<usize>,
    /// It states the speed of a spindle that stands still: a made program states it where the spindle starts.
    pub(crate) states_speed: bool,
    /// It names a tool, whatever else it is about.
    pub(crate) is_of_tool: bool,
}

impl SourceEvent {
    /// The words of a line, which do nothing elsewhere.
    pub(crate) fn words_alone(line: usize, kind: EventKind, text: impl Into<String>) -> Self {
        Self {
            line,
            kind,
            text: text.into(),
            place: format!("line {line}"),
            actions: Vec::new(),
            rest: Some(kind),
            is_behind: false,
            motion: None,
            states_speed: false,
            is_of_tool: kind == EventKind::Tool,
        }
    }

    /// It does nothing: whether and how often it runs is not known.
    pub(crate) fn only_words(&mut self) {
        if !self.actions.is_empty() {
            self.actions.clear();
            self.rest = Some(self.kind);
        }
    }

    /// The words of a line that are one action.
    pub(crate) fn acting(line: usize, action: EventAction, text: impl Into<String>) -> Self {
        let kind = action.kind();
        Self {
            actions: vec![action],
            rest: None,
            ..Self::words_alone(line, kind, text)
        }
    }
}

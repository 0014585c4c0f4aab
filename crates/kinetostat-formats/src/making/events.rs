//! Events of a source beside its moves: spindle, coolant, tools, pauses, comments.

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
    /// Subject of the event.
    pub kind: EventKind,
    /// The words of the line that are no motion.
    pub text: String,
    /// Source position for the note: `line 12`, or another file's line.
    pub place: String,
    /// Actions that other languages share, in order.
    pub actions: Vec<EventAction>,
    /// Subject of the other words; `None` if the actions are complete.
    pub rest: Option<EventKind>,
    /// The event acts after the motion of its line, not before.
    pub(crate) is_behind: bool,
    /// Index of its motion on the line, counted from 0; `None` for all of them.
    pub(crate) motion: Option<usize>,
    /// The event sets the speed of a stopped spindle: a made program states it at the spindle's start.
    pub(crate) states_speed: bool,
    /// The event names a tool, in addition to its subject.
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

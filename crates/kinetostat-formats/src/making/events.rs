//! Events of a source beside its moves: spindle, coolant, tools, pauses, comments; their subjects and actions.

use kinetostat_program::SpindleRotation;

use crate::making::limits::MakeLanguage;

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

/// Subject of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum EventKind {
    /// Spindle speed, start and stop.
    Spindle,
    /// Coolant on and off.
    Coolant,
    /// Another tool, its length.
    Tool,
    /// The tool stands still for some time.
    Dwell,
    /// Stop until somebody restarts the program.
    Stop,
    /// A loop that nothing leaves.
    Endless,
    /// Text for people.
    Comment,
    /// The end of the program.
    End,
    /// Anything else.
    Other,
}

impl EventKind {
    /// Description of the subject in reports of losses.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Spindle => "spindle",
            Self::Coolant => "coolant",
            Self::Tool => "tools",
            Self::Dwell => "dwells",
            Self::Stop => "stops",
            Self::Endless => "loops without an end",
            Self::Comment => "comments",
            Self::End => "end of the program",
            Self::Other => "other statements",
        }
    }
}

/// Kind of coolant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Coolant {
    /// `M7`, `COOLNT/MIST`.
    Mist,
    /// `M8`, `COOLNT/FLOOD`.
    Flood,
    /// `M9`, `COOLNT/OFF`.
    Off,
}

/// Action of a statement beside the moves that several languages share.
///
/// ```
/// use kinetostat_formats::{EventAction, events_of_gcode};
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG4 X0.5\nM0\nG1 Z-1 F300\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let actions: Vec<_> = events_of_gcode(&program, &path).into_iter().flat_map(|event| event.actions).collect();
/// assert_eq!(actions, [EventAction::Wait { seconds: 0.5 }, EventAction::Stop]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum EventAction {
    /// The tool stands still for some time.
    Wait {
        /// Dwell in s.
        seconds: f64,
    },
    /// Stop until somebody restarts the program (`M0`, `STOP`, `HALT`, `PAUSE`).
    Stop,
    /// Stop if a switch of the machine is set (`M1`, `OPSTOP`).
    OptionalStop,
    /// The spindle turns otherwise, or stops.
    Spindle {
        /// Sense of rotation.
        rotation: SpindleRotation,
        /// Spindle speed, if known.
        rpm: Option<f64>,
    },
    /// Coolant flows, or no more.
    Coolant(Coolant),
}

/// Longest time that is written, s.
const LONGEST_S: f64 = 1e6;

impl EventAction {
    pub(crate) fn kind(self) -> EventKind {
        match self {
            Self::Wait { .. } => EventKind::Dwell,
            Self::Stop | Self::OptionalStop => EventKind::Stop,
            Self::Spindle { .. } => EventKind::Spindle,
            Self::Coolant(_) => EventKind::Coolant,
        }
    }

    /// True if the spindle turns from here on.
    pub(crate) fn starts_spindle(self) -> bool {
        matches!(self, Self::Spindle { rotation, .. } if rotation != SpindleRotation::Stopped)
    }

    /// True if a language has the action.
    pub(crate) fn is_in(self, language: MakeLanguage) -> bool {
        let of_a_machine = matches!(language, MakeLanguage::Apt | MakeLanguage::Gcode);
        match self {
            Self::Wait { seconds } => {
                (0.0..LONGEST_S).contains(&seconds) && (of_a_machine || language.is_of_an_arm())
            }
            Self::Stop | Self::OptionalStop => of_a_machine || language.is_of_an_arm(),
            Self::Spindle { .. } | Self::Coolant(_) => of_a_machine,
        }
    }
}

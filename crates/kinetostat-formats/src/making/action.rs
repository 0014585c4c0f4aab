//! Actions of statements beside the moves that several languages share.

use kinetostat_program::SpindleRotation;

use crate::making::event_kind::EventKind;
use crate::making::limits::MakeLanguage;

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
        /// In s.
        seconds: f64,
    },
    /// Until somebody starts again (`M0`, `STOP`, `HALT`, `PAUSE`).
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

//! Failure of a command, and its exit code.

use std::fmt::Display;
use std::ops::Range;

use kinetostat_machining::RunError;
use kinetostat_machining::number::apart;
use kinetostat_model::{ModelError, TextStyle, shortened};
use kinetostat_program::WriteError;

use crate::ui::numbers::pose_text;
use crate::ui::safe_text::safe;

/// Exit codes, as in the table of `kinetostat --help`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Code {
    /// The question is wrong: a file, a number, an option.
    WrongInput = 1,
    /// The question is right but has no answer: no convergence, a point out of reach.
    Unanswered = 2,
    /// A program was written, but it misses its tolerance.
    ToleranceMissed = 3,
    /// A program was written that keeps its tolerance only if the stated assumptions hold.
    Doubtful = 4,
    /// Ctrl-C.
    Stopped = 130,
}

/// Report before the program ends.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    pub(crate) code: Code,
    /// Plain text, safe for a terminal.
    pub(crate) plain: String,
    /// Report with colours, if there are any.
    pub(crate) styled: Option<String>,
    /// Position in the job file, bytes.
    pub(crate) place: Option<Range<usize>>,
    /// True if the content of the program was refused: the settings for reading it are right.
    pub(crate) is_of_program: bool,
}

pub(crate) type Answer<T> = Result<T, Failure>;

impl Failure {
    /// Wrong input.
    pub(crate) fn input(message: impl Display) -> Self {
        Self::new(Code::WrongInput, message)
    }

    /// Failure: no answer exists or none was found.
    pub(crate) fn unanswered(message: impl Display) -> Self {
        Self::new(Code::Unanswered, message)
    }

    /// A written program that misses its tolerance.
    pub(crate) fn tolerance_missed(message: impl Display) -> Self {
        Self::new(Code::ToleranceMissed, message)
    }

    pub(crate) fn new(code: Code, message: impl Display) -> Self {
        Self {
            code,
            plain: safe(&shortened(&message.to_string())),
            styled: None,
            place: None,
            is_of_program: false,
        }
    }

    /// Several failures, reported one after the other.
    pub(crate) fn together(failures: Vec<Self>) -> Self {
        let styled = |f: &Self| {
            let plain = || format!("\u{1b}[1;31merror\u{1b}[0m: {}", f.plain);
            f.styled.clone().unwrap_or_else(plain)
        };
        let styled: Vec<String> = failures.iter().map(styled).collect();
        let plain: Vec<String> = failures.iter().map(|f| f.plain.clone()).collect();
        Self {
            code: Code::WrongInput,
            plain: plain.join("\n\nerror: "),
            styled: Some(styled.join("\n\n")),
            place: None,
            is_of_program: false,
        }
    }

    /// Found at a place of the job file: the text with its line is whole, and safe.
    pub(crate) fn located(plain: String, styled: String, place: Range<usize>) -> Self {
        Self {
            code: Code::WrongInput,
            plain,
            styled: Some(styled),
            place: Some(place),
            is_of_program: false,
        }
    }

    /// Adds a possible reason.
    pub(crate) fn with_reason(mut self, reason: &str) -> Self {
        if self.code != Code::Stopped {
            self.plain = format!("{}. Perhaps the reason: {}", self.plain, safe(reason));
            self.styled = None;
        }
        self
    }

    /// Marks it as a failure of the program's content.
    pub(crate) fn of_program(self) -> Self {
        Self {
            is_of_program: true,
            ..self
        }
    }

    /// Puts the name of a file in front.
    pub(crate) fn within(mut self, place: &str) -> Self {
        self.plain = format!("{}: {}", safe(place), self.plain);
        self.styled = None;
        self
    }
}

impl From<ModelError> for Failure {
    fn from(error: ModelError) -> Self {
        let plain = error.rendered(TextStyle::Plain);
        Self {
            code: Code::WrongInput,
            // The model crate has made its text safe; its line structure is wanted.
            plain: plain.strip_prefix("error: ").unwrap_or(&plain).to_owned(),
            styled: Some(error.rendered(TextStyle::Terminal)),
            place: None,
            is_of_program: false,
        }
    }
}

/// Message of a run that Ctrl-C ended.
pub(crate) const STOPPED: &str = "stopped on request; nothing was written";

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Cancelled | RunError::Write(WriteError::Cancelled) => {
                Self::new(Code::Stopped, STOPPED)
            }
            error if error.is_unanswered() => Self::unanswered(error),
            error => Self::input(error),
        }
    }
}

impl From<kinetostat::Error> for Failure {
    fn from(error: kinetostat::Error) -> Self {
        let advice = match &error {
            kinetostat::Error::Unreachable { .. } | kinetostat::Error::OutsideLimits { .. } => {
                "; choose a place inside the workspace, or check the model's limits and the tool's length"
            }
            kinetostat::Error::NotConverged { limit: Some(_), .. } => {
                "; `kinetostat curve` shows how, `kinetostat equilibria` finds the others"
            }
            kinetostat::Error::NotConverged { .. } => {
                "; the load may be beyond what the machine can carry here: try a part of it"
            }
            kinetostat::Error::FreeDirection { .. } => {
                "; leave that part of the load out, or check passive joints and platform"
            }
            _ => "",
        };
        let reported = match &error {
            // Millimetres and degrees, as the place was requested.
            kinetostat::Error::Unreachable {
                place,
                distance_m,
                angle_rad,
                nearest,
            } => format!(
                "{place}: the place cannot be reached; the nearest that was found is {} away: {}",
                apart(1e3 * distance_m, angle_rad.to_degrees()),
                pose_text(nearest)
            ),
            other => other.to_string(),
        };
        let message = format!("{reported}{advice}");
        if error.is_unanswered() {
            Self::unanswered(message)
        } else {
            Self::input(message)
        }
    }
}

//! Failure of a command, and its exit code.

use std::fmt::Display;
use std::ops::Range;

use kinetostat_diagnostic::{Diagnostic, ErrorCode, Location};
use kinetostat_machining::number::apart;
use kinetostat_machining::{RunError, WayOut};
use kinetostat_model::{ModelError, Problem, TextStyle, shortened};
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

/// Exit code of a kind of error.
fn exit_code(code: ErrorCode) -> Code {
    match code {
        ErrorCode::Unreachable
        | ErrorCode::OutsideLimits
        | ErrorCode::NoClosure
        | ErrorCode::NotConverged
        | ErrorCode::FreeDirection
        | ErrorCode::NoAnswer => Code::Unanswered,
        ErrorCode::ToleranceMissed => Code::ToleranceMissed,
        ErrorCode::Doubtful => Code::Doubtful,
        ErrorCode::Stopped => Code::Stopped,
        _ => Code::WrongInput,
    }
}

/// Makes a failure of a code and its message: `ErrorCode::Value.failure("...")`.
pub(crate) trait Failing {
    fn failure(self, message: impl Display) -> Failure;
}

impl Failing for ErrorCode {
    fn failure(self, message: impl Display) -> Failure {
        Failure::new(self, message)
    }
}

/// Report before the program ends.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    /// Plain text, safe for a terminal.
    pub(crate) plain: String,
    /// Report with colours, if there are any.
    pub(crate) styled: Option<String>,
    /// Position in the job file, bytes.
    pub(crate) place: Option<Range<usize>>,
    /// True if the content of the program was refused: the settings for reading it are right.
    pub(crate) is_of_program: bool,
    /// Turn of the tool that was looked for, where an arm cannot follow a program.
    pub(crate) way_out: Option<Box<WayOut>>,
    /// True if what a long run has done so far could not be saved.
    pub(crate) is_not_kept: bool,
    /// Kind of the error.
    kind: ErrorCode,
    /// The faults one by one, where there are several or where they have a location.
    faults: Vec<Diagnostic>,
}

pub(crate) type Answer<T> = Result<T, Failure>;

impl Failure {
    fn new(kind: ErrorCode, message: impl Display) -> Self {
        Self {
            plain: safe(&shortened(&message.to_string())),
            styled: None,
            place: None,
            is_of_program: false,
            way_out: None,
            is_not_kept: false,
            kind,
            faults: Vec::new(),
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
        // Together they are wrong input, whatever else is among them.
        let mut kinds = failures.iter().map(|f| f.kind);
        let kind = kinds.find(|kind| exit_code(*kind) == Code::WrongInput);
        Self {
            plain: plain.join("\n\nerror: "),
            styled: Some(styled.join("\n\n")),
            faults: failures.iter().flat_map(Self::diagnostics).collect(),
            ..Self::new(kind.unwrap_or(ErrorCode::JobFile), "")
        }
    }

    /// Found at a place of the job file: the text with its line is whole, and safe.
    pub(crate) fn located(problem: &Problem, place: Range<usize>) -> Self {
        let plain = problem.rendered(TextStyle::Plain);
        Self {
            plain: plain.strip_prefix("error: ").unwrap_or(plain).to_owned(),
            styled: Some(problem.rendered(TextStyle::Terminal).to_owned()),
            place: Some(place),
            faults: vec![of_problem(ErrorCode::JobFile, problem)],
            ..Self::new(ErrorCode::JobFile, "")
        }
    }

    /// Exit code of the process.
    pub(crate) fn code(&self) -> Code {
        exit_code(self.kind)
    }

    /// The faults for programs.
    pub(crate) fn diagnostics(&self) -> Vec<Diagnostic> {
        match self.faults.is_empty() {
            true => vec![Diagnostic::new(self.kind, &self.plain)],
            false => self.faults.clone(),
        }
    }

    /// Adds the faults one by one.
    pub(crate) fn with_faults(mut self, faults: impl IntoIterator<Item = Diagnostic>) -> Self {
        self.faults.extend(faults);
        self
    }

    /// Adds a possible reason.
    pub(crate) fn with_reason(mut self, reason: &str) -> Self {
        if self.code() != Code::Stopped {
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

/// A problem of a model or job file, for programs.
fn of_problem(code: ErrorCode, problem: &Problem) -> Diagnostic {
    let some = |text: &str| (!text.is_empty()).then(|| text.to_owned());
    let mut diagnostic = Diagnostic::new(code, &problem.message);
    diagnostic.location = Location {
        file: some(&problem.file),
        line: problem.line,
        column: problem.column,
        name: some(&problem.path),
    };
    diagnostic.remedy = some(&problem.help);
    diagnostic
}

impl From<ModelError> for Failure {
    fn from(error: ModelError) -> Self {
        let plain = error.rendered(TextStyle::Plain);
        let plain = plain.strip_prefix("error: ").unwrap_or(&plain).to_owned();
        let faults = error.problems().iter();
        let faults = faults.map(|problem| of_problem(ErrorCode::ModelFile, problem));
        Self {
            // The model crate has made its text safe; its line structure is wanted.
            plain,
            styled: Some(error.rendered(TextStyle::Terminal)),
            ..Self::new(ErrorCode::ModelFile, "").with_faults(faults)
        }
    }
}

/// Message of a run that Ctrl-C ended.
pub(crate) const STOPPED: &str = "stopped on request; nothing was written";

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        if let RunError::Cancelled | RunError::Write(WriteError::Cancelled) = error {
            return Self::new(ErrorCode::Stopped, STOPPED);
        }
        let way_out = match &error {
            RunError::ArmStops { way_out, .. } => Some(Box::new(*way_out)),
            _ => None,
        };
        Self {
            way_out,
            ..Self::new(code_of_run(&error), error)
        }
    }
}

/// Kind of an error of a run.
fn code_of_run(error: &RunError) -> ErrorCode {
    match error {
        RunError::ArmStops { error, .. } => code_of_run(error),
        RunError::Point { cause, .. } | RunError::TouchOff { cause, .. } => code_of(cause),
        error if error.is_unanswered() => ErrorCode::NoAnswer,
        RunError::WeightNotStated { .. } => ErrorCode::Missing,
        _ => ErrorCode::ProgramUnsuited,
    }
}

/// Kind of an error of the mechanics.
fn code_of(error: &kinetostat::Error) -> ErrorCode {
    match error {
        kinetostat::Error::Unreachable { .. } => ErrorCode::Unreachable,
        kinetostat::Error::OutsideLimits { .. } => ErrorCode::OutsideLimits,
        kinetostat::Error::NoClosure { .. } => ErrorCode::NoClosure,
        kinetostat::Error::NotConverged { .. } => ErrorCode::NotConverged,
        kinetostat::Error::FreeDirection { .. } => ErrorCode::FreeDirection,
        kinetostat::Error::UnknownName { .. } => ErrorCode::UnknownName,
        kinetostat::Error::Model { .. } => ErrorCode::ModelUnsuited,
        _ => ErrorCode::Value,
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
        Self::new(code_of(&error), message)
    }
}

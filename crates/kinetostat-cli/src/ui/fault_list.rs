//! Many faults of one file in one message.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::slice;

use kinetostat_cutting::CutError;
use kinetostat_diagnostic::{Diagnostic, ErrorCode, Location};
use kinetostat_formats::{MakeError, PathError, ProgramError, ProgramFault};
use kinetostat_program::{MapError, ProgramError as GcodeError};

use crate::ui::failure::{Failing, Failure};

/// A fault of a file, one of several.
pub(crate) trait Fault: Display {
    /// The reason alone, by which faults are gathered.
    fn reason(&self) -> &str;

    /// The fault for programs.
    fn diagnostic(&self) -> Diagnostic;
}

/// A fault of a line; its parts are those of [`Diagnostic`].
fn at_line(
    code: ErrorCode,
    file: Option<&str>,
    line: Option<usize>,
    found: Option<&str>,
    reason: &str,
    remedy: &str,
) -> Diagnostic {
    let mut diagnostic = Diagnostic::new(code, reason);
    diagnostic.location = Location {
        file: file.map(str::to_owned),
        line,
        ..Location::default()
    };
    diagnostic.found = found.map(str::to_owned);
    diagnostic.remedy = Some(remedy.to_owned());
    diagnostic
}

impl Fault for ProgramError {
    fn reason(&self) -> &str {
        &self.reason
    }

    fn diagnostic(&self) -> Diagnostic {
        let (file, line) = (Some(self.file.as_str()), Some(self.line));
        let found = Some(self.found.as_str());
        let code = ErrorCode::ProgramRefused;
        at_line(code, file, line, found, &self.reason, &self.remedy)
    }
}

impl Fault for GcodeError {
    fn reason(&self) -> &str {
        &self.reason
    }

    fn diagnostic(&self) -> Diagnostic {
        let (line, found) = (Some(self.line), Some(self.found.as_str()));
        let code = ErrorCode::ProgramRefused;
        at_line(code, None, line, found, &self.reason, &self.remedy)
    }
}

impl Fault for MakeError {
    fn reason(&self) -> &str {
        &self.reason
    }

    fn diagnostic(&self) -> Diagnostic {
        let code = match self.is_of_template {
            true => ErrorCode::JobFile,
            false => ErrorCode::ProgramRefused,
        };
        at_line(code, None, self.line, None, &self.reason, &self.remedy)
    }
}

impl Fault for PathError {
    fn reason(&self) -> &str {
        &self.reason
    }

    fn diagnostic(&self) -> Diagnostic {
        let (file, line) = (Some(self.file.as_str()), Some(self.line));
        let code = ErrorCode::ProgramRefused;
        at_line(code, file, line, None, &self.reason, &self.remedy)
    }
}

impl Fault for ProgramFault {
    fn reason(&self) -> &str {
        Self::reason(self)
    }

    fn diagnostic(&self) -> Diagnostic {
        match self {
            Self::Text(fault) => fault.diagnostic(),
            Self::Path(fault) => fault.diagnostic(),
            other => Diagnostic::new(ErrorCode::ProgramRefused, other.to_string()),
        }
    }
}

impl Fault for CutError {
    fn reason(&self) -> &str {
        &self.found
    }

    fn diagnostic(&self) -> Diagnostic {
        let mut diagnostic = Diagnostic::new(ErrorCode::Value, self.to_string());
        diagnostic.location = Location {
            file: self.file.clone(),
            line: self.line,
            name: Some(self.quantity.clone()),
            ..Location::default()
        };
        diagnostic.found = Some(self.found.clone());
        match self.is_suggestion {
            true => diagnostic.remedy = Some(self.expected.clone()),
            false => diagnostic.allowed = Some(self.expected.clone()),
        }
        diagnostic
    }
}

impl Fault for MapError {
    fn reason(&self) -> &str {
        &self.reason
    }

    fn diagnostic(&self) -> Diagnostic {
        let line = usize::try_from(self.line).ok();
        let found = Some(self.found.as_str());
        at_line(
            ErrorCode::FileForm,
            None,
            line,
            found,
            &self.reason,
            &self.remedy,
        )
    }
}

/// All faults of a file, or the only one, as a failure; `places` is what they are: `lines`.
pub(crate) fn failure_of<F: Fault>(code: ErrorCode, places: &str, first: &F, all: &[F]) -> Failure {
    with_text(code, fault_list_text(places, first, all), first, all)
}

/// All faults of a file, or the only one, as a failure with a text of its own.
pub(crate) fn with_text<F: Fault>(code: ErrorCode, text: String, first: &F, all: &[F]) -> Failure {
    let all = if all.is_empty() {
        slice::from_ref(first)
    } else {
        all
    };
    let faults = all.iter().map(Fault::diagnostic);
    code.failure(text).with_faults(faults)
}

/// Faults of one reason that are listed; further ones are counted.
const FAULTS_OF_A_REASON: usize = 3;

/// Places that are named for each reason beside those.
const PLACES_NAMED: usize = 500;

/// Faults listed in all.
const FAULTS_SHOWN: usize = 40;

/// All faults of a file in the order of its lines, or the only one.
pub(crate) fn fault_list_text<F: Fault>(places: &str, first: &F, all: &[F]) -> String {
    if all.len() < 2 {
        return first.to_string();
    }
    let mut lines = vec![format!("{} {places} are refused:", all.len())];
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut shown = 0;
    // Reasons in the order in which they come, each with the line where the places stand that are not shown in full: that of the first
    // of them.
    let mut further: Vec<(&str, usize, Vec<String>)> = Vec::new();
    let mut of_reason: BTreeMap<&str, usize> = BTreeMap::new();
    for fault in all {
        let reason = fault.reason();
        let count = counts.entry(reason).or_default();
        *count += 1;
        if *count <= FAULTS_OF_A_REASON && shown < FAULTS_SHOWN {
            shown += 1;
            lines.push(format!("  {fault}"));
            continue;
        }
        let index = *of_reason.entry(reason).or_insert_with(|| {
            further.push((reason, lines.len(), Vec::new()));
            lines.push(String::new());
            further.len() - 1
        });
        further[index].2.push(place_of(&fault.to_string(), reason));
    }
    for (reason, line, mut places) in further {
        let more = places.len().saturating_sub(PLACES_NAMED);
        places.truncate(PLACES_NAMED);
        let more = match more {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        lines[line] = format!("  {}{more}: {reason}", places.join(", "));
    }
    lines.join("\n")
}

/// Returns the place of a fault: the text before its reason.
fn place_of(fault: &str, reason: &str) -> String {
    let before = fault.split_once(reason).map_or(fault, |(before, _)| before);
    before.trim_end().trim_end_matches(':').to_owned()
}

//! End of a run: its text and JSON on the screen, and the check of its tolerance.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{RunResult, ToleranceResult};

use crate::job::setting::Setting;
use crate::program::flat_lines::WithSources;
use crate::ui::failure::{Answer, Failing};
use crate::ui::json::print_answer;
use crate::ui::screen::{self, Stream};

/// A written program that misses its tolerance has an exit code of its own; files are in place.
pub(crate) fn refuse_missed_tolerance(
    tolerance: &ToleranceResult,
    setting: &Setting,
) -> Answer<()> {
    match tolerance.missed_text() {
        Some(text) => Err(setting.within(ErrorCode::ToleranceMissed.failure(text))),
        None => Ok(()),
    }
}

/// A written program that keeps its tolerance only if its assumptions hold has an exit code of its own; files are in place.
pub(crate) fn refuse_doubtful(result: &RunResult, setting: &Setting) -> Answer<()> {
    match result.at_worst_text() {
        Some(text) => {
            let costliest = result.assessment.assumptions.first();
            let costliest = costliest.map_or("", |assumption| &assumption.text);
            let text = format!("{text} The costliest one: {costliest}");
            Err(setting.within(ErrorCode::Doubtful.failure(text)))
        }
        None => Ok(()),
    }
}

/// Prints the text for people, and the JSON on the standard output if requested.
pub(crate) fn print_run(text: &str, result: Option<&RunResult>) -> Answer<()> {
    match result {
        Some(result) => {
            let flat = result.run_inputs.flat.as_ref();
            print_answer(text, &WithSources(result, flat), true)
        }
        None => screen::print(Stream::Out, text),
    }
}

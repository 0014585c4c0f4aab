//! Measured responses, to be drawn beside the model's.

use std::path::Path;

use kinetostat_chatter::{
    ChatterError, MeasuredResponse, read_columns, read_universal, turning_columns,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode};

use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::ui::failure::{Answer, Failing, Failure};

/// Measured responses, and the rest of the file.
#[derive(Default)]
pub(crate) struct Measured {
    pub(crate) responses: Vec<MeasuredResponse>,
    /// Responses of turns or by moments, which nothing is done with.
    pub(crate) turning: Vec<String>,
}

/// Reads a universal file, or a table with columns as `xx_re_um_per_n`.
pub(crate) fn read(files: &InputFiles, path: &Path) -> Answer<Measured> {
    let text = files.text("measured responses", path)?;
    let mut written = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let universal = written.next() == Some("-1");
    let found = match universal {
        true => read_universal(&text).map(|file| file.responses),
        false => read_columns(&with_decimal_points(&text)),
    };
    let failed = |error| ErrorCode::FileForm.failure(format!("{}: {error}", path.display()));
    Ok(Measured {
        responses: found.map_err(failed)?,
        turning: match universal {
            true => Vec::new(),
            false => turning_columns(&text),
        },
    })
}

/// Warnings about data that a measured file omits, or that belong to another place than the tool's tip.
pub(crate) fn warnings(file: &Measured) -> Vec<Warning> {
    let measured = &file.responses;
    let mut all = Vec::new();
    if !file.turning.is_empty() {
        all.push(Warning::new(
            WarningCode::Model,
            format!(
                "not read of the measured responses, since they are of turns or by moments: {}",
                file.turning.join(", ")
            ),
        ));
    }
    let unit = measured.iter().filter(|m| !m.units_stated).count();
    if unit > 0 {
        all.push(Warning::new(
            WarningCode::Model,
            format!(
                "{unit} of {} measured responses state no units: SI units (m, N) were taken",
                measured.len()
            ),
        ));
    }
    let apart = |m: &&MeasuredResponse| m.response_node != m.reference_node;
    if let Some(first) = measured.iter().find(apart) {
        all.push(Warning::new(
            WarningCode::Model,
            format!(
                "{} of {} measured responses are between two places ('{}': motion of node {} by a force at node {}): the model's are those of the tool's tip by what acts there",
                measured.iter().filter(apart).count(),
                measured.len(),
                first.name,
                first.response_node,
                first.reference_node
            ),
        ));
    }
    all
}

/// Converts an error of a measurement.
pub(crate) fn of_measurement(error: ChatterError) -> Failure {
    ErrorCode::FileForm.failure(format!("measured responses: {error}"))
}

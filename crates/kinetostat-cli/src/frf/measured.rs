//! Measured responses, to be drawn beside the model's.

use std::path::Path;

use kinetostat_chatter::{MeasuredResponse, read_columns, read_universal};
use kinetostat_machining::{Warning, WarningCode};

use crate::files::input_files::InputFiles;
use crate::ui::failure::{Answer, Failure};

/// Of a universal file, or of a table with columns as `xx_re_um_per_n`.
pub(crate) fn read(files: &InputFiles, path: &Path) -> Answer<Vec<MeasuredResponse>> {
    let text = files.text("measured responses", path)?;
    let universal = text.lines().next().is_some_and(|line| line.trim() == "-1");
    let found = match universal {
        true => read_universal(&text).map(|file| file.responses),
        false => read_columns(&text),
    };
    found.map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

/// What a measured file does not say, or says of another place than the tool's tip.
pub(crate) fn warnings(measured: &[MeasuredResponse]) -> Vec<Warning> {
    let mut all = Vec::new();
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

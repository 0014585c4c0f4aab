//! `kinetostat check --pose`: the model against poses that were measured on the machine.
//!
//! It takes a model and a file of poses (CSV or TOML) and gives the differences, and the sign, offset, coupling or
//! frame that explains them.

mod comparison;
mod csv_file;
mod explanation_text;
mod file;
mod pose_row;
mod text;
mod toml_file;

use std::path::Path;

use kinetostat_analysis::measured_poses::Tolerance;
use kinetostat_model::Model;

use crate::check::poses::comparison::{axes, compare};
use crate::check::poses::file::read;
use crate::check::poses::text::answer_text;
use crate::files::input_files::InputFiles;
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;

/// The model and where it came from, for one file of poses.
pub(crate) fn run(
    model: &Model,
    source: &str,
    file: &Path,
    tolerance_mm: f64,
    json: bool,
) -> Answer<()> {
    if !(tolerance_mm > 0.0 && tolerance_mm <= 1e4) {
        return Err(Failure::input(format!(
            "--pose-tolerance-mm is {tolerance_mm}; a length from above 0 to 10000 mm is needed"
        )));
    }
    let names = axes(model);
    let rows = read(&InputFiles::default(), file, &names)?;
    let tolerance = Tolerance {
        distance: 1e-3 * tolerance_mm,
        angle: (0.1 * tolerance_mm).to_radians(),
    };
    let answer = compare(model, source, file, &names, &rows, tolerance, tolerance_mm)?;
    let text = answer_text(&answer);
    json::print_answer(&text, &answer, json)
}

//! Measured responses, to be drawn beside the model's.

use std::path::Path;

use kinetostat_chatter::{MeasuredResponse, read_columns, read_universal};

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

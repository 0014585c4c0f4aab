//! Files of measured poses: a table (CSV) or TOML. Units and conventions are in the names of the columns.

use std::path::Path;

use crate::check::poses::csv_file::from_csv;
use crate::check::poses::pose_row::{MOST, PoseRow};
use crate::check::poses::toml_file::from_toml;
use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::place::joints::Named;
use crate::ui::failure::{Answer, Failure};

pub(crate) fn read(files: &InputFiles, path: &Path, names: &[Named]) -> Answer<Vec<PoseRow>> {
    let bytes = files.bytes("file of poses", path)?;
    let name = path.display().to_string();
    let text = String::from_utf8(bytes)
        .map_err(|_| Failure::input(format!("{name}: not UTF-8 text; save it as UTF-8")))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let toml = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let rows = match toml {
        true => from_toml(&name, text, names)?,
        false => from_csv(&with_decimal_points(text), names).map_err(|f| f.within(&name))?,
    };
    if rows.is_empty() {
        return Err(Failure::input(format!(
            "{name}: there is no pose in it; write one row for each"
        )));
    }
    if rows.len() > MOST {
        return Err(Failure::input(format!(
            "{name}: {} poses, at most {MOST} are read",
            rows.len()
        )));
    }
    Ok(rows)
}

//! The table of points as a Parquet file: the columns and digits of the CSV, every point, units and meanings in the metadata.

#[cfg(feature = "parquet")]
use std::io::Write;
use std::path::Path;
#[cfg(feature = "parquet")]
use std::sync::{Arc, Mutex, PoisonError};

#[cfg(feature = "parquet")]
use kinetostat_formats::fields::{Cell, RowColumn, RowsWriter};
use kinetostat_machining::{PointResult, RunInputs};

use crate::program::points_table::Listing;
#[cfg(feature = "parquet")]
use crate::program::points_table::{header, rows};
use crate::ui::failure::{Answer, Failure};

/// A table of points is a Parquet file where its name ends so.
pub(crate) fn is_named(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

/// Columns that hold words.
#[cfg(feature = "parquet")]
const WORDS: [&str; 8] = [
    "kind",
    "status",
    "nearest_limit",
    "most_loaded_drive",
    "shoulder",
    "elbow",
    "wrist",
    "source_file",
];

/// Ends of names with the units that they say, longer ones first.
#[cfg(feature = "parquet")]
const UNITS: [(&str, &str); 5] = [
    ("_n_per_mm", "N/mm"),
    ("_n_m", "N m"),
    ("_mm", "mm"),
    ("_deg", "deg"),
    ("_n", "N"),
];

/// Beginnings (or all) of names with what they are, longer ones first.
#[cfg(feature = "parquet")]
const MEANINGS: [(&str, &str); 30] = [
    ("line", "line of the input program, from 1"),
    (
        "output_line",
        "line of the written program, from 1; 0 if none was written",
    ),
    (
        "kind",
        "feed, rapid (at its end), corner or entry (on a step)",
    ),
    ("share", "share of the block up to here, 0 to 1"),
    ("path", "length of the path up to here"),
    (
        "error_before",
        "where the tool is without compensation minus where it should be, program axes",
    ),
    (
        "error_after",
        "where the tool is with the written program minus where it should be, program axes",
    ),
    (
        "correction",
        "what the written program adds to the place, program axes",
    ),
    ("force", "force on the tool, program axes"),
    ("moment", "moment on the tool about its tip, program axes"),
    (
        "orientation",
        "tool in the program, program axes from tool axes: quaternion, scalar w",
    ),
    ("residual_rotation", "rotation of the tool that stays"),
    (
        "tool_turn",
        "how far the tool is turned from the orientation that it is kept near to",
    ),
    (
        "limit_distance",
        "distance of the nearest joint to its limit, below zero outside",
    ),
    (
        "share_of_rating",
        "force or torque of the most loaded drive by its rating",
    ),
    ("pendant", "what the controller shows"),
    (
        "smallest_stiffness",
        "stiffness of the tool's tip against a force in the softest direction",
    ),
    (
        "share_to_buckling",
        "largest share of the way to buckling of any limb, 1 is buckling",
    ),
    ("status", "ok or unstable"),
    (
        "nearest_limit",
        "joint that is nearest to an end of its range, and which end",
    ),
    (
        "most_loaded_drive",
        "drive that carries the largest share of its rating",
    ),
    ("shoulder", "side on which the shoulder stands"),
    ("elbow", "side to which the elbow is bent"),
    ("wrist", "side to which the wrist is turned"),
    ("configuration", "number of the configuration of the arm"),
    (
        "shoulder_from_singular",
        "distance of the wrist's centre from the axis of joint 1",
    ),
    (
        "elbow_from_singular",
        "angle of the elbow from the stretched arm",
    ),
    (
        "wrist_from_singular",
        "angle of joint 5 from where axes 4 and 6 are in line",
    ),
    ("source_line", "line in the file that it was expanded from"),
    ("source_file", "file that it was expanded from"),
];

#[cfg(feature = "parquet")]
fn column(name: &str) -> RowColumn {
    let is_text = WORDS.contains(&name);
    let unit = UNITS.iter().find(|(end, _)| name.ends_with(end));
    // The longest beginning counts: a share of the way to buckling is no share of a block.
    let own = MEANINGS.iter().filter(|(start, _)| name.starts_with(start));
    let meaning = own.max_by_key(|(start, _)| start.len());
    let description = match meaning {
        Some((_, meaning)) => *meaning,
        None if ["x_mm", "y_mm", "z_mm"].contains(&name) => {
            "where the tool should be, program coordinates"
        }
        None if name.contains("_command_") => "joint value as commanded",
        None if name.contains("_force_") => "force or torque of the drive",
        None if name.contains("_correction_") => "change of the joint by the compensation",
        None => "",
    };
    RowColumn {
        name: name.to_owned(),
        unit: match (is_text, unit) {
            (true, _) => String::new(),
            (false, Some((_, unit))) => (*unit).to_owned(),
            (false, None) => "1".to_owned(),
        },
        description: description.to_owned(),
        is_text,
    }
}

/// Bytes that were written since they were taken last.
#[cfg(feature = "parquet")]
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

#[cfg(feature = "parquet")]
impl Shared {
    fn take(&self) -> Vec<u8> {
        let mut bytes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut bytes)
    }
}

#[cfg(feature = "parquet")]
impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// The file piece by piece.
#[cfg(feature = "parquet")]
pub(crate) fn table(
    run_inputs: &RunInputs,
    points: &[PointResult],
    listing: &Listing,
    mut put: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    let header = header(run_inputs, points, listing);
    let columns: Vec<RowColumn> = header.iter().map(|name| column(name)).collect();
    let facts = [
        ("title", format!("points of {}", run_inputs.program)),
        ("model", run_inputs.model.clone()),
        ("load", run_inputs.load.clone()),
        ("kinetostat_version", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let facts = facts.map(|(name, text)| (name.to_owned(), text));
    let sink = Shared::default();
    let mut file = RowsWriter::new(sink.clone(), &columns, &facts).map_err(Failure::input)?;
    rows(run_inputs, listing, &mut points.iter(), |row| {
        let cells = row
            .iter()
            .zip(&columns)
            .map(|(cell, column)| match column.is_text {
                true => Cell::Text(cell),
                // An empty cell is a number that does not exist.
                false => Cell::Number(cell.parse().unwrap_or(f64::NAN)),
            });
        file.push(cells).map_err(Failure::input)?;
        let bytes = sink.take();
        match bytes.is_empty() {
            true => Ok(()),
            false => put(&bytes),
        }
    })?;
    file.finish().map_err(Failure::input)?;
    put(&sink.take())
}

#[cfg(not(feature = "parquet"))]
pub(crate) fn table(
    _: &RunInputs,
    _: &[PointResult],
    _: &Listing,
    _: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    Err(Failure::input(
        "this program was built without Parquet: name a table of points that ends in .csv",
    ))
}

#[cfg(all(test, feature = "parquet"))]
mod tests {
    use super::*;

    #[test]
    fn names_say_their_units_and_meanings() {
        for (name, unit, word) in [
            ("error_before_x_mm", "mm", "without compensation"),
            ("force_z_n", "N", "program axes"),
            ("moment_z_n_m", "N m", "about its tip"),
            ("smallest_stiffness_n_per_mm", "N/mm", "softest"),
            ("joint_1_command_deg", "deg", "commanded"),
            ("share_to_buckling", "1", "buckling"),
            ("kind", "", "rapid"),
            ("y_mm", "mm", "should be"),
        ] {
            let column = column(name);
            assert_eq!(column.unit, unit, "{name}");
            assert!(
                column.description.contains(word),
                "{name}: {}",
                column.description
            );
        }
    }
}

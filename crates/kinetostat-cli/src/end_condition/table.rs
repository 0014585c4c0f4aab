//! Tables of equilibria: units in the header, full precision.

use crate::end_condition::coordinates::CoordinateName;
use crate::ui::failure::{Answer, Failure};

pub(crate) const WRENCH_AND_PLACE: [&str; 12] = [
    "fx_n", "fy_n", "fz_n", "mx_n_m", "my_n_m", "mz_n_m", "x_mm", "y_mm", "z_mm", "rx_deg",
    "ry_deg", "rz_deg",
];

pub(crate) fn column(c: &CoordinateName) -> String {
    let name = format!("{}_{}", c.name, c.unit);
    // A spreadsheet would take it for a formula.
    if name.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{name}")
    } else {
        name
    }
}

/// A number that reads back to the same bits; empty where there is none.
pub(crate) fn cell(x: f64) -> String {
    if x.is_finite() {
        x.to_string()
    } else {
        String::new()
    }
}

pub(crate) fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.to_owned()
}

pub(crate) fn written(rows: &[Vec<String>]) -> Answer<Vec<u8>> {
    let failed =
        |error: csv::Error| Failure::input(format!("the table cannot be written: {error}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(failed)?;
    }
    writer
        .into_inner()
        .map_err(|error| failed(csv::Error::from(error.into_error())))
}

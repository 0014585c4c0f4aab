//! Tables for programs: full precision, as CSV.

use kinetostat_diagnostic::ErrorCode;

use crate::ui::failure::{Answer, Failing};

/// A number that reads back to the same bits; empty where there is none.
pub(crate) fn cell(x: f64) -> String {
    if x.is_finite() {
        x.to_string()
    } else {
        String::new()
    }
}

/// Cell of a number that may be missing.
pub(crate) fn cell_if_any(x: Option<f64>) -> String {
    x.map_or_else(String::new, cell)
}

pub(crate) fn written(rows: &[Vec<String>]) -> Answer<Vec<u8>> {
    let failed = |error: csv::Error| {
        ErrorCode::Output.failure(format!("the table cannot be written: {error}"))
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(failed)?;
    }
    writer
        .into_inner()
        .map_err(|error| failed(csv::Error::from(error.into_error())))
}

//! Columns of tables of equilibria: units in the header.

use crate::end_condition::coordinates::CoordinateName;

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

pub(crate) fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.to_owned()
}

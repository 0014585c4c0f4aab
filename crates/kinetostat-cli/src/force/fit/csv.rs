//! Measured and fitted forces as a table, a row for each of the file.

use crate::force::fit::answer::FitAnswer;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;

const HEADER: [&str; 13] = [
    "feed_mm_per_tooth",
    "fx_n",
    "fy_n",
    "fz_n",
    "fx_fitted_n",
    "fy_fitted_n",
    "fz_fitted_n",
    "fx_residual_n",
    "fy_residual_n",
    "fz_residual_n",
    "fx_half_width_95_n",
    "fy_half_width_95_n",
    "fz_half_width_95_n",
];

pub(crate) fn of_fit(answer: &FitAnswer) -> Answer<Vec<u8>> {
    let mut rows = vec![HEADER.map(String::from).to_vec()];
    for of in &answer.rows {
        let mut row = vec![cell(of.feed_mm_per_tooth)];
        let forces = [of.force_n, of.fitted_n, of.residual_n];
        row.extend(forces.iter().flatten().map(|n| cell(*n)));
        let widths = of.half_width_95_n.iter();
        row.extend(widths.copied().map(cell_if_any));
        rows.push(row);
    }
    written(&rows)
}

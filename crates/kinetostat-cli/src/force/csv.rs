//! The force over one revolution as a table.

use crate::force::answer::ForceAnswer;
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::Answer;

pub(crate) fn of_force(answer: &ForceAnswer) -> Answer<Vec<u8>> {
    let header = [
        "angle_deg",
        "fx_n",
        "fy_n",
        "fz_n",
        "across_tool_n",
        "torque_n_mm",
        "mx_n_mm",
        "my_n_mm",
        "mz_n_mm",
    ];
    let mut rows = vec![header.map(String::from).to_vec()];
    for at in &answer.revolution {
        let [x, y, z] = at.force_n;
        let mut row = vec![cell(at.angle_deg), cell(x), cell(y), cell(z)];
        row.push(cell(x.hypot(y)));
        row.push(cell(at.torque_n_mm));
        row.extend(at.moment_n_mm.iter().map(|m| cell(*m)));
        rows.push(row);
    }
    written(&rows)
}

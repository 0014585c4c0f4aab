//! All equilibria as a table.

use crate::end_condition::table::{WRENCH_AND_PLACE, column, yes};
use crate::equilibria::answer::EquilibriaAnswer;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;

pub(crate) fn of_equilibria(a: &EquilibriaAnswer) -> Answer<Vec<u8>> {
    let mut header: Vec<String> = [
        "number",
        "energy_j",
        "stable",
        "may_flutter",
        "shape_stable",
        "share_to_buckling",
        "singular",
        "found_by_spread_starts",
        "stiffness_n_per_mm",
    ]
    .map(String::from)
    .to_vec();
    header.extend(WRENCH_AND_PLACE.map(String::from));
    header.extend(a.coordinates.iter().map(column));
    let mut rows = vec![header];
    for e in &a.equilibria {
        let mut row = vec![
            e.number.to_string(),
            cell(e.energy_j),
            yes(e.stable),
            yes(e.may_flutter),
            yes(e.shape_stable),
            cell_if_any(e.share_to_buckling),
            yes(e.singular),
            e.found_by_spread_starts.to_string(),
            cell(e.stiffness_n_per_mm),
        ];
        row.extend(
            [
                e.force_n,
                e.moment_n_m,
                e.position_mm,
                e.rotation_vector_deg,
            ]
            .iter()
            .flatten()
            .map(|x| cell(*x)),
        );
        row.extend(e.coordinates.iter().map(|x| cell(*x)));
        rows.push(row);
    }
    written(&rows)
}

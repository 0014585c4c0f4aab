//! All points of a curve as a table.

use crate::curve::answer::{CurveAnswer, PointAnswer};
use crate::end_condition::table::{WRENCH_AND_PLACE, column, yes};
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;

pub(crate) fn of_curve(a: &CurveAnswer) -> Answer<Vec<u8>> {
    let word = |name: &str, unit: &str| {
        let unit = unit
            .replace('/', " per ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join("_")
            .to_lowercase();
        let name = name.replace(' ', "_");
        if unit.is_empty() {
            name
        } else {
            format!("{name}_{unit}")
        }
    };
    let u = &a.units;
    let mut header: Vec<String> = vec!["branch".into(), "point".into(), "name".into()];
    if a.grows == "load" && !u.load_unit.is_empty() {
        header.push("load_factor".into());
    }
    header.push(word(u.displacement, u.displacement_unit));
    header.push(word(u.load, u.load_unit));
    header.push(word("slope", u.slope_unit));
    header.extend(
        [
            "stable_under_dead_load",
            "stable_under_prescribed_motion",
            "may_flutter",
            "share_to_buckling",
            "spring_energy_j",
        ]
        .map(String::from),
    );
    header.extend(WRENCH_AND_PLACE.map(String::from));
    header.extend(a.coordinates.iter().map(column));
    let mut rows = vec![header];
    let row = |branch: &str, point: &str, name: &str, p: &PointAnswer| {
        let mut row = vec![branch.to_owned(), point.to_owned(), name.to_owned()];
        if a.grows == "load" && !u.load_unit.is_empty() {
            row.push(cell(p.factor.unwrap_or(f64::NAN)));
        }
        row.extend(p.shown.iter().map(|x| cell(*x)));
        row.push(yes(p.stable_under_dead_load));
        row.push(yes(p.stable_under_prescribed_motion));
        row.push(yes(p.may_flutter));
        row.push(cell_if_any(p.share_to_buckling));
        row.push(cell(p.spring_energy_j));
        row.extend(
            [
                p.force_n,
                p.moment_n_m,
                p.position_mm,
                p.rotation_vector_deg,
            ]
            .iter()
            .flatten()
            .map(|x| cell(*x)),
        );
        row.extend(p.coordinates.iter().map(|x| cell(*x)));
        row
    };
    for branch in &a.branches {
        let number = branch.number.to_string();
        for (i, p) in branch.points.iter().enumerate() {
            rows.push(row(&number, &(i + 1).to_string(), "", p));
        }
    }
    // Named points lie between the points of their branches.
    for p in &a.named_points {
        let branch = p
            .branches
            .first()
            .map_or_else(String::new, usize::to_string);
        rows.push(row(
            &branch,
            "",
            &format!("{} {}", p.name, p.kind),
            &p.point,
        ));
    }
    written(&rows)
}

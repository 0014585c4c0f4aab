//! All points of a curve, or all equilibria, as a table: units in the header, full precision.

use crate::curve::answer::{CurveAnswer, PointAnswer};
use crate::end_condition::chain::CoordinateName;
use crate::equilibria::answer::EquilibriaAnswer;
use crate::ui::failure::{Answer, Failure};

const WRENCH_AND_PLACE: [&str; 12] = [
    "fx_n", "fy_n", "fz_n", "mx_n_m", "my_n_m", "mz_n_m", "x_mm", "y_mm", "z_mm", "rx_deg",
    "ry_deg", "rz_deg",
];

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
        row.push(p.share_to_buckling.map_or_else(String::new, cell));
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
            e.share_to_buckling.map_or_else(String::new, cell),
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

fn column(c: &CoordinateName) -> String {
    let name = format!("{}_{}", c.name, c.unit);
    // A spreadsheet would take it for a formula.
    if name.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{name}")
    } else {
        name
    }
}

/// A number that reads back to the same bits; empty where there is none.
fn cell(x: f64) -> String {
    if x.is_finite() {
        x.to_string()
    } else {
        String::new()
    }
}

fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.to_owned()
}

fn written(rows: &[Vec<String>]) -> Answer<Vec<u8>> {
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

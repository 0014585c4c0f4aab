//! All figures of an assembly as a table.

use kinetostat_analysis::assembled::Cases;
use kinetostat_diagnostic::ErrorCode;

use crate::assemble::answer::Assembly;
use crate::ui::failure::{Answer, Failing};
use kinetostat::number::largest_size;

/// One number in all cases.
pub(crate) struct Row {
    /// `platform`, `limb`, `passive joint`, `spring deflection` or `spring torque`.
    pub(crate) what: &'static str,
    /// Platform or limb.
    pub(crate) owner: String,
    /// Component, joint or spring direction.
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) cases: Cases<f64>,
    /// Sort key of the list.
    pub(crate) weight: f64,
}

/// All numbers of an answer, what is larger in front.
pub(crate) fn rows(a: &Assembly) -> Vec<Row> {
    let mut list = Vec::new();
    let axes = ["x", "y", "z"];
    let mut triple = |what, owner: &str, word: &str, unit, v: &Cases<[f64; 3]>, weight: f64| {
        for (i, axis) in axes.iter().enumerate() {
            list.push(Row {
                what,
                owner: owner.to_owned(),
                name: format!("{word} {axis}"),
                unit,
                cases: v.component(i),
                weight,
            });
        }
    };
    for p in &a.platforms {
        triple("platform", &p.name, "shift", "mm", &p.shift_mm, 0.0);
        triple(
            "platform",
            &p.name,
            "turn",
            "deg",
            &p.rotation_vector_deg,
            0.0,
        );
    }
    for l in &a.limbs {
        triple("limb", &l.name, "force", "N", &l.force_n, l.strain_n);
        triple("limb", &l.name, "moment", "N m", &l.moment_n_m, l.strain_n);
    }
    for l in &a.limbs {
        for j in &l.passive_joints {
            list.push(Row {
                what: "passive joint",
                owner: l.name.clone(),
                name: j.name.clone(),
                unit: j.unit,
                cases: j.shift,
                // A degree counts as a millimetre: what is seen.
                weight: weight(&j.shift),
            });
        }
        for s in &l.springs {
            let lever = if s.torque_unit == "N" {
                a.length_m
            } else {
                1.0
            };
            for (what, unit, cases) in [
                ("spring deflection", s.deflection_unit, s.deflection),
                ("spring torque", s.torque_unit, s.torque),
            ] {
                list.push(Row {
                    what,
                    owner: l.name.clone(),
                    name: s.name.clone(),
                    unit,
                    cases,
                    weight: lever * weight(&s.torque),
                });
            }
        }
    }
    let order = |what: &str| {
        let words = ["platform", "limb", "passive joint", "spring deflection"];
        words.iter().position(|w| *w == what).unwrap_or(3)
    };
    // Stable, so that what weighs the same (up to rounding) keeps the order of the model.
    let coarse = |x: f64| match x > 0.0 {
        true => (x.log10() * 1e6).round(),
        false => f64::MIN,
    };
    list.sort_by(|x, y| {
        let by_group = order(x.what).cmp(&order(y.what));
        by_group.then(coarse(y.weight).total_cmp(&coarse(x.weight)))
    });
    list
}

/// Table of all numbers, full precision.
pub(crate) fn csv(a: &Assembly) -> Answer<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed =
        |e: csv::Error| ErrorCode::Output.failure(format!("the table cannot be written: {e}"));
    writer
        .write_record([
            "what",
            "platform_or_limb",
            "name",
            "unit",
            "without_load",
            "without_load_by_deviations",
            "without_load_linear",
            "under_load",
            "under_load_by_deviations",
            "under_load_linear",
        ])
        .map_err(failed)?;
    for row in rows(a) {
        let mut cells: Vec<String> = [row.what, &row.owner, &row.name]
            .map(crate::ui::csv_cell::text)
            .into();
        cells.push(row.unit.to_owned());
        cells.extend(
            row.cases
                .all()
                .map(|x| x.map_or_else(String::new, |x| crate::ui::csv_cell::digits(x, 8))),
        );
        writer.write_record(cells).map_err(failed)?;
    }
    writer
        .into_inner()
        .map_err(|e| failed(csv::Error::from(e.into_error())))
}

pub(crate) fn decimals(unit: &str) -> i32 {
    match unit {
        "N" => 3,
        "N m" => 4,
        _ => 5,
    }
}

/// Sort key of a list: the share of the deviations, then the whole.
fn weight(x: &Cases<f64>) -> f64 {
    let under = x.under_load_by_deviations.unwrap_or(0.0).abs();
    let whole = x.all().into_iter().flatten();
    x.without_load_by_deviations.abs().max(under) + 1e-6 * largest_size(whole)
}

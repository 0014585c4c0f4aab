//! What assembly locked in, in words and as a table.

use crate::assemble::answer::{Assembly, Cases};
use crate::assemble::query::Question;
use crate::program::summary;
use crate::ui::failure::{Answer, Failure};
use crate::ui::screen::{columns, fixed, item, load_triple, number, wrapped};

/// Rows of a list that is not asked for as a whole.
const SHOWN: usize = 12;

/// One number in all cases.
pub(crate) struct Row {
    /// `platform`, `limb`, `passive joint`, `spring deflection` or `spring torque`.
    what: &'static str,
    /// Platform or limb.
    owner: String,
    /// Component, joint or spring direction.
    name: String,
    unit: &'static str,
    cases: Cases<f64>,
    /// What the list is sorted by.
    weight: f64,
}

/// All numbers of an answer, what is larger in front.
fn rows(a: &Assembly) -> Vec<Row> {
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
                weight: j.shift.weight(),
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
                    weight: lever * s.torque.weight(),
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

impl Cases<[f64; 3]> {
    fn component(&self, i: usize) -> Cases<f64> {
        Cases {
            without_load: self.without_load[i],
            without_load_by_deviations: self.without_load_by_deviations[i],
            without_load_linear: self.without_load_linear[i],
            under_load: self.under_load.map(|v| v[i]),
            under_load_by_deviations: self.under_load_by_deviations.map(|v| v[i]),
            under_load_linear: self.under_load_linear.map(|v| v[i]),
        }
    }
}

impl Cases<f64> {
    /// What sorts a list: the share of the deviations, then the whole.
    fn weight(&self) -> f64 {
        let under = self.under_load_by_deviations.unwrap_or(0.0).abs();
        let whole = self.all().into_iter().flatten();
        self.without_load_by_deviations.abs().max(under)
            + 1e-6 * whole.fold(0.0_f64, |m, x| m.max(x.abs()))
    }

    fn all(&self) -> [Option<f64>; 6] {
        [
            Some(self.without_load),
            Some(self.without_load_by_deviations),
            Some(self.without_load_linear),
            self.under_load,
            self.under_load_by_deviations,
            self.under_load_linear,
        ]
    }
}

/// Every number, full precision.
pub(crate) fn csv(a: &Assembly) -> Answer<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Failure::input(format!("the table cannot be written: {e}"));
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
            .map(crate::program::points_table::text)
            .into();
        cells.push(row.unit.to_owned());
        cells.extend(
            row.cases.all().map(|x| {
                x.map_or_else(String::new, |x| crate::program::points_table::digits(x, 8))
            }),
        );
        writer.write_record(cells).map_err(failed)?;
    }
    writer
        .into_inner()
        .map_err(|e| failed(csv::Error::from(e.into_error())))
}

/// The question, one sentence, and tables.
pub(crate) fn in_words(question: &Question, a: &Assembly, all: bool) -> String {
    let mut out = question.spot.heading();
    out.push_str(&wrapped(&verdict(a), 2));
    out.push_str("\nOver-constraint\n");
    out.push_str(&over_constraint(a));
    let loaded = a.platforms.iter().any(|p| p.shift_mm.under_load.is_some());
    if loaded {
        out.push('\n');
        out.push_str(&wrapped(
            &format!(
                "The load: force {} N and moment {} N m on the tool. 'of errors' is the share of the deviations: as built less as drawn.",
                load_triple(question.spot.wrench.force().into()),
                load_triple(question.spot.wrench.moment().into())
            ),
            0,
        ));
    }
    let list = rows(a);
    for (what, title) in [
        ("platform", "From the commanded place"),
        (
            "limb",
            "Wrench on the end of every limb, about it, base axes",
        ),
        ("passive joint", "Passive joints"),
        (
            "spring",
            "Springs, in their own axes: deflection and torque",
        ),
    ] {
        out.push_str(&group(a, &list, (what, title), loaded, all));
    }
    out.push_str(&summary::warnings(&a.warnings));
    out
}

/// What happened, in one or two sentences.
fn verdict(a: &Assembly) -> String {
    let Some(tool) = a.platforms.last() else {
        return String::new();
    };
    let norm = |v: [f64; 3]| nalgebra::Vector3::from(v).norm();
    let shift = norm(tool.shift_mm.without_load_by_deviations);
    let turn = norm(tool.rotation_vector_deg.without_load_by_deviations);
    let moved = match shift > 1e-9 || turn > 1e-9 {
        true => format!(
            "without load the tool is shifted by {} mm and turned by {} deg",
            fixed(shift, 4),
            fixed(turn, 4)
        ),
        false => "the tool stays where it is commanded".to_owned(),
    };
    let degree = a.over_constraint.degree;
    if a.deviations.is_empty() {
        return match degree {
            0 => "The model has no deviations, and none could lock anything in: the machine is statically determinate.".to_owned(),
            n => format!("The model has no deviations: as drawn its limbs go together without strain. {}, so that errors would be locked in; give some with --deviation or as [[deviation]].", times(n)),
        };
    }
    let Some(limb) = &a.most_strained_limb else {
        return match degree {
            0 => format!(
                "Nothing is locked in: the machine is statically determinate, its deviations only move it; {moved}."
            ),
            n => format!(
                "Nothing is locked in: {}, but these deviations strain no limb; {moved}.",
                times(n).to_lowercase()
            ),
        };
    };
    if degree == 0 && a.something_else_acts {
        // As built less as drawn: the weights' share, in a machine that stands a little elsewhere.
        let shares = a.limbs.iter().map(|l| {
            let unlike = norm(l.force_n.without_load_by_deviations);
            (unlike, norm(l.force_n.without_load))
        });
        let (unlike, whole) = shares.fold((0.0_f64, 0.0_f64), |m, s| (m.0.max(s.0), m.1.max(s.1)));
        return format!(
            "Nothing is locked in: the machine is statically determinate, its deviations only move it; {moved}. Weights, loads and preloads of the model pass through the limbs a little otherwise than in the machine as drawn under the same: the forces on their ends change by up to {} N, of up to {} N.",
            number(unlike, 3),
            number(whole, 4)
        );
    }
    let own = a.limbs.iter().find(|l| l.name == *limb);
    let (force, moment) = own.map_or((0.0, 0.0), |l| {
        (
            norm(l.force_n.without_load_by_deviations),
            norm(l.moment_n_m.without_load_by_deviations),
        )
    });
    let others = a
        .limbs
        .iter()
        .filter(|l| l.name != *limb && l.strain_n > 0.999 * own.map_or(0.0, |o| o.strain_n))
        .count();
    let most = match others {
        0 => format!("limb '{limb}' most"),
        1 => format!("limb '{limb}' and one more most"),
        n => format!("limb '{limb}' and {n} more most, equally"),
    };
    format!(
        "Assembly with these deviations strains {most}: {} N m and {} N stay on its end; {moved}.",
        number(moment, 4),
        number(force, 4)
    )
}

fn times(degree: usize) -> String {
    match degree {
        1 => "The machine is over-constrained in 1 way".to_owned(),
        n => format!("The machine is over-constrained in {n} ways"),
    }
}

fn over_constraint(a: &Assembly) -> String {
    let d = &a.over_constraint;
    if d.degree == 0 {
        return item(
            "none: the limbs hold the platforms just as needed, deviations only move them",
        );
    }
    let mut out = item(&match d.degree {
        1 => "1 way in which the limbs can strain each other".to_owned(),
        n => format!("{n} independent ways in which the limbs can strain each other"),
    });
    for stress in &d.stresses {
        out.push_str(&item(&stress.in_words));
    }
    out
}

/// One table; rows without any number worth showing are left out.
fn group(
    a: &Assembly,
    list: &[Row],
    (what, title): (&str, &str),
    loaded: bool,
    all: bool,
) -> String {
    let of_group: Vec<&Row> = list.iter().filter(|r| r.what.starts_with(what)).collect();
    // What is rounding beside the largest, or shows no digit, is zero.
    let most = |unit: &str| {
        let same = of_group.iter().filter(|r| r.unit == unit);
        same.flat_map(|r| r.cases.all())
            .flatten()
            .fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let cell = |row: &Row, x: f64| {
        let least = (1e-5 * most(row.unit)).max(0.5 * 0.1_f64.powi(decimals(row.unit)));
        match x.abs() < least {
            true => "0".to_owned(),
            false => fixed(x, decimals(row.unit) as usize),
        }
    };
    let shown: Vec<&&Row> = of_group
        .iter()
        .filter(|r| {
            let mut numbers = r.cases.all().into_iter().flatten();
            all || what == "platform" || numbers.any(|x| cell(r, x) != "0")
        })
        .collect();
    if of_group.is_empty() {
        return String::new();
    }
    let mut out = format!("\n{title}\n");
    if shown.is_empty() {
        out.push_str(&item("nothing: all zero"));
        return out;
    }
    let mut header = vec![String::new(), String::new(), "no load".to_owned()];
    if a.something_else_acts {
        header.push("of errors".to_owned());
    }
    header.push("linear".to_owned());
    if loaded {
        header.extend(["loaded", "of errors", "linear"].map(str::to_owned));
    }
    let mut table = vec![header];
    let limit = match what {
        "passive joint" => SHOWN,
        "spring" => 2 * SHOWN,
        _ => usize::MAX,
    };
    for row in shown.iter().take(if all { usize::MAX } else { limit }) {
        let c = &row.cases;
        let cell = |x: f64| cell(row, x);
        let mut cells = vec![
            format!("{}: {}", row.owner, row.name),
            row.unit.to_owned(),
            cell(c.without_load),
        ];
        if a.something_else_acts {
            cells.push(cell(c.without_load_by_deviations));
        }
        cells.push(cell(c.without_load_linear));
        if loaded {
            cells.extend(
                [
                    c.under_load,
                    c.under_load_by_deviations,
                    c.under_load_linear,
                ]
                .map(|x| cell(x.unwrap_or(0.0))),
            );
        }
        table.push(cells);
    }
    out.push_str(&columns(&table, 2));
    let left = shown.len().saturating_sub(limit);
    if left > 0 && !all {
        out.push_str(&wrapped(
            &format!("... and {left} smaller; --all shows them, --csv and --json have every one"),
            2,
        ));
    }
    out
}

fn decimals(unit: &str) -> i32 {
    match unit {
        "N" => 3,
        "N m" => 4,
        _ => 5,
    }
}

//! Assembly stress in words and as a table.

use crate::assemble::answer::Assembly;
use crate::assemble::query::AssemblyQuery;
use crate::assemble::table::{Row, decimals, rows};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, load_triple, number};
use crate::ui::warnings;
use kinetostat::number::{larger, largest_size};

/// Rows of a list that is not requested as a whole.
const SHOWN: usize = 12;

/// The question, one sentence, and tables.
pub(crate) fn answer_text(assembly: &AssemblyQuery, a: &Assembly, all: bool) -> String {
    let mut out = assembly.query.heading();
    out.push_str(&wrapped(&result_text(a), 2));
    if let Some(by) = a.found_by {
        out.push_str(&wrapped(&format!("Note: {}.", by.sentence()), 2));
    }
    out.push_str("\nOver-constraint\n");
    out.push_str(&over_constraint(a));
    let loaded = a.platforms.iter().any(|p| p.shift_mm.under_load.is_some());
    if loaded {
        out.push('\n');
        out.push_str(&wrapped(
            &format!(
                "The load: force {} N and moment {} N m on the tool. 'of errors' is the share of the deviations: as built less as drawn.",
                load_triple(assembly.query.wrench.force().into()),
                load_triple(assembly.query.wrench.moment().into())
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
        out.push_str(&group(a, &list, what, title, loaded, all));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

/// Result in one or two sentences.
fn result_text(a: &Assembly) -> String {
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
        // The difference "as built" minus "as drawn" is the weights' share at a slightly different posture.
        let shares = a.limbs.iter().map(|l| {
            let unlike = norm(l.force_n.without_load_by_deviations);
            (unlike, norm(l.force_n.without_load))
        });
        let (unlike, whole) = shares.fold((0.0, 0.0), |m, s| (larger(m.0, s.0), larger(m.1, s.1)));
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
fn group(a: &Assembly, list: &[Row], what: &str, title: &str, loaded: bool, all: bool) -> String {
    let of_group: Vec<&Row> = list.iter().filter(|r| r.what.starts_with(what)).collect();
    // Values at rounding level beside the largest, or without a visible digit, are zero.
    let most = |unit: &str| {
        let same = of_group.iter().filter(|r| r.unit == unit);
        largest_size(same.flat_map(|r| r.cases.all()).flatten())
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

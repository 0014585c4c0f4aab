//! The answer of `stiffness` for a person.

use crate::machine::principal_directions::{principals, what_moves};
use crate::place::joints;
use crate::place::query::PlaceQuery;
use crate::stiffness::answer::{AtRest, LimbShare, MICRO, Stiffness, per_column};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, load_triple, number};
use crate::ui::warnings;
use kinetostat::number::largest_size;

pub(crate) fn answer_text(query: &PlaceQuery, a: &Stiffness) -> String {
    let mut out = query.heading();
    if !a.on_controller.is_empty() {
        out.push_str(&joints::values_text("On the controller", &a.on_controller));
        out.push('\n');
    }
    let state = if a.loaded {
        format!(
            "Stiffness under the force {} N and the moment {} N m on the tool, with weights, preloads and deviations: what a further small force would meet.",
            load_triple(a.force_n),
            load_triple(a.moment_n_m)
        )
    } else {
        let with = match a.left_out.is_empty() {
            true => String::new(),
            false => format!(
                " Left out are {}; the stiffness with them is below.",
                a.left_out.join(", ")
            ),
        };
        format!(
            "Stiffness of the unloaded machine as drawn (weights, preloads and deviations left out; give --force for the loaded one).{with}"
        )
    };
    out.push_str(&wrapped(&state, 0));
    out.push_str(&wrapped(
        "Base axes, about the tool's tip. Rows: force in N, moment in N m; columns: motion in mm, rotation in rad.",
        0,
    ));
    out.push('\n');
    out.push_str(&table(&a.stiffness_n_m_rad));
    out.push_str(&rigid(a));
    out.push_str(&asymmetry(query, a));
    out.push('\n');
    out.push_str(&wrapped(&against_force(a), 0));
    if let Some(rest) = &a.at_rest {
        out.push_str(&at_rest(rest));
    }
    if let Some(c) = &a.compliance_m_rad_per_n {
        out.push_str(match a.rigid_directions {
            0 => "\nCompliance, its inverse: micrometres and microradians\n\n",
            _ => "\nCompliance, zero along the locked motion: micrometres and microradians\n\n",
        });
        out.push_str(&compliance(c));
    } else {
        out.push('\n');
        out.push_str(&wrapped(
            "There is no inverse: a direction is free, so a force along it meets nothing.",
            0,
        ));
    }
    if let Some(c) = &a.compliance_besides_free_motions_m_rad_per_n {
        out.push('\n');
        out.push_str(&wrapped(
            "Compliance besides: motion under a load that pushes along no free direction, up to free motions; micrometres and microradians",
            0,
        ));
        out.push('\n');
        out.push_str(&compliance(c));
    }
    out.push('\n');
    out.push_str(&wrapped(
        &format!(
            "Principal directions: {} of 6 have stiffness{}",
            a.rank,
            match a.rigid_directions {
                0 => String::new(),
                n => format!(", infinite in {n} (the machine cannot move that way)"),
            }
        ),
        0,
    ));
    out.push('\n');
    out.push_str(&principals(&a.principal_directions));
    out.push_str("\nWhat moves\n");
    a.principal_directions
        .iter()
        .for_each(|p| out.push_str(&what_moves(p)));
    out.push_str("\nLimbs\n");
    for limb in &a.limbs {
        out.push_str(&item(&limb_text(limb, a.limbs.len())));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn compliance(c: &[[f64; 6]; 6]) -> String {
    matrix(
        c,
        [
            "dx, um", "dy, um", "dz, um", "rx, urad", "ry, urad", "rz, urad",
        ],
        ["per N", "per N", "per N", "per N m", "per N m", "per N m"],
        |_, _| MICRO,
    )
}

/// A 6 x 6 table; entries that are rounding noise beside the diagonal show as 0.
fn matrix(
    m: &[[f64; 6]; 6],
    names: [&str; 6],
    units: [&str; 6],
    factor: impl Fn(usize, usize) -> f64,
) -> String {
    let mut header = vec![String::new()];
    header.extend(units.map(str::to_owned));
    let mut rows = vec![header];
    // The largest entry of the translational, and of the rotational, diagonal.
    let known = |i: usize| if m[i][i].is_nan() { 0.0 } else { m[i][i] };
    let scale = |i: usize| {
        let block = if i < 3 { 0..3 } else { 3..6 };
        largest_size(block.map(known))
    };
    let most = largest_size(m.iter().flatten().filter(|x| !x.is_nan()));
    let cell = |i: usize, j: usize, digits: i32| {
        let noise = (1e-9 * (scale(i) * scale(j)).sqrt()).max(1e-15 * most);
        if m[i][j].is_nan() {
            "locked".to_owned()
        } else if m[i][j].abs() <= noise {
            "0".to_owned()
        } else {
            number(m[i][j] * factor(i, j), digits)
        }
    };
    // Six columns within the width of a terminal.
    let width = |j: usize| {
        (0..6)
            .map(|i| cell(i, j, 5).len())
            .max()
            .unwrap_or(0)
            .max(7)
    };
    let wide = (0..6).map(|j| width(j) + 2).sum::<usize>() > 70;
    for i in 0..6 {
        let mut row = vec![names[i].to_owned()];
        row.extend((0..6).map(|j| {
            if !wide {
                return cell(i, j, 5);
            }
            match cell(i, j, 4) {
                long if long.len() > 9 => number(m[i][j] * factor(i, j), 3),
                short => short,
            }
        }));
        rows.push(row);
    }
    columns(&rows, 1)
}

/// The smallest stiffness against a force, one sentence.
pub(crate) fn against_force(a: &Stiffness) -> String {
    match a.smallest_stiffness_n_per_mm.is_finite() {
        true => format!(
            "Smallest stiffness against a force: {} N/mm (the tip pushed in its softest direction, the tool free to turn).",
            number(a.smallest_stiffness_n_per_mm, 4)
        ),
        false => "No force on the tip moves it.".to_owned(),
    }
}

/// The stiffness with the loads of the model.
fn at_rest(rest: &AtRest) -> String {
    let mut out = String::from("\n");
    out.push_str(&wrapped(
        &format!(
            "With all that acts in the model and without a load on the tool{}: smallest stiffness against a force {} N/mm.",
            match rest.stable {
                true => "",
                false => " (the machine is NOT stable so)",
            },
            number(rest.smallest_stiffness_n_per_mm, 4)
        ),
        0,
    ));
    out.push('\n');
    out.push_str(&table(&rest.stiffness_n_m_rad));
    out
}

/// A stiffness matrix with its units.
fn table(stiffness: &[[f64; 6]; 6]) -> String {
    matrix(
        stiffness,
        ["fx, N", "fy, N", "fz, N", "mx, N m", "my, N m", "mz, N m"],
        [
            "per mm", "per mm", "per mm", "per rad", "per rad", "per rad",
        ],
        |_, j| per_column(j),
    )
}

/// Loads that move nothing, where a direction is rigid.
fn rigid(a: &Stiffness) -> String {
    if a.constraint_wrenches_n_n_m.is_empty() {
        return String::new();
    }
    let part = |w: &[f64]| load_triple([w[0], w[1], w[2]]);
    let loads = a.constraint_wrenches_n_n_m.iter();
    let loads: Vec<String> = loads
        .map(|w| format!("{} N with {} N m", part(&w[..3]), part(&w[3..])))
        .collect();
    let text = format!(
        "locked: the machine cannot move along this axis alone, so the stiffness is infinite there; the compliance below holds in all directions. Loads that move nothing: {}.",
        loads.join("; ")
    );
    format!("\n{}", wrapped(&text, 0))
}

/// Explains the asymmetry of the matrix under a moment, which surprises beside a table.
fn asymmetry(query: &PlaceQuery, a: &Stiffness) -> String {
    let moment = query.wrench.moment();
    if !a.loaded || moment.norm() == 0.0 {
        return String::new();
    }
    let k = &a.stiffness_n_m_rad;
    if (k[3][4] - k[4][3]).is_nan() {
        return String::new();
    }
    format!(
        "\n{}",
        wrapped(
            &format!(
                "Under a moment the matrix is not symmetric: its rotational block differs from its transpose by the moment itself. Here K(mx, ry) - K(my, rx) = {} N m/rad, and the moment about z is {} N m. The symmetric part is the curvature of the stored energy.",
                fixed(k[3][4] - k[4][3], 4),
                fixed(moment.z, 4)
            ),
            0
        )
    )
}

/// A limb among a number of them.
fn limb_text(limb: &LimbShare, of: usize) -> String {
    let mut parts = vec![format!("stiff in {} of 6", limb.rank - limb.negative)];
    if limb.free > 0 {
        parts.push(format!("free in {} (passive joints)", limb.free));
    }
    if limb.rigid > 0 {
        parts.push(format!("rigid in {}", limb.rigid));
    }
    if limb.negative > 0 {
        let held = if of > 1 {
            " (unless the others hold it)"
        } else {
            ""
        };
        parts.push(format!(
            "negative in {}, where its load pulls it away{held}",
            limb.negative
        ));
    }
    let mut text = format!("limb '{}': {}", limb.stiffness.name, parts.join(", "));
    if !limb.redundant_passive_joints.is_empty() {
        text.push_str(&format!(
            "; {} can move while the end is held (redundant)",
            limb.redundant_passive_joints.join(" and ")
        ));
    }
    text
}

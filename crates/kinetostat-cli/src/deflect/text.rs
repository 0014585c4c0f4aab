//! The answer at one place for a person.

use kinetostat_machining::number as formatter;

use crate::deflect::answer::{Deflection, LimbAnswer};
use crate::machine::instability::leads_to;
use crate::place::joints;
use crate::place::query::PlaceQuery;
use crate::ui::layout::{self, columns, wrapped};
use crate::ui::numbers::{fixed, number, triple};
use crate::ui::warnings;
use kinetostat::number::largest_size;

/// Rate of the last corrections above which an iteration is slow.
const SLOW: f64 = 0.2;

/// Displacements up to this are none, mm.
const SEEN_MM: f64 = 1e-7;

pub(crate) fn answer_text(query: &PlaceQuery, a: &Deflection) -> String {
    let mut out = query.heading();
    let length = |mm: f64| formatter::length(mm, 4, formatter::Rounding::Nearest);
    let mut moves = format!(
        "The tool's tip moves by {} and turns by {}.",
        length(a.displacement_size_mm),
        formatter::angle(a.rotation_size_deg, 4, formatter::Rounding::Nearest)
    );
    if a.displacement_without_load_size_mm > SEEN_MM {
        moves.push_str(&format!(
            " The load moves it by {}; {} by {} without the load.",
            length(a.displacement_by_load_size_mm),
            query.moves_unloaded(),
            length(a.displacement_without_load_size_mm)
        ));
    }
    out.push_str(&wrapped(&moves, 2));
    if let Some(by) = a.found_by.filter(|by| by.may_be_another_branch()) {
        out.push_str(&wrapped(&format!("Note: {}.", by.sentence()), 2));
    }
    out.push('\n');
    out.push_str(&vectors(a));
    out.push('\n');
    out.push_str(&actuators(a));
    out.push_str(&joints::values_text("On the controller", &a.on_controller));
    out.push_str(&stability(a));
    out.push_str(&links(a));
    out.push_str(&internal(a));
    // Newton's corrections fall faster and faster; where they do not, something is singular nearby.
    if let Some(rate) = a.rate_observed.filter(|rate| *rate > SLOW) {
        out.push('\n');
        out.push_str(&wrapped(
            &format!(
                "The iteration ended slowly, its last correction {} of the one before: a limit of the load or a change of shape is near.",
                number(rate, 2)
            ),
            2,
        ));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

/// Load and displacement, component by component.
fn vectors(a: &Deflection) -> String {
    let row = |name: &str, v: [f64; 3], decimals: usize, unit: &str| {
        let mut cells = vec![format!("{name}, {unit}")];
        let most = largest_size(v);
        // Fixed decimals would show a small load, or its effect, as zero.
        let small = most > 0.0 && most < 10.0_f64.powf(1.0 - decimals as f64);
        cells.extend(v.iter().map(|x| match small {
            true => number(*x, 4),
            false => fixed(*x, decimals),
        }));
        cells
    };
    let mut rows = vec![
        ["base axes", "x", "y", "z"].map(str::to_owned).to_vec(),
        row("force on the tool", a.force_n, 3, "N"),
        row("moment about its tip", a.moment_n_m, 3, "N m"),
        row("displacement of the tip", a.displacement_mm, 6, "mm"),
    ];
    if a.displacement_without_load_size_mm > SEEN_MM {
        let (load, unloaded) = (a.displacement_by_load_mm, a.displacement_without_load_mm);
        rows.push(row("of it by the load", load, 6, "mm"));
        rows.push(row("of it without the load", unloaded, 6, "mm"));
    }
    rows.push(row("rotation vector", a.rotation_vector_deg, 6, "deg"));
    columns(&rows, 2)
}

fn actuators(a: &Deflection) -> String {
    let mut rows = vec![
        ["actuator", "command", "", "force", ""]
            .map(str::to_owned)
            .to_vec(),
    ];
    for x in &a.actuators {
        rows.push(vec![
            x.name.clone(),
            fixed(x.command, 4),
            x.command_unit.to_owned(),
            fixed(x.force, 3),
            x.force_unit.to_owned(),
        ]);
    }
    match a.actuators.as_slice() {
        [] => "The machine has no actuators.\n".to_owned(),
        _ => columns(&rows, 2),
    }
}

/// Limbs, platform, and the whole with its tool free.
fn stability(a: &Deflection) -> String {
    let mut out = String::from("\nStability\n");
    for limb in &a.limbs {
        out.push_str(&layout::item(&limb_text(limb)));
    }
    out.push_str(&layout::item(&platform(a)));
    if let Some(share) = a.free_beyond_limbs.filter(|_| a.stable) {
        let of = match a.snapped {
            true => "this equilibrium beyond the snap, with the tool free,",
            false => "the machine with its tool free",
        };
        out.push_str(&layout::item(&format!(
            "{of} is {} % of the way to {}",
            number(100.0 * share, 3),
            leads_to(a.conservative)
        )));
    }
    for joint in &a.overcome_joints {
        out.push_str(&layout::item(&joint.description()));
    }
    if !a.conservative {
        out.push_str(&layout::item(&format!(
            "not conservative: {}; where the symmetric part of the stiffness is positive, nothing diverges, whatever the masses are; beyond, something diverges for all masses where the determinant is negative or that part is negative in every motion; flutter depends on masses and damping",
            a.not_conservative_because.join(", ")
        )));
    }
    out
}

/// States whether the platform is stable.
fn platform(a: &Deflection) -> String {
    if a.platform_may_flutter {
        let directions = match a.negative_directions.as_slice() {
            [] => String::new(),
            list => format!(
                ", as its stiffness is not positive where it {}",
                list.join("; it ")
            ),
        };
        format!(
            "the platform does not diverge, but may swing with growing amplitude (flutter), which depends on its masses{directions}"
        )
    } else if !a.platform_stable {
        match a.negative_directions.as_slice() {
            [] => "the platform does NOT stay: one in between has negative stiffness".to_owned(),
            list => format!(
                "the platform does NOT stay, its stiffness is negative: it {}",
                list.join("; it ")
            ),
        }
    } else if a.free_directions > 0 {
        format!(
            "the platform stays, but without any stiffness in {}",
            formatter::counted(a.free_directions, "direction")
        )
    } else {
        match a.smallest_stiffness_n_per_mm.is_finite() {
            true => format!(
                "the platform stays; its smallest stiffness against a force is {} N/mm",
                number(a.smallest_stiffness_n_per_mm, 4)
            ),
            false => "the platform stays; no force moves it".to_owned(),
        }
    }
}

/// Describes a limb's share of the way to instability: without a potential only a bound of stability is known
/// (see [`kinetostat::equilibrium::CriticalLoad::definite_until`]).
fn limb_text(limb: &LimbAnswer) -> String {
    let share = match limb.share_to_buckling {
        Some(mu) if mu.abs() < 1e-6 => "no load bends or buckles it".to_owned(),
        Some(mu) if mu < 0.0 => format!("{}: the load stretches it", formatter::share(mu)),
        Some(mu) => format!("{} of the way to buckling", formatter::share(mu)),
        None if limb.stable => "it has no inner freedom that could buckle".to_owned(),
        None => "a passive joint is pushed out of line".to_owned(),
    };
    let stability = match limb.stable {
        // Only loads without a potential are stable beyond one.
        true if limb.share_to_buckling.is_some_and(|mu| mu > 1.0) => {
            "does not diverge, but may swing with growing amplitude (flutter), which depends on its masses"
        }
        true => "keeps its shape",
        false => "does NOT keep its shape: it snaps to another one",
    };
    let neutral = if limb.neutral_passive_joints.is_empty() {
        String::new()
    } else {
        format!(
            "; {} can turn for nothing",
            limb.neutral_passive_joints.join(", ")
        )
    };
    format!("limb '{}' {stability} ({share}){neutral}", limb.name)
}

/// Axial loads of the links.
fn links(a: &Deflection) -> String {
    let single = a.limbs.len() == 1;
    let mut rows = vec![
        ["link", "axial force, N", "Euler load, N", "share of it"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for (limb, link) in a
        .limbs
        .iter()
        .flat_map(|l| l.links.iter().map(move |k| (l, k)))
    {
        rows.push(vec![
            match single {
                true => link.name.clone(),
                false => format!("{}: {}", limb.name, link.name),
            },
            fixed(link.axial_force_n, 3),
            number(link.euler_load_n, 4),
            formatter::share(link.share_of_euler_load),
        ]);
    }
    if rows.len() == 1 {
        return String::new();
    }
    format!(
        "\n{}{}",
        columns(&rows, 2),
        wrapped(
            "Negative forces compress; the Euler load is that of the link pinned at both ends, in its softer plane.",
            2
        )
    )
}

/// Internal forces between the limbs through the platform without any load on the tool.
fn internal(a: &Deflection) -> String {
    let size = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let any = a
        .limbs
        .iter()
        .any(|l| size(&l.force_without_load_n) > 1e-6 || size(&l.moment_without_load_n_m) > 1e-6);
    if !any {
        return String::new();
    }
    let mut rows = vec![
        [
            "without load on the tool",
            "force on its end, N",
            "moment, N m",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for l in &a.limbs {
        rows.push(vec![
            format!("limb '{}'", l.name),
            triple(l.force_without_load_n, |x| fixed(x, 3)),
            triple(l.moment_without_load_n_m, |x| fixed(x, 4)),
        ]);
    }
    format!("\n{}", columns(&rows, 2))
}

//! The answer of `equilibria` for a person.

use nalgebra::Vector3;

use crate::end_condition::holding::Holding;
use crate::equilibria::answer::{Coverage, EquilibriaAnswer, ShapeAnswer};
use crate::equilibria::query::MOST_KNOWN;
use crate::ui::layout::{WIDTH, columns, item, wrapped};
use crate::ui::numbers::{fixed, number};
use crate::ui::warnings;
use kinetostat::number::larger;

/// Upper limit of the equilibria that are shown; others are counted.
const MOST_SHOWN: usize = 20;

pub(crate) fn answer_text(heading: &str, a: &EquilibriaAnswer) -> String {
    let mut out = heading.to_owned();
    out.push_str(&wrapped(&a.question, 0));
    out.push('\n');
    out.push_str(&wrapped(&result_text(a), 2));
    if !a.equilibria.is_empty() {
        out.push('\n');
        out.push_str(&table(a));
        out.push('\n');
        out.push_str(&joints(a));
        if a.equilibria.len() > MOST_SHOWN {
            let listed = match a.coverage.known > a.equilibria.len() {
                true => format!("the first {} of them", a.equilibria.len() - MOST_SHOWN),
                false => "them".to_owned(),
            };
            out.push_str(&format!(
                "  and {} more of higher energy; JSON and CSV have {listed}\n",
                a.coverage.known - MOST_SHOWN
            ));
        }
        out.push_str(&modes(a));
    }
    out.push_str("\nHow complete this is\n");
    for line in completeness(a) {
        out.push_str(&item(&line));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn result_text(a: &EquilibriaAnswer) -> String {
    let mut text = found(a);
    if a.equilibria.iter().any(|e| e.may_flutter) {
        text.push_str(" Under the load, which has no potential, some may swing with growing amplitude (flutter); whether they do depends on the masses, which are not asked for here.");
    }
    text
}

fn found(a: &EquilibriaAnswer) -> String {
    let stable = a.coverage.known_stable;
    let mut text = match a.coverage.known {
        0 => none_found(&a.tool_held),
        1 if a.equilibria[0].singular => "One equilibrium, and it is degenerate: at a limit or bifurcation point, or one of a family that moves for nothing.".into(),
        1 if stable == 1 => "One equilibrium, and it is stable.".into(),
        1 => "One equilibrium, and it is NOT stable.".into(),
        n => {
            let of = match stable {
                0 => "none of them is stable".to_owned(),
                1 => "one of them is stable".to_owned(),
                n => format!(
                    "{n} of them are stable: the {} may snap between these",
                    a.tool_held.subject
                ),
            };
            format!("{n} equilibria; {of}.")
        }
    };
    if a.coverage.incomplete {
        text.push_str(
            " The list is INCOMPLETE: the energy has a minimum, and the stable shape there is missing. Search on with more --starts and --fruitless.",
        );
    }
    text
}

/// Possible causes, by end condition and loads.
fn none_found(holding: &Holding) -> String {
    let subject = holding.subject;
    let mut text = "No equilibrium was found. This does not say that there is none.".to_owned();
    if !holding.held.is_empty() {
        let locked = match subject {
            "machine" => "near a singular posture",
            _ => "near a posture in which the chain is stretched out and locked",
        };
        text.push_str(&format!(
            " The place where the tool is held may be out of the {subject}'s reach, and {locked} the search may miss some (`kinetostat curve` follows them there from a nearer place)."
        ));
    }
    if !holding.free.is_empty() {
        text.push_str(&format!(
            " What acts on the tool, where it is free, may be more than the {subject} can carry: check the load and its unit, or let it grow from nothing (`kinetostat curve` with --force and --factor)."
        ));
    }
    text
}

fn table(a: &EquilibriaAnswer) -> String {
    let along = match a.stiffness_along {
        Some(d) => format!(
            "N/mm along {}",
            crate::end_condition::holding::axis_description(&Vector3::from(d))
        ),
        None => "smallest principal, N/mm".to_owned(),
    };
    let energy = if a.conservative {
        "energy, J"
    } else {
        "spring energy, J"
    };
    // Forces that some equilibrium has.
    let component = |e: &ShapeAnswer, k: usize| {
        if k < 3 {
            e.force_n[k]
        } else {
            e.moment_n_m[k - 3]
        }
    };
    let most = |list: std::ops::Range<usize>| {
        a.equilibria
            .iter()
            .flat_map(|e| list.clone().map(move |k| component(e, k).abs()))
            .fold(0.0, larger)
    };
    let most = [most(0..3), most(3..6)];
    let names = ["fx, N", "fy, N", "fz, N", "mx, N m", "my, N m", "mz, N m"];
    let shown: Vec<usize> = (0..6)
        .filter(|&k| {
            let level = most[k / 3];
            level > 1e-9
                && a.equilibria
                    .iter()
                    .any(|e| component(e, k).abs() > 1e-7 * level)
        })
        .collect();
    let mut header = vec![
        "no".to_owned(),
        energy.to_owned(),
        "stable".to_owned(),
        "to buckling".to_owned(),
        along,
    ];
    header.extend(shown.iter().map(|&k| names[k].to_owned()));
    let mut rows = vec![header];
    for e in a.equilibria.iter().take(MOST_SHOWN) {
        let stability = match (e.stable, e.shape_stable, e.singular) {
            (_, _, true) => "at a limit",
            _ if e.may_flutter => "may swing",
            (true, ..) => "yes",
            (false, true, _) => "shape only",
            (false, false, _) => "NO",
        };
        let mut row = vec![
            e.number.to_string(),
            a.energy(e, 6),
            stability.to_owned(),
            e.share_to_buckling
                .map_or_else(|| "-".to_owned(), kinetostat_machining::number::share),
            match e.stiffness_n_per_mm.is_finite() {
                true => number(e.stiffness_n_per_mm, 5),
                false => "infinite".to_owned(),
            },
        ];
        row.extend(shown.iter().map(|&k| {
            let x = component(e, k);
            if x.abs() <= 1e-9 * most[k / 3] {
                "0".to_owned()
            } else {
                number(x, 6)
            }
        }));
        rows.push(row);
    }
    columns(&rows, 2)
}

/// Joints of every equilibrium, as many as the screen is wide.
fn joints(a: &EquilibriaAnswer) -> String {
    let moving: Vec<usize> = (0..a.coordinates.len())
        .filter(|&i| a.coordinates[i].kind != "spring" || a.coordinates.len() <= 8)
        .collect();
    let mut rows = vec![
        std::iter::once("no".to_owned())
            .chain(moving.iter().map(|&i| {
                let c = &a.coordinates[i];
                format!("{}, {}", c.name, c.unit)
            }))
            .collect::<Vec<String>>(),
    ];
    for e in a.equilibria.iter().take(MOST_SHOWN) {
        let mut row = vec![e.number.to_string()];
        row.extend(moving.iter().map(|&i| fixed(e.coordinates[i], 3)));
        rows.push(row);
    }
    let text = columns(&rows, 2);
    let wide = text.lines().any(|l| l.chars().count() > WIDTH);
    if wide || moving.is_empty() {
        return "  The joints are in the JSON and in the CSV.\n".into();
    }
    text
}

fn modes(a: &EquilibriaAnswer) -> String {
    let mut out = String::new();
    for e in a.equilibria.iter().filter(|e| !e.shape_stable).take(4) {
        if !e.mode_in_words.is_empty() {
            out.push_str(&item(&format!(
                "{} gives way with {}",
                e.number, e.mode_in_words
            )));
        }
    }
    if out.is_empty() {
        out
    } else {
        format!("\n{out}")
    }
}

/// Estimates the chance of equilibria that were not found. An estimate of zero is never printed: few starts know little.
fn chance(c: &Coverage) -> String {
    if c.chance_of_more_at_most >= 1.0 {
        return "too few of the starts ended at the equilibria listed to say how many are missing: others may well exist. Search on with more --starts and --fruitless".to_owned();
    }
    let at_most = number(100.0 * c.chance_of_more_at_most, 2);
    let so_far = match c.chance_of_more {
        Some(chance) => format!(
            "about {} % of further such starts would end at a new one, with 95 % confidence at most {at_most} %",
            number(100.0 * chance, 2)
        ),
        None => format!(
            "with 95 % confidence at most {at_most} % of further such starts would end at a new one"
        ),
    };
    format!(
        "{so_far}. This counts starts, not equilibria: one that few starts lead to may be missing"
    )
}

fn completeness(a: &EquilibriaAnswer) -> Vec<String> {
    let c = &a.coverage;
    let mut list = Vec::new();
    let seldom = a
        .equilibria
        .iter()
        .map(|e| e.found_by_spread_starts)
        .min()
        .unwrap_or(0);
    let machine = a.tool_held.subject == "machine";
    let limbs = !c.limbs.is_empty();
    let spread = match machine && !limbs {
        true => {
            "from places and orientations of the tool spread around the commanded one (and beyond singular postures nearby), every second one with turned joints"
        }
        false => "evenly spread over all joint angles within 180 deg",
    };
    if limbs {
        let counts: Vec<String> = (c.limbs.iter())
            .map(|own| format!("{} of '{}' ({} stable)", own.shapes, own.name, own.stable))
            .collect();
        list.push(format!(
            "with the tool held the limbs do not feel each other, and every combination of their shapes is an equilibrium: {}",
            counts.join(", ")
        ));
    }
    let mut text = format!(
        "{} starts{}, {spread}: {} ended at an equilibrium",
        c.starts,
        if limbs { " of the limbs" } else { "" },
        c.ended_within_bounds
    );
    if c.ended_outside_bounds > 0 {
        text.push_str(&format!(
            ", {} at {}",
            c.ended_outside_bounds,
            match machine {
                true => "one that is not listed: a slide turned inside out, or unstable and far away (more than three times the machine's size, or springs out of all proportion)",
                false => "one beyond these bounds",
            }
        ));
    }
    match seldom {
        0 => {}
        1 => text.push_str("; each one listed was found at least once"),
        n => text.push_str(&format!("; each one listed was found at least {n} times")),
    }
    list.push(text);
    list.push(if !c.exhausted && a.equilibria.len() >= MOST_KNOWN {
        format!(
            "the search ended when {MOST_KNOWN} were known; those of high energy strain the machine far beyond what it is made for"
        )
    } else if c.exhausted {
        format!(
            "the search ended because the last {} starts found nothing new",
            c.fruitless
        )
    } else {
        "the search ended before it was complete: --starts N and --fruitless N let it go on"
            .to_owned()
    });
    if !a.equilibria.is_empty() && !c.incomplete {
        list.push(chance(c));
    }
    if machine && !a.tool_held.free.is_empty() {
        list.push(
            "the tool was held at these places and let go; from the commanded place and from every equilibrium found it was driven along each of its free motions to every place where that takes no force, and let go beside unstable ones. Loops that can be assembled another way (a leg mirrored or bent far) are easily missed: these chances do not count them".to_owned(),
        );
    }
    if a.equilibria.iter().any(|e| e.found_by_spread_starts == 0) {
        list.push(
            "some were reached only along a curve or from another equilibrium (mirrored, or along its mode): such shapes are easily missed"
                .to_owned(),
        );
    }
    if a.equilibria.iter().any(|e| e.singular) {
        list.push(
            "one is degenerate: at a limit or bifurcation point, or one of a family that moves for nothing"
                .to_owned(),
        );
    }
    list
}

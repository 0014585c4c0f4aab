//! Two elastic links with a torsion spring between them and a load on the middle [R 4.6.2]: Figures
//! 4.4 and 4.5. The report prints no numbers of them.

use kinetostat::{
    Chain, ChainProblem, CurveSettings, Equilibrium, Load, Settings, Wrench,
    continuation::{CurvePoint, Curves, SpecialKind},
    equilibria,
    equilibrium::{Bounds, Equilibria, SearchSettings},
    follow, solve_chain,
};
use kinetostat_report::{Plot, PlotLine};
use nalgebra::Vector3;

use crate::chapter_5::three_link_figures::outline;
use crate::shared::curves::{Drawn, lines, marks, of_kind, unstable_entry};
use crate::shared::models::{
    ALPHA0, along_x, at_rest, critical_load, displacement_controlled, elastic_links, load_on_middle,
};
use crate::{Cause, Contents, Item};

/// Loads, in units of G*.
const LOADS: [f64; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];

fn problem(chain: &Chain, g: f64, dx: f64) -> Result<ChainProblem<'_>, Cause> {
    let mut problem = displacement_controlled(chain, at_rest() + dx);
    problem.posture = vec![ALPHA0, 0.0, -2.0 * ALPHA0, 0.0, ALPHA0];
    problem.loads = load_on_middle(chain, g)?;
    Ok(problem)
}

fn all(chain: &Chain, g: f64, dx: f64) -> Result<Equilibria, Cause> {
    let settings = SearchSettings::default();
    Ok(equilibria(
        &problem(chain, g, dx)?,
        &Bounds::of(chain),
        &settings,
    )?)
}

fn k_x(e: &Equilibrium) -> f64 {
    e.stiffness.cartesian.matrix[(0, 0)]
}

fn node_y(e: &Equilibrium) -> f64 {
    e.nodes.first().map_or(f64::NAN, |n| n.translation.y)
}

fn load_name(g: f64) -> String {
    match g {
        0.0 => "G = 0".into(),
        1.0 => "G = G*".into(),
        g => format!("G = {g} G*"),
    }
}

fn missing(what: &str) -> Cause {
    Cause::Missing(what.to_owned())
}

/// The curves through all shapes at one displacement: every loop, open or closed.
fn curves<'c>(chain: &'c Chain, g: f64, range: (f64, f64)) -> Result<Curves<'c>, Cause> {
    let at = -0.05;
    let found = all(chain, g, at)?;
    let first = found.found.first().ok_or_else(|| missing("a shape"))?;
    let mut settings = CurveSettings::within(range.0 - at, range.1 - at);
    settings.largest_turn = 0.03;
    let problem = problem(chain, g, at)?;
    let mut curves = follow(&problem, &along_x(), &first.equilibrium, 0.0, &settings)?;
    for other in found.found.iter().skip(1) {
        curves.add(&other.equilibrium, 0.0)?;
    }
    Ok(curves)
}

pub(crate) fn fig_4_4() -> Result<Contents, Cause> {
    let chain = elastic_links(ALPHA0)?;
    let mut items = Vec::new();
    let mut plot = Plot {
        title: "Figure 4.4: force of two elastic links under a load G on the middle".into(),
        x_label: "displacement dx / L".into(),
        y_label: "force F_x L / K".into(),
        lines: vec![unstable_entry("unstable, end held")],
        marks: Vec::new(),
    };
    for (colour, g) in LOADS.into_iter().enumerate() {
        let c = curves(&chain, g, (-0.1, 0.08))?;
        let name = load_name(g);
        for limit in of_kind(&c, SpecialKind::DisplacementLimit) {
            let p = &limit.point.equilibrium;
            let at = format!("limit point with the end held, G = {g} G*");
            for (what, value, unit) in [
                ("x", p.tip.translation.x, "L"),
                ("dx", p.tip.translation.x - at_rest(), "L"),
                ("node y", node_y(p), "L"),
                ("F_x", p.wrench.0[0], "K/L"),
            ] {
                items.push(Item::unprinted(
                    format!("{what} of the {at}"),
                    value,
                    unit,
                    "",
                ));
            }
        }
        let at = |p: &CurvePoint| (p.equilibrium.tip.translation.x - at_rest(), p.conjugate);
        let drawn = Drawn {
            name: &name,
            colour,
            held: true,
            at: &at,
        };
        plot.lines.extend(lines(&c, &drawn));
        plot.marks.extend(marks(&c, &drawn, |k| {
            k == SpecialKind::DisplacementLimit || k.is_bifurcation()
        }));
    }
    flat(&mut items)?;
    critical(&chain, &mut items)?;
    Ok(Contents {
        items,
        plots: vec![plot],
    })
}

/// The flat posture: a fork without preload, a limit point with it.
fn flat(items: &mut Vec<Item>) -> Result<(), Cause> {
    let chain = elastic_links(0.0)?;
    let straight = displacement_controlled(&chain, 2.0);
    let start = solve_chain(&straight, &Settings::default())?;
    let mut settings = CurveSettings::within(-0.2, 0.05);
    settings.branches = 4;
    let c = follow(&straight, &along_x(), &start, 0.0, &settings)?;
    let forks = of_kind(&c, SpecialKind::Pitchfork);
    let fork = forks
        .last()
        .ok_or_else(|| missing("the pitchfork of the flat chain"))?;
    let x = 2.0 + fork.point.parameter;
    items.push(Item::unprinted(
        "pitchfork of the flat chain without preload (a0 = 0): x",
        x,
        "L",
        "K_L r^2 - K_L r + 2K = 0, x = 2r.",
    ));
    items.push(Item::unprinted(
        "pitchfork of the flat chain without preload: F_x",
        fork.point.conjugate,
        "K/L",
        "",
    ));

    // With the preload, the load 4 a0/r holds the chain flat at the same place.
    let chain = elastic_links(ALPHA0)?;
    let r = 0.5 * x;
    let load = 4.0 * ALPHA0 / r;
    let mut flat = displacement_controlled(&chain, x);
    flat.loads = vec![Load::Dead {
        node: chain.node("middle")?,
        wrench: Wrench::new(Vector3::new(0.0, -load, 0.0), Vector3::zeros()),
    }];
    // The curve of flat and nearly flat shapes, from one beside the point.
    let beside = {
        let mut near = flat.clone();
        near.end.pose.translation.x = x - 0.01;
        let found = equilibria(&near, &Bounds::of(&chain), &SearchSettings::default())?;
        let flattest = found
            .found
            .iter()
            .filter(|f| !f.stable)
            .min_by(|a, b| {
                let of =
                    |f: &kinetostat::equilibrium::FoundEquilibrium| node_y(&f.equilibrium).abs();
                of(a).total_cmp(&of(b))
            })
            .map(|f| f.equilibrium.clone());
        flattest.ok_or_else(|| missing("the flat shape"))?
    };
    let mut settings = CurveSettings::within(-0.05, 0.05);
    settings.branches = 4;
    let c = follow(&flat, &along_x(), &beside, -0.01, &settings)?;
    let note = "The theory calls this a perfect pitchfork. It is none: E_YYY = 8 a0/r^3 is not zero, so under constant G the curve turns back here (limit point); only without preload (a0 = 0) it forks.";
    let limit = c
        .specials
        .iter()
        .min_by(|a, b| {
            let away = |s: &kinetostat::continuation::Special| s.point.parameter.abs();
            away(a).total_cmp(&away(b))
        })
        .ok_or_else(|| missing("the limit point of the flat chain"))?;
    items.push(Item::unprinted(
        format!(
            "flat chain with preload: x of its {}",
            crate::shared::curves::word(limit.kind)
        ),
        x + limit.point.parameter,
        "L",
        note,
    ));
    items.push(Item::unprinted(
        "flat chain with preload: G = 4 a0/r that holds it there",
        load,
        "K/L",
        "",
    ));
    items.push(Item::unprinted(
        "flat chain with preload: the same in units of G*",
        load / critical_load(),
        "",
        "",
    ));
    Ok(())
}

/// Load at which the stiffness of the upper shape at dx = 0 vanishes.
fn critical(chain: &Chain, items: &mut Vec<Item>) -> Result<(), Cause> {
    // The stiffness is steep here: converged beyond the default.
    let settings = Settings::default().with_torque(1e-13);
    let at = |g: f64| -> Result<Equilibrium, Cause> {
        Ok(solve_chain(&problem(chain, g, 0.0)?, &settings)?)
    };
    let (mut a, mut b) = (1.0, 1.02);
    let (mut at_a, mut at_b) = (k_x(&at(a)?), k_x(&at(b)?));
    for _ in 0..40 {
        if (b - a).abs() < 1e-14 || at_a == at_b {
            break;
        }
        let next = b - at_b * (b - a) / (at_b - at_a);
        (a, at_a) = (b, at_b);
        b = next;
        at_b = k_x(&at(b)?);
    }
    let e = at(b)?;
    for (what, value, unit) in [
        ("G/G*", b, ""),
        ("node y", node_y(&e), "L"),
        ("F_x", e.wrench.0[0], "K/L"),
    ] {
        items.push(Item::unprinted(
            format!("K_x = 0 of the upper shape at dx = 0: {what}"),
            value,
            unit,
            "G* of the rigid links is 1.1 % low for elastic ones.",
        ));
    }
    Ok(())
}

pub(crate) fn fig_4_5() -> Result<Contents, Cause> {
    let chain = elastic_links(ALPHA0)?;
    let mut items = Vec::new();
    let mut plots = Vec::new();
    for dx in [-0.05, 0.0, 0.05] {
        let mut plot = Plot {
            title: format!("Figure 4.5: all shapes at dx = {dx} L (y drawn larger than x)"),
            x_label: "x / L".into(),
            y_label: "y / L".into(),
            lines: vec![unstable_entry("unstable, end held")],
            marks: Vec::new(),
        };
        for (colour, g) in LOADS.into_iter().enumerate() {
            let found = all(&chain, g, dx)?;
            items.push(Item::unprinted(
                format!("G = {g} G*, dx = {dx} L: shapes found"),
                found.found.len() as f64,
                "",
                "K_L = 200 K/L^2.",
            ));
            items.push(Item::unprinted(
                format!(
                    "G = {g} G*, dx = {dx} L: chance that a further start finds another, at most"
                ),
                found.chance_of_more_at_most,
                "",
                "Upper end of the estimate, at 95 %.",
            ));
            // From the upper shape down.
            let mut shapes: Vec<&kinetostat::equilibrium::FoundEquilibrium> =
                found.found.iter().collect();
            shapes.sort_by(|a, b| node_y(&b.equilibrium).total_cmp(&node_y(&a.equilibrium)));
            for (k, f) in shapes.iter().enumerate() {
                let e = &f.equilibrium;
                let free = f.stable && k_x(e) > 0.0;
                let stability = match (f.stable, free) {
                    (_, true) => "stable",
                    (true, false) => "stable with the end held, unstable under a dead force",
                    (false, _) => "unstable",
                };
                let label = format!("G = {g} G*, dx = {dx} L, shape {}", k + 1);
                for (what, value, unit) in [
                    ("node y", node_y(e), "L"),
                    ("F_x", e.wrench.0[0], "K/L"),
                    ("K_xx", k_x(e), "K/L^2"),
                ] {
                    items.push(Item::unprinted(
                        format!("{label}: {what}"),
                        value,
                        unit,
                        stability,
                    ));
                }
                plot.lines.push(PlotLine {
                    name: if f.stable && (k == 0 || !shapes[0].stable) {
                        load_name(g)
                    } else {
                        String::new()
                    },
                    colour,
                    dashed: !f.stable,
                    dots: false,
                    points: outline(&chain, &e.coordinates, &["middle"]),
                });
            }
        }
        plots.push(plot);
    }
    Ok(Contents { items, plots })
}

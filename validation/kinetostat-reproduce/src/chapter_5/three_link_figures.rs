//! Figures 5.5 to 5.8: energy, shapes and curves of the three-link chains.

use kinetostat::{
    Chain, CurveSettings, EndCondition, MotionKind, Pose, Prescribed, Settings, Wrench,
    continuation::{Curves, LoadPattern, SpecialKind},
    critical_load_factor,
    equilibrium::StabilityOf,
    follow,
    model::Kinematics,
    solve_chain,
};
use kinetostat_report::{Plot, PlotLine, PlotMark};
use nalgebra::{Vector2, Vector3};

use crate::chapter_5::three_links::{ThreeLinkShape, pick, shapes};
use crate::shared::curves::{Drawn, lines, marks, of_kind, unstable_entry};
use crate::shared::models::{
    along_x, displacement_controlled, linked, s_chain, z_at_rest, z_chain,
};
use crate::{Cause, Contents, Item};

/// Displacement of the energy diagram and of the shapes shown; the report's figure names none.
const DELTA: f64 = 0.2;

/// Energy of the straight chain as its first link is turned to `q` and its end held: both elbows.
/// `None` beyond the reach of the other two links.
fn energy(q: f64, elbow: f64) -> Result<Option<f64>, Cause> {
    let z = Vector3::z();
    let chain = Chain::builder("S chain, first link turned")
        .rigid(Pose::rotation(z * q))
        .translation(Vector3::new(1.0, 0.0, 0.0))
        .spring("theta1", MotionKind::Revolute, z, 1.0, 0.0)
        .translation(Vector3::new(1.0, 0.0, 0.0))
        .spring("theta2", MotionKind::Revolute, z, 1.0, 0.0)
        .translation(Vector3::new(1.0, 0.0, 0.0))
        .build()?;
    let mut problem = displacement_controlled(&chain, 3.0 - DELTA);
    let span = Vector2::new(3.0 - DELTA - q.cos(), -q.sin());
    let reach = 0.5 * span.norm();
    if reach >= 1.0 {
        return Ok(None);
    }
    let half = reach.acos() * elbow;
    problem.posture = vec![span.y.atan2(span.x) + half - q, -2.0 * half];
    Ok(Some(solve_chain(&problem, &Settings::default())?.energy))
}

pub(crate) fn fig_5_5() -> Result<Contents, Cause> {
    let chain = s_chain()?;
    let found = shapes(&chain, 3.0 - DELTA)?;
    let stable = found.iter().filter(|e| e.stable).count();
    let mut items = vec![
        Item::compared("minima of the energy", "2", stable as f64, "", ""),
        Item::compared(
            "maxima of the energy",
            "2",
            (found.len() - stable) as f64,
            "",
            "The report names no displacement; here Delta = 0.2.",
        ),
    ];
    // Both elbows meet where the other two links are stretched.
    let last = ((1.0 + (3.0 - DELTA).powi(2) - 4.0) / (2.0 * (3.0 - DELTA))).acos();
    let steps = 60;
    let mut up = Vec::new();
    let mut down = Vec::new();
    for k in 1..steps {
        let q = -last * (std::f64::consts::PI * f64::from(k) / f64::from(steps)).cos();
        if let Some(e) = energy(q, 1.0)? {
            up.push((q.to_degrees(), e));
        }
        if let Some(e) = energy(q, -1.0)? {
            down.push((q.to_degrees(), e));
        }
    }
    let mut plot = Plot {
        title: "Figure 5.5: energy of the S chain over its first angle, Delta = 0.2".into(),
        x_label: "angle q, degrees".into(),
        y_label: "energy E / K".into(),
        lines: vec![
            PlotLine::solid("elbow up", 0, up),
            PlotLine::solid("elbow down", 1, down),
        ],
        marks: Vec::new(),
    };
    for e in &found {
        let energy = 0.5 * (e.angles[1].powi(2) + e.angles[2].powi(2));
        let name = if e.stable { "minimum" } else { "maximum" };
        let q = e.angles[0].to_degrees();
        items.push(Item::unprinted(
            format!("energy of the {name} at q = {q:.3} deg"),
            energy,
            "K",
            "",
        ));
        plot.marks.push(PlotMark {
            at: (q, energy),
            name: name.into(),
            detail: format!("q = {q:.6} deg, E = {energy:.9} K"),
        });
    }
    Ok(Contents {
        items,
        plots: vec![plot],
    })
}

/// The links of a chain at a posture, as a line.
pub(crate) fn outline(chain: &Chain, angles: &[f64], joints: &[&str]) -> Vec<(f64, f64)> {
    let k = Kinematics::new(chain, &Pose::identity(), angles, &[]);
    let mut points = vec![(0.0, 0.0)];
    for name in joints {
        if let Ok(node) = chain.node(name) {
            let p = k.node_position(node);
            points.push((p.x, p.y));
        }
    }
    let tip = k.tip_pose().translation.vector;
    points.push((tip.x, tip.y));
    points
}

/// Joints of the chain from the angles alone: links of unit length.
fn links(e: &ThreeLinkShape) -> Vec<(f64, f64)> {
    let mut at = (0.0, 0.0);
    let mut turned = 0.0;
    let mut points = vec![at];
    for angle in e.angles.iter().take(3) {
        turned += angle;
        at = (at.0 + turned.cos(), at.1 + turned.sin());
        points.push(at);
    }
    points
}

fn shape_items(items: &mut Vec<Item>, label: &str, e: &ThreeLinkShape) {
    for (what, value, unit) in [
        ("q", e.angles[0].to_degrees(), "deg"),
        ("theta1", e.angles[1].to_degrees(), "deg"),
        ("theta2", e.angles[2].to_degrees(), "deg"),
        ("F_x", e.force, "K/l"),
        ("K_x", e.stiffness, "K/l^2"),
        ("S_c", e.s_c, "K"),
        (
            "share mu of the way to buckling (stable below 1)",
            e.share_to_buckling,
            "",
        ),
    ] {
        items.push(Item::unprinted(format!("{label}: {what}"), value, unit, ""));
    }
}

pub(crate) fn fig_5_6() -> Result<Contents, Cause> {
    let chain = s_chain()?;
    let mut items = Vec::new();
    let mut plot = Plot {
        title: "Figure 5.6: shapes of the S chain".into(),
        x_label: "x / l".into(),
        y_label: "y / l".into(),
        lines: vec![unstable_entry("unstable (Z)")],
        marks: Vec::new(),
    };
    for (colour, delta) in [0.02, 0.2, 0.5, 1.0, 1.5].into_iter().enumerate() {
        let found = shapes(&chain, 3.0 - delta)?;
        for stable in [true, false] {
            let e = pick(&found, "a shape of the S chain", |e| {
                e.stable == stable && e.angles[0] > 0.0
            })?;
            let form = if stable {
                "stable (arch)"
            } else {
                "unstable (Z)"
            };
            shape_items(&mut items, &format!("Delta = {delta}, {form}"), &e);
            plot.lines.push(PlotLine {
                name: if stable {
                    format!("Delta = {delta}")
                } else {
                    String::new()
                },
                colour,
                dashed: !stable,
                dots: false,
                points: links(&e),
            });
        }
    }
    Ok(Contents {
        items,
        plots: vec![plot],
    })
}

pub(crate) fn fig_5_8() -> Result<Contents, Cause> {
    let chain = z_chain()?;
    let mut items = Vec::new();
    let mut plot = Plot {
        title: "Figure 5.8: shapes of the Z chain".into(),
        x_label: "x / l".into(),
        y_label: "y / l".into(),
        lines: vec![unstable_entry("unstable (symmetric)")],
        marks: Vec::new(),
    };
    for (colour, delta) in [0.0, 0.05, 0.1, 0.115, 0.2, 0.4].into_iter().enumerate() {
        let found = shapes(&chain, z_at_rest() - delta)?;
        for (k, e) in found.iter().enumerate() {
            let stability = if e.stable { "stable" } else { "unstable" };
            let label = format!("Delta = {delta}, shape {} ({stability})", k + 1);
            shape_items(&mut items, &label, e);
        }
        // The mirrored Z is the same at all displacements: left out of the picture.
        let mut named = false;
        for e in found.iter().filter(|e| e.angles[1] < 0.0) {
            plot.lines.push(PlotLine {
                name: if e.stable && !named {
                    named = true;
                    format!("Delta = {delta}")
                } else {
                    String::new()
                },
                colour,
                dashed: !e.stable,
                dots: false,
                points: links(e),
            });
        }
    }
    let (c, start) = z_curve(&chain)?;
    let forks = of_kind(&c, SpecialKind::Pitchfork);
    let fork = forks
        .first()
        .ok_or_else(|| Cause::Missing("the pitchfork of the Z chain".into()))?;
    items.push(Item::unprinted(
        "pitchfork: Delta",
        -fork.point.parameter,
        "l",
        "The zigzag loses its symmetry here: the \"sudden transformation\" of the text.",
    ));
    items.push(Item::unprinted(
        "pitchfork: x",
        start - -fork.point.parameter,
        "l",
        "",
    ));
    items.push(Item::unprinted(
        "pitchfork: F_x",
        fork.point.conjugate,
        "K/l",
        "",
    ));
    let mut curve = Plot {
        title: "Figure 5.8: force of the Z chain".into(),
        x_label: "displacement Delta / l".into(),
        y_label: "compressive force -F_x l / K".into(),
        lines: vec![unstable_entry("unstable")],
        marks: Vec::new(),
    };
    let drawn = Drawn {
        name: "stable, end held",
        colour: 0,
        held: true,
        at: &|p| (-p.parameter, -p.conjugate),
    };
    curve.lines.extend(lines(&c, &drawn));
    curve.marks = marks(&c, &drawn, |_| true);
    Ok(Contents {
        items,
        plots: vec![plot, curve],
    })
}

fn z_curve(chain: &Chain) -> Result<(Curves<'_>, f64), Cause> {
    let mut problem = displacement_controlled(chain, z_at_rest());
    problem.posture = vec![0.17, -0.52, 0.52, 0.0];
    let start = solve_chain(&problem, &Settings::default())?;
    let mut settings = CurveSettings::within(-0.45, 0.05);
    settings.largest_turn = 0.03;
    settings.branches = 10;
    let c = follow(&problem, &along_x(), &start, 0.0, &settings)?;
    Ok((c, z_at_rest()))
}

pub(crate) fn fig_5_7() -> Result<Contents, Cause> {
    let chain = s_chain()?;
    let problem = displacement_controlled(&chain, 3.0);
    let start = solve_chain(&problem, &Settings::default())?;
    let mut settings = CurveSettings::within(-1.52, 0.1);
    settings.largest_turn = 0.05;
    settings.conjugate_range = (-6.0, 1.0);
    settings.branches = 10;
    let c = follow(&problem, &along_x(), &start, 0.0, &settings)?;
    let drawn = Drawn {
        name: "stable",
        colour: 0,
        held: true,
        at: &|p| (-p.parameter, -p.conjugate),
    };
    let mut plot = Plot {
        title: "Figure 5.7: force of the S chain".into(),
        x_label: "displacement Delta / l".into(),
        y_label: "compressive force -F_x l / K".into(),
        lines: lines(&c, &drawn),
        marks: marks(&c, &drawn, |_| true),
    };
    plot.lines.push(unstable_entry("unstable"));

    let mut items = Vec::new();
    let mut forks = of_kind(&c, SpecialKind::Pitchfork);
    forks.sort_by(|a, b| b.point.conjugate.total_cmp(&a.point.conjugate));
    for (fork, mode) in forks.iter().zip(["arch", "zigzag"]) {
        items.push(Item::unprinted(
            format!("bifurcation load of the {mode}"),
            -fork.point.conjugate,
            "K/l",
            "Compression positive, as in the figure.",
        ));
    }
    for delta in [0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 1.5] {
        let found = shapes(&chain, 3.0 - delta)?;
        for (stable, name) in [(true, "stable"), (false, "unstable")] {
            let e = pick(&found, "a shape of the S chain", |e| e.stable == stable)?;
            for (what, value, unit) in [
                ("F", -e.force, "K/l"),
                ("K", e.stiffness, "K/l^2"),
                ("S_c", e.s_c, "K"),
            ] {
                let name = format!("{what} of the {name} shape at Delta = {delta}");
                items.push(Item::unprinted(name, value, unit, ""));
            }
        }
    }
    for n in 2..=6 {
        let load = column(n)?;
        let exact = 2.0 * (1.0 - (std::f64::consts::PI / n as f64).cos());
        items.push(Item::unprinted(
            format!("critical load of {n} equal links"),
            load,
            "K/l",
            &format!("2 (1 - cos(pi/{n})) = {exact:.10}"),
        ));
    }
    Ok(Contents {
        items,
        plots: vec![plot],
    })
}

/// First critical load of a straight column of `n` links, ends hinged.
fn column(n: usize) -> Result<f64, Cause> {
    let chain = linked("column", &vec![0.0; n - 1]).build()?;
    let mut end = EndCondition::pose(Pose::translation(n as f64, 0.0, 0.0));
    end.prescribed[0] = Prescribed::Wrench;
    end.prescribed[5] = Prescribed::Wrench;
    let problem = kinetostat::ChainProblem::new(&chain, end);
    let pattern = LoadPattern {
        end: Wrench::new(-Vector3::x(), Vector3::zeros()),
        loads: Vec::new(),
    };
    let settings = CurveSettings::within(0.0, 5.0);
    let critical = critical_load_factor(&problem, &pattern, StabilityOf::ShapeAndEnd, &settings)?;
    let exact = critical
        .exact
        .ok_or_else(|| Cause::Missing(format!("the critical load of {n} links")))?;
    Ok(exact.factor)
}

//! Curves of equilibria: limit points and bifurcations at their places to 1e-8 with their kinds,
//! branches through the tabulated equilibria, jumps, and critical loads [R 4.6, 5.2-5.6].

use crate::common::{
    Recipe, Rng, assert_chain_equilibrium, close, golden, number, planar_column, random_chain,
};
use crate::curves_of_columns::press;
use crate::curves_of_elastic_links::{elastic_links, elastic_problem};
use kinetostat::{
    Anchor, Chain, ChainProblem, CurveSettings, EndCondition, Equilibrium, Load, MotionKind,
    Parameter, Pose, Prescribed, Settings, Twist, Wrench,
    continuation::{BranchEnd, CurvePoint, Curves, LoadPattern, Special, SpecialKind},
    critical_load_factor,
    equilibrium::StabilityOf,
    follow, solve_chain,
    spatial::moved,
};
use nalgebra::{Vector3, vector};

pub fn z_chain() -> Chain {
    let z = Vector3::z();
    Chain::builder("z")
        .passive("q", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("th1", MotionKind::Revolute, z, 1.0, -30_f64.to_radians())
        .translation(vector![1.0, 0.0, 0.0])
        .spring("th2", MotionKind::Revolute, z, 1.0, 30_f64.to_radians())
        .translation(vector![1.0, 0.0, 0.0])
        .passive("e", MotionKind::Revolute, z, 0.0)
        .build()
        .unwrap()
}

/// Where the end of the unloaded Z chain is, m.
pub fn z_unloaded() -> f64 {
    (5.0 + 4.0 * 30_f64.to_radians().cos()).sqrt()
}

/// End held at x on its line, free to turn.
pub fn held(chain: &Chain, x: f64) -> ChainProblem<'_> {
    let mut end = EndCondition::pose(Pose::translation(x, 0.0, 0.0));
    end.prescribed[5] = Prescribed::Wrench;
    ChainProblem::new(chain, end)
}

pub fn along_x() -> Parameter {
    Parameter::Displacement(Twist::new(vector![1.0, 0.0, 0.0], Vector3::zeros()))
}

pub fn solved(problem: &ChainProblem<'_>) -> Equilibrium {
    let e = solve_chain(problem, &Settings::default()).unwrap();
    assert_chain_equilibrium(problem, &e);
    e
}

/// What holds for every curve: equilibria at every point, finite numbers, steps along the tangent.
#[track_caller]
pub fn assert_curves(c: &Curves<'_>) {
    for branch in &c.branches {
        assert!(branch.points.len() > 1, "a branch without a step");
        for p in &branch.points {
            assert_point(c, p);
        }
        for pair in branch.points.windows(2) {
            assert!(pair[1].arc > pair[0].arc);
        }
        for end in branch.ends {
            assert_ne!(end, BranchEnd::Lost, "a branch was lost");
        }
    }
    for s in &c.specials {
        assert_point(c, &s.point);
        assert!(s.mode.iter().all(|x| x.abs() <= 1.0));
    }
}

#[track_caller]
fn assert_point(c: &Curves<'_>, p: &CurvePoint) {
    assert!(p.parameter.is_finite() && p.conjugate.is_finite() && !p.slope.is_nan());
    let mut problem = c.problem.clone();
    match &c.parameter {
        Parameter::Displacement(t) => {
            problem.end.pose.translation.vector += t.linear() * p.parameter;
        }
        Parameter::Load(pattern) => {
            problem.end.wrench += pattern.end * p.parameter;
            for load in &pattern.loads {
                let Load::Dead { node, wrench } = load else {
                    panic!("dead loads only")
                };
                problem.loads.push(Load::Dead {
                    node: *node,
                    wrench: *wrench * p.parameter,
                });
            }
        }
    }
    assert_chain_equilibrium(&problem, &p.equilibrium);
}

pub fn of_kind<'c>(c: &'c Curves<'_>, kind: SpecialKind) -> Vec<&'c Special> {
    c.specials.iter().filter(|s| s.kind == kind).collect()
}

#[test]
fn the_z_chain_forks_at_its_pitchfork() {
    let chain = z_chain();
    let mut problem = held(&chain, z_unloaded());
    problem.posture = vec![0.17, -0.52, 0.52, 0.0];
    let start = solved(&problem);
    let mut settings = CurveSettings::within(-0.45, 0.05);
    settings.branches = 10;
    let c = follow(&problem, &along_x(), &start, 0.0, &settings).unwrap();
    assert_curves(&c);
    assert_eq!(c.branches.len(), 2);
    assert_eq!(c.specials.len(), 1);
    let fork = &c.specials[0];
    assert_eq!(fork.kind, SpecialKind::Pitchfork);
    close("Delta", -fork.point.parameter, 0.110931613194, 1e-11);
    close("F_x", fork.point.conjugate, -1.03347699957, 1e-10);
    close(
        "x",
        fork.point.equilibrium.tip.translation.x,
        2.79838129798,
        1e-10,
    );
    // Both curves go through every equilibrium of the table that is connected to the start.
    let file = golden("z_chain.json");
    for row in file["cases"].as_array().unwrap() {
        let n = |key: &str| number(&row[key]);
        if n("theta1_deg") > 0.0 {
            continue; // the mirrored Z is connected only through the straight chain
        }
        let label = format!("delta {}, q {}", n("delta"), n("q_deg"));
        let here = c.at(-n("delta")).unwrap();
        let p = here
            .iter()
            .find(|p| (p.equilibrium.coordinates[0].to_degrees() - n("q_deg")).abs() < 1e-5)
            .unwrap_or_else(|| panic!("{label}: not on the curve"));
        assert_point(&c, p);
        close(&label, p.conjugate, n("F_x"), 2e-8);
        close(&label, p.slope, n("K_x"), 1e-6);
        let stable = row["stable"].as_bool().unwrap();
        assert_eq!(p.displacement_control.stable, stable, "{label}");
        assert_eq!(p.dead_load.stable, stable && n("K_x") > 0.0, "{label}");
        close(
            &label,
            p.displacement_control.share_to_buckling.unwrap(),
            n("mu"),
            1e-7,
        );
    }
}

#[test]
fn the_s_chain_passes_through_figure_5_7() {
    let file = golden("figure_5_7.json");
    let chain = planar_column(3, 1.0, 1.0);
    let problem = held(&chain, 3.0);
    let start = solved(&problem);
    let mut settings = CurveSettings::within(-1.52, 0.1);
    settings.conjugate_range = (-6.0, 1.0);
    settings.branches = 10;
    // The straight chain is locked: its curve is a line of rising force at one displacement.
    let c = follow(&problem, &along_x(), &start, 0.0, &settings).unwrap();
    assert_curves(&c);
    assert_eq!(c.branches.len(), 3);
    let forks = of_kind(&c, SpecialKind::Pitchfork);
    assert_eq!((forks.len(), c.specials.len()), (2, 2));
    for (fork, force) in forks.iter().zip([-1.0, -3.0]) {
        close("bifurcation load", fork.point.conjugate, force, 1e-10);
        close("at the locked length", fork.point.parameter, 0.0, 1e-12);
    }
    for p in &c.branches[0].points {
        assert_eq!(
            p.displacement_control.stable,
            p.conjugate > -1.0,
            "straight at {}",
            p.conjugate
        );
    }
    for row in file["cases"].as_array().unwrap() {
        let delta = number(&row["delta"]);
        let here = c.at(-delta).unwrap();
        assert_eq!(
            here.len(),
            4,
            "two shapes and their mirror images at {delta}"
        );
        for (shape, stable) in [("stable", true), ("unstable", false)] {
            let label = format!("{shape} at {delta}");
            let same: Vec<_> = here
                .iter()
                .filter(|p| p.displacement_control.stable == stable)
                .collect();
            assert_eq!(same.len(), 2, "{label}");
            for p in same {
                close(&label, p.conjugate, number(&row[shape]["F_x"]), 2e-8);
                close(&label, p.slope, number(&row[shape]["K_x"]), 3e-7);
            }
        }
    }
}

/// Zeros of K_x of the rigid two-link chain (4.6.1): load limits of the upper branch, two of them
/// near each other.
#[test]
fn the_rigid_links_have_the_load_limits_of_the_closed_form() {
    let z = Vector3::z();
    let a0 = 15_f64.to_radians();
    let chain = Chain::builder("two links")
        .passive("q1", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .node("middle")
        .spring("theta", MotionKind::Revolute, z, 1.0, -2.0 * a0)
        .translation(vector![1.0, 0.0, 0.0])
        .passive("q2", MotionKind::Revolute, z, 0.0)
        .build()
        .unwrap();
    type Row = (f64, f64, f64);
    let table: [(f64, &[Row]); 4] = [
        (0.9, &[]),
        (
            1.005,
            &[
                (0.1422197071, 0.0479559718, -1.945908995),
                (0.3522324213, -0.0546418919, -1.939607473),
            ],
        ),
        (1.05, &[(0.5116302756, -0.187956683, -1.988529081)]),
        (1.5, &[(0.9032153489, -0.693675473, -2.245611734)]),
    ];
    for (g, rows) in table {
        // Coarse steps of half a radian hold two limit points in one step.
        for turn in [0.1, 0.5] {
            let label = format!("G/G* {g}, steps of {turn}");
            let mut problem = elastic_problem(&chain, g, -1.0);
            let a = ((2.0 * a0.cos() - 1.0) / 2.0_f64).acos();
            problem.posture = vec![a, -2.0 * a, 0.0];
            let mut settings = CurveSettings::within(-0.2, 1.06);
            settings.largest_turn = turn;
            settings.largest_change = Some(1.0);
            let c = follow(&problem, &along_x(), &solved(&problem), 0.0, &settings).unwrap();
            assert_curves(&c);
            let mut limits = of_kind(&c, SpecialKind::LoadLimit);
            limits.sort_by(|a, b| b.point.parameter.total_cmp(&a.point.parameter));
            // Near the locked length the force has one more turning point beyond the table's range.
            let limits: Vec<_> = limits
                .iter()
                .filter(|s| s.point.equilibrium.coordinates[0] > 0.0)
                .collect();
            assert_eq!(limits.len(), rows.len(), "{label}");
            for (s, (alpha, dx, force)) in limits.iter().zip(rows) {
                close(&label, s.point.equilibrium.coordinates[0], *alpha, 1e-9);
                close(&label, s.point.parameter - 1.0, *dx, 2e-9);
                close(&label, s.point.conjugate, *force, 2e-9);
                close(&label, s.point.slope, 0.0, 1e-9);
                assert!(s.stable_side, "{label}");
            }
        }
    }
}

#[test]
fn the_loaded_middle_snaps_through_at_its_load_limit() {
    // 4.6.2 with the end at dx = 0 fixed: the load on the middle grows.
    let chain = elastic_links(15_f64.to_radians());
    let mut problem = elastic_problem(&chain, 1.0, 0.0);
    let loads = std::mem::take(&mut problem.loads);
    let pattern = LoadPattern {
        end: Wrench::zero(),
        loads,
    };
    let settings = CurveSettings::within(-3.0, 3.0);
    let c = follow(
        &problem,
        &Parameter::Load(pattern.clone()),
        &solved(&problem),
        0.0,
        &settings,
    )
    .unwrap();
    assert_curves(&c);
    assert_eq!(c.specials.len(), 2);
    // By symmetry the shape stays symmetric: the limits of E_Y by the height alone.
    let (up, down) = (&c.specials[0], &c.specials[1]);
    for s in [up, down] {
        assert_eq!(s.kind, SpecialKind::LoadLimit);
        assert!(s.stable_side);
        let (y, g) = (
            s.point.equilibrium.nodes[0].translation.y,
            s.point.parameter * 4.0 * 15_f64.to_radians().sin(),
        );
        let (slope, bend) = energy_of_height(y);
        close("E_Y", slope + g, 0.0, 1e-8);
        close("E_YY", bend, 0.0, 1e-6);
    }
    assert!(up.point.parameter > 1.8 && down.point.parameter < 0.25);
    let jumps = c.jumps().unwrap();
    assert_eq!(jumps.len(), 2);
    for (jump, special) in jumps.iter().zip([up, down]) {
        assert!(jump.dead_load);
        assert_eq!(jump.to.len(), 1, "one stable shape at that load");
        let to = &jump.to[0];
        assert_point(&c, to);
        close("same load", to.parameter, special.point.parameter, 1e-12);
        let (from, to) = (
            special.point.equilibrium.nodes[0].translation.y,
            to.equilibrium.nodes[0].translation.y,
        );
        assert!(from * to < 0.0, "snaps through the flat shape");
    }
    let r = critical_load_factor(&problem, &pattern, StabilityOf::ShapeAndEnd, &settings).unwrap();
    let exact = r.exact.unwrap();
    close("critical", exact.factor, up.point.parameter, 1e-10);
    assert_eq!(exact.kind, Some(SpecialKind::LoadLimit));
    // A shallow arch straightens before it snaps: the linear prediction is far too high.
    assert!(r.linear.unwrap() > 3.0 * exact.factor);
}

/// `dE/dY` without the load and `d^2E/dY^2` of the symmetric shape of 4.6.2 at dx = 0, by
/// differences of the energy `200 (r - 1)^2 + 2 (a - a0)^2`.
fn energy_of_height(y: f64) -> (f64, f64) {
    let (a0, h) = (15_f64.to_radians(), 1e-4);
    let c = a0.cos();
    let e = |y: f64| {
        let (r, a) = (c.hypot(y), y.atan2(c));
        200.0 * (r - 1.0).powi(2) + 2.0 * (a - a0).powi(2)
    };
    let at = |k: f64| e(y + k * h);
    let slope = (at(-2.0) - 8.0 * at(-1.0) + 8.0 * at(1.0) - at(2.0)) / (12.0 * h);
    let bend =
        (-at(-2.0) + 16.0 * at(-1.0) - 30.0 * at(0.0) + 16.0 * at(1.0) - at(2.0)) / (12.0 * h * h);
    (slope, bend)
}

/// Wrong input is refused with a reason; nothing panics.
#[test]
fn curves_that_cannot_be_are_refused() {
    let chain = z_chain();
    let mut problem = held(&chain, z_unloaded());
    problem.posture = vec![0.17, -0.52, 0.52, 0.0];
    let start = solved(&problem);
    let settings = CurveSettings::within(-1.0, 1.0);
    let refused = |parameter: Parameter| {
        let text = follow(&problem, &parameter, &start, 0.0, &settings)
            .unwrap_err()
            .to_string();
        assert!(text.contains("chain 'z'"), "{text}");
    };
    let twist = |x: f64, z: f64, rz: f64| {
        Parameter::Displacement(Twist::new(vector![x, 0.0, z], vector![0.0, 0.0, rz]))
    };
    refused(twist(0.0, 0.0, 0.0));
    refused(twist(f64::NAN, 0.0, 0.0));
    refused(twist(0.0, 1.0, 0.0)); // out of the chain's plane
    refused(twist(1.0, 1.0, 0.0));
    refused(twist(0.0, 0.0, 1.0)); // the rotation is free, not prescribed
    refused(Parameter::end_wrench(press())); // x is held
    refused(Parameter::Load(LoadPattern::default()));
    refused(Parameter::Load(LoadPattern {
        end: Wrench::zero(),
        loads: vec![Load::Dead {
            node: 99,
            wrench: press(),
        }],
    }));
}

/// A hinged bar held by an inclined spring: the classical asymmetric bifurcation, at `P = k L / 2`.
#[test]
fn a_bar_on_an_inclined_spring_forks_transcritically() {
    let chain = Chain::builder("inclined spring")
        .passive("q", MotionKind::Revolute, Vector3::z(), 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .build()
        .unwrap();
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.loads = vec![Load::spring_between(
        Anchor::Base(vector![0.0, 1.0, 0.0]),
        Anchor::node(chain.tip()),
        1.0,
        2.0_f64.sqrt(),
    )];
    let mut settings = CurveSettings::within(0.0, 1.0);
    settings.branches = 3;
    let parameter = Parameter::end_wrench(press());
    let c = follow(
        &problem,
        &parameter,
        &solve_chain(&problem, &Settings::default()).unwrap(),
        0.0,
        &settings,
    );
    let c = c.unwrap();
    assert_eq!((c.branches.len(), c.specials.len()), (2, 1));
    let fork = &c.specials[0];
    assert_eq!(fork.kind, SpecialKind::Transcritical);
    close("P", fork.point.parameter, 0.5, 1e-12);
    close("upright", fork.point.equilibrium.coordinates[0], 0.0, 1e-12);
    // The other branch: P = k (1 - sqrt(1/(1 - sin a))) cos a / sin a, on both sides of the fork.
    let (mut below, mut above) = (0, 0);
    for p in &c.branches[1].points {
        let a = p.equilibrium.coordinates[0];
        if a.abs() > 1e-3 {
            let expected = (1.0 / (1.0 - a.sin()).sqrt() - 1.0) * a.cos() / a.sin();
            close("side branch", p.parameter, expected, 1e-9);
            *(if expected < 0.5 {
                &mut below
            } else {
                &mut above
            }) += 1;
            assert_eq!(
                p.dead_load.stable,
                expected > 0.5,
                "stable where the load rises"
            );
        }
    }
    assert!(below > 2 && above > 2);
}

#[test]
fn a_pushed_shape_snaps_where_its_displacement_ends() {
    // 4.6.2 without load: the lower shape, drawn apart, ends at dx = -0.00958 and snaps to the
    // upper one.
    let chain = elastic_links(15_f64.to_radians());
    let mut problem = elastic_problem(&chain, 0.0, -0.05);
    let upper = solved(&problem);
    problem.posture = vec![-0.287, -0.02, 0.574, -0.02, 0.0];
    let lower = solved(&problem);
    assert!(upper.nodes[0].translation.y > 0.3 && lower.nodes[0].translation.y < -0.2);
    let settings = CurveSettings::within(-0.1, 0.1);
    let mut c = follow(&problem, &along_x(), &lower, 0.0, &settings).unwrap();
    let jumps = c.jumps().unwrap();
    assert_eq!(jumps.len(), 1);
    assert!(
        !jumps[0].dead_load && jumps[0].to.is_empty(),
        "no other shape is known yet"
    );
    c.add(&upper, 0.0).unwrap();
    assert_eq!(c.branches.len(), 2);
    let jumps = c.jumps().unwrap();
    assert_eq!(jumps.len(), 1);
    let to = &jumps[0].to[0];
    assert_point(&c, to);
    close("at", to.parameter, 0.05 - 0.0095788571, 1e-9);
    assert!(to.displacement_control.stable && to.equilibrium.nodes[0].translation.y > 0.2);
}

/// Random spatial chains under random loads, conditions mixed: equilibria and curves never fail,
/// and whatever they return holds.
#[test]
fn curves_of_random_chains_hold() {
    for seed in 0..12 {
        let mut rng = Rng(seed);
        let recipe = Recipe {
            stages: 2,
            passive: 2,
            k_t: 2e4,
            k_r: 60.0,
            preload: 0.2,
        };
        let r = random_chain(&mut rng, &recipe);
        let target = moved(&r.tip(), &Twist::new(rng.vector(0.02), rng.vector(0.08)));
        let mut problem = r.problem(EndCondition::pose(target));
        let node = rng.below(r.chain.nodes().len());
        problem.loads = vec![Load::dead(
            node,
            Wrench::new(rng.vector(80.0), rng.vector(2.0)),
        )];
        if seed % 2 == 1 {
            for k in 0..6 {
                if rng.below(3) == 0 {
                    problem.end.prescribed[k] = Prescribed::Wrench;
                }
            }
            problem.end.wrench = rng.wrench(20.0, 2.0);
        }
        let held = (0..6).find(|&k| problem.end.prescribed[k] == Prescribed::Pose);
        let parameter = match held {
            Some(k) if seed % 3 > 0 => Parameter::along(&problem.end.axes, k),
            _ => Parameter::Load(LoadPattern {
                end: Wrench::zero(),
                loads: vec![Load::dead(node, rng.wrench(30.0, 0.5))],
            }),
        };
        let Ok(start) = solve_chain(&problem, &Settings::default()) else {
            continue;
        };
        let mut settings = CurveSettings::within(-0.3, 0.3);
        settings.branches = 2;
        settings.points = 60;
        let c = follow(&problem, &parameter, &start, 0.0, &settings).unwrap();
        assert!(c.branches[0].points.len() > 10, "seed {seed}");
        for p in c.branches.iter().flat_map(|b| &b.points) {
            assert!(p.parameter.is_finite() && p.conjugate.is_finite() && !p.slope.is_nan());
            assert!(p.equilibrium.residual.closure_m < 1e-10, "seed {seed}");
            assert!(p.equilibrium.residual.torque < 1e-8, "seed {seed}");
        }
        c.jumps().unwrap();
    }
}

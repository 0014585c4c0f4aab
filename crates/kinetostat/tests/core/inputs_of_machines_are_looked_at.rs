//! Numbers that are none, zero, negative or absurd in settings of curves and iterations, in platforms, loads
//! on them and states of machines: an error that names the input, what is needed and what was found, or a
//! finite answer.

use kinetostat::{
    Anchor, Chain, ChainProblem, CurveSettings, EndCondition, LengthLaw, Limb, Load, Mechanism,
    MotionKind, Parameter, Platform, PlatformLoad, Pose, Result, Settings, Twist, Wrench,
    compensation::compensate_from,
    continuation::LoadPattern,
    critical_load_factor,
    equilibrium::StabilityOf,
    follow,
    machine::MechanismState,
    reference::{IterationSettings, newton_iteration, report_iteration},
    solve_chain,
};
use nalgebra::{UnitQuaternion, Vector3, vector};

use crate::inputs_are_looked_at::{Ask, every_input};

/// Three springs in a plane.
fn chain() -> Chain {
    Chain::builder("three springs")
        .spring("s1", MotionKind::Revolute, Vector3::z(), 50.0, 0.1)
        .translation(vector![0.5, 0.0, 0.0])
        .spring("s2", MotionKind::Revolute, Vector3::z(), 40.0, -0.2)
        .translation(vector![0.5, 0.0, 0.0])
        .spring("s3", MotionKind::Prismatic, Vector3::x(), 4e3, 0.0)
        .node("end")
        .build()
        .unwrap()
}

fn problem(chain: &Chain) -> ChainProblem<'_> {
    let end = EndCondition::wrench(Wrench::new(vector![1.0, 2.0, 0.0], Vector3::zeros()));
    ChainProblem::new(chain, end)
}

fn pattern() -> LoadPattern {
    LoadPattern {
        end: Wrench::new(vector![-10.0, 0.0, 0.0], Vector3::zeros()),
        loads: Vec::new(),
    }
}

/// Points of a curve under a growing load.
fn curve(change: impl Fn(&mut CurveSettings, &mut f64)) -> Result<Vec<f64>> {
    let chain = chain();
    let problem = problem(&chain);
    let start = solve_chain(&problem, &Settings::default())?;
    let (mut settings, mut value) = (CurveSettings::within(-1.0, 1.0), 0.0);
    settings.points = 8;
    change(&mut settings, &mut value);
    let curves = follow(
        &problem,
        &Parameter::Load(pattern()),
        &start,
        value,
        &settings,
    )?;
    let points = curves.branches.iter().flat_map(|b| &b.points);
    Ok(points.flat_map(|p| [p.parameter, p.conjugate]).collect())
}

fn critical(change: impl Fn(&mut CurveSettings, &mut LoadPattern)) -> Result<Vec<f64>> {
    let chain = chain();
    let (mut settings, mut pattern) = (CurveSettings::within(0.0, 30.0), pattern());
    settings.points = 40;
    change(&mut settings, &mut pattern);
    let stability_of = StabilityOf::ShapeAndEnd;
    let found = critical_load_factor(&problem(&chain), &pattern, stability_of, &settings)?;
    Ok([found.reached].into_iter().chain(found.linear).collect())
}

fn iterated(exact: bool, change: impl Fn(&mut IterationSettings)) -> Result<Vec<f64>> {
    let chain = chain();
    let mut settings = IterationSettings::default();
    change(&mut settings);
    let run = if exact {
        newton_iteration
    } else {
        report_iteration
    };
    let found = run(&problem(&chain), None, &settings)?;
    // What grows beyond all bounds is said to: its numbers are those of the iteration.
    Ok(found.equilibrium.map_or_else(Vec::new, |e| e.coordinates))
}

/// What a machine of two platforms is made of.
struct Parts {
    middle: Platform,
    tip: Pose,
    gravity: Vector3<f64>,
    on_limb: Option<Load>,
    on_platforms: Option<PlatformLoad>,
}

fn machine(change: impl Fn(&mut Parts)) -> Result<Mechanism> {
    let mut parts = Parts {
        middle: Platform::new("middle", Pose::translation(1.0, 0.0, 0.0)),
        tip: Pose::identity(),
        gravity: Vector3::zeros(),
        on_limb: None,
        on_platforms: None,
    };
    parts.middle.mass = 2.0;
    change(&mut parts);
    let mut builder = Mechanism::builder("two");
    let middle = builder.platform(parts.middle);
    let tool = builder.platform(Platform::new("tool", Pose::translation(2.0, 0.0, 0.0)));
    for (name, from, to) in [("lower", 0, middle), ("upper", middle, tool)] {
        builder = builder.limb(
            Limb::between(name, from, to, chain()).fixed_at(if to == middle {
                parts.tip
            } else {
                Pose::identity()
            }),
        );
    }
    builder = builder.gravity(parts.gravity);
    if let Some(load) = parts.on_limb {
        builder = builder.load("upper", load);
    }
    if let Some(load) = parts.on_platforms {
        builder = builder.platform_load(load);
    }
    builder.build()
}

/// Where the tool of a machine goes under a small load.
fn rest(change: impl Fn(&mut Parts)) -> Result<Vec<f64>> {
    let machine = machine(change)?;
    let home = machine.platforms()[machine.tool()].home;
    let push = Wrench::new(vector![0.3, 0.2, 0.0], Vector3::zeros());
    let found = machine.posture(&home)?.deflected_by(&push)?;
    Ok([numbers(&found.tool), found.actuator_forces()].concat())
}

fn numbers(pose: &Pose) -> Vec<f64> {
    pose.to_homogeneous().iter().copied().collect()
}

/// From a state to start from, or towards a pose that is wanted.
fn from(change: impl Fn(&mut MechanismState, &mut Pose, &mut Wrench)) -> Result<[Vec<f64>; 2]> {
    let machine = machine(|_| {})?;
    let mut pose = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&pose)?;
    let (mut state, mut wrench) = (posture.rest_state(), Wrench::zero());
    change(&mut state, &mut pose, &mut wrench);
    let converged = posture.deflected_from(&wrench, state.clone())?;
    let none = [false; 6];
    let compensated = compensate_from(&posture, &pose, &wrench, none.into(), state)?;
    Ok([
        numbers(&converged.tool),
        numbers(&compensated.equilibrium.tool),
    ])
}

/// Along the path of a machine under a growing load, and while its tool is taken along.
fn path(change: impl Fn(&mut CurveSettings, &mut f64)) -> Result<Vec<f64>> {
    let machine = machine(|_| {})?;
    let posture = machine.posture(&machine.platforms()[machine.tool()].home)?;
    let (mut settings, mut along) = (CurveSettings::within(-1.0, 1.0), 1e-4);
    settings.points = 4;
    change(&mut settings, &mut along);
    let end = EndCondition::wrench(Wrench::zero());
    let growing = Wrench::new(vector![0.3, 0.2, 0.0], Vector3::zeros());
    let path = posture.curves(&Parameter::end_wrench(growing), &end, &settings)?;
    let direction = Twist::new(vector![1.0, 0.0, 0.0], Vector3::zeros());
    let held = posture.displaced_along(&direction, &[0.0, along], Some(posture.rest_state()))?;
    let points = path.branches[0].points.iter().map(|p| p.parameter);
    Ok(points.chain(held.points.iter().map(|p| p.force)).collect())
}

fn strut(law: LengthLaw) -> PlatformLoad {
    PlatformLoad::strut(
        Anchor::on_platform(0, vector![0.0, 0.4, 0.0]),
        Anchor::on_platform(2, Vector3::zeros()),
        law,
    )
}

fn inputs() -> Vec<(&'static str, Ask)> {
    let of_curve = |change: fn(&mut CurveSettings, &mut f64, f64)| -> Ask {
        Box::new(move |x| curve(|s, value| change(s, value, x)))
    };
    let of_critical = |change: fn(&mut CurveSettings, &mut LoadPattern, f64)| -> Ask {
        Box::new(move |x| critical(|s, pattern| change(s, pattern, x)))
    };
    let of_path = |change: fn(&mut CurveSettings, &mut f64, f64)| -> Ask {
        Box::new(move |x| path(|s, along| change(s, along, x)))
    };
    let of_machine =
        |change: fn(&mut Parts, f64)| -> Ask { Box::new(move |x| rest(|parts| change(parts, x))) };
    let of_state = |change: fn(&mut MechanismState, &mut Pose, &mut Wrench, f64)| -> Ask {
        Box::new(move |x| Ok(from(|state, pose, wrench| change(state, pose, wrench, x))?.concat()))
    };
    let count = |x: f64| {
        if x.is_finite() {
            x.clamp(0.0, 60.0) as usize
        } else {
            0
        }
    };
    vec![
        (
            "tolerance",
            Box::new(|x| iterated(false, |s| s.tolerance = x)),
        ),
        (
            "tolerance",
            Box::new(|x| iterated(true, |s| s.tolerance = x)),
        ),
        (
            "steps",
            Box::new(move |x| iterated(true, |s| s.steps = count(x))),
        ),
        ("range", of_path(|s, _, x| s.range.0 = x)),
        ("range", of_path(|s, _, x| s.range.1 = x)),
        ("smallest_step", of_path(|s, _, x| s.smallest_step = x)),
        ("distance", of_path(|_, along, x| *along = x)),
        ("range", of_curve(|s, _, x| s.range.0 = x)),
        ("range", of_curve(|s, _, x| s.range.1 = x)),
        (
            "conjugate_range",
            of_curve(|s, _, x| s.conjugate_range.0 = x),
        ),
        (
            "conjugate_range",
            of_curve(|s, _, x| s.conjugate_range.1 = x),
        ),
        ("largest_angle", of_curve(|s, _, x| s.largest_angle = x)),
        ("largest_turn", of_curve(|s, _, x| s.largest_turn = x)),
        (
            "largest_change",
            of_curve(|s, _, x| s.largest_change = Some(x)),
        ),
        ("smallest_step", of_curve(|s, _, x| s.smallest_step = x)),
        ("closure", of_curve(|s, _, x| s.solver.closure = x)),
        ("parameter at the start", of_curve(|_, value, x| *value = x)),
        (
            "points",
            Box::new(move |x| curve(|s, _| s.points = count(x))),
        ),
        (
            "branches",
            Box::new(move |x| curve(|s, _| s.branches = count(x))),
        ),
        ("range", of_critical(|s, _, x| s.range.1 = x)),
        ("largest_turn", of_critical(|s, _, x| s.largest_turn = x)),
        (
            "load pattern",
            of_critical(|_, pattern, x| pattern.end.0[0] = x),
        ),
        (
            "home pose",
            of_machine(|p, x| p.middle.home.translation.vector.y = x),
        ),
        ("mass", of_machine(|p, x| p.middle.mass = x)),
        (
            "centre of mass",
            of_machine(|p, x| p.middle.centre_of_mass.x = x),
        ),
        ("inertia", of_machine(|p, x| p.middle.inertia[(0, 1)] = x)),
        ("gravity", of_machine(|p, x| p.gravity.z = x)),
        (
            "tip on the platform",
            of_machine(|p, x| p.tip.translation.vector.z = x),
        ),
        (
            "wrench on a platform",
            of_machine(|p, x| {
                p.on_platforms = Some(PlatformLoad::Wrench {
                    platform: 1,
                    point: Vector3::zeros(),
                    wrench: Wrench::new(vector![0.0, x, 0.0], Vector3::zeros()),
                    turns: false,
                });
            }),
        ),
        (
            "place of a wrench on a platform",
            of_machine(|p, x| {
                p.on_platforms = Some(PlatformLoad::Wrench {
                    platform: 2,
                    point: vector![x, 0.0, 0.0],
                    wrench: Wrench::new(vector![0.0, 0.1, 0.0], Vector3::zeros()),
                    turns: true,
                });
            }),
        ),
        (
            "stiffness",
            of_machine(|p, x| {
                p.on_platforms = Some(strut(LengthLaw::Linear {
                    stiffness: x,
                    free_length: 2.0,
                    preload: 0.1,
                }));
            }),
        ),
        (
            "free length",
            of_machine(|p, x| {
                p.on_platforms = Some(strut(LengthLaw::Linear {
                    stiffness: 0.5,
                    free_length: x,
                    preload: 0.1,
                }));
            }),
        ),
        (
            "column",
            of_machine(|p, x| {
                p.on_platforms = Some(strut(LengthLaw::Gas {
                    force: 0.2,
                    length: 2.1,
                    column: x,
                    exponent: 1.2,
                }));
            }),
        ),
        (
            "tension",
            of_machine(|p, x| p.on_platforms = Some(strut(LengthLaw::Constant { tension: x }))),
        ),
        (
            "place of an end",
            of_machine(|p, x| {
                let law = LengthLaw::Constant { tension: 0.1 };
                let (from, to) = (Anchor::Base(vector![0.0, x, 0.3]), Anchor::node(1));
                p.on_limb = Some(Load::strut(from, to, law));
            }),
        ),
        (
            "wrench of the follower",
            of_machine(|p, x| {
                let local = Wrench::new(vector![0.0, x, 0.0], Vector3::zeros());
                p.on_limb = Some(Load::follower(1, local));
            }),
        ),
        (
            "force",
            of_machine(|p, x| {
                let (point, force) = (vector![0.0, 0.1, 0.0], vector![0.0, x, 0.0]);
                p.on_limb = Some(Load::point_force(1, point, force));
            }),
        ),
        (
            "load",
            of_machine(|p, x| {
                let wrench = Wrench::new(vector![0.0, x, 0.0], Vector3::zeros());
                p.on_limb = Some(Load::dead(1, wrench));
            }),
        ),
        (
            "state to start from",
            of_state(|s, _, _, x| s.platforms[1].translation.vector.x = x),
        ),
        (
            "state to start from",
            of_state(|s, _, _, x| s.coordinates[0][1] = x),
        ),
        (
            "state to start from",
            of_state(|s, _, _, x| s.wrenches[1].0[0] = x),
        ),
        ("wrench", of_state(|_, _, w, x| w.0[1] = x)),
        (
            "pose that is wanted",
            of_state(|_, pose, _, x| pose.translation.vector.y = x),
        ),
    ]
}

#[test]
fn every_input_of_curves_and_machines_is_looked_at() {
    let (refused, answered) = every_input(inputs());
    assert!(refused > 130 && answered > 60, "{refused} {answered}");
}

/// Lists of the wrong length, and a pose whose rotation is none.
#[test]
fn states_of_another_machine_are_refused() {
    let one = from(|state, _, _| {
        state.coordinates[1].pop();
    });
    let words = one.unwrap_err().to_string();
    assert!(
        words.contains("limb 'upper'") && words.contains("needs 3 values, 2"),
        "{words}"
    );
    let words = from(|state, _, _| state.wrenches.clear())
        .unwrap_err()
        .to_string();
    assert!(words.contains("needs 2 values, 0"), "{words}");
    let words = from(|state, _, _| state.platforms.truncate(1))
        .unwrap_err()
        .to_string();
    assert!(words.contains("needs 3 values, 1"), "{words}");
    let none = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(f64::NAN, 0.0, 0.0, 0.0));
    let words = rest(|parts| parts.middle.home.rotation = none)
        .unwrap_err()
        .to_string();
    assert!(
        words.contains("platform 'middle'") && words.contains("home pose is NaN"),
        "{words}"
    );
    let curve = curve(|s, _| s.range = (2.0, 1.0));
    let words = curve.unwrap_err().to_string();
    assert!(
        words.contains("range is (2.0, 1.0), a smaller and a larger number"),
        "{words}"
    );
}

//! Each load's tangent against differences of its wrenches, its work against its energy, `K_C` under
//! it against re-solved wrenches, and what each does to symmetry.

use crate::common::invariants::antisymmetric_error;
use crate::common::{RandomChain, Recipe, Rng, cases, close, random_chain, scaled_error};
use crate::stored_stiffness_is_the_derivative_of_the_wrench::differences;
use kinetostat::{
    Anchor, Chain, ChainProblem, EndCondition, Equilibrium, Error, LengthLaw, Load, MotionKind,
    Pose, Prescribed, Settings, Twist, Wrench,
    chain::{is_conservative, load_energy},
    model::{FunctionLoad, Kinematics, LengthResponse, check_tangents},
    solve_chain,
    spatial::moved,
};
use kinetostat_testing::largest_size;
use nalgebra::{DMatrix, Matrix3, Vector3, vector};
use proptest::prelude::*;

/// A load of every kind on two nodes, by name; the flag says whether it is conservative.
fn every_kind(rng: &mut Rng, r: &RandomChain) -> Vec<(&'static str, Load, bool)> {
    let nodes = r.chain.nodes().len();
    let (a, b) = (rng.below(nodes), rng.below(nodes));
    let mut anchor = |node: usize| Anchor::Node {
        node,
        point: rng.vector(0.1),
    };
    let (from, to) = (anchor(a), anchor(b));
    let ground = Anchor::Base(vector![0.9, -0.7, 0.8] + rng.vector(0.1));
    let linear = LengthLaw::Linear {
        stiffness: 4e3,
        free_length: 0.3,
        preload: 60.0,
    };
    let gas = LengthLaw::Gas {
        force: 200.0,
        length: 4.0,
        column: 6.0,
        exponent: 1.25,
    };
    let hardening = LengthLaw::function(|l| LengthResponse {
        tension: 500.0 * l.powi(3),
        slope: 1500.0 * l * l,
        energy: 125.0 * l.powi(4),
    });
    vec![
        (
            "dead force",
            Load::dead(a, Wrench::new(rng.vector(150.0), Vector3::zeros())),
            true,
        ),
        ("dead wrench", Load::dead(a, rng.wrench(100.0, 10.0)), false),
        ("gravity", Load::gravity(rng.axis() * 9.81), true),
        (
            "follower",
            Load::follower(a, rng.wrench(100.0, 10.0)),
            false,
        ),
        (
            "counterweight",
            Load::counterweight(b, rng.vector(0.5), 12.0, vector![0.0, 0.0, -9.81]),
            true,
        ),
        ("spring between nodes", Load::strut(from, to, linear), true),
        (
            "spring to the base",
            Load::spring_between(from, ground, 3e3, 0.5),
            true,
        ),
        (
            "ideal spring",
            Load::spring_between(ground, to, 1e3, 0.0),
            true,
        ),
        ("gas spring", Load::strut(ground, to, gas), true),
        ("rope", Load::constant_tension(ground, from, 120.0), true),
        ("law of length", Load::strut(to, ground, hardening), true),
        ("function", Load::function(swirl(a, b)), false),
        ("function with energy", Load::function(bowl(b)), true),
    ]
}

/// A force on `a` that turns with the place of `b`: two nodes, no tangent, no potential.
fn swirl(a: usize, b: usize) -> FunctionLoad {
    FunctionLoad::new("swirl", vec![a, b], |poses| {
        let p = poses[1].translation.vector;
        let f = vector![-p.y, p.x, 0.3] * 60.0;
        let m = poses[0].rotation * vector![3.0, 0.0, 1.0];
        vec![Wrench::new(f, m), Wrench::new(-f * 0.5, Vector3::zeros())]
    })
}

/// A quadratic well about a place, with tangent and energy.
fn bowl(node: usize) -> FunctionLoad {
    let k = Matrix3::new(900.0, 100.0, 0.0, 100.0, 700.0, 50.0, 0.0, 50.0, 500.0);
    let centre = vector![0.4, 0.1, -0.3];
    FunctionLoad::new("bowl", vec![node], move |poses| {
        let d = poses[0].translation.vector - centre;
        vec![Wrench::new(-k * d, Vector3::zeros())]
    })
    .with_tangent(move |_| {
        let mut tangent = DMatrix::zeros(6, 6);
        tangent.view_mut((0, 0), (3, 3)).copy_from(&-k);
        tangent
    })
    .with_energy(move |poses| {
        let d = poses[0].translation.vector - centre;
        0.5 * d.dot(&(k * d))
    })
}

/// Work of a load along a small change of coordinates, by its wrenches at the middle.
fn torque(r: &RandomChain, load: &Load, x: &[f64]) -> Vec<f64> {
    let kinematics = Kinematics::new(&r.chain, &r.base, x, &r.commands);
    let mut list = Vec::new();
    match load {
        Load::Dead { node, wrench } => list.push((*node, *wrench)),
        Load::Gravity(g) => {
            let weights = r.chain.bodies().iter();
            list.extend(weights.map(|b| (b.node, Wrench::new(g * b.mass, Vector3::zeros()))));
        }
        Load::Custom(load) => load.wrenches(&kinematics, &mut list),
        _ => unreachable!(),
    }
    (0..x.len())
        .map(|i| {
            list.iter()
                .map(|(node, w)| kinematics.jacobian(*node).column(i).dot(&w.0))
                .sum()
        })
        .collect()
}

proptest! {
    #![proptest_config(cases(24))]
    #[test]
    fn tangents_are_derivatives_and_energies_are_potentials(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 3, ..Recipe::default() });
        let x: Vec<f64> = r.posture.iter().map(|x| x + 0.05 * rng.signed()).collect();
        for (name, load, conservative) in every_kind(&mut rng, &r) {
            let check = check_tangents(&r.chain, &r.base, &x, &r.commands, &load).unwrap();
            prop_assert!(check.largest < 1e-7, "{name}: {check:?}");
            prop_assert_eq!(load.conservative(&r.chain), conservative, "{}", name);

            // The generalised torque is minus the slope of the energy.
            let mut problem = r.problem(EndCondition::pose(Pose::identity()));
            problem.loads = vec![load.clone()];
            let energy = |x: &[f64]| load_energy(&problem, x).unwrap();
            prop_assert_eq!(energy(&x).is_some(), conservative, "{}", name);
            if !conservative {
                continue;
            }
            let torque = torque(&r, &load, &x);
            let size = largest_size(torque.iter().copied().chain([1.0]));
            for (i, torque) in torque.iter().enumerate() {
                let at = |s: f64| {
                    let mut near = x.clone();
                    near[i] += s * 1e-3;
                    energy(&near).unwrap()
                };
                let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-3;
                prop_assert!((slope + torque).abs() < 1e-7 * size, "{name} {i}: {slope} {torque}");
            }
        }
    }
}

fn held(r: &RandomChain, load: Load, rng: &mut Rng) -> Option<(Equilibrium, Vec<Load>, Pose)> {
    let target = moved(&r.tip(), &Twist::new(rng.vector(0.004), rng.vector(0.01)));
    let mut problem = r.problem(EndCondition::pose(target));
    problem.loads = vec![load];
    let e = solve_chain(&problem, &Settings::default()).ok()?;
    Some((e, problem.loads, target))
}

proptest! {
    #![proptest_config(cases(6))]
    /// `K_C` under each load is the derivative of the re-solved wrench; its antisymmetric part is
    /// that of the end moment alone if and only if the load is conservative.
    #[test]
    fn the_stiffness_under_each_load_is_the_derivative_of_the_wrench(seed in any::<u64>()) {
        let mut rng = Rng(seed);
        let r = random_chain(&mut rng, &Recipe { stages: 3, passive: 2, ..Recipe::default() });
        for (name, load, conservative) in every_kind(&mut rng, &r) {
            let Some((e, loads, target)) = held(&r, load, &mut rng) else { continue };
            prop_assert_eq!(e.conservative, conservative, "{}", name);
            let k = e.stiffness.cartesian.matrix;
            let asymmetry = antisymmetric_error(&k, &e.wrench.moment(), r.chain.scale().length);
            if conservative {
                prop_assert!(asymmetry < 1e-9, "{name}: {asymmetry:e}");
            }
            if e.stability.share_to_buckling.is_some_and(|mu| mu > 0.9) {
                continue;
            }
            let mut near = r.problem(EndCondition::pose(target));
            near.loads = loads;
            near.posture.clone_from(&e.coordinates);
            let error = scaled_error(&k, &differences(&near, &e, 1e-4));
            prop_assert!(error < 1e-6, "{name}: {error:e}");
        }
    }
}

/// Beck's column as a chain: planar and symmetric for dead loads, not for the follower.
#[test]
fn a_follower_makes_the_stiffness_asymmetric_where_the_same_dead_force_does_not() {
    let section = kinetostat::BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    let chain = Chain::builder("column")
        .link("lower", &section, 0.5)
        .node("middle")
        .link("upper", &section, 0.5)
        .build()
        .unwrap();
    let middle = chain.node("middle").unwrap();
    let push = Wrench::new(vector![-2e4, 3e3, 0.0], Vector3::zeros());
    let asymmetry = |load: Load| {
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        problem.loads = vec![load];
        let e = solve_chain(&problem, &Settings::default()).unwrap();
        let k = e.stiffness.cartesian.matrix;
        (
            antisymmetric_error(&k, &Vector3::zeros(), 1.0),
            e.conservative,
        )
    };
    let (dead, dead_is_conservative) = asymmetry(Load::dead(middle, push));
    let (follower, follower_is_conservative) = asymmetry(Load::follower(middle, push));
    assert!(dead < 1e-12 && dead_is_conservative, "{dead:e}");
    assert!(follower > 1e-4 && !follower_is_conservative, "{follower:e}");
}

/// Work of the end wrench along a path = change of the stored energy + that of the loads.
#[test]
fn work_of_the_end_is_the_change_of_all_energies() {
    let mut done = 0;
    for seed in 0..6 {
        let mut rng = Rng(seed);
        let r = random_chain(
            &mut rng,
            &Recipe {
                stages: 3,
                passive: 2,
                ..Recipe::default()
            },
        );
        let loads: Vec<Load> = every_kind(&mut rng, &r)
            .into_iter()
            .filter(|(_, _, conservative)| *conservative)
            .map(|(_, load, _)| load)
            .collect();
        let start = r.tip();
        let span = Twist::new(rng.vector(0.006), rng.vector(0.02));
        let mut problem = r.problem(EndCondition::pose(start));
        problem.loads = loads;
        let mut at = |share: f64| {
            let step = Twist(span.0 * share);
            problem.end = EndCondition::pose(moved(&start, &step));
            let e = solve_chain(&problem, &Settings::default()).ok()?;
            assert!(e.conservative && is_conservative(&problem));
            problem.posture.clone_from(&e.coordinates);
            let all = e.energy + load_energy(&problem, &e.coordinates).unwrap()?;
            // Along exp(s w) the spatial angular velocity is w itself.
            Some((all, e.wrench.0.dot(&span.0)))
        };
        let points: Option<Vec<(f64, f64)>> = (0..=16).map(|i| at(f64::from(i) / 16.0)).collect();
        let Some(points) = points else { continue };
        // Simpson with one Richardson step.
        let simpson = |stride: usize| {
            let n = 16 / stride;
            let sum: f64 = (0..=n)
                .map(|i| {
                    let weight = if i == 0 || i == n {
                        1.0
                    } else if i % 2 == 1 {
                        4.0
                    } else {
                        2.0
                    };
                    weight * points[i * stride].1
                })
                .sum();
            sum / (3.0 * n as f64)
        };
        let work = (16.0 * simpson(1) - simpson(2)) / 15.0;
        let change = points[16].0 - points[0].0;
        let size = largest_size(points.iter().map(|p| p.1).chain([1e-3]));
        close("work", work, change, 1e-8 * size);
        done += 1;
    }
    assert!(done >= 4, "{done}");
}

/// A bar of length a on a hinge, held up by a spring from its end to a point at height h above the
/// hinge: with length l = sqrt(a^2 + h^2 - 2 a h cos f), f the angle from the vertical, statics of
/// one moment gives tension * a h sin f / l = m g a sin f.
#[test]
fn a_spring_that_holds_a_pendulum_agrees_with_statics_by_hand() {
    let (a, h, weight, k, free) = (0.6_f64, 0.9_f64, 80.0, 110.0, 0.2);
    let chain = Chain::builder("pendulum")
        .passive("f", MotionKind::Revolute, Vector3::y(), 1.0)
        .translation(vector![0.0, 0.0, a])
        .build()
        .unwrap();
    let tip = chain.tip();
    let spring = |free| {
        Load::spring_between(
            Anchor::Base(vector![0.0, 0.0, h]),
            Anchor::node(tip),
            k,
            free,
        )
    };
    let solve = |start: f64, free: f64, down: f64| {
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        problem.posture = vec![start];
        let pull = Wrench::new(vector![0.0, 0.0, -down], Vector3::zeros());
        problem.loads = vec![spring(free), Load::dead(tip, pull)];
        solve_chain(&problem, &Settings::default()).unwrap()
    };
    // By hand: k (1 - free / l) h = weight, so l = free / (1 - weight / (k h)); f from l.
    let l = free / (1.0 - weight / (k * h));
    let f = ((a * a + h * h - l * l) / (2.0 * a * h)).acos();
    let e = solve(f + 0.1, free, weight);
    close("angle", e.coordinates[0], f, 1e-11);
    assert!(e.conservative);

    // With k h = weight and no free length the bar is balanced in every place.
    let flat = |loads: Vec<Load>| {
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        problem.loads = loads;
        let energy = |f: f64| load_energy(&problem, &[f]).unwrap().unwrap();
        for f in [0.0, 0.7, 1.9, 3.0] {
            close("indifferent", energy(f), energy(1.0), 1e-12);
        }
    };
    let pull = Wrench::new(vector![0.0, 0.0, -k * h], Vector3::zeros());
    flat(vec![spring(0.0), Load::dead(tip, pull)]);

    // A lever with a counterweight: M R = m r balances the bar in every place.
    let gravity = vector![0.0, 0.0, -9.81];
    let lever = vector![0.0, 0.0, -a - 0.3];
    flat(vec![
        Load::counterweight(tip, lever, 10.0, gravity),
        Load::counterweight(tip, Vector3::zeros(), 5.0, gravity),
    ]);
}

#[test]
fn laws_of_length_are_what_they_say() {
    let gas = |exponent| LengthLaw::Gas {
        force: 300.0,
        length: 0.5,
        column: 0.4,
        exponent,
    };
    // Boyle: half the column, twice the push.
    let half = gas(1.0).respond(0.3);
    close("isothermal", half.tension, -600.0, 1e-9);
    close("its energy", half.energy, 300.0 * 0.4 * 2_f64.ln(), 1e-9);
    close(
        "adiabatic",
        gas(1.4).respond(0.3).tension,
        -300.0 * 2_f64.powf(1.4),
        1e-9,
    );
    for law in [gas(1.0), gas(1.3), LengthLaw::Constant { tension: 7.0 }] {
        // Also pressed beyond the stop, where the characteristic goes on straight.
        for length in [0.7, 0.5, 0.3, 0.121, 0.1] {
            let (d, at) = (1e-4, |s: f64| law.respond(length + s * 1e-4));
            let slope = (8.0 * (at(1.0).tension - at(-1.0).tension)
                - (at(2.0).tension - at(-2.0).tension))
                / (12.0 * d);
            let force = (8.0 * (at(1.0).energy - at(-1.0).energy)
                - (at(2.0).energy - at(-2.0).energy))
                / (12.0 * d);
            let here = law.respond(length);
            let size = here.tension.abs();
            close("tension", force, here.tension, 1e-8 * size);
            close("slope", slope, here.slope, 1e-6 * (size + here.slope.abs()));
        }
    }
}

/// Two hinges in a plane under a moment: the potential counts whole turns.
#[test]
fn a_dead_moment_is_conservative_where_all_turns_share_one_axis() {
    let build = |second: Vector3<f64>| {
        Chain::builder("arm")
            .spring("a", MotionKind::Revolute, Vector3::z(), 5.0, 0.0)
            .translation(vector![0.5, 0.0, 0.0])
            .spring("b", MotionKind::Revolute, second, 5.0, 0.0)
            .translation(vector![0.5, 0.0, 0.0])
            .build()
            .unwrap()
    };
    let moment = Wrench::new(Vector3::zeros(), vector![0.3, 0.2, 40.0]);
    for (axis, conservative) in [(-Vector3::z(), true), (Vector3::y(), false)] {
        let chain = build(axis);
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(moment));
        assert_eq!(is_conservative(&problem), conservative);
        let energy = load_energy(&problem, &[9.0, 1.0]).unwrap();
        assert_eq!(energy.is_some(), conservative);
        if let Some(energy) = energy {
            let zero = load_energy(&problem, &[0.0, 0.0]).unwrap().unwrap();
            close("turns", energy - zero, -40.0 * 8.0, 1e-10);
        }
        let dead = Load::dead(chain.tip(), moment);
        assert_eq!(dead.conservative(&chain), conservative);
        // A moment that the held end takes does no work.
        problem.end = EndCondition::pose(Pose::translation(1.0, 0.0, 0.0));
        problem.end.wrench = moment;
        assert!(is_conservative(&problem));
        problem.end.prescribed[5] = Prescribed::Wrench;
        assert_eq!(is_conservative(&problem), conservative);
    }
}

#[test]
fn a_load_that_does_not_fit_says_why() {
    let mut rng = Rng(3);
    let r = random_chain(
        &mut rng,
        &Recipe {
            stages: 2,
            passive: 1,
            ..Recipe::default()
        },
    );
    let refused = |load: Load| {
        let mut problem = r.problem(EndCondition::pose(r.tip()));
        problem.loads = vec![load];
        let error = solve_chain(&problem, &Settings::default()).unwrap_err();
        assert!(!error.is_unanswered(), "{error}");
        error.to_string()
    };
    let ground = Anchor::Base(vector![0.0, 0.0, 3.0]);
    let pull = Wrench::new(vector![1.0, 0.0, 0.0], Vector3::zeros());
    let says = |text: String, words: &str| assert!(text.contains(words), "{text}");
    says(refused(Load::follower(99, pull)), "node 99");
    says(
        refused(Load::spring_between(ground, Anchor::node(99), 1.0, 0.1)),
        "node 99",
    );
    says(
        refused(Load::spring_between(ground, Anchor::node(0), f64::NAN, 0.1)),
        "a finite number",
    );
    says(
        refused(Load::spring_between(ground, Anchor::node(0), 1.0, -0.1)),
        "not below zero",
    );
    says(
        refused(Load::counterweight(0, Vector3::x(), f64::NAN, Vector3::z())),
        "a finite number",
    );
    says(
        refused(Load::function(FunctionLoad::new("none", vec![0], |_| {
            Vec::new()
        }))),
        "'none': the function returned 0 wrenches for 1 nodes",
    );
    let shape = FunctionLoad::new("shape", vec![0], |_| vec![Wrench::zero()])
        .with_tangent(|_| DMatrix::zeros(3, 3));
    says(
        refused(Load::function(shape)),
        "'shape': the tangent is 3 x 3, 6 x 6 is needed",
    );
    let nan = |_: &[Pose]| vec![Wrench::new(Vector3::repeat(f64::NAN), Vector3::zeros())];
    says(
        refused(Load::function(FunctionLoad::new("nan", vec![0], nan))),
        "finite",
    );
}

/// A wrong tangent is found by the check, and in debug builds refused before solving.
#[test]
fn a_wrong_tangent_is_found() {
    let mut rng = Rng(11);
    let r = random_chain(
        &mut rng,
        &Recipe {
            stages: 2,
            passive: 1,
            ..Recipe::default()
        },
    );
    let tip = r.chain.tip();
    let pull = |poses: &[Pose]| {
        vec![Wrench::new(
            poses[0].translation.vector * -300.0,
            Vector3::zeros(),
        )]
    };
    let wrong = Load::function(
        FunctionLoad::new("wrong", vec![tip], pull)
            .with_tangent(|_| DMatrix::identity(6, 6) * 300.0),
    );
    let check = check_tangents(&r.chain, &r.base, &r.posture, &r.commands, &wrong).unwrap();
    assert!(check.largest > 0.1, "{check:?}");
    assert_eq!(check.node, tip);
    let mut problem = r.problem(EndCondition::pose(r.tip()));
    problem.loads = vec![wrong];
    let answer = solve_chain(&problem, &Settings::default());
    if cfg!(debug_assertions) {
        let error = answer.unwrap_err();
        assert!(matches!(error, Error::Model { .. }));
        assert!(error.to_string().contains("not the derivative"), "{error}");
    }
}

/// A function that stops giving numbers somewhere ends the iteration, not the program.
#[test]
fn a_function_that_turns_into_nan_on_the_way_ends_in_an_error() {
    for seed in 0..12 {
        let mut rng = Rng(seed);
        let recipe = Recipe {
            stages: 2,
            passive: 2,
            ..Recipe::default()
        };
        let r = random_chain(&mut rng, &recipe);
        let tip = r.chain.tip();
        let end = r.tip().translation.vector.x;
        // At the edge itself the wrench is a number and its tangent is none.
        let (edge, span) = [(1e-3, 0.05), (0.05, 0.05), (1e-3, 1e-3)][rng.below(3)];
        let cliff = FunctionLoad::new("cliff", vec![tip], move |poses| {
            let x = poses[0].translation.x;
            let pull = (end + edge - x).sqrt() * 1e3;
            vec![Wrench::new(vector![pull, 0.0, 0.0], Vector3::zeros())]
        });
        let step = Twist::new(vector![span, 0.0, 0.0], Vector3::zeros());
        let mut problem = r.problem(EndCondition::pose(moved(&r.tip(), &step)));
        problem.loads = vec![Load::function(cliff)];
        let answer = solve_chain(&problem, &Settings::default());
        assert!(answer.is_err(), "{answer:?}");
    }
}

/// A rocker between two slides: pushed in, the tool moves along y by the slides of both limbs.
#[test]
fn a_machine_names_the_joints_of_its_limbs() {
    use kinetostat::{BeamSection, DirectionKind, Limb, Mechanism, Platform};
    let tube = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    let chain = |name: &str| {
        Chain::builder(name)
            .passive("slide", MotionKind::Prismatic, Vector3::y(), 0.0)
            .link("rod", &tube, 0.5)
            .build()
            .unwrap()
    };
    let mut builder = Mechanism::builder("rocker");
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.5, 0.0, 0.0)));
    for name in ["left", "right"] {
        builder = builder.limb(Limb::between(name, 0, tool, chain(name)));
    }
    let machine = builder.build().unwrap();
    let posture = machine.posture(&Pose::translation(0.5, 0.0, 0.0)).unwrap();
    let k = posture.stiffness().unwrap();
    let free: Vec<_> = k
        .directions
        .iter()
        .filter(|d| d.kind == DirectionKind::Free)
        .collect();
    assert_eq!(free.len(), 1);
    assert_eq!(
        free[0].description(),
        "free: moves along y by left: slide, right: slide"
    );
    let participation = k.participation(&posture, &free[0].twist);
    assert_eq!(participation, free[0].participation);
    let names: Vec<&str> = participation.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["left: slide", "right: slide"]);
    close("share", participation[0].share, 0.5, 1e-9);
    close("motion", participation[1].motion.abs(), 1.0, 1e-9);
    let pushed = Wrench::new(vector![100.0, 0.0, 0.0], Vector3::zeros());
    let e = posture.deflected_by(&pushed).unwrap();
    assert!(e.directions.iter().any(|d| !d.participation.is_empty()));
    let participation = e.participation(&machine, &Twist::new(Vector3::x(), Vector3::zeros()));
    let names: Vec<&str> = participation.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["left: rod.x", "right: rod.x"]);
}

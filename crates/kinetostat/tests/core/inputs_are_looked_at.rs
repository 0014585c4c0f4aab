//! Numbers that are none, zero, negative or absurd in the scalar inputs of the public functions: an
//! error that names the argument, or a finite answer. And messages about what was requested wrongly.

use kinetostat::error::{Part, Place};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, ChainProblem, EndCondition, Error, LinkSpec, MotionKind,
    Pose, Prescribed, Result, Settings, Wrench,
    machine::inverse_kinematics,
    reference::{ChainBlocks, eliminate_passive, planar_beam, with_hinge_at_root},
    solve_chain, unloaded_stiffness,
};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6, vector};

use crate::common::arm;

pub type Ask = Box<dyn Fn(f64) -> Result<Vec<f64>>>;

fn matrix(m: &Matrix6<f64>) -> Vec<f64> {
    m.iter().copied().collect()
}

fn tube() -> BeamSection {
    BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03)
}

fn elastic() -> Chain {
    Chain::builder("elastic")
        .passive("q", MotionKind::Revolute, Vector3::z(), 0.2)
        .link("bar", &tube(), 0.7)
        .build()
        .unwrap()
}

fn problem(chain: &Chain) -> ChainProblem<'_> {
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
    problem.end.pose = Pose::translation(0.68, 0.14, 0.0);
    problem.end.prescribed = [Prescribed::Pose; 6];
    problem
}

fn solved(change: impl Fn(&mut ChainProblem<'_>, &mut Settings)) -> Result<Vec<f64>> {
    let chain = elastic();
    let mut problem = problem(&chain);
    problem.end.prescribed = [Prescribed::Wrench; 6];
    problem.end.prescribed[0] = Prescribed::Pose;
    problem.end.prescribed[1] = Prescribed::Pose;
    let mut settings = Settings::default();
    change(&mut problem, &mut settings);
    let e = solve_chain(&problem, &settings)?;
    Ok([e.coordinates, matrix(&e.stiffness.cartesian.matrix)].concat())
}

/// What each input is called in messages, and a query with it.
fn inputs() -> Vec<(&'static str, Ask)> {
    let section = |change: fn(&mut BeamSection, f64)| -> Ask {
        Box::new(move |x| {
            let mut own = tube();
            change(&mut own, x);
            Ok(matrix(&own.cantilever(0.5)?))
        })
    };
    let built = |change: fn(f64) -> kinetostat::ChainBuilder| -> Ask {
        Box::new(move |x| {
            let chain = change(x).build()?;
            let k = unloaded_stiffness(
                &chain,
                &Pose::identity(),
                &chain.home_coordinates(),
                &chain.home_commands(),
            )?;
            Ok(matrix(&k.cartesian.matrix))
        })
    };
    let at = |change: fn(&mut Pose, &mut Vec<f64>, &mut Vec<f64>, f64)| -> Ask {
        Box::new(move |x| {
            let chain = arm(true);
            let mut base = Pose::identity();
            let (mut q, mut commands) = (chain.home_coordinates(), chain.home_commands());
            change(&mut base, &mut q, &mut commands, x);
            let k = unloaded_stiffness(&chain, &base, &q, &commands)?;
            let blocks = ChainBlocks::unloaded(&chain, &base, &q, &commands)?;
            let c = blocks.compliance();
            Ok([matrix(&k.cartesian.matrix), matrix(&c.springs)].concat())
        })
    };
    let settings =
        |change: fn(&mut Settings, f64)| -> Ask { Box::new(move |x| solved(|_, s| change(s, x))) };
    let conditions = |change: fn(&mut ChainProblem<'_>, f64)| -> Ask {
        Box::new(move |x| solved(|p, _| change(p, x)))
    };
    vec![
        ("length", Box::new(|x| Ok(matrix(&tube().cantilever(x)?)))),
        ("Young", section(|s, x| s.youngs_modulus = x)),
        ("shear", section(|s, x| s.shear_modulus = x)),
        ("area", section(|s, x| s.area = x)),
        (
            "second moment about y",
            section(|s, x| s.second_moment_y = x),
        ),
        (
            "second moment about z",
            section(|s, x| s.second_moment_z = x),
        ),
        ("torsion constant", section(|s, x| s.torsion_constant = x)),
        (
            "tension",
            Box::new(|x| Ok(planar_beam(x, 2.0, 0.5)?.iter().copied().collect())),
        ),
        (
            "bending",
            Box::new(|x| Ok(planar_beam(1.0, x, 0.5)?.iter().copied().collect())),
        ),
        (
            "stiffness",
            Box::new(|x| {
                let mut k = tube().cantilever(0.5)?;
                k[(1, 1)] = x;
                Ok(matrix(
                    &eliminate_passive(&k, &Vector6::ith(0, 1.0))?.matrix,
                ))
            }),
        ),
        (
            "motion of the end",
            Box::new(|x| {
                let k = tube().cantilever(0.5)?;
                Ok(matrix(&with_hinge_at_root(
                    &k,
                    kinetostat::reference::Axis::Z,
                    x,
                )?))
            }),
        ),
        (
            "length",
            built(|x| Chain::builder("l").link_with("l", &LinkSpec::beam(tube(), x))),
        ),
        (
            "stiffness",
            built(|x| Chain::builder("s").spring("s", MotionKind::Prismatic, Vector3::x(), x, 0.0)),
        ),
        (
            "rest",
            built(|x| Chain::builder("s").spring("s", MotionKind::Revolute, Vector3::x(), 5.0, x)),
        ),
        (
            "drive",
            built(|x| {
                let spec = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), x);
                Chain::builder("drive").actuator("drive", spec)
            }),
        ),
        (
            "offset",
            built(|x| {
                let b = Chain::builder("offset").translation(vector![x, 0.0, 0.0]);
                b.spring("s", MotionKind::Prismatic, Vector3::x(), 5.0, 0.0)
            }),
        ),
        ("base", at(|base, _, _, x| base.translation.vector.y = x)),
        ("coordinates[1]", at(|_, q, _, x| q[1] = x)),
        ("commands[0]", at(|_, _, c, x| c[0] = x)),
        ("closure", settings(|s, x| s.closure = x)),
        ("torque", settings(|s, x| s.torque = x)),
        (
            "smallest_load_step",
            settings(|s, x| s.smallest_load_step = x),
        ),
        (
            "iterations",
            settings(|s, x| {
                s.iterations = if x.is_finite() {
                    x.clamp(0.0, 60.0)
                } else {
                    0.0
                } as usize
            }),
        ),
        ("end", conditions(|p, x| p.end.wrench.0[5] = x)),
        (
            "end",
            conditions(|p, x| p.end.pose.translation.vector.x = x),
        ),
        ("base", conditions(|p, x| p.base.translation.vector.z = x)),
        (
            "target",
            Box::new(|x| {
                let chain = arm(false);
                let target = Pose::translation(x, 0.1, 0.2);
                let found = inverse_kinematics(&chain, &Pose::identity(), &target, None)?;
                Ok(found.commands)
            }),
        ),
    ]
}

/// Inputs that may be infinitely far away.
const LIMITS: [&str; 4] = [
    "range",
    "conjugate_range",
    "largest_angle",
    "largest_change",
];

/// Asks with every odd number: each is refused by its name, or has a finite answer. How many were refused and
/// answered.
pub fn every_input(inputs: Vec<(&'static str, Ask)>) -> (usize, usize) {
    let numbers = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        1e300,
        -1e300,
        -1.0,
        1.0,
    ];
    let (mut refused, mut answered) = (0, 0);
    let mut faults = Vec::new();
    for (name, ask) in inputs {
        for x in numbers {
            let answer = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| ask(x)));
            match answer {
                Err(_) => faults.push(format!("{name} {x}: panic")),
                Ok(Ok(answer)) => {
                    let far = x.is_infinite() && LIMITS.contains(&name);
                    if !(x.is_finite() || far) || !answer.iter().all(|v| v.is_finite()) {
                        faults.push(format!("{name} {x}: {answer:?}"));
                    }
                    answered += 1;
                }
                Ok(Err(error)) => {
                    let words = error.to_string();
                    let unanswered = error.is_unanswered() && x.is_finite();
                    if !(words.contains(name) || unanswered) {
                        faults.push(format!("{name} {x}: {words}"));
                    }
                    for odd in ["inf mm", "NaN mm", "inf deg", "of NaN", "of inf"] {
                        if words.contains(odd) {
                            faults.push(format!("{name} {x}: {words}"));
                        }
                    }
                    refused += 1;
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    (refused, answered)
}

#[test]
fn every_scalar_input_is_looked_at() {
    let (refused, answered) = every_input(inputs());
    assert!(refused > 80 && answered > 30, "{refused} {answered}");
}

#[test]
fn messages_say_what_was_asked_wrongly() {
    let tube = BeamSection::tube(2.1e11, 8.1e10, 0.03, 0.04);
    let words = tube.cantilever(0.5).unwrap_err().to_string();
    assert!(words.contains("inner diameter is larger"), "{words}");
    let chain = Chain::builder("tube").link("bar", &tube, 0.5).build();
    let words = chain.unwrap_err().to_string();
    assert!(words.contains("inner diameter is larger"), "{words}");

    // A planar chain held out of its plane.
    let chain = Chain::builder("planar")
        .passive("q1", MotionKind::Revolute, Vector3::z(), 0.3)
        .translation(vector![0.5, 0.0, 0.0])
        .spring("s", MotionKind::Revolute, Vector3::z(), 50.0, 0.0)
        .translation(vector![0.5, 0.0, 0.0])
        .build()
        .unwrap();
    let mut end = EndCondition::wrench(Wrench::zero());
    end.pose = Pose::translation(0.9, 0.2, 0.005);
    for k in 0..3 {
        end.prescribed[k] = Prescribed::Pose;
    }
    let words = solve_chain(&ChainProblem::new(&chain, end), &Settings::default())
        .unwrap_err()
        .to_string();
    assert!(
        words.contains("5.0000 mm") && words.contains("moves along z"),
        "{words}"
    );

    // A force along a slide that nothing holds.
    let chain = Chain::builder("slide")
        .passive("way", MotionKind::Prismatic, Vector3::x(), 0.0)
        .spring("s", MotionKind::Prismatic, Vector3::y(), 50.0, 0.0)
        .build()
        .unwrap();
    let wrench = Wrench::new(vector![10.0, 1.0, 0.0], Vector3::zeros());
    let problem = ChainProblem::new(&chain, EndCondition::wrench(wrench));
    let error = solve_chain(&problem, &Settings::default()).unwrap_err();
    assert!(matches!(error, Error::FreeDirection { .. }), "{error}");
    let words = error.to_string();
    assert!(words.contains("'way' with 10.0000 N"), "{words}");

    // An unsymmetric matrix is none of an unloaded link.
    let mut k = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03)
        .cantilever(0.5)
        .unwrap();
    k[(1, 5)] *= 1.001;
    let words = eliminate_passive(&k, &Vector6::ith(0, 1.0))
        .unwrap_err()
        .to_string();
    assert!(
        words.contains("not symmetric") && words.contains("(6, 2)"),
        "{words}"
    );
}

#[test]
fn a_mistake_in_a_chain_names_the_part() {
    let axis = Vector3::z();
    let spec = |stiffness| ActuatorSpec::new(MotionKind::Revolute, axis, stiffness);
    let flat = Matrix6::from_diagonal(&vector![1e6, 1e6, 1e6, 1e4, 1e4, 0.0]);
    let mut nowhere = spec(1e4);
    nowhere.home = f64::NAN;
    let start = || Chain::builder("arm");
    let cases = [
        (
            start().actuator("elbow", nowhere),
            Part::Actuator("elbow".into()),
            "chain 'arm': actuator 'elbow': its home is NaN",
        ),
        (
            start().actuator("elbow", spec(-1.0)),
            Part::Spring("elbow".into()),
            "chain 'arm': spring 'elbow': its stiffness -1 is not positive",
        ),
        (
            start().spring6("bar", &flat, [0.0; 6]),
            Part::Spring("bar".into()),
            "chain 'arm': spring 'bar': its stiffness 0 is not positive (diagonal entry 6)",
        ),
        (
            start().link("bar", &tube(), -0.7),
            Part::Link("bar".into()),
            "chain 'arm': link 'bar': its length is -0.7, a positive number of metres is needed",
        ),
        (
            start().passive("hinge", MotionKind::Revolute, Vector3::zeros(), 0.0),
            Part::Coordinate("hinge".into()),
            "chain 'arm': coordinate 'hinge': the axis [0, 0, 0] has no direction",
        ),
        (
            start().body("head", -3.0, Vector3::zeros(), Matrix3::zeros()),
            Part::Body("head".into()),
            "chain 'arm': body 'head': its mass is -3 kg",
        ),
    ];
    for (builder, part, message) in cases {
        let error = builder.build().unwrap_err();
        assert_eq!(error.place().and_then(Place::part), Some(&part), "{error}");
        assert!(error.to_string().starts_with(message), "{error}");
    }
}

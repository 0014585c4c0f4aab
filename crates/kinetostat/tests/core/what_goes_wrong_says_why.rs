//! Every kind of error, with its message: what, where, and what was expected.

use crate::common::{Orthoglide, arm, orthoglide_point, planar_column};
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, ChainBuilder, ChainProblem, EndCondition, Error, Limb, Load,
    Mechanism, MotionKind, Platform, Pose, PostureRequest, Settings, Twist, Wrench,
    machine::LimbPosture, model::SpringLaw, solve_chain, unloaded_stiffness,
};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3, vector};

#[track_caller]
fn says(error: &Error, parts: &[&str]) {
    let text = error.to_string();
    for part in parts {
        assert!(text.contains(part), "'{part}' is missing in: {text}");
    }
}

fn k6() -> Matrix6<f64> {
    Matrix6::identity() * 1e5
}

#[track_caller]
fn refused(builder: ChainBuilder, parts: &[&str]) {
    let error = builder.build().expect_err("should be refused");
    assert!(matches!(error, Error::Model { .. }), "{error:?}");
    assert!(!error.is_unanswered());
    says(&error, &["chain 'c'"]);
    says(&error, parts);
}

fn c() -> ChainBuilder {
    Chain::builder("c")
}

#[test]
fn chains_that_make_no_sense_are_refused_by_name() {
    let z = Vector3::z();
    let revolute = MotionKind::Revolute;
    refused(
        c().passive("hinge", revolute, Vector3::zeros(), 0.0),
        &["'hinge'", "has no direction"],
    );
    refused(
        c().passive("hinge", revolute, z * f64::NAN, 0.0),
        &["'hinge'", "has no direction"],
    );
    refused(
        c().passive("hinge", revolute, z, f64::INFINITY),
        &["'hinge'", "start value is inf"],
    );
    refused(
        c().spring("s", revolute, z, -5.0, 0.0),
        &["spring 's'", "-5 is not positive", "passive joint"],
    );
    refused(
        c().spring("s", revolute, z, 0.0, 0.0),
        &["spring 's'", "is not positive"],
    );
    refused(
        c().spring("s", revolute, z, f64::NAN, 0.0),
        &["spring 's'", "not finite"],
    );
    refused(
        c().spring("s", revolute, z, 1.0, f64::NAN),
        &["spring 's'", "rest position"],
    );
    let mut k = k6();
    k[(0, 1)] = 3.0e4;
    refused(
        c().spring6("beam", &k, [0.0; 6]),
        &["spring 'beam'", "not symmetric"],
    );
    k[(0, 1)] = 2e5;
    k[(1, 0)] = 2e5;
    refused(
        c().spring6("beam", &k, [0.0; 6]),
        &["spring 'beam'", "not positive definite"],
    );
    k[(0, 1)] = f64::INFINITY;
    refused(
        c().spring6("beam", &k, [0.0; 6]),
        &["spring 'beam'", "not finite"],
    );
    let law = SpringLaw::Linear(DMatrix::identity(2, 2));
    refused(
        c().springs("part", &[0, 1, 5], law.clone(), vec![0.0; 3]),
        &["spring 'part'", "3 x 3", "2 x 2"],
    );
    refused(
        c().springs("part", &[1, 0], law.clone(), vec![0.0; 2]),
        &["spring 'part'", "directions must increase"],
    );
    refused(
        c().springs("part", &[0, 6], law.clone(), vec![0.0; 2]),
        &["spring 'part'", "0..6"],
    );
    refused(c().springs("part", &[], law, vec![]), &["spring 'part'"]);
    let section = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    refused(
        c().link("rod", &section, 0.0),
        &["link 'rod'", "length is 0", "positive"],
    );
    refused(
        c().link("rod", &section, -1.0),
        &["link 'rod'", "length is -1"],
    );
    refused(c().link("rod", &section, f64::NAN), &["link 'rod'", "NaN"]);
    refused(
        c().parallelogram("p", 0.3, 0.0, &k6(), 0.0),
        &["parallelogram 'p'", "width 0"],
    );
    refused(
        c().parallelogram("p", -0.3, 0.1, &k6(), 0.0),
        &["parallelogram 'p'", "length -0.3"],
    );
    refused(
        c().coupled("ghost", revolute, z, 1.0),
        &["'ghost'", "no coordinate of that name"],
    );
    refused(
        c().passive("a", revolute, z, 0.0)
            .passive("a", revolute, z, 0.0),
        &["'a' is used twice"],
    );
    refused(c().node("tip"), &["'tip' is used twice"]);
    refused(c().node("n").node("n"), &["'n' is used twice"]);
    let body = |mass, com, inertia| c().body("b", mass, com, inertia);
    let (o, i) = (Vector3::zeros(), Matrix3::identity());
    refused(body(-1.0, o, i), &["body 'b'", "-1 kg"]);
    refused(body(f64::NAN, o, i), &["body 'b'", "NaN"]);
    refused(body(1.0, o * f64::NAN, i), &["body 'b'", "not finite"]);
    refused(body(1.0, o, i * f64::NAN), &["body 'b'", "not finite"]);
    refused(
        c().translation(vector![f64::NAN, 0.0, 0.0]),
        &["rigid offset", "not finite"],
    );
    let mut spec = ActuatorSpec::new(revolute, z, 1e6);
    spec.limits = Some((0.5, 1.0));
    refused(
        c().actuator("A1", spec.clone()),
        &["actuator 'A1'", "home 0", "0.5 .. 1"],
    );
    spec.limits = None;
    spec.home = f64::NAN;
    refused(c().actuator("A1", spec.clone()), &["actuator 'A1'", "NaN"]);
    spec.home = 0.0;
    spec.stiffness = Some(-3.0);
    refused(
        c().actuator("A1", spec),
        &["spring 'A1'", "-3 is not positive"],
    );
}

#[test]
fn mechanisms_that_make_no_sense_are_refused_by_name() {
    let chain = c().spring6("s", &k6(), [0.0; 6]).build().unwrap();
    let other = c().spring6("t", &k6(), [0.0; 6]).build().unwrap();
    let limb = |name: &str, from, to| Limb::between(name, from, to, chain.clone());
    let refuse = |limbs: Vec<Limb>, platforms: Vec<Platform>, parts: &[&str]| {
        let mut b = Mechanism::builder("m");
        for p in platforms {
            b.platform(p);
        }
        for l in limbs {
            b = b.limb(l);
        }
        let error = b.build().expect_err("should be refused");
        says(&error, &["mechanism 'm'"]);
        says(&error, parts);
    };
    let tool = || Platform::new("tool", Pose::identity());
    refuse(vec![], vec![], &["no moving platform"]);
    refuse(vec![], vec![tool()], &["no limb holds platform 'tool'"]);
    refuse(
        vec![limb("a", 0, 1), limb("a", 0, 1)],
        vec![tool()],
        &["'a' is used twice"],
    );
    refuse(
        vec![limb("a", 0, 1)],
        vec![Platform::new("base", Pose::identity())],
        &["'base' is used twice"],
    );
    refuse(
        vec![limb("a", 0, 2)],
        vec![tool()],
        &["limb 'a'", "platforms 0 and 2 of 2"],
    );
    refuse(
        vec![limb("a", 1, 1)],
        vec![tool()],
        &["limb 'a'", "two different"],
    );
    refuse(
        vec![limb("a", 1, 0)],
        vec![tool()],
        &["limb 'a'", "ends at the base"],
    );
    let mut mixed = limb("a", 0, 1);
    mixed.actual = other;
    refuse(
        vec![mixed],
        vec![tool()],
        &["limb 'a'", "nominal and actual"],
    );
    let mut heavy = tool();
    heavy.mass = -2.0;
    refuse(
        vec![limb("a", 0, 1)],
        vec![heavy],
        &["platform 'tool'", "not negative"],
    );
    let error =
        Mechanism::serial(chain, Pose::identity(), vector![0.0, f64::NAN, 0.0]).unwrap_err();
    says(&error, &["gravity is NaN", "a finite number is needed"]);
}

#[test]
fn names_sizes_and_numbers_are_checked() {
    let chain = arm(true);
    let error = chain.node("elbow").unwrap_err();
    assert!(matches!(error, Error::UnknownName { .. }));
    says(&error, &["chain 'arm'", "node", "'elbow'", "mass 1", "tip"]);

    let error = unloaded_stiffness(&chain, &Pose::identity(), &[0.0; 3], &[0.0; 6]).unwrap_err();
    assert!(
        matches!(
            error,
            Error::Size {
                expected: 42,
                found: 3,
                ..
            }
        ),
        "{error:?}"
    );
    says(
        &error,
        &["chain 'arm'", "coordinates needs 42", "3 were given"],
    );
    let error = unloaded_stiffness(&chain, &Pose::identity(), &[0.0; 42], &[0.0]).unwrap_err();
    says(&error, &["commands needs 6", "1 were given"]);
    let mut x = [0.0; 42];
    x[5] = f64::NAN;
    let error = unloaded_stiffness(&chain, &Pose::identity(), &x, &[0.0; 6]).unwrap_err();
    assert!(matches!(error, Error::NotFinite { .. }));
    says(&error, &["coordinates[5] is NaN", "finite"]);

    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.end.wrench.0[2] = f64::INFINITY;
    let error = solve_chain(&problem, &Settings::default()).unwrap_err();
    says(&error, &["chain 'arm'", "the end condition is inf"]);

    let machine = Orthoglide::default().build();
    let error = machine
        .posture(&Pose::translation(f64::NAN, 0.0, 0.0))
        .unwrap_err();
    says(&error, &["mechanism 'orthoglide'", "target pose is NaN"]);
    let posture = machine.posture(&Pose::identity()).unwrap();
    let error = posture.linear_assembly(&[Twist::zero()]).unwrap_err();
    says(&error, &["limb errors needs 3", "1 were given"]);
    let error = machine
        .posture(PostureRequest::joints(&Pose::identity(), vec![]))
        .unwrap_err();
    says(&error, &["limb postures needs 3", "0 were given"]);
    let bad = LimbPosture {
        commands: vec![0.0],
        coordinates: vec![0.0; 2],
    };
    let error = machine
        .posture(PostureRequest::joints(
            &Pose::identity(),
            vec![bad.clone(), bad.clone(), bad],
        ))
        .unwrap_err();
    says(&error, &["coordinates needs 15", "2 were given"]);
}

#[test]
fn targets_out_of_reach_name_the_limb_and_the_nearest_pose() {
    let machine = Orthoglide::default().build();
    let error = machine
        .posture(&Pose::translation(0.0, 0.5, 0.0))
        .unwrap_err();
    assert!(error.is_unanswered());
    let Error::Unreachable {
        distance_m,
        nearest,
        ..
    } = &error
    else {
        panic!("{error:?}")
    };
    assert!(
        (*distance_m > 0.05) && nearest.translation.vector.norm() > 0.1,
        "{error:?}"
    );
    says(&error, &["leg x", "cannot be reached", "nearest pose"]);
    let turned = Pose::rotation(vector![0.2, 0.0, 0.0]);
    let error = machine.posture(&turned).unwrap_err();
    assert!(matches!(error, Error::Unreachable { .. }), "{error:?}");
}

#[test]
fn a_wrench_along_a_free_direction_is_named() {
    // A machine of one hinge and one link: turning costs nothing.
    let section = BeamSection::tube(2.1e11, 8e10, 0.03, 0.02);
    let chain = Chain::builder("door")
        .passive("hinge", MotionKind::Revolute, Vector3::z(), 0.0)
        .link("leaf", &section, 0.8)
        .build()
        .unwrap();
    let home = Pose::translation(0.8, 0.0, 0.0);
    let machine = Mechanism::serial(chain, home, Vector3::zeros()).unwrap();
    let joints = LimbPosture {
        commands: vec![],
        coordinates: machine.limbs()[0].nominal.home_coordinates(),
    };
    let posture = machine
        .posture(PostureRequest::joints(&home, vec![joints]))
        .unwrap();
    assert_eq!(posture.stiffness().unwrap().rank(), 5);
    // Along the leaf it holds.
    let e = posture
        .deflected_by(&Wrench::new(vector![100.0, 0.0, 0.0], Vector3::zeros()))
        .unwrap();
    crate::common::assert_equilibrium(&posture, &e);
    // A moment about the hinge has no equilibrium anywhere.
    let error = posture
        .deflected_by(&Wrench::new(Vector3::zeros(), vector![0.0, 0.0, 20.0]))
        .unwrap_err();
    assert!(matches!(error, Error::FreeDirection { .. }), "{error:?}");
    assert!(error.is_unanswered());
    says(
        &error,
        &["mechanism 'door'", "free direction", "no force is needed"],
    );
}

#[test]
fn an_iteration_that_fails_hands_over_its_last_state() {
    // Two rigid links of 1 m cannot end 3 m away.
    let chain = planar_column(2, 1.0, 1.0);
    let mut problem =
        ChainProblem::new(&chain, EndCondition::pose(Pose::translation(3.0, 0.0, 0.0)));
    problem.posture = vec![0.3, -0.6, 0.3];
    let error = solve_chain(&problem, &Settings::default()).unwrap_err();
    let Error::NotConverged {
        last,
        load_factor,
        residual_position_m,
        ..
    } = &error
    else {
        panic!("{error:?}")
    };
    assert_eq!(last.len(), 3);
    assert!(last.iter().all(|x| x.is_finite()), "{last:?}");
    assert!((0.0..1.0).contains(load_factor), "{load_factor}");
    assert!(*residual_position_m > 0.5, "{error}");
    assert!(error.is_unanswered());
    says(
        &error,
        &[
            "chain 'column'",
            "no equilibrium found",
            "share of the load",
        ],
    );
}

#[test]
fn limits_are_reported_not_refused() {
    let mut spec = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e6);
    spec.limits = Some((-0.1, 0.1));
    let chain = Chain::builder("slide").actuator("x", spec).build().unwrap();
    let machine = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).unwrap();
    let posture = machine.posture(&Pose::translation(0.25, 0.0, 0.0)).unwrap();
    let violations = posture.limit_violations();
    assert_eq!(violations.len(), 1);
    assert_eq!(violations[0].0, "x");
    assert!((violations[0].1 - 0.25).abs() < 1e-12);
    assert_eq!(violations[0].2, (-0.1, 0.1));
    let _ = orthoglide_point(0);
}

#[test]
fn loads_that_are_no_numbers_or_act_nowhere_are_refused() {
    let machine = Orthoglide::default().build();
    let posture = machine.posture(&Pose::identity()).unwrap();
    let mut wrench = Wrench::zero();
    wrench.0[1] = f64::NAN;
    let error = posture.deflected_by(&wrench).unwrap_err();
    assert!(
        matches!(error, Error::NotFinite { .. }),
        "deflected_by: {error:?}"
    );
    let error = posture
        .wrench_at(&Pose::translation(f64::NAN, 0.0, 0.0))
        .unwrap_err();
    assert!(
        matches!(error, Error::NotFinite { .. }),
        "wrench_at: {error:?}"
    );
    let chain = arm(true);
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.loads = vec![Load::Dead {
        node: 99,
        wrench: Wrench::new(Vector3::x(), Vector3::zeros()),
    }];
    assert!(
        solve_chain(&problem, &Settings::default()).is_err(),
        "a load on node 99 was dropped in silence"
    );
}

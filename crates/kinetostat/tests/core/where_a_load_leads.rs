//! Machines that Newton does not bring to equilibrium from their unloaded posture: pendulums, strings and trusses
//! in their flat posture, free bars, limit points on the way. Against statics by hand.

use kinetostat::{
    ActuatorSpec, Chain, CurveSettings, EndCondition, Error, Mechanism, MotionKind, Parameter,
    Platform, Pose, Wrench,
    continuation::{LoadPattern, SpecialKind},
    error::LoadLimit,
};
use nalgebra::{Matrix2, Vector2, Vector3, vector};

use crate::common::assert_equilibrium;
use crate::graphs::limb;
use crate::planar_machines::truss;

fn force(x: f64, y: f64, z: f64) -> Wrench {
    Wrench::new(vector![x, y, z], Vector3::zeros())
}

/// A slide of some stiffness along x, a pin about y, and a bar of 1 m that hangs from it, turned by
/// an angle at home; a mass at its end.
fn pendulum(stiffness: f64, mass: f64, angle: f64) -> Mechanism {
    let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), stiffness);
    let chain = Chain::builder("bar")
        .actuator("slide", slide)
        .passive("pin", MotionKind::Revolute, Vector3::y(), angle)
        .translation(vector![0.0, 0.0, -1.0])
        .build()
        .unwrap();
    let home = Pose::rotation(vector![0.0, angle, 0.0]) * Pose::translation(0.0, 0.0, -1.0);
    let mut machine = Mechanism::builder("pendulum").gravity(vector![0.0, 0.0, -9.81]);
    let mut tool = Platform::new("tool", home);
    tool.mass = mass;
    let tool = machine.platform(tool);
    let bar = limb("bar", 0, tool, Pose::identity(), chain);
    machine.limb(bar).build().unwrap()
}

/// Force up at a height of a truss whose unloaded height is `h`.
fn truss_force(b: f64, h: f64, k: f64, z: f64) -> f64 {
    let l = b.hypot(z);
    2.0 * k * (l - b.hypot(h)) * z / l
}

#[test]
fn a_pushed_pendulum_hangs_along_its_load() {
    let (k, mass) = (5e5, 20.0);
    let machine = pendulum(k, mass, 0.0);
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    let weight = 9.81 * mass;
    for push in [0.5_f64, 50.0, -50.0, 5000.0] {
        let e = posture.deflected_by(&force(push, 0.0, 0.0)).unwrap();
        assert_equilibrium(&posture, &e);
        let angle = f64::atan2(push, weight);
        let place = vector![push / k + angle.sin(), 0.0, -angle.cos()];
        let off = (e.tool.translation.vector - place).norm();
        assert!(off < 1e-9, "{push} N: {off:e} m");
        assert!(e.stable());
        // A little force turns the bar against its tension and pushes the slide.
        let along = Vector2::new(angle.cos(), angle.sin());
        let moves =
            along * along.transpose() / push.hypot(weight) + Matrix2::new(1.0, 0.0, 0.0, 0.0) / k;
        let softest = 1.0 / moves.symmetric_eigenvalues().max();
        let found = e.stiffness_against_force();
        assert!(
            (found - softest).abs() < 1e-6 * softest,
            "{found} {softest}"
        );
    }
}

#[test]
fn a_bar_without_weight_turns_until_the_load_pulls_along_it() {
    let machine = pendulum(5e5, 0.0, 0.35);
    let home = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).unwrap();
    assert!(posture.stiffness().unwrap().rank() < 6);
    for push in [0.01_f64, 30.0, 300.0] {
        let pull = push * vector![0.6, 0.0, -0.8];
        let e = posture.deflected_by(&force(pull.x, 0.0, pull.z)).unwrap();
        assert_equilibrium(&posture, &e);
        let place = vector![pull.x / 5e5 + 0.6, 0.0, -0.8];
        assert!(
            (e.tool.translation.vector - place).norm() < 1e-8,
            "{push} N"
        );
    }
}

#[test]
fn a_slide_that_nothing_holds_has_no_rest() {
    let drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::y(), 1e5);
    let chain = Chain::builder("slides")
        .passive("loose", MotionKind::Prismatic, vector![0.8, 0.0, 0.6], 0.0)
        .actuator("drive", drive)
        .build()
        .unwrap();
    let machine = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).unwrap();
    let posture = machine.posture(&Pose::identity()).unwrap();
    let error = posture.deflected_by(&force(3.0, 5.0, 0.0)).unwrap_err();
    assert!(matches!(error, Error::FreeDirection { .. }), "{error:?}");
    // Square to it, it holds.
    let e = posture.deflected_by(&force(-0.6, 5.0, 0.8)).unwrap();
    assert!((e.displacement.linear().y - 5e-5).abs() < 1e-12);
}

#[test]
fn a_flat_truss_sags_by_the_third_root_of_its_load() {
    let (b, k) = (0.5, 1e5);
    let machine = truss(b, 0.0, k);
    let posture = machine.posture(&Pose::identity()).unwrap();
    for push in [-1e-3_f64, -0.05, -1.0, 40.0] {
        let e = posture.deflected_by(&force(0.0, 0.0, push)).unwrap();
        assert_equilibrium(&posture, &e);
        let z = e.displacement.linear().z;
        let own = truss_force(b, 0.0, k, z);
        assert!((own - push).abs() < 1e-8 * push.abs(), "{push} N: {own} N");
        assert!(e.stable());
    }
    // The same with a load that grows: no limit at the flat posture, which it leaves at no force.
    let load = Parameter::Load(LoadPattern {
        end: force(0.0, 0.0, -1.0),
        loads: Vec::new(),
    });
    let settings = CurveSettings::within(-1.0, 1.0);
    let path = posture
        .curves(&load, &EndCondition::wrench(Wrench::zero()), &settings)
        .unwrap();
    let limits = path.specials.iter();
    let limits = limits.filter(|s| s.kind == SpecialKind::LoadLimit);
    assert_eq!(limits.count(), 0);
    let points = &path.branches[0].points;
    let ends = [points.first(), points.last()].map(Option::unwrap);
    for (end, factor) in ends.into_iter().zip([-1.0, 1.0]) {
        assert!((end.parameter - factor).abs() < 1e-12);
        let own = truss_force(b, 0.0, k, end.equilibrium.displacement.linear().z);
        assert!((own + factor).abs() < 1e-8, "{own} N");
    }
}

#[test]
fn a_straight_string_sags_under_its_own_mass() {
    let (b, k, mass) = (0.5, 1e5, 2.0);
    let straight = truss(b, 0.0, k);
    let mut tool = straight.platforms()[straight.tool()].clone();
    tool.mass = mass;
    let mut machine = Mechanism::builder("string").gravity(vector![0.0, 0.0, -9.81]);
    machine.platform(tool);
    for bar in straight.limbs() {
        machine = machine.limb(bar.clone());
    }
    let machine = machine.build().unwrap();
    let posture = machine.posture(&Pose::identity()).unwrap();
    let e = posture.deflected_by(&Wrench::zero()).unwrap();
    assert_equilibrium(&posture, &e);
    let own = truss_force(b, 0.0, k, e.displacement.linear().z);
    assert!((own + 9.81 * mass).abs() < 1e-7, "{own} N");
    assert!(e.stable());
}

/// Share and displacement of a truss's first limit under a push down.
fn limit_by_hand(b: f64, h: f64, k: f64, push: f64) -> (f64, f64) {
    let z = ((b.hypot(h) * b * b).powf(2.0 / 3.0) - b * b).sqrt();
    (-truss_force(b, h, k, z) / push, z - h)
}

fn assert_limit(found: &LoadLimit, b: f64, h: f64, k: f64, push: f64) {
    let (share, down) = limit_by_hand(b, h, k, push);
    assert!(
        (found.share - share).abs() < 1e-7 * share,
        "{found:?}, {share}"
    );
    let off = found.displacement.linear().z - down;
    assert!(off.abs() < 1e-5 * h, "{found:?}, {down}");
}

#[test]
fn a_load_beyond_a_limit_point_is_reported_with_the_limit() {
    let (b, h, k) = (0.5, 0.1, 1e5);
    let machine = truss(b, h, k);
    let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
    let error = posture.deflected_by(&force(0.0, 0.0, -151.0)).unwrap_err();
    let Error::NotConverged {
        limit: Some(limit),
        load_factor,
        ..
    } = &error
    else {
        panic!("{error:?}")
    };
    assert_limit(limit, b, h, k, 151.0);
    assert!(*load_factor == limit.share && limit.share > 0.999);
    let text = error.to_string();
    for word in ["0.9997", "limit point", "snaps"] {
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn an_answer_behind_a_limit_point_is_recognised() {
    let (b, k) = (0.5, 1e5);
    for (h, push) in [(1e-4_f64, 1e-3_f64), (1e-3, 0.02), (1e-3, 1.0)] {
        let machine = truss(b, h, k);
        let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
        let rest = posture.deflected_by(&Wrench::zero()).unwrap();
        let loaded = posture.deflected_by(&force(0.0, 0.0, -push)).unwrap();
        assert!(loaded.displacement.linear().z < -h, "it was pushed through");
        let limit = posture.snaps_before(&rest, &loaded).unwrap();
        assert_limit(&limit.expect("it snaps"), b, h, k, push);
        // Pulled up it never does, nor below the limit.
        let (share, _) = limit_by_hand(b, h, k, push);
        for pull in [push, -0.9 * share * push] {
            let loaded = posture.deflected_by(&force(0.0, 0.0, pull)).unwrap();
            assert_eq!(posture.snaps_before(&rest, &loaded).unwrap(), None);
        }
    }
}

/// Whatever the share of the limit: below it the state found is the one in front of it, which the
/// machine reaches without a snap; beyond it, if any state is reported, the limit is on the way.
#[test]
fn a_limit_beyond_the_load_is_not_on_the_way() {
    let mut beyond_limit = 0;
    for (b, slope, k) in [
        (1.0, 0.25, 1e6),
        (0.5, 0.2, 1e5),
        (0.5, 0.002, 1e5),
        (2.0, 0.05, 3e7),
        (1.0, 0.01, 1e4),
        (1.0, 0.5, 1e6),
    ] {
        let h = slope * b;
        let machine = truss(b, h, k);
        let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
        let rest = posture.deflected_by(&Wrench::zero()).unwrap();
        let (whole, down) = limit_by_hand(b, h, k, 1.0);
        for share in [
            0.3, 0.7, 0.9, 0.95, 0.99, 0.995, 0.999, 0.9995, 0.9999, 0.99999, 0.999999, 1.001,
            1.01, 1.2, 30.0, 100.0,
        ] {
            let case = format!("b {b}, h {h}, k {k}, share {share}");
            let push = share * whole;
            let loaded = posture.deflected_by(&force(0.0, 0.0, -push));
            if share < 1.0 {
                let loaded = loaded.unwrap();
                assert!(loaded.stable(), "{case}");
                assert!(loaded.displacement.linear().z > down, "{case}");
                let snap = posture.snaps_before(&rest, &loaded).unwrap();
                assert_eq!(snap, None, "{case}");
            } else if let Ok(loaded) = loaded {
                assert!(loaded.displacement.linear().z < -h, "{case}");
                let snap = posture.snaps_before(&rest, &loaded).unwrap();
                let snap = snap.unwrap_or_else(|| panic!("{case}: no snap is reported"));
                assert_limit(&snap, b, h, k, push);
                beyond_limit += 1;
            }
        }
    }
    assert!(beyond_limit > 0, "no load led beyond a limit");
}

#[test]
fn no_force_moves_a_tool_in_the_middle_of_its_joint() {
    let drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 5.0);
    let chain = Chain::builder("turns")
        .actuator("drive", drive)
        .build()
        .unwrap();
    let machine = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).unwrap();
    let posture = machine.posture(&Pose::identity()).unwrap();
    let e = posture.deflected_by(&Wrench::zero()).unwrap();
    assert_eq!(e.stiffness_against_force(), f64::INFINITY);
}

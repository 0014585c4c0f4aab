//! A load that changes as its node goes is as stiff as a spring of the chain: a guide under a spring across it rests on
//! the branch that the growing force leads to, far below and next to the limit, for a chain and for a machine.

use kinetostat::{
    Anchor, Chain, ChainProblem, EndCondition, Load, Mechanism, MotionKind, Pose, Settings, Wrench,
    solve_chain,
};
use kinetostat_testing::largest_size;
use nalgebra::{Vector3, vector};

/// Distance of the guide from the far end of the spring (m), height at rest (m), stiffness of the spring (N/m).
const ACROSS: f64 = 0.5;
const HEIGHT: f64 = 0.1;
const STIFF: f64 = 1e5;

/// Force that holds the guide at a height, N, upwards.
fn force_at(z: f64, own: f64) -> f64 {
    let (length, free) = (ACROSS.hypot(z), ACROSS.hypot(HEIGHT));
    STIFF * (length - free) * z / length + own * (z - HEIGHT)
}

/// Height on the branch from rest under a share of the largest force: bisection between the limit and rest.
fn height_under(force: f64, own: f64) -> f64 {
    let free = ACROSS.hypot(HEIGHT);
    let limit = (free * ACROSS * ACROSS / (1.0 + own / STIFF)).powf(2.0 / 3.0) - ACROSS * ACROSS;
    let (mut low, mut high) = (limit.sqrt(), HEIGHT);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match force_at(middle, own) < force {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

#[test]
fn a_guide_under_a_spring_across_it_stays_on_the_branch_from_rest() {
    let mut differences = Vec::new();
    for (own, arm) in [(100.0, 0.0), (300.0, 0.0), (1.0, 2.0), (1000.0, 0.3)] {
        let chain = Chain::builder("guide")
            .spring("slide", MotionKind::Prismatic, Vector3::z(), own, HEIGHT)
            .home("slide", HEIGHT)
            .translation(vector![arm, 0.0, 0.0])
            .build()
            .unwrap();
        let post = Anchor::Base(vector![arm + ACROSS, 0.0, 0.0]);
        let free = ACROSS.hypot(HEIGHT);
        let spring = Load::spring_between(post, Anchor::node(chain.tip()), STIFF, free);
        let home = Pose::translation(arm, 0.0, HEIGHT);
        let machine = Mechanism::serial(chain.clone(), home, Vector3::zeros()).unwrap();
        let machine = machine.with_load("guide", spring.clone()).unwrap();
        let posture = machine.posture(&home).unwrap();
        let limit =
            (free * ACROSS * ACROSS / (1.0 + own / STIFF)).powf(2.0 / 3.0) - ACROSS * ACROSS;
        let largest_force = force_at(limit.sqrt(), own);
        for percent in 1..20 {
            let force = largest_force * f64::from(percent) * 0.05;
            let push = Wrench::new(vector![0.0, 0.0, force], Vector3::zeros());
            let expected = height_under(force, own);
            let loaded = posture.deflected_by(&push).unwrap();
            differences.push((loaded.tool.translation.z - expected) / HEIGHT);
            assert!(loaded.stable(), "{own} N/m, {percent}/20 of the limit");
            let end = EndCondition::wrench(push);
            let mut problem = ChainProblem::new(&chain, end);
            problem.loads = vec![spring.clone()];
            let alone = solve_chain(&problem, &Settings::default()).unwrap();
            differences.push((alone.coordinates[0] - expected) / HEIGHT);
        }
    }
    assert_eq!(differences.len(), 4 * 19 * 2);
    let most = largest_size(differences);
    assert!(most < 1e-7, "{most:e} of the height");
}

/// Nothing but the spring holds the guide: beyond the limit it rests on the other side, however hard it is pushed.
#[test]
fn a_guide_on_a_passive_slide_rests_beyond_the_limit() {
    let chain = Chain::builder("guide")
        .passive("slide", MotionKind::Prismatic, Vector3::z(), HEIGHT)
        .build()
        .unwrap();
    let post = Anchor::Base(vector![ACROSS, 0.0, 0.0]);
    let spring = Load::spring_between(post, Anchor::node(chain.tip()), STIFF, ACROSS.hypot(HEIGHT));
    let home = Pose::translation(0.0, 0.0, HEIGHT);
    let machine = Mechanism::serial(chain, home, Vector3::zeros()).unwrap();
    let posture = machine
        .with_load("guide", spring)
        .unwrap()
        .posture(&home)
        .unwrap();
    for force in [-70.0, -76.0, -100.0, -150.0, -300.0, -1509.0, -5000.0] {
        let push = Wrench::new(vector![0.0, 0.0, force], Vector3::zeros());
        let loaded = posture.deflected_by(&push).unwrap();
        let z = loaded.tool.translation.z;
        assert_eq!(z > 0.0, force == -70.0, "{force} N: {z} m");
        assert!(loaded.stable());
        let off = (force_at(z, 0.0) - force) / force;
        assert!(
            off.abs() < 1e-8,
            "{force} N is held by {} N",
            force_at(z, 0.0)
        );
    }
}

//! Commanded for the compensated target, the loaded machine is where it should be [R 7.7-7.13].

use crate::common::{Orthoglide, Rng, arm, assert_equilibrium, orthoglide_point};
use crate::oracle::Flat;
use kinetostat::{
    Directions, Mechanism, Pose, PostureRequest, Settings, Wrench, compensate,
    compensation::compensate_from, machine::LimbPosture, spatial::pose_residual,
};
use kinetostat_testing::LargestEntry;
use nalgebra::{Vector3, vector};

const POSITION: Directions = Directions::POSITION;

pub fn heavy_arm() -> Mechanism {
    Mechanism::serial(arm(true), Pose::identity(), vector![0.0, 0.0, -9.81]).unwrap()
}

/// A target the arm reaches, and the joints that reach it.
pub fn reachable(machine: &Mechanism, rng: &mut Rng) -> (Pose, LimbPosture) {
    let limb = &machine.limbs()[0].nominal;
    let (low, high) = (
        [-2.0, -0.8, -0.4, -2.0, 0.4, -2.0],
        [2.0, 0.8, 1.2, 2.0, 1.6, 2.0],
    );
    let commands: Vec<f64> = (0..6).map(|i| rng.between(low[i], high[i])).collect();
    let joints = LimbPosture {
        commands,
        coordinates: limb.home_coordinates(),
    };
    (
        kinetostat::model::unloaded_tip(
            limb,
            &Pose::identity(),
            &joints.coordinates,
            &joints.commands,
        ),
        joints,
    )
}

#[test]
fn an_arm_corrects_all_six_directions_under_weight_and_force() {
    let machine = heavy_arm();
    let mut rng = Rng(21);
    for pose in 0..8 {
        let (desired, joints) = reachable(&machine, &mut rng);
        let posture = machine
            .posture(PostureRequest::joints(&desired, vec![joints]))
            .unwrap();
        assert_eq!(posture.correctable(), Directions::ALL, "pose {pose}");
        let wrench = rng.wrench(2000.0, 300.0);
        let before = posture.deflected_by(&wrench).unwrap();
        assert_equilibrium(&posture, &before);
        let c = compensate_from(
            &posture,
            &desired,
            &wrench,
            Directions::ALL,
            posture.rest_state(),
        )
        .unwrap();
        assert_equilibrium(&c.posture, &c.equilibrium);
        assert!(
            c.left_over.0.norm() < 1e-12,
            "pose {pose}: {:?}",
            c.left_over
        );
        let again = c.posture.deflected_by(&wrench).unwrap();
        assert_equilibrium(&c.posture, &again);
        let residual = pose_residual(&again.tool, &desired);
        assert!(
            residual.linear().norm() < 5e-12 && residual.angular().norm() < 5e-12,
            "pose {pose}: {residual:?}"
        );
        // To first order the correction is minus the deflection.
        let sum = c.correction.0 + before.displacement.0;
        assert!(
            sum.norm() < 0.05 * before.displacement.0.norm(),
            "pose {pose}"
        );
        // And the oracle, commanded for the same joints, arrives there too.
        let mut flat = Flat::at_rest(&c.posture);
        flat.load = wrench.0;
        flat.solve(false);
        let residual = pose_residual(&flat.platforms[machine.tool()], &desired);
        assert!(
            residual.0.norm() < 1e-10,
            "pose {pose}: oracle {residual:?}"
        );
        // The commands are those of the modified target.
        let target = *c.posture.target();
        let tip = kinetostat::model::unloaded_tip(
            &machine.limbs()[0].nominal,
            &Pose::identity(),
            &c.posture.limbs()[0].coordinates,
            &c.posture.limbs()[0].commands,
        );
        assert!(pose_residual(&tip, &target).0.norm() < 1e-11);
        assert!((pose_residual(&target, &desired).0 - c.correction.0).norm() < 1e-14);
    }
}

#[test]
fn an_arm_may_correct_positions_only() {
    let machine = heavy_arm();
    let mut rng = Rng(22);
    for _ in 0..4 {
        let (desired, joints) = reachable(&machine, &mut rng);
        let posture = machine
            .posture(PostureRequest::joints(&desired, vec![joints]))
            .unwrap();
        let wrench = rng.wrench(2000.0, 300.0);
        let c =
            compensate_from(&posture, &desired, &wrench, POSITION, posture.rest_state()).unwrap();
        assert_equilibrium(&c.posture, &c.equilibrium);
        assert!(c.left_over.linear().norm() < 1e-12);
        assert!(c.left_over.angular().norm() > 1e-6);
        assert!(
            c.correction.angular().norm() < 1e-14,
            "the program's orientation is untouched"
        );
        let again = c.posture.deflected_by(&wrench).unwrap();
        assert!((pose_residual(&again.tool, &desired).0 - c.left_over.0).norm() < 1e-11);
    }
}

#[test]
fn single_rotations_can_be_corrected_with_the_others_left() {
    let machine = heavy_arm();
    let mut rng = Rng(23);
    for pose in 0..4 {
        let (desired, joints) = reachable(&machine, &mut rng);
        let posture = machine
            .posture(PostureRequest::joints(&desired, vec![joints]))
            .unwrap();
        let wrench = rng.wrench(4000.0, 900.0);
        for k in 3..6 {
            let directions = POSITION.with(k);
            let c = compensate_from(
                &posture,
                &desired,
                &wrench,
                directions,
                posture.rest_state(),
            )
            .unwrap();
            assert_equilibrium(&c.posture, &c.equilibrium);
            assert!(c.left_over.linear().norm() < 1e-12);
            assert!(
                c.left_over.0[k].abs() < 1e-12,
                "pose {pose}, direction {k}: {:?}",
                c.left_over
            );
        }
    }
}

#[test]
fn neighbouring_answers_are_a_start_and_change_nothing() {
    let machine = Orthoglide {
        line_error: 0.017,
        ..Default::default()
    }
    .build();
    let wrench = Wrench::new(vector![215.0, -10.0, -25.0], vector![1.0, 21.5, 0.0]);
    let mut near = compensate(
        &machine,
        &orthoglide_point(0),
        &wrench,
        POSITION,
        &Settings::default(),
    )
    .unwrap();
    let goal = orthoglide_point(1).translation.vector;
    for k in 1..=20 {
        let p: Vector3<f64> = goal * (f64::from(k) / 20.0);
        let desired = Pose::translation(p.x, p.y, p.z);
        let posture = machine
            .posture(PostureRequest::pose(&desired).near(&near.posture))
            .unwrap();
        let c = compensate_from(
            &posture,
            &desired,
            &wrench,
            POSITION,
            near.equilibrium.state.clone(),
        )
        .unwrap();
        assert_equilibrium(&c.posture, &c.equilibrium);
        let alone =
            compensate(&machine, &desired, &wrench, POSITION, &Settings::default()).unwrap();
        assert!((c.correction.0 - alone.correction.0).norm() < 1e-11, "{k}");
        assert!(c.left_over.linear().norm() < 1e-12);
        near = c;
    }
}

#[test]
fn a_tool_far_from_the_platform_is_corrected_at_its_own_tip() {
    let machine = Orthoglide {
        line_error: 0.017,
        ..Default::default()
    }
    .build()
    .with_tool(&Pose::translation(0.0, 0.0, 0.1));
    let wrench = Wrench::new(vector![215.0, -10.0, -25.0], Vector3::zeros());
    for index in 0..5 {
        let desired = orthoglide_point(index) * Pose::translation(0.0, 0.0, 0.1);
        let c = compensate(&machine, &desired, &wrench, POSITION, &Settings::default()).unwrap();
        assert_equilibrium(&c.posture, &c.equilibrium);
        let again = c.posture.deflected_by(&wrench).unwrap();
        let residual = pose_residual(&again.tool, &desired).linear().norm();
        assert!(residual < 1e-12, "{index}: {residual:e}");
        assert_eq!(c.posture.correctable(), POSITION);
    }
}

#[test]
fn what_can_be_corrected_does_not_depend_on_the_tool_frame() {
    let machine = Orthoglide::default().build();
    let mut rng = Rng(31);
    for index in 0..5 {
        let tool = rng.pose(0.2, 1.5);
        let other = machine.with_tool(&tool);
        let posture = other.posture(&(orthoglide_point(index) * tool)).unwrap();
        let basis = posture.mobility();
        assert_eq!(basis.ncols(), 3);
        assert!(
            basis.rows(3, 3).largest_entry() < 1e-9,
            "it translates only: {basis}"
        );
        assert_eq!(posture.correctable(), POSITION);
    }
}

#[test]
fn the_rates_of_the_commands_are_exact() {
    // With exact tangents the combined iteration is quadratic: few steps, no fallback.
    let wrench = Wrench::new(vector![215.0, -10.0, -25.0], vector![1.0, 21.5, 0.0]);
    let machine = Orthoglide {
        line_error: 0.017,
        ..Default::default()
    }
    .build();
    for index in 0..5 {
        let c = compensate(
            &machine,
            &orthoglide_point(index),
            &wrench,
            POSITION,
            &Settings::default(),
        )
        .unwrap();
        assert!(
            c.equilibrium.residual.iterations <= 6,
            "{}",
            c.equilibrium.residual.iterations
        );
    }
    let machine = heavy_arm();
    let mut rng = Rng(41);
    for _ in 0..4 {
        let (desired, joints) = reachable(&machine, &mut rng);
        let posture = machine
            .posture(PostureRequest::joints(&desired, vec![joints]))
            .unwrap();
        let c = compensate_from(
            &posture,
            &desired,
            &rng.wrench(2000.0, 300.0),
            Directions::ALL,
            posture.rest_state(),
        )
        .unwrap();
        assert!(
            c.equilibrium.residual.iterations <= 6,
            "{}",
            c.equilibrium.residual.iterations
        );
    }
}

#[test]
fn the_lean_answer_is_the_full_one() {
    let machine = Orthoglide {
        line_error: 0.017,
        ..Default::default()
    }
    .build();
    let wrench = Wrench::new(vector![215.0, -10.0, -25.0], vector![1.0, 21.5, 0.0]);
    let posture = machine.posture(&orthoglide_point(3)).unwrap();
    let lean = posture.rest_under(&wrench, posture.rest_state()).unwrap();
    assert_eq!(lean, posture.deflected_by(&wrench).unwrap().state);
}

#[test]
fn the_mobility_of_a_turned_lever_is_that_of_its_tool_point() {
    use kinetostat::{ActuatorSpec, Chain, MotionKind};
    let lever = Chain::builder("lever")
        .actuator(
            "turn",
            ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e6),
        )
        .translation(vector![1.0, 0.0, 0.0])
        .build()
        .unwrap();
    let machine = Mechanism::serial(lever, Pose::identity(), Vector3::zeros())
        .unwrap()
        .with_tool(&Pose::translation(0.3, 0.4, 0.2));
    let target = Pose::rotation(Vector3::z() * 1.1) * Pose::translation(1.3, 0.4, 0.2);
    let posture = machine.posture(&target).unwrap();
    let basis = posture.mobility();
    assert_eq!(basis.ncols(), 1);
    // Natural length 1 m: the motion is [z x p; z].
    let p = target.translation.vector;
    let motion = nalgebra::DVector::from_row_slice(&[-p.y, p.x, 0.0, 0.0, 0.0, 1.0]).normalize();
    assert!(
        (basis.column(0).dot(&motion).abs() - 1.0).abs() < 1e-9,
        "{basis}"
    );
    assert_eq!(posture.correctable().len(), 1);
}

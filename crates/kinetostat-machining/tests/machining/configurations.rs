//! Arms reach within their limits what they reach from joint values within their limits.

use kinetostat::{Pose, PostureRequest, spatial::pose_residual};
use kinetostat_machining::{Configurations, Grid, MapPlace, MapTask, PlaceState, RunError};
use kinetostat_machining::{Unwatched, map, posture_at};
use kinetostat_model::Model;

/// Joint values spread evenly over their limits, the same every time (Kronecker sequence of square roots of primes).
fn spread(limits: &[(f64, f64)], index: u32) -> Vec<f64> {
    let primes = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0];
    let each = limits.iter().zip(primes);
    each.map(|((low, high), prime)| {
        let share = (0.5 + f64::from(index) * prime.sqrt()).fract();
        low + (high - low) * share
    })
    .collect()
}

fn all_within_limits(preset: &str) {
    let arm = Model::preset(preset).expect("a preset").mechanism;
    let drives = arm.limbs()[0].nominal.actuators();
    let limits: Vec<(f64, f64)> = drives.iter().filter_map(|drive| drive.limits).collect();
    assert_eq!(limits.len(), drives.len(), "{preset} states all limits");
    let configurations = Configurations::of(&arm);
    let mut elsewhere = 0;
    for index in 0..150 {
        let joints = spread(&limits, index);
        let given = arm.posture(PostureRequest::commands(&joints));
        let pose = *given.expect("a posture").target();
        let found = configurations.posture(&pose).expect("a posture");
        assert!(
            found.within_limits().is_ok(),
            "{preset} {index}: {joints:?}"
        );
        // Where these joints lead by direct kinematics.
        let commands = found.commands();
        let there = arm.posture(PostureRequest::commands(&commands));
        let off = pose_residual(&pose, there.expect("a posture").target()).0;
        assert!(off.norm() < 1e-9, "{preset} {index}: {off}");
        let home = arm.posture(&pose).and_then(|p| p.within_limits());
        elsewhere += usize::from(home.is_err());
    }
    assert!(
        elsewhere > 10,
        "{preset}: only {elsewhere} need another configuration"
    );
}

#[test]
fn an_arm_of_six_axes_reaches_within_its_limits_what_its_joints_reach() {
    all_within_limits("heavy_6r");
    all_within_limits("kuka_kr270_like");
}

#[test]
fn a_scara_reaches_within_its_limits_what_its_joints_reach() {
    all_within_limits("scara");
}

#[test]
fn what_no_configuration_reaches_is_told_as_before() {
    let arm = Model::preset("heavy_6r").expect("a preset").mechanism;
    let far = Pose::translation(9.0, 0.3, -0.2);
    let error = posture_at(&arm, &far).expect_err("9 m away");
    assert!(
        matches!(error, kinetostat::Error::Unreachable { .. }),
        "{error}"
    );
    // A machine of several limbs has one way to a place, and limits that it leaves are named.
    let machine = Model::preset("orthoglide").expect("a preset").mechanism;
    assert!(!Configurations::of(&machine).are_several());
}

#[test]
fn a_map_of_an_arm_shows_what_it_reaches_in_another_configuration() {
    let model = Model::preset("scara").expect("a preset");
    let arm = &model.mechanism;
    // With the elbow on the other side than at home, beyond what joint 4 allows next to home.
    let drives = arm.limbs()[0].nominal.actuators();
    let limits: Vec<(f64, f64)> = drives.iter().filter_map(|drive| drive.limits).collect();
    let of = |index| {
        let joints = spread(&limits, index);
        let posture = arm.posture(PostureRequest::commands(&joints));
        *posture.expect("a posture").target()
    };
    let outside = |pose: &Pose| arm.posture(pose).is_ok_and(|p| p.within_limits().is_err());
    let pose = (0..150).map(of).find(outside).expect("one of 150");
    let at = (pose.translation.vector * 1e3).into();
    let task = MapTask {
        mechanism: arm,
        grid: Grid {
            from_mm: at,
            to_mm: at,
            counts: [1; 3],
        },
        orientation: pose.rotation,
        orientation_follows: false,
        load: None,
        further: Vec::new(),
        variables: Vec::new(),
        ratings: vec![None; 4],
        first: 0,
    };
    let mut places: Vec<MapPlace> = Vec::new();
    map(&task, &Unwatched, <[MapPlace]>::to_vec, |found| {
        places.extend(found);
        Ok::<(), RunError>(())
    })
    .expect("a map");
    assert_eq!(places[0].state, PlaceState::Regular);
    let stiffness = posture_at(arm, &pose).and_then(|p| p.stiffness());
    let softest = 1e-3 * stiffness.expect("a stiffness").stiffness_against_force();
    let found = places[0].smallest_stiffness_n_per_mm;
    assert!(
        (found - softest).abs() <= 1e-9 * softest,
        "{found} {softest}"
    );
}

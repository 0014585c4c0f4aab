//! Twists, wrenches and differences of poses.

use kinetostat::{
    Pose, Twist, Wrench,
    spatial::{moved, pose_residual, shift_matrix},
};
use nalgebra::vector;

#[test]
fn work_does_not_depend_on_the_reference_point() {
    let twist = Twist::new(vector![0.1, -0.2, 0.3], vector![0.4, 0.5, -0.6]);
    let wrench = Wrench::new(vector![10.0, -3.0, 2.0], vector![1.0, 7.0, -4.0]);
    let arm = vector![0.3, 0.9, -0.2];
    let there = twist.shifted(&arm).dot(&wrench.shifted(&arm));
    assert!((there - twist.dot(&wrench)).abs() < 1e-12);
    assert!((shift_matrix(&arm) * twist.0 - twist.shifted(&arm).0).norm() < 1e-15);
    assert!((shift_matrix(&arm).transpose() * wrench.shifted(&arm).0 - wrench.0).norm() < 1e-12);
}

#[test]
fn residual_undoes_a_motion_for_tiny_and_large_angles() {
    let pose = Pose::new(vector![0.2, -1.0, 3.0], vector![0.3, 2.0, -1.0]);
    for size in [1e-9, 1e-3, 1.0, 3.1] {
        let axis = vector![0.36, -0.48, 0.8] * size;
        let twist = Twist::new(vector![0.1, 0.2, 0.3] * size, axis);
        let back = pose_residual(&moved(&pose, &twist), &pose);
        assert!((back.0 - twist.0).norm() < 1e-12 * size.max(1e-3), "{size}");
    }
}

//! Rotations that go on beyond a whole turn.

use std::f64::consts::TAU;

use kinetostat_analysis::rotation::continued;
use nalgebra::{UnitQuaternion, Vector3};

#[test]
fn turns_go_on_beyond_one_and_come_back() {
    let axis = Vector3::new(0.6, 0.0, -0.8);
    let mut before = Vector3::zeros();
    let there = (0..=60).map(|k| 0.21 * f64::from(k));
    let back = (0..60).rev().map(|k| 0.21 * f64::from(k));
    for angle in there.chain(back) {
        let q = UnitQuaternion::from_scaled_axis(axis * angle);
        before = continued(q.scaled_axis(), &before);
        assert!((before - axis * angle).norm() < 1e-9, "{angle}: {before}");
    }
    // Exactly one turn, but for rounding in any direction.
    let rounding = Vector3::new(1e-9, -2e-9, 1e-9);
    let one = continued(rounding, &(axis * 6.2));
    assert!((one - axis * TAU).norm() < 1e-8, "{one}");
}

//! Sums and multiples of twists and wrenches.

use kinetostat::{CartesianStiffness, Twist, Wrench};
use nalgebra::{Matrix6, vector};

#[test]
fn sums_and_multiples_are_those_of_the_components() {
    let one = Wrench(vector![1.0, -2.0, 3.0, 0.5, 0.0, -7.0]);
    let other = Wrench(vector![0.25, 4.0, -1.0, 2.0, 8.0, 1.0]);
    let mut grown = one;
    grown += other;
    assert_eq!(grown, one + other);
    grown -= other;
    assert_eq!(grown, one);
    assert_eq!(-(one - other), other - one);
    assert_eq!(2.0 * one, one + one);
    assert_eq!(one * 0.5 + one * 0.5, one);
    assert_eq!(
        [one, other, one].into_iter().sum::<Wrench>(),
        one + one + other
    );
}

#[test]
fn a_stiffness_takes_a_motion_to_a_wrench() {
    let matrix = Matrix6::from_fn(|i, j| (1 + i + 2 * j) as f64);
    let twist = Twist(vector![1.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    let wrench = CartesianStiffness { matrix } * twist;
    assert_eq!(wrench.0, matrix.column(0) - matrix.column(5));
}

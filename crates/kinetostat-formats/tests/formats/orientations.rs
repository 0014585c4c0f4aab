//! Conventions of orientation against rotations put together by hand.

use kinetostat_formats::internal::OrientationText::{self, Abc, Axis, Quaternion, Wpr};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// About one axis, written out.
fn about(axis: usize, degrees: f64) -> Matrix3<f64> {
    let (s, c) = degrees.to_radians().sin_cos();
    let mut m = Matrix3::identity();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    (m[(i, i)], m[(j, j)], m[(i, j)], m[(j, i)]) = (c, c, -s, s);
    m
}

fn apart(convention: OrientationText, numbers: &[f64], matrix: &Matrix3<f64>) -> f64 {
    let found = convention.rotation_of(numbers).unwrap();
    (found.to_rotation_matrix().matrix() - matrix).norm()
}

#[test]
fn a_quarter_about_z_and_then_about_the_new_x() {
    let matrix = about(2, 90.0) * about(0, 90.0);
    assert!(apart(Abc, &[90.0, 0.0, 90.0], &matrix) < 1e-15);
    // W, P, R: about the fixed X first, then Y, then Z.
    assert!(apart(Wpr, &[90.0, 0.0, 90.0], &matrix) < 1e-15);
    let half = 0.5_f64.sqrt();
    assert!(apart(Quaternion, &[half, 0.0, 0.0, -half], &about(2, -90.0)) < 1e-15);
    let down = Axis.rotation_of(&[0.0, 0.0, -1.0]).unwrap();
    assert!((down * Vector3::z() + Vector3::z()).norm() < 1e-15);
}

#[test]
fn what_is_no_orientation_is_none() {
    let cases: [(OrientationText, &[f64]); 5] = [
        (Quaternion, &[1.0, 0.1, 0.0, 0.0]),
        (Quaternion, &[1.0, 0.0, 0.0]),
        (Axis, &[0.0, 0.0, 0.0]),
        (Abc, &[f64::NAN, 0.0, 0.0]),
        (Abc, &[0.0, 0.0]),
    ];
    for (convention, numbers) in cases {
        assert_eq!(
            convention.rotation_of(numbers),
            None,
            "{convention:?} {numbers:?}"
        );
    }
}

proptest! {
    #[test]
    fn angles_of_a_turned_pose_stay_next_to_those_written(
        a in -180.0..180.0_f64, b in -89.0..89.0_f64, c in -180.0..180.0_f64,
        turn in prop::array::uniform3(-1e-3..1e-3_f64), far in 0..2_usize,
    ) {
        // The same orientation is written in two ways.
        let [a, b, c] = [[a, b, c], [a + 180.0, 180.0 - b, c - 180.0]][far];
        let matrix = about(2, a) * about(1, b) * about(0, c);
        prop_assert!(apart(Abc, &[a, b, c], &matrix) < 1e-14);
        prop_assert!(apart(Wpr, &[c, b, a], &matrix) < 1e-14);
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(turn)) * Abc.rotation_of(&[a, b, c]).unwrap();
        let numbers = Abc.numbers_of(&turned, &[a, b, c]);
        let mut worst = Worst::new();
        worst.add(Abc.rotation_of(&numbers).unwrap().angle_to(&turned));
        prop_assert!(worst.value() < 1e-12);
        let mirrored: Vec<f64> = Wpr.numbers_of(&turned, &[c, b, a]).into_iter().rev().collect();
        worst.all_apart(&mirrored, &numbers);
        prop_assert!(worst.value() < 1e-9);
        // A thousandth of a radian turns no angle by more than that over the cosine of B.
        for (number, old) in numbers.iter().zip([a, b, c]) {
            prop_assert!((number - old).abs() < 0.1_f64 / b.to_radians().cos().abs(), "{numbers:?} from {:?}", [a, b, c]);
        }
    }

    #[test]
    fn where_two_axes_fall_together_the_first_angle_stays(a in -180.0..180.0_f64, c in -180.0..180.0_f64, up in 0..2_usize) {
        let b = [90.0, -90.0][up];
        let rotation = Abc.rotation_of(&[a, b, c]).unwrap();
        let numbers = Abc.numbers_of(&rotation, &[a, b, c]);
        let mut worst = Worst::new();
        worst.all_apart(&numbers, &[a, b, c]);
        prop_assert!(worst.value() < 1e-4, "{numbers:?}");
        prop_assert!(Abc.rotation_of(&numbers).unwrap().angle_to(&rotation) < 1e-6);
    }
}

//! Shapes that do not determine a rigid motion: what is free is named and left as it was.

use kinetostat_mirror::{
    FreeMotion, MeasuredPoints, NominalPath, RegistrationOptions, ToldBy, register,
};
use kinetostat_testing::Worst;
use nalgebra::{UnitQuaternion, Vector3};

use crate::machine::{read, sampled};

#[test]
fn about_a_line_and_along_it_nothing_is_turned_or_moved() {
    let (_, path) = read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\n");
    let nominal = NominalPath::new(&path).unwrap();
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.02, 0.05));
    let points: Vec<_> = sampled(&path, 101)[10..91]
        .iter()
        .map(|p| turn.inverse() * (p - Vector3::new(0.0, 0.3, -0.2)))
        .collect();
    let measured = MeasuredPoints::at(&points).unwrap();
    let found = register(&nominal, &measured, RegistrationOptions::default()).unwrap();
    let mut worst = Worst::new();
    for point in &points {
        let moved = found.motion.of(point);
        worst.add(moved.y.hypot(moved.z));
    }
    assert!(worst.of(81) < 1e-9);
    let is_turn =
        |free: &FreeMotion| matches!(free, FreeMotion::Turn { along, .. } if along.x > 0.999);
    let is_shift =
        |free: &FreeMotion| matches!(free, FreeMotion::Shift { along } if along.x > 0.999);
    // Any two screws about the line would be the same freedom: it is said as what one can name.
    assert!(
        found.free.len() == 2 && found.free.iter().any(is_turn) && found.free.iter().any(is_shift),
        "{:?}",
        found.free
    );
    // Nothing was turned about the line.
    assert!(found.motion.rotation.scaled_axis().x.abs() < 2e-3);
}

#[test]
fn about_the_axis_of_a_circle_nothing_is_turned() {
    let (_, path) = read("G21 G90\nG0 X20 Y0 Z0\nG3 X20 Y0 I-20 F600\n");
    let nominal = NominalPath::new(&path).unwrap();
    let points: Vec<_> = sampled(&path, 200)
        .iter()
        .map(|p| p + Vector3::new(0.1, -0.2, 0.05))
        .collect();
    let measured = MeasuredPoints::at(&points).unwrap();
    let found = register(&nominal, &measured, RegistrationOptions::default()).unwrap();
    let [FreeMotion::Turn { through_mm, along }] = found.free[..] else {
        panic!("{:?}", found.free)
    };
    assert!(along.z > 0.999_999 && through_mm.xy().norm() < 1e-6);
    assert!(found.motion.rotation.angle() < 1e-9);
    assert!((found.motion.shift_mm + Vector3::new(0.1, -0.2, 0.05)).norm() < 1e-8);
    assert_eq!(
        found.free[0].to_string().split(" along ").last(),
        Some("(0.00, 0.00, 1.00)")
    );
}

/// A square, measured on one side only: what is free is the turn about that side and the shift along it, with `scale` the growth
/// too; every number is one, and nothing is turned about the side.
#[test]
fn points_of_one_side_of_a_square_turn_nothing_about_it() {
    let (_, path) = read("G21 G90\nG0 X0 Y0 Z0\nF600\nG1 X60\nG1 Y60\nG1 X0\nG1 Y0\n");
    let nominal = NominalPath::new(&path).unwrap();
    let points: Vec<_> = (5..=55)
        .map(|x| Vector3::new(f64::from(x), 0.02, -0.05))
        .collect();
    let measured = MeasuredPoints::at(&points).unwrap();
    for with_scale in [false, true] {
        let options = RegistrationOptions {
            with_scale,
            ..RegistrationOptions::default()
        };
        let found = register(&nominal, &measured, options).unwrap();
        let count =
            |of: &dyn Fn(&FreeMotion) -> bool| found.free.iter().filter(|free| of(free)).count();
        let turns = |free: &FreeMotion| match free {
            FreeMotion::Turn { through_mm, along } => {
                (along - Vector3::x()).norm() < 1e-6 && through_mm.yz().norm() < 1e-6
            }
            _ => false,
        };
        let shifts = |free: &FreeMotion| match free {
            FreeMotion::Shift { along } => (along - Vector3::x()).norm() < 1e-6,
            _ => false,
        };
        let grows = |free: &FreeMotion| matches!(free, FreeMotion::Growth);
        assert_eq!(
            [
                count(&turns),
                count(&shifts),
                count(&grows),
                found.free.len()
            ],
            [1, 1, usize::from(with_scale), 2 + usize::from(with_scale)],
            "{:?}",
            found.free
        );
        assert!(found.motion.rotation.angle() < 1e-9, "{:?}", found.motion);
        assert!((found.motion.scale - 1.0).abs() < 1e-12);
        assert!((found.motion.shift_mm - Vector3::new(0.0, -0.02, 0.05)).norm() < 1e-9);
        for free in &found.free {
            assert!(!free.to_string().contains("NaN"), "{free}");
        }
    }
}

/// From another frame a line of points may come to lie anywhere on either leg: that is no measurement, unless it runs along the whole
/// of a path. What is said of it are numbers all the same.
#[test]
fn what_is_said_of_a_line_in_another_frame_are_numbers() {
    for (text, is_told) in [
        ("G21 G90\nG0 X0 Y0 Z0\nF600\nG1 X60\nG1 Y40\n", false),
        ("G21 G90\nG0 X0 Y0 Z0\nF600\nG1 X49\n", true),
    ] {
        let (_, path) = read(text);
        let nominal = NominalPath::new(&path).unwrap();
        for direction in [
            Vector3::x(),
            -Vector3::x(),
            Vector3::z(),
            Vector3::new(0.6, 0.0, -0.8),
        ] {
            let points: Vec<_> = (0..50)
                .map(|k| Vector3::new(200.0, -90.0, 30.0) + direction * f64::from(k))
                .collect();
            let measured = MeasuredPoints::at(&points).unwrap();
            let options = RegistrationOptions {
                with_scale: true,
                ..RegistrationOptions::default()
            };
            let words = match register(&nominal, &measured, options) {
                Ok(found) => {
                    assert!(is_told && found.told_by == ToldBy::Order, "{found:?}");
                    assert_eq!(found.free.len(), 3, "{found:?}");
                    assert!(
                        found.motion.scale.is_finite() && found.motion.shift_mm.norm().is_finite()
                    );
                    let first = found.motion.of(&points[0]);
                    assert!(first.norm() < 1e-6, "{first}");
                    found.free.iter().map(ToString::to_string).collect()
                }
                Err(why) => {
                    assert!(!is_told, "{why}");
                    let why = why.to_string();
                    let says = "the measured points fit the path in several places (moved by ";
                    assert!(why.starts_with(says), "{why}");
                    why
                }
            };
            assert!(!words.contains("NaN") && !words.contains("inf"), "{words}");
        }
    }
}

#[test]
fn three_places_or_fewer_are_no_measurement_to_register() {
    let (_, path) = read("G21 G90\nG0 X0 Y0 Z0\nF600\nG1 X60\nG1 Y40\n");
    let nominal = NominalPath::new(&path).unwrap();
    // Three points each of which is off by half a millimetre were moved onto the path: nothing was left to correct.
    let places = [
        Vector3::new(10.0, 0.1, 0.0),
        Vector3::new(50.0, 0.1, 0.0),
        Vector3::new(59.5, 30.0, 0.4),
    ];
    for (count, says) in [
        (1, "at one place only"),
        (2, "at two places only"),
        (3, "at three places only"),
    ] {
        let points: Vec<_> = (0..600).map(|k| places[k % count]).collect();
        let measured = MeasuredPoints::at(&points).unwrap();
        for with_scale in [false, true] {
            let options = RegistrationOptions {
                with_scale,
                ..RegistrationOptions::default()
            };
            let why = register(&nominal, &measured, options)
                .unwrap_err()
                .to_string();
            assert!(
                why.contains(says) && why.contains("600 measured points"),
                "{why}"
            );
        }
    }
}

/// Points of the whole path in inches or metres lay well on a piece of one line: the part was "right" then.
#[test]
fn points_in_another_unit_are_refused() {
    let (_, path) = read("G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\nY60\nX0\nY0\n");
    let nominal = NominalPath::new(&path).unwrap();
    for by in [1.0 / 25.4, 1e-3, 1e3, 25.4] {
        let points: Vec<_> = sampled(&path, 300).iter().map(|p| p * by).collect();
        let measured = MeasuredPoints::at(&points).unwrap();
        let error = register(&nominal, &measured, RegistrationOptions::default()).unwrap_err();
        assert!(
            error.to_string().contains("Check the unit"),
            "{by}: {error}"
        );
    }
}

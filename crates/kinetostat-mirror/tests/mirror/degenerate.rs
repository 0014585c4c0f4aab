//! Shapes that do not determine a rigid motion: what is free is named and left as it was.

use kinetostat_mirror::{FreeMotion, MeasuredPoints, NominalPath, RegistrationOptions, register};
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
    let turns = found.free.iter().filter(|free| match free {
        FreeMotion::Turn { along, .. } => along.x > 0.999,
        FreeMotion::Shift { .. } => false,
    });
    let shifts = found.free.iter().filter(|free| match free {
        FreeMotion::Shift { along } => along.x > 0.999,
        FreeMotion::Turn { .. } => false,
    });
    // The two may come as two screws about the line: then both are turns along it.
    assert_eq!(found.free.len(), 2, "{:?}", found.free);
    assert!(turns.count() + shifts.count() == 2, "{:?}", found.free);
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

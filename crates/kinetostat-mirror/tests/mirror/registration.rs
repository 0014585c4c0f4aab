//! The rigid motion, against motions that are known.

use std::cell::RefCell;

use kinetostat_mirror::{
    MeasureSettings, MeasuredPoints, NominalPath, RegistrationOptions, measure, register,
};
use kinetostat_testing::{Worst, figure};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use crate::machine::{Noise, SHAPE, read, sampled};

/// Any turn, shifts of a metre, points in any order: without noise to 1e-9 of the size.
#[test]
fn figure_a_rigid_motion_is_found() {
    let config = ProptestConfig {
        cases: 24,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let motions = (
        prop::array::uniform3(-1.0_f64..1.0),
        0.0..3.1_f64,
        prop::array::uniform3(-1000.0..1000.0_f64),
        any::<bool>(),
        any::<u64>(),
    );
    let off = RefCell::new(Worst::new());
    let done = TestRunner::new(config).run(&motions, |(axis, angle, shift, shuffled, seed)| {
        prop_assume!(Vector3::from(axis).norm() > 0.1);
        let (_, path) = read(SHAPE);
        let turn = UnitQuaternion::from_scaled_axis(Vector3::from(axis).normalize() * angle);
        let shift = Vector3::from(shift);
        let on_path = sampled(&path, 300);
        let mut points: Vec<_> = on_path
            .iter()
            .map(|p| turn.inverse() * (p - shift))
            .collect();
        if shuffled {
            let mut noise = Noise(seed);
            points.sort_by_cached_key(|_| (noise.uniform() * 1e15) as u64);
        }
        let nominal = NominalPath::new(&path).unwrap();
        let measured = MeasuredPoints::at(&points).unwrap();
        let found = register(&nominal, &measured, RegistrationOptions::default()).unwrap();
        let mut worst = Worst::new();
        for place in &on_path {
            let there = turn.inverse() * (place - shift);
            worst.add((found.motion.of(&there) - place).norm());
        }
        // The path is about 100 mm across.
        let relative = worst.of(300) / 100.0;
        prop_assert!(relative < 1e-9, "{relative} after {} steps", found.steps);
        prop_assert!(found.free.is_empty() && found.rejected_rows.is_empty());
        off.borrow_mut().add(relative);
        Ok(())
    });
    done.unwrap();
    let name =
        "mirror: registration without noise, off the place by the size of the path, 24 motions";
    assert!(figure::at_most(name, off.into_inner().value(), 1e-9, "1"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

    /// Deviations do not depend on the frame in which the points were measured.
    #[test]
    fn deviations_are_the_same_in_every_frame(
        turn in prop::array::uniform3(-1.5..1.5_f64),
        shift in prop::array::uniform3(-300.0..300.0_f64),
        size in 0.01..0.2_f64,
    ) {
        let (_, path) = read(SHAPE);
        let nominal = NominalPath::new(&path).unwrap();
        let turn = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
        let off = |p: &Vector3<f64>| p + size * Vector3::new((p.y / 15.0).sin(), (p.x / 20.0).cos(), 1.0);
        let here: Vec<_> = sampled(&path, 300).iter().map(off).collect();
        let away: Vec<_> = here.iter().map(|p| turn * p + Vector3::from(shift)).collect();
        let found = [here, away].map(|points| {
            let measured = MeasuredPoints::at(&points).unwrap();
            measure(&nominal, &measured, &MeasureSettings::default()).unwrap()
        });
        let [here, away] = &found;
        prop_assert_eq!(here.points.len(), away.points.len());
        let mut worst = Worst::new();
        for (a, b) in here.at_stations.iter().zip(&away.at_stations) {
            worst.add((a.deviation_mm - b.deviation_mm).norm());
        }
        prop_assert!(worst.value() < 1e-7, "{}", worst.value());
    }
}

#[test]
fn a_part_that_has_grown_is_only_taken_for_one_when_asked() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let points: Vec<_> = sampled(&path, 300).iter().map(|p| p / 1.001).collect();
    let measured = MeasuredPoints::at(&points).unwrap();
    let rigid = register(&nominal, &measured, RegistrationOptions::default()).unwrap();
    assert_eq!(rigid.motion.scale, 1.0);
    let grown = register(
        &nominal,
        &measured,
        RegistrationOptions {
            with_scale: true,
            ..RegistrationOptions::default()
        },
    )
    .unwrap();
    assert!((grown.motion.scale - 1.001).abs() < 1e-9);
    assert!(grown.deviation_mm < 1e-8 && rigid.deviation_mm > 1e-3);
}

#[test]
fn points_far_off_do_not_pull() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let mut noise = Noise(7);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.01, -0.02, 0.03));
    let mut points: Vec<_> = sampled(&path, 500)
        .iter()
        .map(|p| turn.inverse() * (p + noise.vector(1e-3)))
        .collect();
    let planted: Vec<usize> = (0..20).map(|k| 25 * k + 3).collect();
    for index in &planted {
        points[*index] += Vector3::new(0.3, 0.4, -0.5);
    }
    let measured = MeasuredPoints::at(&points).unwrap();
    let found = register(&nominal, &measured, RegistrationOptions::default()).unwrap();
    assert!(found.motion.rotation.angle_to(&turn) < 1e-5);
    // Across the path by less than 6 um they would be none; a shift along it is not seen.
    let rows: Vec<usize> = planted.iter().map(|index| index + 1).collect();
    assert_eq!(found.rejected_rows, rows);
}

/// A rectangle lies on itself when it is turned by half a turn, a square when it is turned by a quarter, and points on a line may
/// slide: only the order of the points tells where the bump of 0.1 mm at X75 is.
#[test]
fn what_is_the_same_turned_around_is_told_by_the_order() {
    for cuts in ["X100\nY60\nX0\nY0", "X100\nY100\nX0\nY0", "X100"] {
        bump_is_found(cuts);
    }
}

/// The frames are turned by 0.1 to 3.1 rad and some 300 mm away.
fn bump_is_found(cuts: &str) {
    let (_, path) = read(&format!("G21 G90\nG0 X0 Y0 Z0\nF600\nG1 {cuts}\nM30\n"));
    let nominal = NominalPath::new(&path).expect("a path with length");
    for noise_mm in [0.0, 1e-3] {
        for angle in [0.1, 1.5, 2.5, 3.1] {
            let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, angle));
            let mut noise = Noise(7);
            let cut = |i: i32| {
                let place = nominal.point_at(nominal.length_mm() * f64::from(i) / 600.0);
                let bump = match place.y.abs() < 1e-9 {
                    true => 0.1 * (-((place.x - 75.0) / 12.0).powi(2)).exp(),
                    false => 0.0,
                };
                place + Vector3::new(0.0, bump, 0.0)
            };
            let cut: Vec<_> = (0..=600)
                .map(|i| cut(i) + Vector3::repeat(noise_mm * (noise.uniform() - 0.5)))
                .collect();
            let away = Vector3::new(300.0, 200.0, 100.0);
            let points: Vec<_> = cut.iter().map(|place| turn * place + away).collect();
            let measured = MeasuredPoints::at(&points).expect("points");
            let found =
                register(&nominal, &measured, RegistrationOptions::default()).expect("a motion");
            let mut worst = Worst::new();
            for (point, place) in points.iter().zip(&cut) {
                worst.add((found.motion.of(point) - place).norm());
            }
            // Half a turn would be 100 mm; the motion may take away the bump's own share.
            assert!(
                worst.of(601) < 0.2,
                "{cuts:?}, {angle} rad, {noise_mm} mm: {} mm",
                worst.value()
            );
        }
    }
}

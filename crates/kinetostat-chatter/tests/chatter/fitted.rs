//! Modes of measured curves, pairs with a model, and parameters scaled to them.

use std::f64::consts::TAU;

use kinetostat_chatter::{
    MeasuredResponse, Mode, Motion, Parameter, ShapedMode, ToolResponse, fit_modes,
    modal_assurance, pair_modes, scale_parameters,
};
use kinetostat_testing::Worst;
use nalgebra::{Complex, Vector3};

use crate::arm::arm;

fn frequencies(from: f64, to: f64, step: f64) -> Vec<f64> {
    let count = ((to - from) / step).round() as usize;
    (0..=count).map(|i| from + step * i as f64).collect()
}

/// The arm's first five modes from three curves of it, the sixth (126 Hz) outside of the band.
#[test]
fn modes_of_exact_curves() {
    let (arm, hz) = (arm(), frequencies(4.0, 75.0, 0.2));
    let curves: Vec<MeasuredResponse> = (0..3)
        .map(|i| MeasuredResponse::of_model(&arm, i, 1, &hz).unwrap())
        .collect();
    let fit = fit_modes(&curves, 5, [4.0, 75.0]).unwrap();
    let mut modes = arm.modes().to_vec();
    modes.sort_by(|a, b| a.frequency_hz().total_cmp(&b.frequency_hz()));
    let (mut frequency, mut damping, mut constants) = (Worst::new(), Worst::new(), Worst::new());
    for (found, mode) in fit.modes.iter().zip(&modes) {
        frequency.add(found.frequency_hz / mode.frequency_hz() - 1.0);
        damping.add(found.damping_ratio - mode.damping_ratio());
        let shape = mode.shape();
        let size = shape.norm() * shape.y.abs();
        for i in 0..3 {
            constants.add((found.constants[i] - shape[i] * shape.y) / size);
        }
        // Where y moves enough, the driving point gives the shape itself.
        if shape.y.abs() > 0.2 * shape.norm() {
            let own = found.shape(1).unwrap();
            assert!(modal_assurance(&own, shape.as_slice()).unwrap() > 0.9999);
        }
    }
    assert!(frequency.of(5) < 1e-5, "{frequency}");
    assert!(damping.of(5) < 1e-5, "{damping}");
    assert!(constants.of(15) < 1e-2, "{constants}");
}

#[test]
fn modes_of_noisy_accelerances() {
    let (arm, hz) = (arm(), frequencies(5.0, 70.0, 0.125));
    let mut seed = 1_u64;
    let mut noise = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let curves: Vec<MeasuredResponse> = (0..3)
        .map(|i| {
            let mut curve = MeasuredResponse::of_model(&arm, i, 1, &hz).unwrap();
            curve.motion = Motion::Acceleration;
            for (value, f) in curve.values.iter_mut().zip(&hz) {
                *value *= -(TAU * f).powi(2);
                // Up to 1 % of the value, in both parts.
                *value *= 1.0 + Complex::new(noise(), noise()) * 0.02;
            }
            curve
        })
        .collect();
    let fit = fit_modes(&curves, 5, [5.0, 70.0]).unwrap();
    let mut modes: Vec<&Mode> = arm.modes().iter().collect();
    modes.sort_by(|a, b| a.frequency_hz().total_cmp(&b.frequency_hz()));
    let mut worst = Worst::new();
    for (found, mode) in fit.modes.iter().zip(modes).take(5) {
        worst.add_at(found.frequency_hz / mode.frequency_hz() - 1.0, || {
            format!("{found:?}")
        });
        worst.add_at(found.damping_ratio - mode.damping_ratio(), || {
            format!("{found:?}")
        });
    }
    assert!(worst.of(10) < 1e-2, "{worst}");
}

#[test]
fn fits_that_cannot_be_made_are_refused() {
    let tool =
        ToolResponse::new(vec![Mode::along(Vector3::x(), 1.0, 40.0, 0.02).unwrap()]).unwrap();
    let curve = MeasuredResponse::of_model(&tool, 0, 0, &frequencies(10.0, 30.0, 0.5)).unwrap();
    let ask = |modes, band| {
        fit_modes(std::slice::from_ref(&curve), modes, band)
            .unwrap_err()
            .quantity
    };
    assert_eq!(ask(0, [10.0, 30.0]), "number of modes");
    assert_eq!(ask(1, [30.0, 10.0]), "band");
    assert_eq!(ask(1, [10.0, 11.0]), "band");
    assert_eq!(ask(1, [10.0, 30.0]), "modes in the band");
    assert_eq!(
        fit_modes(&[], 1, [1.0, 2.0]).unwrap_err().quantity,
        "responses"
    );
}

#[test]
fn pairs_by_shape_not_by_order() {
    let mode = |hz: f64, shape: [f64; 3]| ShapedMode {
        frequency_hz: hz,
        damping_ratio: 0.02,
        shape: shape.into(),
    };
    let measured = [
        mode(10.0, [1.0, 0.1, 0.0]),
        mode(11.0, [0.0, 1.0, 0.1]),
        mode(25.0, [0.9, 0.0, 0.0]),
    ];
    let model = [
        mode(10.4, [0.0, -2.0, 0.0]),
        mode(10.6, [3.0, 0.0, 0.0]),
        mode(27.0, [1.0, 0.0, 0.1]),
    ];
    let pairs = pair_modes(&measured, &model).unwrap();
    let numbers: Vec<(usize, usize)> = pairs.iter().map(|p| (p.measured, p.model)).collect();
    assert_eq!(numbers, [(0, 1), (1, 0), (2, 2)]);
    assert!((pairs[0].frequency_apart - 0.06).abs() < 1e-12);
    assert!((pairs[0].assurance - 1.0 / 1.01).abs() < 1e-12);
    assert!(pair_modes(&measured, &[mode(1.0, [0.0; 3])]).is_err());
    assert!(modal_assurance(&[1.0], &[1.0, 2.0]).is_err());
}

/// Two drives in series and a mass: the first frequency tells their sum of compliances only.
#[test]
fn what_the_measurement_does_not_tell() {
    let drive = |name: &str, start: f64| Parameter {
        name: name.into(),
        start,
        least: 1e4,
        most: 1e8,
    };
    let first = |k: &[f64]| (1.0 / (50.0 * (1.0 / k[0] + 1.0 / k[1]))).sqrt() / TAU;
    let parameters = [drive("k1", 1e6), drive("k2", 2e6)];
    let found = scale_parameters(&parameters, &[(20.0, 0.1)], |k| Ok(vec![first(k)])).unwrap();
    assert!((first(&found.values) / 20.0 - 1.0).abs() < 1e-9);
    assert_eq!(found.untold.len(), 1);
    assert_eq!(found.deviations, [None, None]);
    assert!(found.singular_values[1] < 1e-6 * found.singular_values[0]);
    // The combination that changes nothing: d ln k1/k1 = -d ln k2/k2.
    let untold = &found.untold[0];
    assert!(
        (untold[0] / found.values[0] + untold[1] / found.values[1]).abs()
            < 1e-6 * untold[1].abs() / found.values[1]
    );

    // A second number that holds them apart tells both.
    let two = |k: &[f64]| Ok(vec![first(k), k[0] / k[1]]);
    let found = scale_parameters(&parameters, &[(20.0, 0.1), (0.7, 0.01)], two).unwrap();
    assert!(found.untold.is_empty());
    assert!((found.values[0] / found.values[1] / 0.7 - 1.0).abs() < 1e-8);
    assert!(found.deviations.iter().all(Option::is_some));

    // A bound in the way is said.
    let tight = [Parameter {
        most: 1.2e6,
        ..drive("k1", 1e6)
    }];
    let found = scale_parameters(&tight, &[(40.0, 0.1)], |k| {
        Ok(vec![(k[0] / 50.0).sqrt() / TAU])
    })
    .unwrap();
    assert_eq!((found.at_bound[0], found.deviations[0]), (true, None));
    assert!((found.values[0] / 1.2e6 - 1.0).abs() < 1e-12);
    let wrong = [Parameter {
        start: 5.0,
        ..drive("k1", 1e6)
    }];
    assert_eq!(
        scale_parameters(&wrong, &[(1.0, 1.0)], |_| Ok(vec![1.0]))
            .unwrap_err()
            .quantity,
        "start of k1"
    );
}

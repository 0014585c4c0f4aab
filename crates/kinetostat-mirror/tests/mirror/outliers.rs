//! Outliers among points with a scatter and a deviation that bends.

use std::collections::BTreeSet;

use kinetostat_mirror::{MeasureSettings, MeasuredPoints, NominalPath, measure};
use nalgebra::Vector3;

use crate::machine::{Noise, SHAPE, read, sampled};

/// Deviations of a tenth of a millimetre that bend along the path.
fn off(p: &Vector3<f64>) -> Vector3<f64> {
    let (x, y) = (p.x / 40.0, p.y / 30.0);
    Vector3::new(0.1 * y.sin(), 0.08 * x.cos(), 0.05 * (x + y).sin())
}

#[test]
fn twenty_of_a_thousand_are_found_and_no_other() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    for (seed, deviation) in [
        (1, 1e-3),
        (2, 3e-4),
        (3, 2e-3),
        (4, 0.0),
        (5, 1e-5),
        (6, 1e-3),
        (7, 1e-4),
    ] {
        let mut noise = Noise(seed);
        let mut points: Vec<_> = sampled(&path, 1000)
            .iter()
            .map(|p| p + off(p) + noise.vector(deviation))
            .collect();
        let mut planted = BTreeSet::new();
        while planted.len() < 20 {
            planted.insert((noise.uniform() * 1000.0) as usize);
        }
        for index in &planted {
            let out = Vector3::new(noise.normal(), noise.normal(), 1.0).normalize();
            points[*index] += out * (0.1 + 0.3 * noise.uniform());
        }
        let settings = MeasureSettings {
            register: false,
            ..MeasureSettings::default()
        };
        let measured = measure(&nominal, &MeasuredPoints::at(&points).unwrap(), &settings).unwrap();
        let rows: BTreeSet<usize> = measured.outliers.iter().map(|o| o.row - 1).collect();
        assert!(measured.left_out.is_empty(), "{:?}", measured.left_out);
        let [missed, wrong] = [planted.difference(&rows), rows.difference(&planted)]
            .map(|set| set.copied().collect::<Vec<_>>());
        assert!(
            missed.is_empty() && wrong.is_empty(),
            "scatter {deviation}: missed {missed:?}, wrong {wrong:?}"
        );
    }
}

#[test]
fn a_point_beyond_the_window_is_named_with_its_distance() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let mut points = sampled(&path, 100);
    points[41].z -= 7.0;
    let settings = MeasureSettings::default();
    let measured = measure(&nominal, &MeasuredPoints::at(&points).unwrap(), &settings).unwrap();
    let [left_out] = measured.left_out[..] else {
        panic!("{:?}", measured.left_out)
    };
    assert_eq!(left_out.row, 42);
    assert!((left_out.distance_mm.unwrap() - 7.0).abs() < 0.05);
    assert_eq!(measured.registration.unwrap().rejected_rows, [42]);
}

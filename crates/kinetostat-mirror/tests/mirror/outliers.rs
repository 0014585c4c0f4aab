//! Outliers among points with a scatter and a deviation that bends.

use std::collections::BTreeSet;

use kinetostat_mirror::{
    MeasureSettings, MeasuredFile, MeasuredPoints, MirrorField, MirrorState, NominalPath, Outcome,
    measure,
};
use kinetostat_testing::{Worst, figure};
use nalgebra::{UnitQuaternion, Vector3};

use crate::machine::{Noise, SHAPE, commanded_within, read, sampled};
use crate::partial::POCKET;

/// Deviations of a tenth of a millimetre that bend along the path.
fn off(p: &Vector3<f64>) -> Vector3<f64> {
    let (x, y) = (p.x / 40.0, p.y / 30.0);
    Vector3::new(0.1 * y.sin(), 0.08 * x.cos(), 0.05 * (x + y).sin())
}

#[test]
fn figure_twenty_of_a_thousand_are_found_and_no_other() {
    let mut worst = Worst::new();
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
            register: kinetostat_mirror::Register::None,
            ..MeasureSettings::default()
        };
        let measured = measure(&nominal, &MeasuredPoints::at(&points).unwrap(), &settings).unwrap();
        let rows: BTreeSet<usize> = measured.outliers.iter().map(|o| o.row - 1).collect();
        assert!(measured.left_out.is_empty(), "{:?}", measured.left_out);
        let [missed, wrong] = [planted.difference(&rows), rows.difference(&planted)]
            .map(|set| set.copied().collect::<Vec<_>>());
        if !missed.is_empty() || !wrong.is_empty() {
            eprintln!("scatter {deviation}: missed {missed:?}, wrong {wrong:?}");
        }
        worst.add((missed.len() + wrong.len()) as f64);
    }
    let name = "mirror: of 20 outliers planted among 1000 points, missed or named wrongly, worst of seven scatters";
    assert!(figure::at_most(name, worst.of(7), 0.0, "points"));
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

/// Within which programs are written.
const TOLERANCE_MM: f64 = 5e-4;

/// Points without a scatter, off by 0.05 mm, of a program that follows its correction within a tolerance: its kinks are no outliers.
#[test]
fn without_a_scatter_none_is_found() {
    let (program, path) = read(POCKET);
    let nominal = NominalPath::new(&path).unwrap();
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        ..MeasureSettings::default()
    };
    let mut state = MirrorState::new(&nominal, "pocket", settings).unwrap();
    for trial in 0..3 {
        let field = MirrorField::new(&nominal, &state).unwrap();
        let sent = match trial {
            0 => sampled(&path, 1000),
            _ => sampled(
                &commanded_within(&program, &path, &field, (TOLERANCE_MM, 4)),
                1000,
            ),
        };
        // It answers with 1.3 times a correction.
        let went = |p: &Vector3<f64>| {
            let foot = nominal.nearest(p).unwrap();
            let sent = p - foot.place_mm;
            let sent = sent - foot.tangent * foot.tangent.dot(&sent);
            foot.place_mm + 0.5 * off(&foot.place_mm) + 1.3 * sent
        };
        let points: Vec<_> = sent.iter().map(went).collect();
        let points = MeasuredPoints::at(&points).unwrap().known_to(TOLERANCE_MM);
        let found = measure(&nominal, &points, &settings).unwrap();
        assert!(
            found.outliers.is_empty(),
            "trial {trial}: {:?}",
            found.outliers
        );
        let file = MeasuredFile {
            name: format!("trial {trial}"),
            sha256: format!("hash {trial}"),
        };
        state.take(&nominal, &[(file, found)], 1.0, None).unwrap();
    }
}

/// Points on the path, in its frame or in another: the rounding of the registration is no outlier, and there is nothing to correct.
#[test]
fn on_the_path_there_is_nothing_to_correct_and_no_outlier() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.9, 1.7));
    let settings = MeasureSettings::default();
    for away in [0.0, 1.0] {
        let turn = UnitQuaternion::identity().slerp(&turn, away);
        let points: Vec<_> = sampled(&path, 1000)
            .iter()
            .map(|p| turn * p + away * Vector3::new(500.0, 80.0, -20.0))
            .collect();
        let found = measure(&nominal, &MeasuredPoints::at(&points).unwrap(), &settings).unwrap();
        assert!(found.outliers.is_empty(), "{:?}", found.outliers);
        let mut state = MirrorState::new(&nominal, "shape", settings).unwrap();
        let file = MeasuredFile {
            name: "trial1.csv".to_owned(),
            sha256: "hash".to_owned(),
        };
        let outcome = state.take(&nominal, &[(file, found)], 1.0, None).unwrap();
        assert_eq!(outcome, Outcome::NothingToCorrect);
        assert!(state.correction_mm.iter().all(|c| *c == Vector3::zeros()));
    }
}

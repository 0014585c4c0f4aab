//! Measurements that a trial does not take: known ones, and those that are not of the path.

use kinetostat_mirror::{
    Alignment, MeasureSettings, MeasuredFile, MeasuredPoints, Measurement, MirrorState,
    NominalPath, measure,
};
use nalgebra::Vector3;

use crate::machine::{SHAPE, read, sampled};

fn rows(points: &[Vector3<f64>]) -> String {
    let rows = points.iter().map(|p| format!("{},{},{}\n", p.x, p.y, p.z));
    format!("x_mm,y_mm,z_mm\n{}", rows.collect::<String>())
}

/// A measurement in the order of the path under a name, from the text of a file.
fn measured(
    nominal: &NominalPath<'_>,
    (name, text): (&str, &str),
    settings: &MeasureSettings,
) -> (MeasuredFile, Measurement) {
    let points = MeasuredPoints::read(name, text).expect("points");
    let file = MeasuredFile {
        name: name.into(),
        sha256: points.sha256(),
    };
    (
        file,
        measure(nominal, &points, settings).expect("a measurement"),
    )
}

#[test]
fn the_same_points_are_no_second_measurement_whatever_the_file_looks_like() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        ..MeasureSettings::default()
    };
    let points: Vec<_> = sampled(&path, 200)
        .iter()
        .map(|p| p + Vector3::new(0.0, 0.0, 0.05))
        .collect();
    let text = rows(&points);
    let backwards: Vec<_> = points.iter().rev().copied().collect();
    let mut state = MirrorState::new(&nominal, "abc", settings).unwrap();
    let of = |name: &str, text: &str| measured(&nominal, (name, text), &settings);
    let first = of("one.csv", &text);
    state.take(&nominal, &[first], 1.0, None).unwrap();
    for (name, text) in [
        ("newline.csv", format!("{text}\n")),
        ("remark.csv", format!("# trial 2\n{text}")),
        ("spaces.csv", text.replace(',', " ; ")),
        ("order.csv", rows(&backwards)),
    ] {
        let before = state.clone();
        let again = of(name, &text);
        let why = state.take(&nominal, &[again], 1.0, None).unwrap_err();
        assert_eq!(
            why.to_string(),
            format!(
                "{name} is the measurement one.csv of an earlier trial, point for point: measure the program with its new correction"
            )
        );
        assert_eq!(state, before);
    }
    // Given twice it would say that trials repeat without any scatter.
    let lower: Vec<_> = points.iter().map(|p| p - Vector3::z() * 0.04).collect();
    let twice = ["a.csv", "b.csv"].map(|name| of(name, &rows(&lower)));
    let why = state.take(&nominal, &twice, 1.0, None).unwrap_err();
    assert!(
        why.to_string()
            .starts_with("a.csv and b.csv are one measurement"),
        "{why}"
    );
    let [once, _] = twice;
    state.take(&nominal, &[once], 1.0, None).unwrap();
}

#[test]
fn a_measurement_most_of_which_has_no_place_is_not_mirrored() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        align: Alignment::ArcLength,
        ..MeasureSettings::default()
    };
    let points = sampled(&path, 600);
    // 599 and 211 have no common divisor: every point once, each far from the one before it.
    let shuffled: Vec<_> = (0..599).map(|k| points[k * 211 % 599]).collect();
    let far: Vec<_> = points
        .iter()
        .enumerate()
        .map(|(k, p)| p + Vector3::z() * if k % 3 == 0 { 0.0 } else { 5.0 })
        .collect();
    for (points, says, advice) in [
        (
            shuffled,
            "of its 599 points have no place on the path (",
            "Give them in the order",
        ),
        (
            far,
            "400 of its 600 points have no place on the path (400 beyond the window)",
            "Check units",
        ),
    ] {
        let taken = [measured(&nominal, ("m.csv", &rows(&points)), &settings)];
        let mut state = MirrorState::new(&nominal, "abc", settings).unwrap();
        let why = state
            .take(&nominal, &taken, 1.0, None)
            .unwrap_err()
            .to_string();
        assert!(
            why.starts_with("m.csv: ") && why.contains(says) && why.contains(advice),
            "{why}"
        );
        assert!(state.trials.is_empty());
    }
}

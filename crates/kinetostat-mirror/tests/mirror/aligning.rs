//! Passes that lie close to each other, and what the points leave open.

use kinetostat_mirror::{
    Alignment, MeasureSettings, MeasuredPoint, MeasuredPoints, NominalPath, Unseen, WhyLeftOut,
    measure,
};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::machine::{SHAPE, read, sampled};

/// Lines 0.8 mm apart.
const ZIGZAG: &str =
    "G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 Y0.8\nG1 X0\nG1 Y1.6\nG1 X60\nG1 Y2.4\nG1 X0\n";

/// 0.5 mm to the left of the way that the tool goes: nearer to the line beside it than to its own on every second one.
fn beside() -> (kinetostat_program::Path, Vec<Vector3<f64>>) {
    let (_, path) = read(ZIGZAG);
    let points = sampled(&path, 480)
        .iter()
        .map(|p| p + Vector3::new(0.0, 0.5, 0.0))
        .collect();
    (path, points)
}

#[test]
fn no_point_is_given_to_a_pass_beside_its_own() {
    let (path, points) = beside();
    let nominal = NominalPath::new(&path).unwrap();
    let mut settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        align: Alignment::ArcLength,
        ..MeasureSettings::default()
    };
    let measured = MeasuredPoints::at(&points).unwrap();
    let found = measure(&nominal, &measured, &settings).unwrap();
    let mut worst = Worst::new();
    let inside = |x: f64| (3.0..57.0).contains(&x);
    for point in &found.points {
        if inside(points[point.row - 1].x) {
            worst.add((point.deviation_mm - Vector3::new(0.0, 0.5, 0.0)).norm());
        }
    }
    assert!(worst.samples() > 400 && worst.value() < 1e-9, "{worst}");

    // By the nearest place alone nobody could tell: they are named, not guessed.
    settings.align = Alignment::Nearest;
    let nearest = measure(&nominal, &measured, &settings);
    let left_out = match &nearest {
        Ok(found) => found.left_out.clone(),
        Err(why) => panic!("{why}"),
    };
    let several = left_out
        .iter()
        .filter(|l| l.why == WhyLeftOut::SeveralStretches);
    assert!(several.count() > 330, "{}", left_out.len());
}

#[test]
fn a_line_of_the_program_tells_passes_apart() {
    let (path, points) = beside();
    let nominal = NominalPath::new(&path).unwrap();
    let line = |p: &Vector3<f64>| match p.y {
        y if y < 0.5 + 1e-9 => Some(3),
        y if (y - 1.3).abs() < 1e-9 => Some(5),
        y if (y - 2.1).abs() < 1e-9 => Some(7),
        _ => None,
    };
    let measured = points.iter().enumerate().filter_map(|(i, p)| {
        Some(MeasuredPoint {
            row: i + 1,
            line: i + 1,
            position_mm: *p,
            weight: 1.0,
            program_line: Some(line(p)?),
        })
    });
    let measured = MeasuredPoints::new(measured.collect()).unwrap();
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        ..MeasureSettings::default()
    };
    let found = measure(&nominal, &measured, &settings).unwrap();
    assert!(found.left_out.is_empty());
    let mut worst = Worst::new();
    for point in &found.points {
        worst.add((point.deviation_mm - Vector3::new(0.0, 0.5, 0.0)).norm());
    }
    assert!(worst.samples() > 300 && worst.value() < 1e-12);
}

#[test]
fn what_the_points_do_not_tell_is_said() {
    let text = format!(
        "{}G0 Z20\nG0 X0 Y100\nG0 Z0\nG1 X40\nM2\n",
        &SHAPE[..SHAPE.len() - 3]
    );
    let (_, path) = read(&text);
    let nominal = NominalPath::new(&path).unwrap();
    let first_pass: f64 = nominal.passes()[0].along_mm[1];
    let on = |ways: &mut dyn Iterator<Item = f64>| -> Vec<Vector3<f64>> {
        ways.map(|s| nominal.point_at(s)).collect()
    };
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        ..MeasureSettings::default()
    };
    // Every 12 mm, and none on the 46 mm of the ramp's beginning.
    let points = on(&mut (0..40)
        .map(|k| 12.0 * f64::from(k))
        .filter(|s| *s < first_pass && !(98.0..160.0).contains(s)));
    let found = measure(&nominal, &MeasuredPoints::at(&points).unwrap(), &settings).unwrap();
    let has = |test: &dyn Fn(&Unseen) -> bool| found.unseen.iter().any(test);
    assert!(
        has(
            &|u| matches!(u, Unseen::Pass { lines: [12, 12], length_mm } if (length_mm - 40.0).abs() < 1e-9)
        ),
        "{:?}",
        found.unseen
    );
    assert!(
        has(&|u| matches!(u, Unseen::Stretch { length_mm, .. } if *length_mm > 30.0)),
        "{:?}",
        found.unseen
    );
    // Two points on the arc of 10 mm radius, 12 mm apart: 10 (1 - cos 0.6) mm.
    let sagitta = 10.0 * (1.0 - 0.6_f64.cos());
    assert!(
        has(
            &|u| matches!(u, Unseen::Gap { gap_mm, sagitta_mm, .. } if (gap_mm - 12.0).abs() < 1e-6 && *sagitta_mm <= sagitta + 1e-6)
        ),
        "{:?}",
        found.unseen
    );
}

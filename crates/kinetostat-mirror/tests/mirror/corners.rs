//! Corners, and seams of contours that come back to where they began.

use kinetostat_mirror::{
    Alignment, MeasureSettings, MeasuredFile, MeasuredPoints, MirrorField, MirrorState,
    NominalPath, measure,
};
use kinetostat_program::{CorrectionField, Path, Request};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::machine::read;

/// Correction of a path after one trial that was measured every half millimetre with `off`, by place and length.
fn mirrored(path: &Path, off: impl Fn(f64) -> Vector3<f64>) -> MirrorState {
    let nominal = NominalPath::new(path).expect("a path");
    let count = (nominal.length_mm() / 0.5).round();
    let places = (0..count as usize).map(|k| nominal.length_mm() * ((k as f64 + 0.5) / count));
    let points: Vec<Vector3<f64>> = places.map(|at| nominal.point_at(at) + off(at)).collect();
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        align: Alignment::ArcLength,
        ..MeasureSettings::default()
    };
    let measured = measure(
        &nominal,
        &MeasuredPoints::at(&points).expect("points"),
        &settings,
    )
    .expect("a measurement");
    assert!(measured.outliers.is_empty(), "{:?}", measured.outliers);
    let mut state = MirrorState::new(&nominal, "corners", settings).expect("a state");
    let file = MeasuredFile {
        name: "trial1.csv".into(),
        sha256: "its hash".into(),
    };
    state
        .take(&nominal, &[(file, measured)], 1.0, None)
        .expect("a trial");
    state
}

fn correction(path: &Path, field: &MirrorField<'_>, piece: usize, share: f64) -> Vector3<f64> {
    let nominal = NominalPath::new(path).expect("a path");
    let move_index = nominal.pieces()[piece].move_index;
    let motion = &path.moves[move_index];
    let request = Request {
        move_index,
        share,
        position_mm: motion.point(share),
        tangent: motion.tangent(share),
        orientation: None,
        turning: None,
    };
    field.corrections(&[request])[0]
        .clone()
        .expect("a correction")
        .shift_mm
}

/// What each leg sees of the same shift is another part of it; at the corner the whole shift is put right, and nowhere is more
/// left across the path than the kernel's constant takes (two thousandths at an end).
#[test]
fn a_shift_of_the_whole_is_put_right_at_every_corner() {
    let shift = Vector3::new(0.08, -0.05, 0.03);
    for degrees in [30.0_f64, 60.0, 90.0, 120.0, 150.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let (x, y) = (60.0 + 60.0 * cosine, 60.0 * sine);
        let text = format!("G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 X{x:.6} Y{y:.6}\nG0 Z9\nM2\n");
        let (_, path) = read(&text);
        let nominal = NominalPath::new(&path).expect("a path");
        let state = mirrored(&path, |_| shift);
        let field = MirrorField::new(&nominal, &state).expect("a field");
        let at = |piece, share| correction(&path, &field, piece, share);
        assert!((at(0, 1.0) - at(1, 0.0)).norm() < 1e-12);
        let mut worst = Worst::new();
        worst.add((at(0, 1.0) + shift).norm());
        for piece in 0..2 {
            for k in 0..=200 {
                let share = f64::from(k) / 200.0;
                let motion = nominal.motion(&nominal.pieces()[piece]);
                let along = motion.tangent(share).expect("a direction");
                let left = at(piece, share) + shift;
                worst.add((left - along * along.dot(&left)).norm());
            }
        }
        assert!(worst.of(403) < 0.005 * shift.norm(), "{degrees}: {worst}");
    }
}

/// Around a circle the kernel lets a wave through by its closed form, at the seam as anywhere.
#[test]
fn a_closed_contour_has_no_seam() {
    let (_, path) = read("G21 G90\nG0 X30 Y0 Z0\nG3 X30 Y0 I-30 F600\nG0 Z9\nM2\n");
    let nominal = NominalPath::new(&path).expect("a path");
    let waves = |at: f64| {
        [1.0, 3.0].map(|k| Vector3::new(0.0, 0.0, 0.05 * (k * at / 30.0 + 0.4 * k).cos()))
    };
    let state = mirrored(&path, |at| waves(at).iter().sum());
    let field = MirrorField::new(&nominal, &state).expect("a field");
    let at = |share| correction(&path, &field, 0, share);
    assert!((at(0.0) - at(1.0)).norm() < 1e-12);
    // The kernel's constant takes 4.4e-4 of it (0.0111 of a point among the 25 that a mean rests on).
    let mut worst = Worst::new();
    for k in 0..=400 {
        let share = f64::from(k) / 400.0;
        let let_through = waves(share * nominal.length_mm());
        let expected: Vector3<f64> = let_through
            .iter()
            .zip([1.0_f64, 3.0])
            .map(|(wave, k)| wave * (-0.5 * (5.0 * k / 30.0).powi(2)).exp())
            .sum();
        worst.add((at(share) + expected).norm());
    }
    assert!(worst.of(401) < 1e-4, "{worst}");
}

/// A rectangle that begins in the middle of a side, and one that begins at a corner, are one line around.
#[test]
fn contours_with_corners_close() {
    let shift = Vector3::new(0.06, 0.04, -0.02);
    for contour in [
        "G0 X30 Y0\nG0 Z0\nG1 X60 F600\nG1 Y40\nG1 X0\nG1 Y0\nG1 X30\n",
        "G0 X0 Y0\nG0 Z0\nG1 X60 F600\nG1 Y40\nG1 X0\nG1 Y0\n",
    ] {
        let (_, path) = read(&format!("G21 G90\nG0 Z9\n{contour}G0 Z9\nM2\n"));
        let nominal = NominalPath::new(&path).expect("a path");
        let state = mirrored(&path, |_| shift);
        let field = MirrorField::new(&nominal, &state).expect("a field");
        let last = nominal.pieces().len() - 1;
        let ends = [
            correction(&path, &field, 0, 0.0),
            correction(&path, &field, last, 1.0),
        ];
        assert!((ends[0] - ends[1]).norm() < 1e-12, "{ends:?}");
        for piece in 1..=last {
            let corner = correction(&path, &field, piece, 0.0);
            assert!((corner + shift).norm() < 0.005 * shift.norm(), "{corner}");
        }
    }
}

/// A leg on which nothing was measured goes from one neighbour's correction to the other's, without a step.
#[test]
fn a_leg_without_points_is_led_from_one_to_the_other() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 Y3\nG1 X0\nG0 Z9\nM2\n";
    let (_, path) = read(text);
    let nominal = NominalPath::new(&path).expect("a path");
    let mut points = Vec::new();
    for k in 0..=60 {
        let x = f64::from(k);
        points.push(Vector3::new(x, 0.05, 0.0));
    }
    for k in 0..=60 {
        points.push(Vector3::new(60.0 - f64::from(k), 3.02, 0.0));
    }
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        align: Alignment::ArcLength,
        ..MeasureSettings::default()
    };
    let measured = measure(
        &nominal,
        &MeasuredPoints::at(&points).expect("points"),
        &settings,
    )
    .expect("a measurement");
    let mut state = MirrorState::new(&nominal, "leg", settings).expect("a state");
    let file = MeasuredFile {
        name: "trial1.csv".into(),
        sha256: "its hash".into(),
    };
    state
        .take(&nominal, &[(file, measured)], 1.0, None)
        .expect("a trial");
    let field = MirrorField::new(&nominal, &state).expect("a field");
    let at = |piece, share| correction(&path, &field, piece, share);
    assert!((at(0, 1.0).y + 0.05).abs() < 1e-3, "{}", at(0, 1.0));
    assert!((at(2, 0.0).y + 0.02).abs() < 1e-3, "{}", at(2, 0.0));
    assert!((at(1, 0.5).y + 0.035).abs() < 1e-3, "{}", at(1, 0.5));
}

/// Where the force turns with the path, the deviation across the plane of the legs steps at the corner, and so does the
/// correction: the mean of both legs would be off on each of them by half the step.
#[test]
fn a_step_of_the_machine_at_a_corner_is_a_step_of_the_correction() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 Y60\nG1 X-30\nG0 Z9\nM2\n";
    let (_, path) = read(text);
    let nominal = NominalPath::new(&path).expect("a path");
    let legs = [
        Vector3::new(0.0, -0.08, 0.01),
        Vector3::new(0.05, 0.0, -0.012),
        Vector3::new(0.0, 0.06, 0.004),
    ];
    let leg = |at: f64| usize::from(at > 60.0) + usize::from(at > 120.0);
    let state = mirrored(&path, |at| legs[leg(at)]);
    let field = MirrorField::new(&nominal, &state).expect("a field");
    let mut worst = Worst::new();
    for (piece, off) in legs.iter().enumerate() {
        for k in 0..=200 {
            let share = f64::from(k) / 200.0;
            let along = nominal.motion(&nominal.pieces()[piece]).tangent(share);
            let along = along.expect("a direction");
            let left = correction(&path, &field, piece, share) + off;
            worst.add((left - along * along.dot(&left)).norm());
        }
    }
    assert!(worst.of(603) < 5e-4, "{worst}");
}

/// A machine that goes beyond the end of a leg, or not as far, leaves points of one leg beside the other. Each is nearest to a
/// corner, or to the wrong leg; none of them takes from the deviation that the legs have everywhere else.
#[test]
fn points_around_a_corner_are_not_taken_for_the_other_leg() {
    let (_, path) = read("G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 Y60\nG0 Z9\nM2\n");
    let nominal = NominalPath::new(&path).expect("a path");
    let settings = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        align: Alignment::ArcLength,
        ..MeasureSettings::default()
    };
    let stations = MirrorState::new(&nominal, "corner", settings).expect("a state");
    // Aside by so much (outwards where negative), beyond the corner by so much, and a point every so many mm.
    for (off, beyond, every) in [
        (-0.26, 0.26, 0.23),
        (-0.26, 0.02, 0.23),
        (-0.26, -0.3, 0.23),
        (-0.26, 0.26, 0.02),
        (-0.26, 0.1, 0.02),
        (0.26, -0.26, 0.23),
        (0.26, 0.1, 0.23),
    ] {
        let count = (60.0 / every) as i32;
        let before = (0..=count).map(|k| 60.0 + beyond - every * f64::from(count - k));
        let after = (0..=count).map(|k| every * f64::from(k) - beyond);
        let points: Vec<_> = before
            .map(|x| Vector3::new(x, off, 0.0))
            .chain(after.map(|y| Vector3::new(60.0 - off, y, 0.0)))
            .collect();
        let points = MeasuredPoints::at(&points).expect("points");
        let found = measure(&nominal, &points, &settings).expect("a measurement");
        let half = stations.along_mm.len() / 2;
        let mut worst = Worst::new();
        for (k, smoothed) in found.at_stations.iter().enumerate() {
            let expected = match k < half {
                true => Vector3::new(0.0, off, 0.0),
                false => Vector3::new(-off, 0.0, 0.0),
            };
            worst.add_at((smoothed.deviation_mm - expected).norm(), || {
                format!("{off}, {beyond}, every {every} mm, station {k}")
            });
        }
        // The kernel's constant takes four ten-thousandths at an end.
        assert!(
            worst.of(2 * half) < 3e-4,
            "{worst}, {:?}",
            found.beside_corners
        );
    }
}

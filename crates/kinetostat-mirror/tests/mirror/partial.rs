//! Measurements of a part of the path: on the right part of it, or refused.

use kinetostat_mirror::{MeasureSettings, MeasuredPoints, NominalPath, ToldBy, measure};
use kinetostat_testing::Worst;
use nalgebra::{UnitQuaternion, Vector3};

use crate::machine::{Noise, SHAPE, read, sampled};

/// A pocket whose outline has no symmetry but for what a deviation hides: lines and arcs of 10 and 20 mm.
pub const POCKET: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG3 X80 Y20 J20\nG1 Y50\nG3 X70 Y60 I-10\nG1 X10 Z-3\nG3 X0 Y50 J-10\nG1 Y0 Z0\nM2\n";
const ANGLE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\nG1 Y35\nG1 X70 Y50 Z5\nM2\n";
/// These lie on themselves when they are turned.
const RECTANGLE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600\nG1 Y60\nG1 X0\nG1 Y0\nM2\n";
const SQUARE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X60 F600\nG1 Y60\nG1 X0\nG1 Y0\nM2\n";
const SLOT: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X50 F600\nG3 Y20 J10\nG1 X0\nG3 Y0 J-10\nM2\n";

const COVERED: [f64; 5] = [0.2, 0.27, 0.33, 0.4, 0.5];

/// The deviations of the machine: smooth, at most 0.06 mm in each direction.
fn off(way_mm: f64) -> Vector3<f64> {
    Vector3::new(
        0.05 * (way_mm / 40.0).sin() + 0.01,
        0.04 * (way_mm / 55.0).cos(),
        -0.03 + 0.03 * (way_mm / 70.0).sin(),
    )
}

/// What was cut along a part of the path, one place a millimetre, and its deviations across the path: root mean square.
fn cut(text: &str, from: f64, covered: f64) -> (Vec<Vector3<f64>>, f64) {
    let (_, path) = read(text);
    let nominal = NominalPath::new(&path).expect("a path");
    let count = nominal.length_mm() as usize;
    let places = sampled(&path, count);
    let [first, end] = [from, from + covered].map(|share| (count as f64 * share) as usize);
    let mut sum = 0.0;
    let own = first..end.min(count);
    let cut: Vec<_> = own
        .clone()
        .map(|k| {
            let away = off(k as f64);
            let foot = nominal.nearest(&(places[k] + away)).expect("a place");
            sum += foot.distance_mm.powi(2);
            places[k] + away
        })
        .collect();
    (cut, (sum / own.len() as f64).sqrt())
}

fn shuffled(points: &mut [Vector3<f64>]) {
    let mut noise = Noise(11);
    points.sort_by_cached_key(|_| (noise.uniform() * 1e15) as u64);
}

/// In the frame of the program, or a little out of it: the same part of the path, and no deviation that was not there.
#[test]
fn a_part_of_the_path_is_found_where_it_is() {
    for (name, text) in [
        ("pocket", POCKET),
        ("shape", SHAPE),
        ("angle", ANGLE),
        ("rectangle", RECTANGLE),
        ("square", SQUARE),
        ("slot", SLOT),
    ] {
        let (_, path) = read(text);
        let nominal = NominalPath::new(&path).unwrap();
        for covered in COVERED {
            for (from, angle, shift) in [(0.0, 0.0, 0.0), (0.0, 3e-3, 0.3), (0.37, 3e-3, 0.3)] {
                let (cut, planted) = cut(text, from, covered);
                let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.5, 0.8) * angle);
                let away = |p: &Vector3<f64>| turn * p + Vector3::new(shift, -shift, shift);
                let mut points: Vec<_> = cut.iter().map(away).collect();
                if from > 0.0 {
                    shuffled(&mut points);
                }
                let measured = MeasuredPoints::at(&points).unwrap();
                let found = measure(&nominal, &measured, &MeasureSettings::default()).unwrap();
                let registration = found.registration.unwrap();
                let place = format!("{name}, {covered} of it from {from}, turned by {angle}");
                let mut worst = Worst::new();
                for p in &cut {
                    worst.add((registration.motion.of(&away(p)) - p).norm());
                }
                // A line leaves a shift along it open, which stays as it was; a wrong place would be tens of mm away.
                assert!(worst.value() < 1.0 + 2.0 * shift, "{place}: {worst}");
                assert_eq!(registration.told_by, ToldBy::Frame, "{place}");
                let figures = found.figures;
                assert!(
                    figures.rms_mm <= 1.01 * planted,
                    "{place}: {figures:?}, {planted}"
                );
                assert!(figures.smoothed_largest_mm < 0.11, "{place}: {figures:?}");
            }
        }
    }
}

/// In another frame: where it is, or refused with what to do; never elsewhere.
#[test]
fn a_part_of_the_path_in_another_frame_is_found_or_refused() {
    let (mut found_of, mut refused_of) = ([0; 2], [0; 2]);
    for (text, symmetric) in [
        (POCKET, 0),
        (SHAPE, 0),
        (ANGLE, 0),
        (RECTANGLE, 1),
        (SLOT, 1),
    ] {
        let (_, path) = read(text);
        let nominal = NominalPath::new(&path).unwrap();
        for covered in COVERED {
            for (from, in_order) in [(0.0, true), (0.23, false)] {
                let (cut, planted) = cut(text, from, covered);
                let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.9, 1.7));
                let away = |p: &Vector3<f64>| turn * p + Vector3::new(310.0, -40.0, 95.0);
                let mut points: Vec<_> = cut.iter().map(away).collect();
                if !in_order {
                    shuffled(&mut points);
                }
                let measured = MeasuredPoints::at(&points).unwrap();
                match measure(&nominal, &measured, &MeasureSettings::default()) {
                    Ok(found) => {
                        let motion = found.registration.unwrap().motion;
                        let mut worst = Worst::new();
                        for p in &cut {
                            worst.add((motion.of(&away(p)) - p).norm());
                        }
                        let place = format!("{text}, {covered} from {from}");
                        assert!(worst.value() < 2.0, "{place}: {worst}");
                        assert!(found.figures.rms_mm <= 1.01 * planted, "{place}");
                        found_of[symmetric] += 1;
                    }
                    Err(why) => {
                        let why = why.to_string();
                        let says = "neither their frame nor their order tells which: measure more";
                        assert!(why.contains(says) && !why.contains("NaN"), "{why}");
                        refused_of[symmetric] += 1;
                    }
                }
            }
        }
    }
    // Half of a shape without a symmetry lies on it in one place only.
    assert!(
        found_of[0] >= 12,
        "found {found_of:?}, refused {refused_of:?}"
    );
    assert!(
        refused_of[1] >= 14,
        "found {found_of:?}, refused {refused_of:?}"
    );
}

/// Points of another part, of nothing, or in another unit are no measurement of this path.
#[test]
fn what_is_not_of_this_path_is_refused() {
    let (_, path) = read(POCKET);
    let nominal = NominalPath::new(&path).unwrap();
    let mut noise = Noise(3);
    let cloud: Vec<_> = (0..400)
        .map(|_| Vector3::from_fn(|_, _| 80.0 * noise.uniform()))
        .collect();
    let (whole, _) = cut(POCKET, 0.0, 1.0);
    let inches: Vec<_> = whole.iter().map(|p| p / 25.4).collect();
    let metres: Vec<_> = whole.iter().map(|p| p * 1000.0).collect();
    // A third of the points on a clamp beside the part.
    let clamp = |(k, p): (usize, &Vector3<f64>)| match k % 3 {
        0 => Vector3::new(120.0 + 0.1 * k as f64, 30.0, 15.0),
        _ => *p,
    };
    let clamped: Vec<_> = whole.iter().enumerate().map(clamp).collect();
    for (name, points) in [
        ("cloud", cloud),
        ("inches", inches),
        ("metres", metres),
        ("clamped", clamped),
    ] {
        let measured = MeasuredPoints::at(&points).unwrap();
        let why = measure(&nominal, &measured, &MeasureSettings::default()).unwrap_err();
        let why = why.to_string();
        assert!(
            why.contains("do not register them") || why.contains("heck units and frame"),
            "{name}: {why}"
        );
    }
}

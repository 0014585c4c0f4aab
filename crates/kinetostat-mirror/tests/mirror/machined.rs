//! Whether the last correction was in the program that was measured: machines whose answer is written down here.

use kinetostat_mirror::{
    MeasuredFile, MeasuredPoints, Measurement, MirrorState, NominalPath, measure,
};
use nalgebra::Vector3;

use crate::machine::{Noise, SETTINGS, read};

const LINE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X120 F600\nM2\n";

/// What the machine is off by without a correction, mm.
fn off(x: f64, height: f64) -> Vector3<f64> {
    let angle = std::f64::consts::TAU * x / 70.0;
    Vector3::new(
        0.0,
        height * (0.5 + angle.cos()),
        0.6 * height * angle.sin(),
    )
}

/// Points at places that come by chance, from one length to another.
fn places(noise: &mut Noise, [from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let mut all: Vec<f64> = (0..count)
        .map(|_| from + (to - from) * noise.uniform())
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

fn measured(
    nominal: &NominalPath<'_>,
    name: &str,
    points: &[Vector3<f64>],
) -> [(MeasuredFile, Measurement); 1] {
    let points = MeasuredPoints::at(points).expect("points");
    let file = MeasuredFile {
        name: name.into(),
        sha256: points.sha256(),
    };
    [(
        file,
        measure(nominal, &points, &SETTINGS).expect("a measurement"),
    )]
}

/// The correction of a state at a place, from its stations.
fn correction(state: &MirrorState, x: f64) -> Vector3<f64> {
    let after = state.along_mm.partition_point(|at| *at <= x);
    let k = after.clamp(1, state.along_mm.len() - 1);
    let way = state.along_mm[k] - state.along_mm[k - 1];
    let share = (x - state.along_mm[k - 1]) / way;
    state.correction_mm[k - 1].lerp(&state.correction_mm[k], share)
}

struct Case {
    height: f64,
    sigma: f64,
    relaxation: f64,
    answer: f64,
    counts: [usize; 2],
    /// Where the second trial is measured.
    range: [f64; 2],
}

/// The second trial of the new program (with the share `answer` of the correction) or of the old one (0).
fn second(case: &Case, machined: bool, seed: u64) -> Result<Option<bool>, String> {
    let (_, path) = read(LINE);
    let nominal = NominalPath::new(&path).expect("feed moves");
    let mut state = MirrorState::new(&nominal, "line", SETTINGS).expect("a state");
    let mut noise = Noise(seed);
    let mut points = |state: &MirrorState, answer: f64, range, count| {
        let all = places(&mut noise, range, count);
        let at = |x: &f64| {
            let place = Vector3::new(*x, 0.0, 0.0);
            place + off(*x, case.height) + correction(state, *x) * answer + noise.vector(case.sigma)
        };
        all.iter().map(at).collect::<Vec<_>>()
    };
    let one = points(&state, 0.0, [0.0, 60.0], case.counts[0]);
    let first = measured(&nominal, "first", &one);
    state
        .take(&nominal, &first, case.relaxation, None)
        .expect("trial 1");
    let answer = if machined { case.answer } else { 0.0 };
    let two = points(&state, answer, case.range, case.counts[1]);
    let before = state.clone();
    let next = measured(&nominal, "second", &two);
    match state.take(&nominal, &next, case.relaxation, None) {
        Ok(_) => Ok(state.trials[1].shows_correction),
        Err(why) => {
            assert_eq!(state, before, "what is refused changes nothing");
            Err(why.to_string())
        }
    }
}

#[test]
fn the_old_program_with_new_noise_and_other_points_is_refused_and_no_other() {
    for seed in 0..40 {
        // A correction of 100 um in a scatter of 5, and of 20 in 1.
        for (height, sigma) in [(0.1, 0.005), (0.02, 0.001)] {
            for (relaxation, counts) in [(1.0, [60, 45]), (0.6, [60, 80]), (1.4, [30, 40])] {
                let mut case = Case {
                    height,
                    sigma,
                    relaxation,
                    answer: 1.0,
                    counts,
                    range: [0.0, 60.0],
                };
                let why = second(&case, false, seed).expect_err("the old program");
                assert!(
                    why.starts_with("second: nothing is seen of the correction that trial 1 wrote"),
                    "{why}"
                );
                for answer in [0.3, 0.7, 1.0, 1.3, 1.8] {
                    case.answer = answer;
                    let shows = second(&case, true, seed);
                    let shown = if answer < 0.5 {
                        shows.is_ok()
                    } else {
                        shows == Ok(Some(true))
                    };
                    assert!(
                        shown,
                        "{seed}, {height}, {relaxation}, answer {answer}: {shows:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_the_scatter_hides_is_not_refused_and_said_to_be_hidden() {
    let mut untold = 0;
    for seed in 0..40 {
        // A correction no larger than the scatter of a point.
        let case = Case {
            height: 0.004,
            sigma: 0.02,
            relaxation: 0.5,
            answer: 1.0,
            counts: [25, 20],
            range: [0.0, 60.0],
        };
        for machined in [false, true] {
            let shows = second(&case, machined, seed).expect("taken");
            untold += usize::from(shows == Some(false));
        }
    }
    assert!(untold >= 72, "{untold} of 80");
    // Measured elsewhere: nothing is known of what was there before.
    let case = Case {
        height: 0.1,
        sigma: 0.002,
        relaxation: 1.0,
        answer: 1.0,
        counts: [60, 50],
        range: [75.0, 120.0],
    };
    for machined in [false, true] {
        assert_eq!(second(&case, machined, 5), Ok(Some(false)));
    }
}

/// Points without a scatter, at the same places: the same but for the last digits.
#[test]
fn exact_points_are_told_apart_too() {
    let (_, path) = read(LINE);
    let nominal = NominalPath::new(&path).unwrap();
    let at = |height: f64| -> Vec<_> {
        let all = (0..=60).map(f64::from);
        all.map(|x| Vector3::new(x, 0.0, 0.0) + off(x, height))
            .collect()
    };
    for (left, is_taken) in [(0.1 + 1e-8, false), (0.02, true), (0.07, true)] {
        let mut state = MirrorState::new(&nominal, "line", SETTINGS).unwrap();
        let one = measured(&nominal, "first", &at(0.1));
        state.take(&nominal, &one, 1.0, None).unwrap();
        let two = measured(&nominal, "second", &at(left));
        let taken = state.take(&nominal, &two, 1.0, None);
        assert_eq!(taken.is_ok(), is_taken, "{left}: {taken:?}");
    }
}

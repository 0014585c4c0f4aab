//! Outliers, drift and smoothing of logs whose truth is known.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::f64::consts::TAU;

use kinetostat_cutting::{
    Conditioning, CutErrorKind, DriftModel, ForceLog, LoggedBy, OutlierTreatment,
};
use kinetostat_testing::Worst;

use crate::noise::Noise;

const RATE: f64 = 2000.0;

fn times(count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64 / RATE).collect()
}

fn log_of(at: Vec<f64>, x: Vec<f64>) -> ForceLog {
    let zero = vec![0.0; at.len()];
    ForceLog::new(LoggedBy::Time, at, [x, zero.clone(), zero], None).unwrap()
}

/// A cut from 2 to 7 s of ten: mean force, ripple of two teeth at 6000 rpm.
fn cut(t: f64) -> f64 {
    match (2.0..7.0).contains(&t) {
        true => 120.0 + 60.0 * (TAU * 200.0 * t).sin() + 8.0 * (TAU * 100.0 * t).cos(),
        false => 0.0,
    }
}

/// Noise of 2 N, drift of 15 N in 10 s, spikes of more than six times the spread of the ripple (63 N): the mean force comes back, and every spike is named, and nothing else.
#[test]
fn the_truth_comes_back() {
    let at = times(20_000);
    let mut noise = Noise(5);
    let drift = |t: f64| 4.0 + 1.5 * t;
    let mut x: Vec<f64> = at
        .iter()
        .map(|t| cut(*t) + drift(*t) + 2.0 * noise.normal())
        .collect();
    let spikes = [3, 1000, 1001, 5000, 9999, 12_345, 13_999, 14_001, 19_998];
    for (i, row) in spikes.iter().enumerate() {
        x[*row] += if i % 2 == 0 { 800.0 } else { -750.0 };
    }
    let spiked = x.clone();
    let log = log_of(at.clone(), x);
    for (model, air) in [
        (DriftModel::Line, vec![[0.1, 1.9], [7.1, 9.9]]),
        (DriftModel::Piecewise, vec![[7.1, 9.9], [0.1, 1.9]]),
    ] {
        let done = Conditioning::new(0.01)
            .with_air(air)
            .with_drift(model)
            .apply(&log)
            .unwrap();
        let report = &done.report;
        let named: Vec<usize> = report.outliers.iter().map(|o| o.row - 1).collect();
        assert_eq!(named, spikes, "{:?}", report.outliers);
        assert_eq!(report.outlier_count, spikes.len());
        for outlier in &report.outliers {
            assert_eq!(outlier.channel, "fx_n");
            assert_eq!(outlier.value, spiked[outlier.row - 1]);
            assert_eq!(outlier.at, at[outlier.row - 1]);
            assert_eq!(outlier.line, None);
            let truth = cut(outlier.at) + drift(outlier.at);
            // The median of a ripple is off by no more than it changes in five rows.
            assert!((outlier.median - truth).abs() < 75.0, "{outlier:?} {truth}");
        }
        // Twenty rows in a window: noise of 2/sqrt(20) N, four times that at most in 20 000 rows; an outlier, replaced by a
        // median that is off by the ripple of 68 N, leaves a twentieth of that.
        let mut worst = Worst::new();
        for t in at.iter().filter(|t| (0.05..9.95).contains(*t)) {
            let near = [2.0, 7.0].iter().any(|edge| (t - edge).abs() < 0.006);
            if !near {
                let truth = if (2.0..7.0).contains(t) { 120.0 } else { 0.0 };
                worst.add(done.log.at(*t).unwrap().0[0] - truth);
            }
        }
        assert!(worst.value() < 5.5, "{}", worst.value());
        let drift_found = report.drift.as_ref().unwrap();
        assert!(
            (drift_found.at_start[0] - 4.0).abs() < 0.15,
            "{drift_found:?}"
        );
        assert!(
            (drift_found.at_end[0] - 19.0).abs() < 0.15,
            "{drift_found:?}"
        );
        assert!(drift_found.left_n < 0.1, "{drift_found:?}");
        let sentences = report.sentences();
        assert!(sentences[0].contains("9 of 60000 values"), "{sentences:?}");
        assert!(sentences[1].contains("2 stretches"), "{sentences:?}");
        assert!(sentences[2].contains("0.01 s"), "{sentences:?}");
    }
}

/// Two thirds of the noise of a window's mean, at a window of one revolution: not a coincidence of the test above.
#[test]
fn the_mean_lowers_noise_by_the_root_of_the_rows() {
    let at = times(40_000);
    let mut noise = Noise(17);
    let x = at.iter().map(|_| noise.normal()).collect();
    let done = Conditioning::new(0.05).apply(&log_of(at, x)).unwrap();
    assert_eq!(done.report.outlier_count, 0, "{:?}", done.report.worst());
    let squares: Vec<f64> = (100..39_900)
        .map(|i| done.log.at(i as f64 / RATE).unwrap().0[0].powi(2))
        .collect();
    let deviation = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    // The mean over 0.05 s is one over 100 rows.
    assert!((deviation - 0.1).abs() < 0.01, "{deviation}");
}

/// Constant and straight signals stay as they are, at the ends too and with uneven rows.
#[test]
fn straight_lines_stay() {
    let mut noise = Noise(2);
    let mut t = 0.0;
    let at: Vec<f64> = (0..3000)
        .map(|_| {
            t += 1e-4 + 1e-3 * noise.uniform();
            t
        })
        .collect();
    for (level, slope) in [(50.0, 0.0), (-20.0, 37.0), (1000.0, -400.0)] {
        let x = at.iter().map(|t| level + slope * t).collect();
        let log = log_of(at.clone(), x);
        for window in [0.0, 0.001, 0.05, 0.7] {
            let done = Conditioning::new(window).apply(&log).unwrap();
            assert_eq!(done.report.outlier_count, 0);
            let mut worst = Worst::new();
            for t in &at {
                worst.add(done.log.at(*t).unwrap().0[0] - (level + slope * t));
            }
            assert!(worst.value() < 1e-7, "{window}: {}", worst.value());
        }
    }
}

/// The moving mean against sums of short steps, written apart.
#[test]
fn the_mean_is_that_of_the_straight_pieces() {
    let mut noise = Noise(23);
    let mut t = 3.0;
    let (mut at, mut x) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        t += 0.01 + 0.1 * noise.uniform();
        at.push(t);
        x.push(10.0 * noise.normal());
    }
    let log = log_of(at.clone(), x);
    let keep = Conditioning::new(0.4).with_outliers(OutlierTreatment::Keep);
    let done = keep.apply(&log).unwrap();
    assert!(done.report.sentences()[0].contains("not looked for"));
    let [first, last] = log.range();
    let mut worst = Worst::new();
    for t in &at {
        let half = (0.2_f64).min(t - first).min(last - t);
        if half == 0.0 {
            continue;
        }
        let steps = 200_000;
        let value = |i: usize| {
            let place = t - half + 2.0 * half * (i as f64 + 0.5) / steps as f64;
            log.at(place.clamp(first, last)).unwrap().0[0]
        };
        let mean = (0..steps).map(value).sum::<f64>() / steps as f64;
        worst.add(done.log.at(*t).unwrap().0[0] - mean);
    }
    assert!(worst.value() < 1e-6, "{}", worst.value());
}

/// Few rows, far apart: a plateau keeps its height, and a jump is over within the window.
#[test]
fn rows_far_apart_keep_their_plateaus() {
    let at = vec![0.0, 20.0, 50.0, 50.01, 90.0, 90.01, 103.0];
    let force = vec![0.0, 50.0, 50.0, 400.0, 400.0, 0.0, 0.0];
    let zero = vec![0.0; 7];
    let log = ForceLog::new(LoggedBy::AlongPath, at, [force, zero.clone(), zero], None).unwrap();
    let done = Conditioning::new(0.2).apply(&log).unwrap();
    assert_eq!(done.report.rows, 7);
    let mut compared = 0;
    for (place, expected) in [
        (10.0, 25.0),
        (30.0, 50.0),
        (49.8, 50.0),
        (50.2, 400.0),
        (70.0, 400.0),
        (89.8, 400.0),
        (90.2, 0.0),
        (100.0, 0.0),
    ] {
        let found = done.log.at(place).unwrap().0[0];
        assert!((found - expected).abs() < 1e-6, "{place}: {found}");
        compared += 1;
    }
    assert_eq!(compared, 8);
}

/// Steps, ramps, kinks and quantised rest are no outliers.
#[test]
fn clean_signals_have_no_outliers() {
    let at = times(4000);
    let shapes: [fn(usize) -> f64; 5] = [
        |i| if (1000..3000).contains(&i) { 80.0 } else { 0.0 },
        |i| (i as f64 - 2000.0).abs(),
        |i| if i % 7 == 3 { 0.01 } else { 0.0 } + if i > 2000 { 50.0 } else { 0.0 },
        |i| 30.0 * (i as f64 * 0.3).sin(),
        |i| if i < 2000 { 0.0 } else { (i - 2000) as f64 },
    ];
    for (index, shape) in shapes.iter().enumerate() {
        let x = (0..4000).map(shape).collect();
        let done = Conditioning::new(0.0)
            .apply(&log_of(at.clone(), x))
            .unwrap();
        assert_eq!(
            done.report.outlier_count,
            0,
            "{index}: {:?}",
            done.report.worst()
        );
    }
}

/// A tooth whose peak is one row wide is not an outlier: so many are refused, and kept where that is stated.
#[test]
fn peaks_of_teeth_are_not_thrown_away() {
    let at = times(4000);
    let mut noise = Noise(1);
    let x: Vec<f64> = (0..4000)
        .map(|i| if i % 20 == 0 { 200.0 } else { 0.0 } + noise.normal())
        .collect();
    let log = log_of(at, x);
    let error = Conditioning::new(0.01).apply(&log).unwrap_err();
    assert_eq!(error.kind, CutErrorKind::Measurement);
    assert!(error.to_string().contains("200 of 4000 rows"), "{error}");
    let kept = Conditioning::new(0.01).with_outliers(OutlierTreatment::Keep);
    let done = kept.apply(&log).unwrap();
    let mean = done.log.at(1.0).unwrap().0[0];
    assert!((mean - 10.0).abs() < 1.0, "{mean}");
}

/// One stretch gives its mean, none nothing; moments drift too.
#[test]
fn drift_with_little_air() {
    let at = times(4000);
    let x: Vec<f64> = at.iter().map(|t| 5.0 + t).collect();
    let log = ForceLog::new(
        LoggedBy::Time,
        at,
        [x.clone(), x.clone(), x.clone()],
        Some([x.clone(), x.clone(), x]),
    )
    .unwrap();
    let one = Conditioning::new(0.0)
        .with_air(vec![[0.0, 1.0]])
        .apply(&log)
        .unwrap();
    let drift = one.report.drift.unwrap();
    assert_eq!(drift.at_start.len(), 6);
    assert!((drift.at_start[5] - 5.5).abs() < 1e-3 && (drift.at_end[5] - 5.5).abs() < 1e-3);
    let (force, moment) = one.log.at(1.0).unwrap();
    assert!((force[2] - 0.5).abs() < 1e-3 && (moment[0] - 0.5).abs() < 1e-3);
    let none = Conditioning::new(0.0).apply(&log).unwrap();
    assert_eq!(none.report.drift, None);
    assert_eq!(none.log.at(1.0), log.at(1.0));
    assert!(none.report.sentences()[1].contains("none removed"));
}

#[test]
fn what_cannot_be_is_refused() {
    let log = log_of(times(100), vec![1.0; 100]);
    for (conditioning, word) in [
        (Conditioning::new(-1.0), "window"),
        (Conditioning::new(1.0), "window"),
        (Conditioning::new(f64::NAN), "window"),
        (Conditioning::new(0.0).with_air(vec![[0.01, 0.01]]), "air"),
        (
            Conditioning::new(0.0).with_air(vec![[3.0, 4.0]]),
            "0.0495 s",
        ),
        (
            Conditioning::new(0.0).with_air(vec![[0.0, f64::NAN]]),
            "air",
        ),
        (
            Conditioning::new(0.0).with_air(vec![[0.0, 0.02], [0.01, 0.03]]),
            "overlap",
        ),
    ] {
        let error = conditioning.apply(&log).unwrap_err();
        assert_eq!(error.kind, CutErrorKind::Measurement);
        assert!(error.to_string().contains(word), "{error}");
    }
    let zero = || [vec![0.0; 2], vec![0.0; 2], vec![0.0; 2]];
    let new = |at: Vec<f64>| ForceLog::new(LoggedBy::AlongPath, at, zero(), None);
    assert!(new(vec![0.0, 1.0]).is_ok());
    for at in [
        vec![0.0, 0.0],
        vec![1.0, 0.0],
        vec![0.0, f64::NAN],
        vec![0.0],
        vec![0.0, 1e10],
    ] {
        assert_eq!(new(at).unwrap_err().kind, CutErrorKind::Measurement);
    }
}

#[test]
fn csv_is_read_in_any_order() {
    let text = "\u{feff}# kistler\n\nfz_n;mx_n_m;my_n_m;mz_n_m;along_mm; fx_n ;fy_n\r\n3;0.1;0.2;0.3;0;1;2\r\n# pause\r\n6;0;0;0;2.5;-4e0;5\r\n";
    let log = ForceLog::read("slot.csv", text).unwrap();
    assert_eq!(log.by(), LoggedBy::AlongPath);
    assert_eq!(log.at(0.0), Some(([1.0, 2.0, 3.0], [0.1, 0.2, 0.3])));
    assert_eq!(log.at(2.5), Some(([-4.0, 5.0, 6.0], [0.0; 3])));
    assert_eq!(log.at(-1e-9), None);
}

#[test]
fn faults_of_a_file_name_its_line() {
    let header = "time_s,fx_n,fy_n,fz_n";
    let cases = [
        (
            format!("{header}\n0,1,2,3\n1,1,2,3\n\n1,1,2,3\n"),
            5,
            "1 s after 1 s",
        ),
        (
            format!("{header}\n0,1,2,3\n-1,1,2,3\n"),
            3,
            "-1 s after 0 s",
        ),
        (format!("{header}\n0,1,2,3\nnan,1,2,3\n"), 3, "NaN s"),
        (format!("{header}\n0,1,2,3\n1,1,2,inf\n"), 3, "fz_n: inf N"),
        (format!("{header}\n0,1,2,3\n1,1,\"2,5\",3\n"), 3, "`2,5`"),
        (
            format!("{header}\n0,1,2,3\n1,1,2\n"),
            3,
            "3 cells under 4 columns",
        ),
        (format!("{header}\n0,1,2,3\n"), 2, "two at least"),
        (format!("{header}\n"), 1, "two at least"),
        (String::new(), 1, "neither `time_s` nor `along_mm`"),
        (
            "time_s,along_mm,fx_n,fy_n,fz_n\n".to_owned(),
            1,
            "of which one",
        ),
        ("time_s,fx_n,fz_n\n".to_owned(), 1, "no column `fy_n`"),
        (format!("{header},mx_n_m,mz_n_m\n"), 1, "no column `my_n_m`"),
        (
            format!("# a\n{header},temperature\n"),
            2,
            "column `temperature`",
        ),
        (format!("{header},fx_n\n"), 1, "column `fx_n` twice"),
        (
            "time_s;fx_n;fy_n;fz_n\n0;1;2;3\n0,1;1;2;3\n".to_owned(),
            3,
            "`0,1`",
        ),
    ];
    let mut looked_at = 0;
    for (text, line, expected) in cases {
        let error = ForceLog::read("slot.csv", &text).unwrap_err();
        assert_eq!(error.file.as_deref(), Some("slot.csv"));
        assert_eq!(error.line, Some(line), "{text:?}: {error}");
        assert!(error.to_string().contains(expected), "{text:?}: {error}");
        looked_at += 1;
    }
    assert_eq!(looked_at, 15);
}

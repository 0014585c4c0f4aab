//! The shift of logs whose shift is known.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use kinetostat_cutting::{Activity, CutErrorKind, ForceLog, LoggedBy, match_shift};
use kinetostat_testing::Worst;
use proptest::prelude::*;

use crate::noise::Noise;

/// Stretches of a program in which it cuts, from and to, s.
const CUTS: [[f64; 2]; 4] = [[0.0, 3.0], [3.8, 5.1], [6.6, 12.2], [13.0, 13.9]];

fn cuts(t: f64) -> bool {
    CUTS.iter().any(|[from, to]| (*from..*to).contains(&t))
}

fn expected(cuts: &[[f64; 2]]) -> Activity {
    let of = |[from, to]: &[f64; 2]| [[*from, 0.0], [*from, 1.0], [*to, 1.0], [*to, 0.0]];
    Activity::new(cuts.iter().flat_map(of).collect()).unwrap()
}

/// A log of `length` s at `rate` rows in a second, in which the program begins at `shift`.
fn log(
    rate: f64,
    length: f64,
    shift: f64,
    size: impl Fn(f64) -> f64,
    noise: &mut Noise,
) -> ForceLog {
    let count = (length * rate) as usize;
    let at: Vec<f64> = (0..count).map(|i| i as f64 / rate).collect();
    let axes = [0.6, -0.64, 0.48].map(|part| {
        let own = at
            .iter()
            .map(|t| part * size(t - shift) + 3.0 * noise.normal());
        own.collect::<Vec<f64>>()
    });
    ForceLog::new(LoggedBy::Time, at, axes, None).unwrap()
}

/// Any shift, cuts with other forces, noise and ripple: to within a row.
#[test]
fn the_shift_is_found_to_within_a_row() {
    let mut noise = Noise(4);
    let mut worst = Worst::new();
    for (rate, length, shift) in [
        (1000.0, 20.0, 2.3456),
        (1000.0, 60.0, 41.000_31),
        (100.0, 18.0, 0.0),
        (5000.0, 16.0, 0.777_77),
        // A log that begins after the program, and one that ends before it.
        (1000.0, 13.0, -1.5),
        (1000.0, 11.0, 0.25),
    ] {
        let size = |t: f64| match cuts(t) {
            true => 100.0 + 30.0 * (0.7 * t).sin() + 40.0 * (600.0 * t).sin(),
            false => 0.0,
        };
        let log = log(rate, length, shift, size, &mut noise);
        let found = match_shift(&log, &expected(&CUTS)).unwrap();
        worst.add((found.shift_s - shift) * rate);
        assert!(found.correlation > 0.8, "{found:?}");
        assert!(found.within_s * rate < 10.0, "{found:?}");
    }
    assert!(worst.value() < 1.0, "{} rows", worst.value());
}

/// A course that is not 1 and 0: the shift is found far below the distance of the rows.
#[test]
fn below_the_distance_of_the_rows() {
    let mut noise = Noise(9);
    // A triangle of two seconds and one of four.
    let points = vec![
        [0.0, 0.0],
        [1.0, 90.0],
        [2.0, 0.0],
        [2.5, 0.0],
        [4.5, 120.0],
        [6.5, 0.0],
    ];
    let size = |t: f64| -> f64 {
        let of = points.windows(2).find(|p| (p[0][0]..p[1][0]).contains(&t));
        of.map_or(0.0, |p| {
            p[0][1] + (p[1][1] - p[0][1]) * (t - p[0][0]) / (p[1][0] - p[0][0])
        })
    };
    let activity = Activity::new(points.clone()).unwrap();
    let mut worst = Worst::new();
    for shift in [1.5, 1.523_4, 1.538_8, 2.000_77] {
        let at: Vec<f64> = (0..250).map(|i| f64::from(i) * 0.04).collect();
        let x = at
            .iter()
            .map(|t| size(t - shift) + 0.2 * noise.normal())
            .collect();
        let zero = vec![0.0; 250];
        let log = ForceLog::new(LoggedBy::Time, at, [x, zero.clone(), zero], None).unwrap();
        let found = match_shift(&log, &activity).unwrap();
        worst.add(found.shift_s - shift);
        assert!(found.correlation > 0.999, "{found:?}");
    }
    assert!(worst.value() < 0.002, "{} s of 0.04 s", worst.value());
}

fn refused(log: &ForceLog, expected: &Activity, word: &str) {
    let error = match_shift(log, expected).unwrap_err();
    assert_eq!(error.kind, CutErrorKind::Measurement);
    assert!(error.to_string().contains(word), "{error}");
}

#[test]
fn what_is_not_distinct_is_refused() {
    let mut noise = Noise(31);
    // Noise alone.
    let nothing = log(200.0, 30.0, 0.0, |_| 0.0, &mut noise);
    refused(&nothing, &expected(&CUTS), "does not look like the program");
    // One pass of four alike.
    let passes: Vec<[f64; 2]> = (0..4)
        .map(|i| [4.0 * f64::from(i), 4.0 * f64::from(i) + 3.0])
        .collect();
    let one = |t: f64| if (0.0..3.0).contains(&t) { 90.0 } else { 0.0 };
    let log_of_one = log(200.0, 4.5, 0.8, one, &mut noise);
    refused(
        &log_of_one,
        &expected(&passes),
        "the log looks the same at both",
    );
    // All four are recognised by the silence before and behind them.
    let all = |t: f64| {
        if (0.0..15.0).contains(&t) && t % 4.0 < 3.0 {
            90.0
        } else {
            0.0
        }
    };
    let found = match_shift(&log(200.0, 30.0, 7.3, all, &mut noise), &expected(&passes)).unwrap();
    assert!((found.shift_s - 7.3).abs() < 0.005, "{found:?}");
    assert!(
        found.next.unwrap()[1] < found.correlation - 0.1,
        "{found:?}"
    );
    // A feed of ten seconds of which the tool cuts the middle four: where it lies in them nobody knows.
    let middle = |t: f64| if (3.0..7.0).contains(&t) { 90.0 } else { 0.0 };
    let log_of_middle = log(200.0, 30.0, 8.0, middle, &mut noise);
    refused(
        &log_of_middle,
        &expected(&[[0.0, 10.0]]),
        "hide when the cut begins",
    );
    // Nor if the log ends with the feed, where a shift that pushes the feed over that end correlates best.
    let log_that_ends = log(200.0, 19.0, 8.0, middle, &mut noise);
    refused(
        &log_that_ends,
        &expected(&[[0.0, 10.0]]),
        "hide when the cut begins",
    );
    // A force that never changes.
    let at: Vec<f64> = (0..100).map(f64::from).collect();
    let constant = ForceLog::new(
        LoggedBy::Time,
        at.clone(),
        [vec![5.0; 100], vec![0.0; 100], vec![0.0; 100]],
        None,
    );
    refused(&constant.unwrap(), &expected(&CUTS), "correlation");
    let along = ForceLog::new(
        LoggedBy::AlongPath,
        at,
        [vec![5.0; 100], vec![0.0; 100], vec![0.0; 100]],
        None,
    );
    refused(&along.unwrap(), &expected(&CUTS), "along the path");
    for points in [
        vec![],
        vec![[0.0, 1.0]],
        vec![[0.0, 1.0], [0.0, 2.0]],
        vec![[1.0, 1.0], [0.0, 1.0]],
        vec![[0.0, f64::NAN], [1.0, 0.0]],
    ] {
        assert!(Activity::new(points).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// The best correlation is the largest of those at all shifts, by sums over the rows written apart: these cannot cut between two rows.
    #[test]
    fn the_best_of_all_shifts(seed in 0_u64..1000, shift in 0.0..6.0_f64) {
        let mut noise = Noise(seed);
        let size = |t: f64| if cuts(t) { 60.0 } else { 0.0 };
        let log = log(50.0, 20.0, shift, size, &mut noise);
        let found = match_shift(&log, &expected(&CUTS)).unwrap();
        let sizes: Vec<f64> = (0..1000).map(|i| {
            let f = log.at(f64::from(i) / 50.0).unwrap().0;
            (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt()
        }).collect();
        let plain = |shift: f64| {
            let e: Vec<f64> = (0..1000).map(|i| if cuts(f64::from(i) / 50.0 - shift) { 1.0 } else { 0.0 }).collect();
            let mean = |x: &[f64]| x.iter().sum::<f64>() / 1000.0;
            let (a, b) = (mean(&sizes), mean(&e));
            let sum = |f: &dyn Fn(usize) -> f64| (0..1000).map(f).sum::<f64>();
            let product = sum(&|i| (sizes[i] - a) * (e[i] - b));
            product / (sum(&|i| (sizes[i] - a).powi(2)) * sum(&|i| (e[i] - b).powi(2))).sqrt()
        };
        let best = (-600..900).map(|i| plain(f64::from(i) * 0.02)).fold(f64::NEG_INFINITY, |a, b| if b > a || b.is_nan() { b } else { a });
        prop_assert!((found.shift_s - shift).abs() < 0.02);
        prop_assert!((found.correlation - best).abs() < 0.02, "{} {}", found.correlation, best);
    }
}

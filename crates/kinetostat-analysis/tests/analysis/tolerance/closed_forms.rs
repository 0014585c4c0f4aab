//! Statistics against closed forms.

use std::f64::consts::PI;

use kinetostat_analysis::tolerance::{
    Distribution, Draws, MOST_MISSING, MOST_NUMBERS, SHARES, Summary, Uncertain, Uncertainties,
    can_be_kept, design_row, design_rows, linear, linear_points, mean_and_deviation, quantile,
    sobol_indices,
};

fn uncertain(name: &str, value: f64, distribution: Distribution) -> Uncertain {
    Uncertain {
        name: name.into(),
        value,
        unit: String::new(),
        distribution,
    }
}

#[test]
fn moments_of_the_distributions_come_out_of_the_draws() {
    let draws = Draws::new(1 << 14, 3);
    for (distribution, kurtosis) in [
        (Distribution::Normal(0.7), 3.0),
        (Distribution::Uniform(0.7), 1.8),
        (Distribution::Triangular(0.7), 2.4),
    ] {
        let one = Uncertainties::independent(vec![uncertain("x", 5.0, distribution)]);
        let values: Vec<f64> = (0..draws.len())
            .map(|i| one.drawn(&draws, i)[0] - 5.0)
            .collect();
        let (mean, deviation) = mean_and_deviation(&values);
        let fourth = values.iter().map(|x| x.powi(4)).sum::<f64>() / draws.len() as f64;
        assert!(mean.abs() < 1e-4, "{distribution:?}: {mean}");
        assert!(
            (deviation / distribution.standard_deviation() - 1.0).abs() < 1e-3,
            "{distribution:?}"
        );
        assert!(
            (fourth / deviation.powi(4) - kurtosis).abs() < 0.03,
            "{distribution:?}: {fourth}"
        );
    }
}

/// Down to one draw, where the share of a rare quantile lies below all.
#[test]
fn bounds_of_quantiles_are_those_of_sums_of_the_binomial_distribution() {
    for n in (1..=80_u32).chain([128, 145, 150, 200]) {
        let list: Vec<f64> = (0..n).map(f64::from).collect();
        for share in SHARES {
            let (p, q) = (share, 1.0 - share);
            let mut one = q.powi(n as i32);
            let mut sums = vec![one];
            for k in 1..=n {
                one *= f64::from(n + 1 - k) / f64::from(k) * p / q;
                sums.push(sums[k as usize - 1] + one);
            }
            let least = |tail: f64| sums.iter().position(|x| *x >= tail).unwrap_or(n as usize);
            let found = quantile(&list, share);
            let wanted = least(0.025).checked_sub(1).map(|k| list[k]);
            assert_eq!(found.low, wanted, "{n} draws, {share}");
            assert_eq!(
                found.high,
                list.get(least(0.975)).copied(),
                "{n} draws, {share}"
            );
        }
    }
}

#[test]
fn the_bounds_of_quantiles_hold_them_as_often_as_they_say() {
    // Independent draws of a known distribution: 400 lists of 200, splitmix by hand.
    let mut state = 12_345_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    };
    for share in [0.05, 0.5, 0.95] {
        let mut held = 0;
        for _ in 0..400 {
            let mut list: Vec<f64> = (0..200).map(|_| next()).collect();
            list.sort_by(f64::total_cmp);
            let found = quantile(&list, share);
            let (low, high) = (found.low.expect("a bound"), found.high.expect("a bound"));
            held += usize::from(low <= share && share <= high);
        }
        // 95 % or a little more; four standard deviations of 400 trials are 4.4 %.
        assert!((363..=400).contains(&held), "{share}: {held}");
    }
    let few = quantile(&[1.0, 2.0, 3.0], 0.975);
    assert!(
        few.high.is_none(),
        "three draws bound no rare quantile: {few:?}"
    );
    assert!(quantile(&[], 0.5).value.is_nan());
}

#[test]
fn the_standard_error_of_the_mean_is_honest() {
    // The mean of exp(x), x uniform in -1 .. 1, is sinh(1).
    let one = Uncertainties::independent(vec![uncertain("x", 0.0, Distribution::Uniform(1.0))]);
    let mut held = 0;
    for seed in 0..200 {
        let draws = Draws::new(256, seed);
        let values: Vec<f64> = (0..draws.len())
            .map(|i| one.drawn(&draws, i)[0].exp())
            .collect();
        let mean = Summary::of(&draws, &values).mean;
        held += usize::from((mean.value - 1.0_f64.sinh()).abs() <= mean.plus_minus);
    }
    assert!(
        (178..=200).contains(&held),
        "{held} of 200 intervals of 95 % hold it"
    );
}

#[test]
fn sobol_indices_of_ishigami_are_the_known_ones() {
    // f = sin a + 7 sin^2 b + 0.1 c^4 sin a, all uniform in -pi .. pi [Saltelli et al. 2008, 4.34].
    let (a, b) = (7.0, 0.1);
    let three = ["x1", "x2", "x3"].map(|name| uncertain(name, 0.0, Distribution::Uniform(PI)));
    let three = Uncertainties::independent(three.to_vec());
    let draws = Draws::new(1 << 14, 5);
    let f = |x: &[f64]| x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin();
    let answers: Vec<f64> = (0..design_rows(&three, &draws))
        .map(|row| f(&design_row(&three, &draws, row)))
        .collect();
    let (found, used) = sobol_indices(&draws, 3, &answers);
    assert_eq!(used, draws.len());
    let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
    let v2 = a * a / 8.0;
    let v13 = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let v = v1 + v2 + v13;
    for (index, (first, total)) in found.iter().zip([(v1, v1 + v13), (v2, v2), (0.0, v13)]) {
        assert!(
            (index.first.value - first / v).abs() < 0.01,
            "{index:?}, {}",
            first / v
        );
        assert!(
            (index.total.value - total / v).abs() < 0.01,
            "{index:?}, {}",
            total / v
        );
        assert!((index.first.value - first / v).abs() < 2.0 * index.first.plus_minus + 1e-12);
        assert!((index.total.value - total / v).abs() < 2.0 * index.total.plus_minus + 1e-12);
        assert!(
            index.first.plus_minus < 0.03 && index.total.plus_minus < 0.03,
            "{index:?}"
        );
    }
    // What misses one answer is left out as a whole.
    let mut holes = answers.clone();
    holes[7] = f64::NAN;
    assert_eq!(sobol_indices(&draws, 3, &holes).1, draws.len() - 1);
    // Nothing varies: there are no parts.
    assert!(
        sobol_indices(&draws, 3, &vec![4.0; answers.len()]).0[0]
            .first
            .value
            .is_nan()
    );
}

#[test]
fn a_correlated_pair_has_the_variance_of_the_closed_form() {
    // y = 2 a - 3 b: variance 4 s^2 + 9 t^2 - 12 r s t.
    for (r, s, t) in [(0.8, 0.1, 0.2), (-0.5, 0.1, 0.2), (1.0, 0.3, 0.1)] {
        let pair = vec![
            uncertain("a", 1.0, Distribution::Normal(s)),
            uncertain("b", 2.0, Distribution::Normal(t)),
        ];
        let pair = Uncertainties::correlated(pair, &[(0, 1, r)]).expect("a correlation");
        let y = |x: &[f64]| 2.0 * x[0] - 3.0 * x[1];
        let exact = (4.0 * s * s + 9.0 * t * t - 12.0 * r * s * t).sqrt();
        let draws = Draws::new(1 << 14, 11);
        let values: Vec<f64> = (0..draws.len())
            .map(|i| y(&pair.drawn(&draws, i)))
            .collect();
        let found = Summary::of(&draws, &values).standard_deviation;
        assert!(
            (found.value / exact - 1.0).abs() < 3e-3,
            "{r}: {found:?}, {exact}"
        );
        let lines = linear(
            &pair,
            &linear_points(&pair)
                .iter()
                .map(|p| vec![y(p)])
                .collect::<Vec<_>>(),
        );
        assert!((lines[0].standard_deviation / exact - 1.0).abs() < 1e-9);
        assert!((lines[0].shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_correlated_pair_of_uniform_numbers_has_the_covariance_of_its_copula() {
    // Two uniform ones whose normal scores have the correlation r correlate by 6/pi asin(r/2) [Pearson 1907].
    let (half, r) = (0.3, 0.7_f64);
    let pair = vec![
        uncertain("a", 1.0, Distribution::Uniform(half)),
        uncertain("b", 2.0, Distribution::Uniform(half)),
    ];
    let pair = Uncertainties::correlated(pair, &[(0, 1, r)]).expect("a correlation");
    let exact = 6.0 / PI * (0.5 * r).asin() * half * half / 3.0;
    assert!(
        (pair.covariance()[(0, 1)] / exact - 1.0).abs() < 1e-4,
        "{} {exact}",
        pair.covariance()[(0, 1)]
    );
    let draws = Draws::new(1 << 14, 2);
    let sum = (0..draws.len())
        .map(|i| pair.drawn(&draws, i))
        .map(|x| (x[0] - 1.0) * (x[1] - 2.0))
        .sum::<f64>();
    assert!((sum / draws.len() as f64 / exact - 1.0).abs() < 0.01);
}

#[test]
fn correlations_that_contradict_each_other_are_refused() {
    let three = ["a", "b", "c"]
        .map(|n| uncertain(n, 1.0, Distribution::Normal(0.1)))
        .to_vec();
    let refused = Uncertainties::correlated(three, &[(0, 1, 0.9), (1, 2, 0.9), (0, 2, -0.9)]);
    assert!(refused.expect_err("a contradiction").least < -0.5);
}

#[test]
fn more_numbers_than_a_sequence_has_dimensions_stay_independent() {
    let draws = Draws::new(1 << 12, 1);
    let mean = |i: usize, j: usize| {
        (0..draws.len())
            .map(|k| (draws.point(k, i) - 0.5) * (draws.point(k, j) - 0.5))
            .sum::<f64>()
            / draws.len() as f64
            * 12.0
    };
    for (i, j) in [(0, 256), (3, 259), (255, 256), (10, 700)] {
        assert!(mean(i, j).abs() < 0.06, "{i} {j}: {}", mean(i, j));
    }
    assert!((mean(300, 300) - 1.0).abs() < 1e-2);
    let long = Draws::new(200_000, 1);
    assert_eq!(
        (
            long.len(),
            long.replicate(0),
            long.replicate(long.len() - 1)
        ),
        (200_000, 0, 15)
    );
}

#[test]
fn nothing_is_said_of_parts_where_too_much_is_missing() {
    // A sum of two numbers: half each. Where its largest values are missing, what is left looks narrow and sure of itself.
    let two = ["a", "b"].map(|name| uncertain(name, 0.4, Distribution::Normal(1.3)));
    let two = Uncertainties::independent(two.to_vec());
    let draws = Draws::new(4096, 11);
    let parts = |missing_above: f64| {
        let answer = |row| {
            let sum: f64 = design_row(&two, &draws, row).iter().sum();
            if sum > missing_above { f64::NAN } else { sum }
        };
        let answers: Vec<f64> = (0..design_rows(&two, &draws)).map(answer).collect();
        sobol_indices(&draws, 2, &answers)
    };
    let (found, used) = parts(1.8);
    assert!(used < draws.len() / 2, "{used}");
    for index in found {
        let said = [index.first, index.total];
        assert!(
            said.iter()
                .all(|e| e.value.is_nan() && e.plus_minus.is_nan())
        );
    }
    let (found, used) = parts(6.3);
    let missing = 1.0 - used as f64 / draws.len() as f64;
    assert!(missing > 0.0 && missing <= MOST_MISSING, "{missing}");
    for index in found {
        assert!((index.first.value - 0.5).abs() < 0.05, "{index:?}");
        assert!((index.total.value - 0.5).abs() < 0.05, "{index:?}");
    }
}

#[test]
fn what_cannot_be_kept_is_refused_with_what_it_would_take() {
    assert!(can_be_kept(MOST_NUMBERS / 19, 19).is_ok());
    let refused = can_be_kept(1 << 20, 38_000).map_err(|many| many.to_string());
    assert_eq!(
        refused,
        Err("these are 39845888000 numbers (319 GB), and 200000000 (1.6 GB) can be kept".into())
    );
    assert!(can_be_kept(usize::MAX, 2).is_err());
}

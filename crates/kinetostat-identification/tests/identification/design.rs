//! Reference problems P9, P9b and P10 of the choice of postures.

use crate::candidates::{p9, p9b, p10, random_candidates, three_r_test_pose};
use kinetostat_identification::design::{Criterion, DesignSettings, continuous, evaluate, exact};
use nalgebra::{DMatrix, DVector};

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{found:.12e} instead of {expected:.12e}"
    );
}

fn with_repeats() -> DesignSettings {
    DesignSettings {
        repeats: true,
        ..DesignSettings::default()
    }
}

fn criteria(l: &DMatrix<f64>) -> [Criterion; 4] {
    [
        Criterion::TestPoses(l.clone()),
        Criterion::Average,
        Criterion::Determinant,
        Criterion::WorstDirection,
    ]
}

/// Value of a criterion straight from its definition; infinite for a singular matrix.
fn by_definition(m: &DMatrix<f64>, criterion: &Criterion) -> f64 {
    let eigenvalues = m.clone().symmetric_eigenvalues();
    if eigenvalues.min() <= 1e-11 * eigenvalues.max() {
        return f64::INFINITY;
    }
    let Some(inverse) = m.clone().try_inverse() else {
        return f64::INFINITY;
    };
    match criterion {
        Criterion::TestPoses(l) => (l * inverse).trace(),
        Criterion::Average => inverse.trace(),
        Criterion::Determinant => inverse.determinant().powf(1.0 / m.nrows() as f64),
        Criterion::WorstDirection => inverse.symmetric_eigenvalues().max(),
        _ => unreachable!(),
    }
}

/// Best set by enumeration, with its value.
fn brute_force(
    candidates: &[DMatrix<f64>],
    criterion: &Criterion,
    count: usize,
    settings: &DesignSettings,
) -> (Vec<usize>, f64) {
    let p = candidates[0].ncols();
    let fixed = settings.fixed_information.clone();
    let fixed = fixed.unwrap_or_else(|| DMatrix::zeros(p, p));
    let mut best = (Vec::new(), f64::INFINITY);
    let mut chosen: Vec<usize> = (0..count)
        .map(|i| if settings.repeats { 0 } else { i })
        .collect();
    loop {
        let m = chosen.iter().fold(fixed.clone(), |m, x| {
            m + candidates[*x].tr_mul(&candidates[*x])
        });
        let value = by_definition(&m, criterion);
        if value < best.1 {
            best = (chosen.clone(), value);
        }
        let last = |i: usize| candidates.len() - if settings.repeats { 1 } else { count - i };
        let Some(i) = (0..count).rev().find(|i| chosen[*i] < last(*i)) else {
            return best;
        };
        chosen[i] += 1;
        for j in i + 1..count {
            chosen[j] = chosen[j - 1] + usize::from(!settings.repeats);
        }
    }
}

#[test]
fn p9_exchange_agrees_with_enumeration() {
    let candidates = p9();
    let expected: [(&[usize], f64); 4] = [
        (&[1, 13, 14], 2.240942498937),
        (&[1, 3, 14], 3.641023499976e6),
        (&[1, 3, 9], 5.794441408802e5),
        (&[1, 7, 14], 2.661725811448e6),
    ];
    let settings = DesignSettings::default();
    for (criterion, (postures, value)) in criteria(&three_r_test_pose()).iter().zip(expected) {
        let (best, least) = brute_force(&candidates, criterion, 3, &settings);
        let found = exact(&candidates, criterion, 3, &settings).unwrap();
        assert_eq!(best, postures);
        assert_eq!(found.postures, postures);
        close(least, value, 1e-9);
        close(found.value, value, 1e-9);
        assert_eq!(
            found.efficiency.is_none(),
            *criterion == Criterion::WorstDirection
        );
    }
}

#[test]
fn p9_bounds() {
    let l = Criterion::TestPoses(three_r_test_pose());
    let one = continuous(&p9(), &l, 1, &DesignSettings::default()).unwrap();
    close(one.value, 5.379571583, 1e-9);
    assert!(one.gap <= 1e-9);
    close(one.weights.iter().sum(), 1.0, 1e-12);
    let three = continuous(&p9(), &l, 3, &with_repeats()).unwrap();
    close(three.bound, 1.793190526, 1e-9);
    // Without repetition the bound is sharper.
    let found = exact(&p9(), &l, 3, &DesignSettings::default()).unwrap();
    assert!(found.bound.unwrap() > 1.793190526);
}

#[test]
fn p9b_grid() {
    let (candidates, names) = p9b();
    let l = Criterion::TestPoses(three_r_test_pose());
    let design = continuous(&candidates, &l, 1, &with_repeats()).unwrap();
    close(design.value, 6.7440465702, 1e-9);
    assert!(design.gap <= 1e-9);
    for (name, weight) in [
        ((10, 80, 'z'), 0.5389),
        ((0, 0, 'x'), 0.2231),
        ((-60, -30, 'y'), 0.119),
        ((60, 30, 'y'), 0.119),
    ] {
        let x = names.iter().position(|n| *n == name).unwrap();
        assert!(design.support.contains(&x));
        assert!(
            (design.weights[x] - weight).abs() < 6e-4,
            "{}",
            design.weights[x]
        );
    }
    assert_eq!(design.support.len(), 4);
    for (count, efficiency) in [(3, 0.926), (4, 0.996), (6, 0.956), (12, 0.996)] {
        let found = exact(&candidates, &l, count, &with_repeats()).unwrap();
        let reached = found.efficiency.unwrap();
        assert!((reached - efficiency).abs() < 6e-4, "{count}: {reached}");
    }
}

#[test]
fn p10_twelve_of_300() {
    let (candidates, l) = p10(5);
    let l = Criterion::TestPoses(l);
    let found = exact(&candidates, &l, 12, &with_repeats()).unwrap();
    close(found.bound.unwrap(), 0.03972983758, 5e-9);
    assert!(found.value <= 1.01 * 0.03992405069, "{}", found.value);
    assert!(found.efficiency.unwrap() >= 0.95);
    let first: Vec<usize> = (0..12).collect();
    let first = evaluate(&candidates, &first, &l, &with_repeats()).unwrap();
    close(first.value, 0.09905635577, 1e-9);
    // Distinct postures cost 2.4 %, and the sharper bound shows that hardly better ones exist.
    let distinct = exact(&candidates, &l, 12, &DesignSettings::default()).unwrap();
    assert!(distinct.postures.windows(2).all(|w| w[0] < w[1]));
    assert!(distinct.efficiency.unwrap() > 0.99);
}

#[test]
fn gap_is_certified_for_all_differentiable_criteria() {
    let (candidates, l) = p10(5);
    for repeats in [false, true] {
        let settings = DesignSettings {
            repeats,
            ..DesignSettings::default()
        };
        for criterion in &criteria(&l)[..3] {
            for count in [1, 12, 299, 300] {
                let design = continuous(&candidates, criterion, count, &settings).unwrap();
                assert!(design.gap <= 1e-9 && design.gap >= 0.0, "{}", design.gap);
                let limit = if repeats { 1.0 } else { 1.0 / count as f64 };
                assert!(
                    design
                        .weights
                        .iter()
                        .all(|w| (0.0..=limit * (1.0 + 1e-9)).contains(w))
                );
                close(design.weights.iter().sum(), 1.0, 1e-9);
            }
        }
    }
}

#[test]
fn one_test_pose_with_fewer_rows_than_parameters() {
    let (candidates, l) = p10(1);
    let l = Criterion::TestPoses(l);
    let design = continuous(&candidates, &l, 12, &with_repeats()).unwrap();
    assert!(design.gap < 1e-6, "{}", design.gap);
    let found = exact(&candidates, &l, 12, &with_repeats()).unwrap();
    assert!(found.efficiency.unwrap() > 0.9 && found.efficiency.unwrap() <= 1.0);
}

#[test]
fn small_random_problems_agree_with_enumeration() {
    for seed in 0..60 {
        let (p, rows) = [(2, 1), (3, 1), (4, 1), (3, 2), (2, 3), (4, 3)][seed % 6];
        let count = p.max(2) - usize::from(rows > 1 && p > 2);
        let candidates = random_candidates(seed as u64, 9, rows, p);
        let all = random_candidates(1000 + seed as u64, 1, p + seed % 2, p).remove(0);
        let l = all.tr_mul(&all);
        let settings = DesignSettings {
            repeats: seed % 4 < 2,
            fixed_information: (seed % 3 == 0).then(|| DMatrix::identity(p, p) * 0.3),
            ..DesignSettings::default()
        };
        for criterion in criteria(&l) {
            let (best, least) = brute_force(&candidates, &criterion, count, &settings);
            let found = exact(&candidates, &criterion, count, &settings).unwrap();
            assert!(
                found.value <= least * (1.0 + 1e-9),
                "{seed} {criterion:?}: {} of {:?} instead of {least} of {best:?}",
                found.value,
                found.postures,
            );
            if let (Some(bound), Some(efficiency)) = (found.bound, found.efficiency) {
                let free = continuous(&candidates, &criterion, count, &settings).unwrap();
                assert!(free.bound <= least * (1.0 + 1e-12) && bound <= least * (1.0 + 1e-12));
                assert!(free.gap <= 1e-9, "{seed} {criterion:?} {}", free.gap);
                assert!(efficiency > 0.0 && efficiency <= 1.0);
            }
        }
    }
}

#[test]
fn test_poses_do_not_depend_on_units_of_parameters() {
    let (candidates, l) = p10(5);
    let units = DMatrix::from_diagonal(&DVector::from_vec(vec![1e-6, 3e3, 1.0, 2e-9, 7e5]));
    let rescaled: Vec<DMatrix<f64>> = candidates.iter().map(|a| a * &units).collect();
    let l2 = Criterion::TestPoses(&units * &l * &units);
    let l = Criterion::TestPoses(l);
    let settings = DesignSettings::default();
    let (a, b) = (
        exact(&candidates, &l, 12, &settings).unwrap(),
        exact(&rescaled, &l2, 12, &settings).unwrap(),
    );
    assert_eq!(a.postures, b.postures);
    close(b.value, a.value, 1e-9);
    close(b.bound.unwrap(), a.bound.unwrap(), 1e-8);
    let (a, b) = (
        exact(&candidates, &Criterion::Determinant, 12, &settings).unwrap(),
        exact(&rescaled, &Criterion::Determinant, 12, &settings).unwrap(),
    );
    assert_eq!(a.postures, b.postures);
    close(
        b.value,
        a.value * units.determinant().powf(-2.0 / 5.0),
        1e-9,
    );
}

#[test]
fn repetition_divides_the_variance() {
    let candidates = p9();
    let set = [1, 13, 14];
    for criterion in criteria(&three_r_test_pose()) {
        let once = evaluate(&candidates, &set, &criterion, &with_repeats()).unwrap();
        for k in [2, 5] {
            let repeated =
                evaluate(&candidates, &set.repeat(k), &criterion, &with_repeats()).unwrap();
            close(repeated.value * k as f64, once.value, 1e-12);
            if let (Some(a), Some(b)) = (repeated.efficiency, once.efficiency) {
                close(a, b, 1e-8);
            }
        }
    }
}

#[test]
fn fixed_information_counts_as_measurements() {
    let candidates = p9();
    let earlier = candidates[4].tr_mul(&candidates[4]) + candidates[7].tr_mul(&candidates[7]);
    let settings = DesignSettings {
        fixed_information: Some(earlier),
        ..DesignSettings::default()
    };
    for criterion in criteria(&three_r_test_pose()) {
        let found = exact(&candidates, &criterion, 2, &settings).unwrap();
        let (best, least) = brute_force(&candidates, &criterion, 2, &settings);
        assert_eq!(found.postures, best);
        close(found.value, least, 1e-9);
        let mut all = found.postures.clone();
        all.extend([4, 7]);
        let together = evaluate(&candidates, &all, &criterion, &with_repeats()).unwrap();
        close(together.value, found.value, 1e-12);
    }
}

#[test]
fn equal_seeds_give_equal_designs() {
    let (candidates, l) = p10(5);
    for criterion in criteria(&l) {
        let settings = DesignSettings::default();
        assert_eq!(
            exact(&candidates, &criterion, 12, &settings).unwrap(),
            exact(&candidates, &criterion, 12, &settings).unwrap()
        );
    }
}

#[test]
fn no_exchange_improves_the_result() {
    // With 2 rows in 9 parameters no single posture identifies all of them.
    let candidates = random_candidates(8, 30, 2, 9);
    let test = random_candidates(9, 1, 12, 9).remove(0);
    for criterion in criteria(&test.tr_mul(&test)) {
        let found = exact(&candidates, &criterion, 7, &DesignSettings::default()).unwrap();
        for place in 0..7 {
            for x in (0..30).filter(|x| !found.postures.contains(x)) {
                let mut other = found.postures.clone();
                other[place] = x;
                let m = other.iter().fold(DMatrix::zeros(9, 9), |m, x| {
                    m + candidates[*x].tr_mul(&candidates[*x])
                });
                assert!(by_definition(&m, &criterion) >= found.value * (1.0 - 1e-8));
            }
        }
    }
}

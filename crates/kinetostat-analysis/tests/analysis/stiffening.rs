//! The cheapest stiffening: the rule against a search, and the machine that it makes.

use kinetostat_analysis::shares::stiffening::{factors, stiffen};
use kinetostat_model::Model;

use crate::shares::{off_axis, posture};

#[test]
fn no_other_factors_are_cheaper() {
    let (c, w) = ([5.0, 3.0, 1.0, 0.2, 0.0], [1.0, 2.0, 0.5, 1.0, 1.0]);
    let total = |k: &[f64]| c.iter().zip(k).map(|(c, k)| c / k).sum::<f64>();
    let cost = |k: &[f64]| w.iter().zip(k).map(|(w, k)| w * (k - 1.0)).sum::<f64>();
    for budget in [9.0, 7.0, 4.0, 1.0, 0.1] {
        let best = factors(&c, &w, budget).expect("possible");
        assert!((total(&best) - budget).abs() < 1e-12 && best.iter().all(|k| *k >= 1.0));
        // Exchanges between any two parts that keep the sum.
        let mut tried = 0;
        for i in 0..4 {
            for j in (0..4).filter(|&j| j != i) {
                for by in [0.999, 0.99, 0.9, 1.01, 1.1] {
                    let mut other = best.clone();
                    other[i] *= by;
                    let left = budget - total(&other) + c[j] / other[j];
                    other[j] = c[j] / left;
                    if left > 0.0 && other.iter().all(|k| *k >= 1.0) {
                        assert!(cost(&other) >= cost(&best) - 1e-12, "{budget} {i} {j} {by}");
                        tried += 1;
                    }
                }
            }
        }
        assert!(tried >= 3, "{budget}: {tried}");
    }
    assert_eq!(factors(&c, &w, 20.0), Some(vec![1.0; 5]), "nothing to do");
    let fixed = [f64::INFINITY, 1.0, 1.0, 1.0, 1.0];
    assert_eq!(
        factors(&c, &fixed, 4.9),
        None,
        "the part that cannot be changed gives 5"
    );
}

#[test]
fn the_stiffened_machine_meets_the_target() {
    for name in ["heavy_6r", "orthoglide", "hexapod"] {
        let posture = posture(&Model::preset(name).expect(name));
        let found = stiffen(&posture, &off_axis(), 0.7, |_| 1.0)
            .expect(name)
            .expect(name);
        assert!(
            (found.after / found.before - 0.7).abs() < 1e-8,
            "{name}: {}",
            found.after / found.before
        );
        assert!(found.cost > 0.0 && !found.parts.is_empty(), "{name}");
        assert!(
            (found.promised / found.before - 0.7).abs() < 1e-12,
            "{name}"
        );
    }
}

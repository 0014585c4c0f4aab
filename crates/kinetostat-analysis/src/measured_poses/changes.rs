//! All small changes that are tried: signs, quarter turns, couplings.

use crate::measured_poses::explanation::{Axis, Coupling, Explanation};

/// Signs, offsets by quarter turns, couplings and their combinations, without numbers to be fitted.
pub(crate) fn changes(axes: &[Axis], quick: bool) -> Vec<Explanation> {
    let count = axes.len();
    let most_signs = match (quick, count) {
        (true, ..=8) => count,
        (true, _) => 2,
        (false, _) => 1,
    };
    let mut signs: Vec<Vec<usize>> = vec![Vec::new()];
    for axis in 0..count {
        let longer: Vec<Vec<usize>> = signs
            .iter()
            .filter(|s| s.len() < most_signs)
            .map(|s| s.iter().copied().chain([axis]).collect())
            .collect();
        signs.extend(longer);
    }
    let quarter = std::f64::consts::FRAC_PI_2;
    let single: Vec<(usize, f64)> = (0..count)
        .filter(|&i| axes[i].turns)
        .flat_map(|i| [1.0, -1.0, 2.0].map(|n| (i, n * quarter)))
        .collect();
    let mut extras = vec![Explanation::default()];
    extras.extend(single.iter().map(|&o| Explanation {
        offsets: vec![o],
        ..Explanation::default()
    }));
    if quick {
        for (k, &a) in single.iter().enumerate() {
            extras.extend(
                single[k + 1..]
                    .iter()
                    .filter(|b| b.0 != a.0)
                    .map(|&b| Explanation {
                        offsets: vec![a, b],
                        ..Explanation::default()
                    }),
            );
        }
    }
    let mut couplings = Vec::new();
    for (axis, own) in axes.iter().enumerate() {
        for (other, theirs) in axes.iter().enumerate() {
            if own.coupled.iter().any(|c| c.0 == other) {
                couplings.push(Coupling::Reversed { axis, other });
                couplings.push(Coupling::Absent { axis, other });
            } else if other != axis && own.turns == theirs.turns {
                couplings.extend([1.0, -1.0].map(|share| Coupling::Missing { axis, other, share }));
            }
        }
    }
    extras.extend(couplings.into_iter().map(|c| Explanation {
        coupling: Some(c),
        ..Explanation::default()
    }));
    let mut all = Vec::new();
    for reversed in signs {
        for extra in &extras {
            if !quick && !reversed.is_empty() && extra.cost() > 0 {
                continue;
            }
            all.push(Explanation {
                reversed: reversed.clone(),
                ..extra.clone()
            });
        }
    }
    all
}

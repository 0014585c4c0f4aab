//! The cheapest stiffening for a target.
//!
//! A part `j` that becomes `k_j >= 1` times as stiff gives `c_j / k_j` of the compliance instead of `c_j`. What costs
//! `w_j (k_j - 1)` is least, for a wanted compliance, where the parts that are stiffened at all have `k_j = sqrt(c_j / (w_j m))`, with one
//! number `m` for all of them: a convex problem, solved exactly by sorting.
//!
//! **Its assumption:** the load goes the same way through the machine as before. That is exact for serial machines without load;
//! in a parallel machine the stiffened parts attract load, so that the answer is checked by the machine with the stiffened springs, and
//! corrected by the shares found there, until the target is met.

use kinetostat::{Posture, PostureRequest, Wrench};

use super::{Part, Shares, SharesError};

/// A part that is stiffened.
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffened {
    /// The part as it was.
    pub part: Part,
    /// Factor of the stiffness.
    pub factor: f64,
}

/// The cheapest stiffening.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stiffening {
    /// Parts that are stiffened, the most first.
    pub parts: Vec<Stiffened>,
    /// Sum of `weight (factor - 1)`.
    pub cost: f64,
    /// Compliance before, as the shares have it, and by the machine with the stiffened springs.
    pub before: f64,
    /// See `before`.
    pub after: f64,
    /// Compliance that the plain rule (the load goes the same way) had promised.
    pub promised: f64,
}

/// Factors for every part by the rule above; `None` where the target is beyond what these parts can give. `c` and `w` are
/// compliances and weights, `budget` the sum that `c_j / k_j` must come down to.
#[must_use]
pub fn factors(c: &[f64], w: &[f64], budget: f64) -> Option<Vec<f64>> {
    let useful = |j: usize| c[j] > 0.0 && w[j].is_finite() && w[j] > 0.0;
    let rest: f64 = (0..c.len()).filter(|&j| !useful(j)).map(|j| c[j]).sum();
    let mut order: Vec<usize> = (0..c.len()).filter(|&j| useful(j)).collect();
    order.sort_by(|&a, &b| (c[b] / w[b]).total_cmp(&(c[a] / w[a])));
    let mut left = budget - rest;
    let all: f64 = order.iter().map(|&j| c[j]).sum();
    if all <= left {
        return Some(vec![1.0; c.len()]);
    }
    // The parts stiffened are the first of the order: the fewest for which no further one would pay.
    left -= all;
    let mut roots = 0.0;
    for (count, &j) in order.iter().enumerate() {
        left += c[j];
        roots += (c[j] * w[j]).sqrt();
        // sum sqrt(c w m) over the stiffened = what is left for them.
        if left <= 0.0 {
            continue;
        }
        let m = (left / roots).powi(2);
        let next = order.get(count + 1).map_or(0.0, |&k| c[k] / w[k]);
        if m >= next {
            let mut found = vec![1.0; c.len()];
            for &k in &order[..=count] {
                found[k] = (c[k] / (w[k] * m)).sqrt().max(1.0);
            }
            return Some(found);
        }
    }
    None
}

/// The cheapest way to `target` times the compliance (below 1) in a direction of the unloaded machine as drawn; `weight` is
/// the price of a part's relative stiffening, 1 for all alike, infinite for what cannot be changed.
///
/// # Errors
/// As [`Shares::unloaded`]. `None` where no stiffening of these parts is enough.
pub fn stiffen(
    posture: &Posture,
    direction: &Wrench,
    target: f64,
    weight: impl Fn(&Part) -> f64,
) -> Result<Option<Stiffening>, SharesError> {
    let before = Shares::unloaded(posture, direction)?;
    let wanted = before.compliance * target;
    let parts: Vec<Part> = before
        .parts
        .iter()
        .filter(|p| p.kind.is_elastic())
        .cloned()
        .collect();
    let weights: Vec<f64> = parts.iter().map(&weight).collect();
    let mut effective: Vec<f64> = parts.iter().map(|p| p.compliance).collect();
    let mut promised = None;
    let mut last = None;
    for _ in 0..ROUNDS {
        let Some(found) = factors(&effective, &weights, wanted) else {
            return Ok(None);
        };
        promised.get_or_insert_with(|| {
            let own = effective.iter().zip(&found);
            own.map(|(c, k)| c / k).sum::<f64>()
        });
        let springs: Vec<(usize, usize, f64)> = (parts.iter().zip(&found))
            .flat_map(|(p, k)| p.springs.iter().map(|&(limb, spring)| (limb, spring, *k)))
            .collect();
        let stiffer = posture.mechanism().with_springs_scaled(&springs);
        let joints = PostureRequest::joints(posture.target(), posture.limbs().to_vec());
        let stands = stiffer.posture(joints).map_err(|_| SharesError::Singular)?;
        let after = Shares::unloaded(&stands, direction)?;
        let now: Vec<f64> = (after.parts.iter())
            .filter(|p| p.kind.is_elastic())
            .map(|p| p.compliance)
            .collect();
        let met = (after.compliance / wanted - 1.0).abs() < 1e-9;
        // Contribution of each part at its old stiffness, along the present path of the load.
        for ((c, own), k) in effective.iter_mut().zip(now).zip(&found) {
            *c = own * k;
        }
        last = Some((found, after.compliance));
        if met {
            break;
        }
    }
    let Some((found, after)) = last else {
        return Ok(None);
    };
    let cost = (weights.iter().zip(&found))
        .filter(|(_, k)| **k > 1.0)
        .map(|(w, k)| w * (k - 1.0));
    let cost = cost.sum();
    let mut stiffened: Vec<Stiffened> = (parts.into_iter().zip(found))
        .filter(|(_, k)| *k > 1.0)
        .map(|(part, factor)| Stiffened { part, factor })
        .collect();
    stiffened.sort_by(|a, b| b.factor.total_cmp(&a.factor));
    Ok(Some(Stiffening {
        parts: stiffened,
        cost,
        before: before.compliance,
        after,
        promised: promised.unwrap_or(wanted),
    }))
}

/// Maximum number of corrections by the shares of the stiffened machine.
const ROUNDS: usize = 60;

//! Several starts of the exchange algorithm.

use nalgebra::{DMatrix, DVector};

use super::DesignSettings;
use super::error::DesignError;
use super::exchange::Exchange;
use super::linalg::pack;
use super::problem::Problem;

/// Information that regularises incomplete sets, relative to the mean candidate.
const REGULAR: f64 = 1e-6;

/// Efficiency at which further starts are useless.
const OPTIMAL: f64 = 1.0 - 1e-9;

/// Best set of postures over all starts, in ascending order, with its value.
///
/// `weights` of a continuous design guide the starts; `bound` ends them early.
pub(super) fn search(
    problem: &Problem,
    weights: &[f64],
    bound: Option<f64>,
    settings: &DesignSettings,
) -> Result<(Vec<usize>, f64), DesignError> {
    let (p, n) = (problem.parameters, problem.rows.len());
    let mut identity = DVector::zeros(problem.fixed.len());
    pack(&DMatrix::identity(p, p), 1.0, identity.as_mut_slice());
    let regular = &problem.fixed + identity * (REGULAR / n as f64);
    let mut exchange = Exchange::new(problem);
    let mut random = SplitMix64(settings.seed);
    let mut best: Option<(Vec<usize>, f64)> = None;
    let mut largest_rank = 0;
    let mut singular = Vec::new();
    for start in 0..settings.starts.max(1) {
        let mut chosen = match start {
            0 => Vec::new(),
            1 => rounded(weights, problem.count, settings.repeats),
            _ => drawn(weights, problem.count, settings.repeats, &mut random),
        };
        exchange.complete(&regular, &mut chosen);
        if exchange.value(&problem.fixed, &chosen).is_none() {
            // The regularised criterion drives the set towards full rank.
            exchange.improve(&regular, &mut chosen);
        }
        let Some(value) = exchange.improve(&problem.fixed, &mut chosen) else {
            let rank = problem.rank(&chosen);
            if rank >= largest_rank {
                (largest_rank, singular) = (rank, chosen);
            }
            continue;
        };
        if best.as_ref().is_none_or(|(_, v)| value < *v) {
            best = Some((chosen, value));
        }
        if bound.is_some_and(|b| b >= OPTIMAL * value) {
            break;
        }
    }
    let (mut postures, value) = best.ok_or_else(|| problem.too_few_observations(&singular))?;
    postures.sort_unstable();
    // Independent of the order in which the postures were found.
    let value = exchange.value(&problem.fixed, &postures).unwrap_or(value);
    Ok((postures, value))
}

/// Whole parts of the weights times the number of postures, the most weighted ones first.
fn rounded(weights: &[f64], count: usize, repeats: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|a, b| weights[*b].total_cmp(&weights[*a]).then(a.cmp(b)));
    let mut chosen = Vec::with_capacity(count);
    for x in order {
        let share = (weights[x] * count as f64).round() as usize;
        let most = if repeats { share } else { share.min(1) };
        chosen.extend(std::iter::repeat_n(x, most));
    }
    chosen.truncate(count);
    chosen
}

/// Random set: each posture is drawn by the weights or, equally often, from all candidates.
fn drawn(weights: &[f64], count: usize, repeats: bool, random: &mut SplitMix64) -> Vec<usize> {
    let n = weights.len();
    let mut taken = vec![false; n];
    let mut chosen = Vec::with_capacity(count);
    while chosen.len() < count {
        let by_weight = random.uniform() < 0.5;
        let u = random.uniform();
        let mut x = if by_weight {
            let mut sum = 0.0;
            let reached = |w: &f64| {
                sum += w;
                sum > u
            };
            weights.iter().position(reached).unwrap_or(n - 1)
        } else {
            ((u * n as f64) as usize).min(n - 1)
        };
        if !repeats {
            // The caller has checked that there are enough candidates.
            while taken[x] {
                x = (x + 1) % n;
            }
            taken[x] = true;
        }
        chosen.push(x);
    }
    chosen
}

/// Generator of Steele, Lea and Flood (Fast splittable pseudorandom number generators, 2014).
struct SplitMix64(u64);

impl SplitMix64 {
    /// Uniform in `[0, 1)`.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 53) as f64
    }
}

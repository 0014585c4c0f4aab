//! Optimal continuous design: multiplicative updates, then Newton's method on the candidates that remain.

use nalgebra::DVector;

use super::error::DesignError;
use super::mixture::{Iterate, Mixture, distribute};
use super::objective::{Objective, Scratch};
use super::problem::Problem;

/// Multiplicative updates at most; their convergence slows down near the optimum.
const UPDATES: usize = 200;

/// Relative gap at which Newton's method takes over.
const ROUGH: f64 = 0.02;

/// Steps of Newton's method at most.
const STEPS: usize = 200;

/// Weights with the certificate of their value.
pub(super) struct Solution {
    pub(super) weights: Vec<f64>,
    pub(super) value: f64,
    /// Certified lower bound of the value of every design, divided by the value of this one.
    pub(super) ratio: f64,
}

/// Minimises a linear criterion or the determinant until the certified relative gap is at most `gap` or rounding stops it.
pub(super) fn optimise(problem: &Problem, gap: f64) -> Result<Solution, DesignError> {
    let n = problem.rows.len();
    let mixture = Mixture::new(problem, gap);
    let all = || problem.too_few_observations(&(0..n).collect::<Vec<_>>());
    let mut now = mixture
        .at(DVector::from_element(n, 1.0 / n as f64))
        .ok_or_else(all)?;
    // Powers of the multiplicative update: Torsney (1983) for linear criteria, Titterington (1976) for the determinant.
    let square_root = matches!(problem.objective, Objective::Linear(_));
    for _ in 0..UPDATES {
        if now.gap() <= gap.max(ROUGH) {
            break;
        }
        let mut weights = now.weights.clone();
        for (w, d) in weights.iter_mut().zip(now.sensitivities.iter()) {
            // Rounding makes the sensitivity of an almost empty candidate negative.
            let d = d.max(0.0);
            *w *= if square_root { d.sqrt() } else { d };
        }
        distribute(&mut weights, mixture.cap);
        match mixture.at(weights) {
            Some(next) => now = next,
            None => break,
        }
    }
    if now.gap() > gap {
        now = mixture.thinned(now);
    }
    let mut best: Option<Iterate> = None;
    let mut scratch = Scratch::new(problem);
    for _ in 0..STEPS {
        if now.gap() <= gap {
            break;
        }
        let Some(weights) = mixture.newton(&now, gap, &mut scratch) else {
            break;
        };
        let Some(next) = mixture.at(weights) else {
            break;
        };
        let last = std::mem::replace(&mut now, next);
        if best.as_ref().is_none_or(|b| last.ratio > b.ratio) {
            best = Some(last);
        }
    }
    if let Some(b) = best
        && b.ratio > now.ratio
    {
        now = b;
    }
    let equal = mixture.uniform / n as f64;
    let share = |w: &f64| equal + (1.0 - mixture.uniform) * w;
    Ok(Solution {
        weights: now.weights.iter().map(share).collect(),
        value: now.state.value,
        ratio: now.ratio,
    })
}

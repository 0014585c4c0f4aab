//! Optimal continuous design by a primal-dual interior-point method.

use nalgebra::{DMatrix, DVector};

use super::error::DesignError;
use super::objective::{Objective, State};
use super::problem::Problem;

/// Newton steps at most.
const STEPS: usize = 100;

/// Steps without a smaller gap after which rounding has stopped the iteration.
const IDLE_STEPS: usize = 5;

/// Factor by which a step aims to reduce the complementarity.
const REDUCTION: f64 = 0.1;

/// Fraction of the way to the boundary that a step may use.
const TO_BOUNDARY: f64 = 0.95;

/// Refinements of the solution of a linear system.
const REFINEMENTS: usize = 2;

/// Weights with the certificate of their value.
pub(super) struct Solution {
    pub(super) weights: Vec<f64>,
    pub(super) value: f64,
    /// Certified lower bound of the value of every design, divided by the value of this one.
    pub(super) ratio: f64,
}

/// Minimises a linear criterion or the determinant until the certified relative gap is at most `gap` or rounding stops it.
///
/// Unknowns are the observations `t_x` of each candidate, between zero and `limit`; their sum is the number of postures. The
/// Lagrangian with the multipliers `lower` and `upper` of the limits is linearised, as in Wright (Primal-Dual Interior-Point
/// Methods, 1997). Only the certificate decides on the result: it holds for all weights.
pub(super) fn optimise(problem: &Problem, gap: f64) -> Result<Solution, DesignError> {
    let (n, count) = (problem.rows.len(), problem.count as f64);
    let limit = if problem.repeats { f64::INFINITY } else { 1.0 };
    let mut t = DVector::from_element(n, count / n as f64);
    // Sensitivities are divided by the mass: those of the optimum are of the order of one by the number of postures.
    let mut lower = t.map(|t| 1.0 / (n as f64 * t));
    let mut upper = t.map(|t| 1.0 / (n as f64 * (limit - t)));
    let mut best: Option<Solution> = None;
    let mut idle = 0;
    for _ in 0..STEPS {
        let Some(state) = problem
            .objective
            .state(problem.weighted(&problem.fixed, &t))
        else {
            break;
        };
        let sensitivities = problem.sensitivities(&state.solution);
        let fixed = (&problem.fixed * &state.solution).dot(&state.solution);
        // Rounding may exceed one by some units in the last place.
        let ratio = (state.mass / (fixed + largest_sum(problem, &sensitivities))).min(1.0);
        idle += 1;
        if best.as_ref().is_none_or(|b| ratio > b.ratio) {
            idle = 0;
            best = Some(Solution {
                weights: t.iter().map(|t| t / count).collect(),
                value: state.value,
                ratio,
            });
        }
        // All candidates are chosen: there is nothing to distribute.
        let is_full = t.iter().all(|t| *t >= limit);
        if 1.0 / ratio - 1.0 <= gap || idle > IDLE_STEPS || is_full {
            break;
        }
        let slack = t.map(|t| limit - t);
        let mut complementarity = lower.dot(&t);
        let mut bounds = n;
        if limit.is_finite() {
            complementarity += upper.dot(&slack);
            bounds *= 2;
        }
        let target = REDUCTION * complementarity / bounds as f64;
        let barrier = t.map(|t| target / t) - slack.map(|s| target / s);
        let diagonal = lower.component_div(&t) + upper.component_div(&slack);
        let right = sensitivities / state.mass + barrier;
        let Some(step) = newton_step(problem, &state, &diagonal, &right) else {
            break;
        };
        let lower_step =
            t.map(|t| target / t) - &lower - lower.component_div(&t).component_mul(&step);
        let upper_step =
            slack.map(|s| target / s) - &upper + upper.component_div(&slack).component_mul(&step);
        let primal = longest_step(&t, &step).min(longest_step(&slack, &-&step));
        let dual = longest_step(&lower, &lower_step).min(longest_step(&upper, &upper_step));
        t += step * primal;
        // The sum must not drift by rounding.
        t *= count / t.sum();
        lower += lower_step * dual;
        upper += upper_step * dual;
    }
    best.ok_or_else(|| problem.too_few_observations(problem.rank(&(0..n).collect::<Vec<_>>())))
}

/// Largest sum of the sensitivities that an admissible exact design can have.
fn largest_sum(problem: &Problem, sensitivities: &DVector<f64>) -> f64 {
    if problem.repeats {
        return problem.count as f64 * sensitivities.max();
    }
    let mut sorted = sensitivities.as_slice().to_vec();
    sorted.sort_unstable_by(|a, b| b.total_cmp(a));
    sorted.iter().take(problem.count).sum()
}

/// Longest step, at most one, that keeps all numbers positive.
fn longest_step(from: &DVector<f64>, step: &DVector<f64>) -> f64 {
    let reach = from.zip_map(step, |x, d| if d < 0.0 { -x / d } else { f64::INFINITY });
    (TO_BOUNDARY * reach.min()).min(1.0)
}

/// Solution of `(H + diagonal) step + multiplier = right` with the sum zero, `H` the second derivative by the mass.
///
/// `H = V^T V` with the columns `V_x = c L^-1 A_x^T A_x S`, `c^2 = 2 / mass` for linear criteria and `1 / mass` for the logarithm
/// of the determinant.
fn newton_step(
    problem: &Problem,
    state: &State,
    diagonal: &DVector<f64>,
    right: &DVector<f64>,
) -> Option<DVector<f64>> {
    let n = problem.rows.len();
    let c = match problem.objective {
        Objective::Linear(_) => (2.0 / state.mass).sqrt(),
        _ => state.mass.powf(-0.5),
    };
    let scale = diagonal.map(|d| 1.0 / d.sqrt());
    let size = state.solution.len();
    let mut v = DMatrix::zeros(size, n);
    for (x, rows) in problem.rows.iter().enumerate() {
        let left = state.factor.solve_lower_triangular(&rows.transpose())?;
        let product = left * (rows * &state.solution) * (c * scale[x]);
        v.column_mut(x).copy_from_slice(product.as_slice());
    }
    // With a unit diagonal: (I + V^T V)^-1, or I - V^T (I + V V^T)^-1 V where that is smaller.
    let square = if size < n {
        &v * v.transpose()
    } else {
        v.transpose() * &v
    };
    let inner = (DMatrix::identity(square.nrows(), square.nrows()) + square).cholesky()?;
    let solve = |b: DMatrix<f64>| match size < n {
        true => &b - v.tr_mul(&inner.solve(&(&v * &b))),
        false => inner.solve(&b),
    };
    let both = DMatrix::from_columns(&[right.component_mul(&scale), scale.clone()]);
    let mut solved = solve(both.clone());
    // The difference cancels digits where weights tend to a positive limit; refinement restores them.
    for _ in 0..REFINEMENTS {
        solved += solve(&both - &solved - v.tr_mul(&(&v * &solved)));
    }
    let column = |k: usize| solved.column(k).component_mul(&scale);
    let (a, b) = (column(0), column(1));
    let step = &a - &b * (a.sum() / b.sum());
    step.iter().all(|x| x.is_finite()).then_some(step)
}

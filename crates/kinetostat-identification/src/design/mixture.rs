//! Information as a function of the weights, its certificate and the steps of Newton's method.

use nalgebra::{DMatrix, DVector};

use super::linalg::{pack, packed_len};
use super::objective::{Objective, Scratch, State};
use super::problem::Problem;
use super::quadratic::minimise_on_simplex;

/// Information `base + scale * sum w_x H_x` as a function of the weights, whose sum is one.
pub(super) struct Mixture<'a> {
    problem: &'a Problem,
    base: DVector<f64>,
    scale: f64,
    /// Share of the observations that all candidates receive equally.
    pub(super) uniform: f64,
    /// Largest weight of a candidate.
    pub(super) cap: f64,
}

/// Weights with the state of the criterion and the sensitivities there.
pub(super) struct Iterate {
    pub(super) weights: DVector<f64>,
    pub(super) state: State,
    /// Sensitivity `d_x` of each candidate.
    pub(super) sensitivities: DVector<f64>,
    pub(super) ratio: f64,
}

impl Iterate {
    pub(super) fn gap(&self) -> f64 {
        1.0 / self.ratio - 1.0
    }
}

impl<'a> Mixture<'a> {
    pub(super) fn new(problem: &'a Problem, gap: f64) -> Self {
        let (p, n) = (problem.parameters, problem.rows.len());
        let count = problem.count as f64;
        // With fewer test directions than parameters the optimum may be singular. A small equal share of all candidates keeps the
        // information regular, at a cost in the certified gap of about that share.
        let deficient = matches!(&problem.objective, Objective::Linear(b) if b.ncols() < p);
        let uniform = if deficient {
            (0.1 * gap).max(1e-10)
        } else {
            0.0
        };
        // The information of all candidates together is I - M_0.
        let mut base = problem.fixed.clone();
        if uniform > 0.0 {
            let mut identity = DVector::zeros(packed_len(p));
            pack(&DMatrix::identity(p, p), 1.0, identity.as_mut_slice());
            base += (identity - &problem.fixed) * (uniform * count / n as f64);
        }
        Self {
            problem,
            base,
            scale: count * (1.0 - uniform),
            uniform,
            cap: if problem.repeats { 1.0 } else { 1.0 / count },
        }
    }

    fn information(&self, weights: &DVector<f64>) -> DVector<f64> {
        let mut packed = self.base.clone();
        packed.gemv(self.scale, &self.problem.information, weights, 1.0);
        packed
    }

    /// State at given weights with the certificate; `None` if the information is singular.
    pub(super) fn at(&self, weights: DVector<f64>) -> Option<Iterate> {
        let problem = self.problem;
        let state = problem.state(&self.information(&weights))?;
        let mut gradient = DVector::zeros(problem.fixed.len());
        pack(&state.gradient, 2.0, gradient.as_mut_slice());
        let sensitivities = problem.information.tr_mul(&gradient);
        let fixed = problem.fixed.dot(&gradient);
        let largest = fixed + self.largest_sum(&sensitivities);
        // Rounding may exceed one by some units in the last place.
        let ratio = (state.mass / largest).min(1.0);
        ratio.is_finite().then_some(Iterate {
            weights,
            state,
            sensitivities,
            ratio,
        })
    }

    /// Largest sum of the sensitivities that an admissible exact design can have.
    fn largest_sum(&self, sensitivities: &DVector<f64>) -> f64 {
        let count = self.problem.count;
        if self.problem.repeats || count == 1 {
            return count as f64 * sensitivities.max();
        }
        let mut sorted = sensitivities.as_slice().to_vec();
        sorted.sort_unstable_by(|a, b| b.total_cmp(a));
        sorted.iter().take(count).sum()
    }

    /// Removes candidates that the multiplicative updates have left with little weight. Newton's method takes them up again where
    /// that was wrong.
    pub(super) fn thinned(&self, now: Iterate) -> Iterate {
        let cut = 0.02 * now.weights.max();
        let mut weights = now.weights.map(|w| if w < cut { 0.0 } else { w });
        let kept = weights.iter().filter(|w| **w > 0.0).count();
        if !self.problem.repeats && kept < self.problem.count {
            return now;
        }
        distribute(&mut weights, self.cap);
        match self.at(weights) {
            Some(next) if next.state.value < 1.5 * now.state.value => next,
            _ => now,
        }
    }

    /// Step of Newton's method on the candidates with weight and those that violate the optimality condition most.
    pub(super) fn newton(
        &self,
        now: &Iterate,
        gap: f64,
        scratch: &mut Scratch,
    ) -> Option<DVector<f64>> {
        let problem = self.problem;
        let live = self.live(now, gap);
        // In units of the mass, and with sensitivities per unit of weight.
        let scale = self.scale / now.state.mass;
        let hessian = self.hessian(now, &live);
        let start = DVector::from_iterator(live.len(), live.iter().map(|x| now.weights[*x]));
        let gradient = DVector::from_iterator(
            live.len(),
            live.iter().map(|x| -scale * now.sensitivities[*x]),
        );
        let target = minimise_on_simplex(hessian, &gradient, &start, self.cap)?;
        let mut step = DVector::zeros(now.weights.len());
        for (x, (t, s)) in live.iter().zip(target.iter().zip(start.iter())) {
            step[*x] = t - s;
        }
        let from = self.information(&now.weights);
        let mut along = DVector::zeros(from.len());
        along.gemv(self.scale, &problem.information, &step, 0.0);
        let mut length = 1.0;
        for _ in 0..40 {
            let there = &from + &along * length;
            // Rounding of the value must not reject the last steps.
            let most = now.state.value * (1.0 + 1e-13);
            if problem
                .value(there.as_slice(), scratch)
                .is_some_and(|v| v <= most)
            {
                let mut weights = &now.weights + &step * length;
                // The step keeps the sum; rounding may leave the limits.
                weights.apply(|w| *w = w.clamp(0.0, self.cap));
                return Some(weights);
            }
            length *= 0.5;
        }
        None
    }

    /// Candidates that a step of Newton's method may change.
    fn live(&self, now: &Iterate, gap: f64) -> Vec<usize> {
        let n = now.weights.len();
        let mut live: Vec<usize> = (0..n).filter(|x| now.weights[*x] > 0.0).collect();
        // Below the cap the sensitivities are equal at the optimum.
        let inner = live
            .iter()
            .filter(|x| now.weights[**x] < self.cap * (1.0 - 1e-9));
        let lowest = inner
            .map(|x| now.sensitivities[*x])
            .fold(f64::INFINITY, f64::min);
        let mean = now.weights.dot(&now.sensitivities).min(lowest);
        let mut violating: Vec<usize> = (0..n)
            .filter(|x| now.weights[*x] <= 0.0 && now.sensitivities[*x] > mean * (1.0 - gap))
            .collect();
        let d = &now.sensitivities;
        violating.sort_by(|a, b| d[*b].total_cmp(&d[*a]).then(a.cmp(b)));
        violating.truncate(2 * self.problem.parameters + 20);
        live.extend(violating);
        live
    }

    /// Second derivatives by the weights of some candidates, in units of the mass:
    /// `c trace(G H_x M^-1 H_y)`, `c = 2` for linear criteria and 1 for the logarithm of the determinant.
    fn hessian(&self, now: &Iterate, live: &[usize]) -> DMatrix<f64> {
        let problem = self.problem;
        let p = problem.parameters;
        let factor = match problem.objective {
            Objective::Linear(_) => 2.0,
            _ => 1.0,
        };
        let factor = factor * self.scale * self.scale / now.state.mass;
        let length = packed_len(p);
        let mut columns = DMatrix::zeros(length, live.len());
        let mut derivatives = DMatrix::zeros(length, live.len());
        let rows = problem.rows.first().map_or(0, DMatrix::ncols);
        let (mut left, mut right) = (DMatrix::zeros(p, rows), DMatrix::zeros(p, rows));
        let mut product = DMatrix::zeros(p, p);
        for (k, x) in live.iter().enumerate() {
            columns
                .column_mut(k)
                .copy_from(&problem.information.column(*x));
            now.state.gradient.mul_to(&problem.rows[*x], &mut left);
            now.state.inverse.mul_to(&problem.rows[*x], &mut right);
            product.gemm(1.0, &left, &right.transpose(), 0.0);
            product.gemm(1.0, &right, &left.transpose(), 1.0);
            product *= 0.5;
            pack(&product, 2.0, derivatives.column_mut(k).as_mut_slice());
        }
        columns.tr_mul(&derivatives) * factor
    }
}

/// Scales weights to the sum one and limits each to `cap`, with more than one over `cap` positive ones.
pub(super) fn distribute(weights: &mut DVector<f64>, cap: f64) {
    let mut capped = vec![false; weights.len()];
    loop {
        let (mut rest, mut sum) = (1.0, 0.0);
        for (w, c) in weights.iter().zip(&capped) {
            if *c {
                rest -= cap;
            } else {
                sum += w;
            }
        }
        let factor = if sum > 0.0 {
            (rest / sum).max(0.0)
        } else {
            0.0
        };
        let mut changed = false;
        for (w, c) in weights.iter_mut().zip(&mut capped) {
            if !*c {
                *w *= factor;
                if *w > cap {
                    (*w, *c, changed) = (cap, true, true);
                }
            }
        }
        if !changed {
            return;
        }
    }
}

//! Convex quadratic program on the simplex with an upper limit of each coordinate, by an active set.

use nalgebra::{DMatrix, DVector};

use super::linalg::{factor, solve_lower, solve_lower_transposed};

/// Proximal term relative to the largest curvature. It makes the solution unique where several candidates have the same information,
/// and vanishes when the iteration of the caller converges.
const PROXIMAL: f64 = 1e-11;

/// Minimises `g^T (v - w) + (v - w)^T H (v - w) / 2` for `0 <= v <= cap` with the sum of `w`, which is a feasible start.
///
/// `H` is symmetric and positive semidefinite. The working set changes as in the non-negative least squares of Lawson and Hanson
/// (Solving Least Squares Problems, 1974). `None` if rounding prevents a solution.
pub(super) fn minimise_on_simplex(
    mut h: DMatrix<f64>,
    g: &DVector<f64>,
    w: &DVector<f64>,
    cap: f64,
) -> Option<DVector<f64>> {
    let n = w.len();
    let ridge = PROXIMAL * h.diagonal().max() + f64::MIN_POSITIVE;
    for i in 0..n {
        h[(i, i)] += ridge;
    }
    let mut v = w.clone();
    let mut slope = g.clone();
    let mut free: Vec<usize> = (0..n).filter(|i| v[*i] > 0.0).collect();
    // Each pass adds or removes a coordinate; cycling by rounding ends at a feasible point that is a descent direction still.
    for _ in 0..20 * n + 20 {
        let step = equality_step(&h, &slope, &free)?;
        // Share of the step at which a coordinate reaches zero or the cap.
        let reach = |i: usize, d: f64| {
            if v[i] + d <= 0.0 {
                v[i] / -d
            } else if v[i] + d > cap {
                (cap - v[i]).max(0.0) / d
            } else {
                1.0
            }
        };
        let reached: Vec<f64> = free.iter().zip(&step).map(|(i, d)| reach(*i, *d)).collect();
        let share = reached.iter().copied().fold(1.0, f64::min);
        let mut kept = Vec::with_capacity(free.len());
        for ((i, d), r) in free.iter().zip(&step).zip(&reached) {
            if share < 1.0 && *r <= share * (1.0 + 1e-12) {
                v[*i] = if *d < 0.0 { 0.0 } else { cap };
            } else {
                v[*i] += share * d;
                kept.push(*i);
            }
        }
        free = kept;
        slope = &h * (&v - w) + g;
        if share >= 1.0 || free.is_empty() {
            match entering(&slope, &v, &free) {
                Some(i) => free.push(i),
                None => return Some(v),
            }
        }
    }
    Some(v)
}

/// Step of the free coordinates to the minimum with an unchanged sum.
fn equality_step(h: &DMatrix<f64>, slope: &DVector<f64>, free: &[usize]) -> Option<Vec<f64>> {
    let k = free.len();
    if k == 0 {
        return Some(Vec::new());
    }
    let mut lower = DMatrix::from_fn(k, k, |i, j| h[(free[i], free[j])]);
    if !factor(&mut lower) {
        return None;
    }
    // The slope without its mean: the multiplier of the sum is computed for the rest, which is small near the solution.
    let mean = free.iter().map(|i| slope[*i]).sum::<f64>() / k as f64;
    let side = |i: usize, j: usize| if j == 0 { mean - slope[free[i]] } else { 1.0 };
    let mut both = DMatrix::from_fn(k, 2, side);
    solve_lower(&lower, &mut both);
    solve_lower_transposed(&lower, &mut both);
    let multiplier = -both.column(0).sum() / both.column(1).sum();
    let mut step = both.column(0) + both.column(1) * multiplier;
    // The sum of the weights must not drift where the matrix is nearly singular.
    step.add_scalar_mut(-step.sum() / k as f64);
    step.iter()
        .all(|x| x.is_finite())
        .then(|| step.as_slice().to_vec())
}

/// Coordinate at zero or at the cap that violates the optimality conditions most.
fn entering(slope: &DVector<f64>, v: &DVector<f64>, free: &[usize]) -> Option<usize> {
    let n = v.len();
    let mut bound = vec![true; n];
    for i in free {
        bound[*i] = false;
    }
    let at_bound = || (0..n).filter(|i| bound[*i]);
    let multiplier = if free.is_empty() {
        let lowest = at_bound().filter(|i| v[*i] <= 0.0).map(|i| slope[i]);
        let highest = at_bound().filter(|i| v[*i] > 0.0).map(|i| slope[i]);
        0.5 * (lowest.fold(f64::MAX, f64::min) + highest.fold(f64::MIN, f64::max))
    } else {
        free.iter().map(|i| slope[*i]).sum::<f64>() / free.len() as f64
    };
    let violation = |i: usize| {
        if v[i] <= 0.0 {
            multiplier - slope[i]
        } else {
            slope[i] - multiplier
        }
    };
    let tolerance = 1e-13 * slope.amax();
    at_bound()
        .filter(|i| violation(*i) > tolerance)
        .max_by(|a, b| violation(*a).total_cmp(&violation(*b)))
}

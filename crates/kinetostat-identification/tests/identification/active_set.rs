//! Non-negative least squares by the active-set method of Lawson and Hanson (1974), as an independent reference.

use kinetostat_testing::largest;
use nalgebra::{DMatrix, DVector};

/// Minimiser of `|A x - y|` with `x >= 0`. Unknowns that are not needed are exactly zero.
pub fn non_negative(matrix: &DMatrix<f64>, data: &DVector<f64>) -> DVector<f64> {
    let p = matrix.ncols();
    let lengths: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
    let mut x = DVector::zeros(p);
    let mut passive: Vec<usize> = Vec::new();
    loop {
        let residual = data - matrix * &x;
        let slope = |k: usize| matrix.column(k).dot(&residual) / lengths[k];
        let candidates = (0..p).filter(|k| !passive.contains(k));
        let Some(best) = candidates.max_by(|&i, &k| slope(i).total_cmp(&slope(k))) else {
            return x;
        };
        if slope(best) <= 1e-10 * data.norm() {
            return x;
        }
        passive.push(best);
        loop {
            let scaled = DMatrix::from_fn(matrix.nrows(), passive.len(), |i, k| {
                matrix[(i, passive[k])] / lengths[passive[k]]
            });
            let qr = scaled.qr();
            let mut answer = qr.q().tr_mul(data);
            assert!(qr.r().solve_upper_triangular_mut(&mut answer));
            let answer: Vec<f64> = (passive.iter().zip(&answer))
                .map(|(&k, v)| v / lengths[k])
                .collect();
            let blocking = (passive.iter().zip(&answer)).filter(|&(_, &v)| v <= 0.0);
            let shares = blocking.map(|(&k, v)| x[k] / (x[k] - v));
            let step = 1.0 - largest(shares.map(|s| 1.0 - s).chain([0.0]));
            for (&k, v) in passive.iter().zip(&answer) {
                x[k] += step * (v - x[k]);
                if *v <= 0.0 && x[k] <= 1e-12 * data.norm() / lengths[k] {
                    x[k] = 0.0;
                }
            }
            if step == 1.0 {
                break;
            }
            passive.retain(|&k| x[k] > 0.0);
        }
    }
}

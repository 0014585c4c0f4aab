//! Damping by ratios where loads have no potential.
//!
//! Real modes are no modes of such a machine: ratios are those of its complex pairs. A pair that swings undamped as
//! `lambda0` (its coordinate obeys `q'' = lambda0^2 q`) is damped by `zeta` as a single mass is,
//!
//! ```text
//! q'' + 2 zeta |lambda0| q' - lambda0^2 q = 0
//! C = sum M r 2 zeta |lambda0| l^T M / (l^T M r)         r, l its right and left shapes
//! ```
//!
//! so that `lambda0 = i w` becomes `-zeta w + i w sqrt(1 - zeta^2)`, what grows by less than `zeta |lambda0|` dies away,
//! and what goes away without swinging still does. Couplings between pairs there are none.

use nalgebra::{Complex, DMatrix};

use crate::error::Result;
use crate::linear::LinearDynamics;
use crate::modes::quadratic::Quadratic;
use crate::modes::quadratic::start;

/// Pairs whose `w^2` differ by a smaller share are damped as one: near flutter their shapes are nearly the same.
const CLOSE: f64 = 1e-5;
/// Relative offset of the shift in inverse iteration, so that all eigenvectors of a cluster grow alike.
const BESIDE: f64 = 1e-9;

/// Damped eigenvalue from an undamped one.
pub(crate) fn damped(value: Complex<f64>, ratio: f64) -> Complex<f64> {
    let rate = ratio * value.norm();
    let root = (value * value + rate * rate).sqrt();
    // Picks the root on the side of the undamped eigenvalue.
    let root = match (root * value.conj()).re < 0.0 {
        true => -root,
        false => root,
    };
    root - rate
}

/// The ratio of a pair, counted from the lowest: the last counts for all above.
pub(crate) fn ratio_of(ratios: &[f64], pair: usize) -> f64 {
    let own = ratios.get(pair).or(ratios.last());
    own.copied().unwrap_or(0.0)
}

impl LinearDynamics {
    /// `C` of ratios of the complex pairs.
    pub(crate) fn damping_of_pairs(&self, ratios: &[f64]) -> Result<DMatrix<f64>> {
        let pencil = Quadratic::of(self, None)?;
        let values = pencil.eigenvalues().ok_or_else(|| self.not_found())?;
        let n = pencil.mass.nrows();
        let mut sum = DMatrix::zeros(n, n);
        let mut done = vec![false; values.len()];
        for k in 0..values.len() {
            if done[k] {
                continue;
            }
            let squared = -(values[k] * values[k]);
            let near = |s: Complex<f64>| (s - squared).norm() <= CLOSE * squared.norm();
            let own: Vec<usize> = (k..values.len())
                .filter(|&i| !done[i] && near(-(values[i] * values[i])))
                .collect();
            own.iter().for_each(|&i| done[i] = true);
            let mean = own.iter().map(|&i| -(values[i] * values[i]));
            let mean = mean.sum::<Complex<f64>>() / own.len() as f64;
            let rate = 2.0 * ratio_of(ratios, k) * mean.norm().sqrt();
            sum += projector(&pencil, mean, own.len()).map(|x| x.re) * rate;
        }
        // Transforms from coordinates of the pencil: r = back x, and l^T M r is the same in both.
        let mass = &self.mass * &pencil.back;
        Ok(&mass * sum * mass.transpose())
    }
}

/// `R (L^T M R)^-1 L^T` of the `count` pairs near a `w^2`, in coordinates of the pencil.
fn projector(pencil: &Quadratic, squared: Complex<f64>, count: usize) -> DMatrix<Complex<f64>> {
    let n = pencil.mass.nrows();
    let shift = squared * (1.0 + BESIDE);
    let p = DMatrix::from_fn(n, n, |i, j| {
        pencil.tangent[(i, j)] - shift * pencil.mass[(i, j)]
    });
    let mass = pencil.mass.map(|x| Complex::new(x, 0.0));
    let space = |p: DMatrix<Complex<f64>>| {
        let lu = p.lu();
        let columns: Vec<_> = (0..count).map(|k| start(n, k)).collect();
        let mut x = DMatrix::from_columns(&columns).map(|x| Complex::new(x, 0.0));
        for _ in 0..4 {
            if let Some(next) = lu.solve(&(&mass * &x)) {
                x = next.qr().q();
            }
        }
        x
    };
    let (right, left) = (space(p.clone()), space(p.transpose()));
    let product = left.transpose() * &mass * &right;
    match product.lu().solve(&left.transpose()) {
        Some(rows) => right * rows,
        // Exactly where two pairs meet: no damping by ratios is defined.
        None => DMatrix::zeros(n, n),
    }
}

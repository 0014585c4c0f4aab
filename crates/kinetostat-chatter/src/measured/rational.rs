//! A common denominator of several curves by rational fraction polynomials (Richardson & Formenti 1982), in polynomials that
//! are orthogonal on the frequencies (Forsythe), weighted anew by the last denominator (Sanathanan & Koerner 1963).

use nalgebra::{DMatrix, DVector};

use crate::number::Complex64;
use crate::stability::by_qr;

/// Rounds of new weights.
const ROUNDS: usize = 12;

/// Polynomials in `s` with real coefficients, orthogonal on `s = i w` at some frequencies.
struct Orthogonal {
    /// Values by frequency and degree.
    values: DMatrix<Complex64>,
    /// `x p_k = up_k p_(k+1) - down_k p_(k-1)` with `x = s/scale`.
    up: Vec<f64>,
    down: Vec<f64>,
    scale: f64,
}

impl Orthogonal {
    fn new(frequencies: &[f64], weights: &[f64], degree: usize) -> Self {
        let scale = frequencies.iter().copied().fold(0.0, crate::number::larger);
        let n = frequencies.len();
        let mut values = DMatrix::from_element(n, degree + 1, Complex64::default());
        let norm = |column: &DVector<Complex64>| {
            let sum: f64 = column
                .iter()
                .zip(weights)
                .map(|(v, w)| w * v.norm_sqr())
                .sum();
            sum.sqrt()
        };
        let mut last = DVector::from_element(n, Complex64::default());
        let mut now = DVector::from_element(n, Complex64::from(1.0));
        now /= Complex64::from(norm(&now));
        let (mut up, mut down) = (Vec::new(), vec![0.0]);
        values.set_column(0, &now);
        for k in 0..degree {
            let below = *down.last().unwrap_or(&0.0);
            let mut next = DVector::from_fn(n, |i, _| {
                Complex64::new(0.0, frequencies[i] / scale) * now[i] + last[i] * below
            });
            let size = norm(&next);
            next /= Complex64::from(size);
            up.push(size);
            // <x p_k, p_(k+1)> = up_k, and multiplication by x = i w/scale is skew.
            down.push(size);
            values.set_column(k + 1, &next);
            last = now;
            now = next;
        }
        Self {
            values,
            up,
            down,
            scale,
        }
    }

    /// Roots of `sum_k c_k p_k` with a last coefficient that is not 0: eigenvalues of the comrade matrix.
    fn roots(&self, coefficients: &[f64]) -> Option<Vec<Complex64>> {
        let n = coefficients.len() - 1;
        let mut matrix = DMatrix::zeros(n, n);
        for k in 0..n {
            if k + 1 < n {
                matrix[(k, k + 1)] += self.up[k];
            } else {
                // p_n = -sum c_k p_k / c_n at a root.
                for (j, c) in coefficients[..n].iter().enumerate() {
                    matrix[(k, j)] -= self.up[k] * c / coefficients[n];
                }
            }
            if k > 0 {
                matrix[(k, k - 1)] -= self.down[k];
            }
        }
        if !matrix.iter().all(|entry: &f64| entry.is_finite()) {
            return None;
        }
        let all = by_qr(&matrix)?;
        Some(all.iter().map(|x| x * self.scale).collect())
    }
}

/// Real and imaginary parts below each other.
fn real(matrix: &DMatrix<Complex64>) -> DMatrix<f64> {
    let n = matrix.nrows();
    DMatrix::from_fn(2 * n, matrix.ncols(), |i, j| match i < n {
        true => matrix[(i, j)].re,
        false => matrix[(i - n, j)].im,
    })
}

/// Roots of the common denominator, 1/s, of curves (one column each) at angular frequencies: `2 modes` of them, numerators of
/// `2 modes + extra - 1`. `None` where the frequencies do not determine them.
pub(crate) fn poles(
    frequencies: &[f64],
    curves: &DMatrix<Complex64>,
    modes: usize,
    extra: usize,
) -> Option<Vec<Complex64>> {
    let order = 2 * modes;
    let above = order + extra;
    let n = frequencies.len();
    let sizes: Vec<f64> = (0..curves.ncols())
        .map(|o| curves.column(o).norm())
        .collect();
    let mut weights = vec![1.0; n];
    let mut found = None;
    for _ in 0..ROUNDS {
        let basis = Orthogonal::new(frequencies, &weights, order.max(above - 1));
        let weighted = |k: usize, i: usize| basis.values[(i, k)] * weights[i].sqrt();
        let numerator = real(&DMatrix::from_fn(n, above, |i, k| weighted(k, i)));
        let q = numerator.qr().q();
        let mut rows = DMatrix::zeros(2 * n * curves.ncols(), order + 1);
        for o in 0..curves.ncols() {
            let size = sizes[o];
            if size.is_nan() || size <= 0.0 {
                continue;
            }
            let product = real(&DMatrix::from_fn(n, order + 1, |i, k| {
                weighted(k, i) * curves[(i, o)] / size
            }));
            // Component that no numerator can follow.
            let rest = &product - &q * (q.transpose() * &product);
            rows.view_mut((2 * n * o, 0), (2 * n, order + 1))
                .copy_from(&rest);
        }
        // The coefficients of length 1 that leave least.
        let squares = (rows.transpose() * rows).symmetric_eigen();
        let least = squares
            .eigenvalues
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(b.1))?
            .0;
        let coefficients: Vec<f64> = squares.eigenvectors.column(least).iter().copied().collect();
        if !coefficients.iter().all(|c| c.is_finite()) || coefficients[order] == 0.0 {
            return found;
        }
        found = basis.roots(&coefficients);
        let mut most = 0.0;
        for (i, weight) in weights.iter_mut().enumerate() {
            let value: Complex64 = (0..=order)
                .map(|k| basis.values[(i, k)] * coefficients[k])
                .sum();
            *weight = value.norm_sqr().recip();
            most = crate::number::larger(most, *weight);
        }
        if most.is_nan() || most <= 0.0 || most.is_infinite() {
            return found;
        }
        for weight in &mut weights {
            // Every frequency keeps some weight.
            *weight = crate::number::larger(*weight / most, 1e-12);
        }
    }
    found
}

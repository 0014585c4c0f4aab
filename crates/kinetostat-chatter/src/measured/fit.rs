//! Modes of measured curves: common poles by rational fraction polynomials, then constants by linear least squares.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::measured::response::MeasuredResponse;
use crate::number::{Complex64, larger};
use crate::stability::by_qr;

/// Degrees of the numerators beyond those of the modes: what lies outside of the band.
const EXTRA: usize = 3;
/// A fitted mode with more damping is none.
const MOST_DAMPED: f64 = 0.5;

/// One mode of measured curves.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FittedMode {
    /// Undamped natural frequency, Hz.
    pub frequency_hz: f64,
    /// Share of critical damping.
    pub damping_ratio: f64,
    /// Constant of each curve: product of the mass-normalised shape at response and reference, 1/kg.
    pub constants: Vec<f64>,
    /// Part of each curve's constant that is out of phase, as a share of the largest constant: 0 for a mode whose
    /// places all move in phase.
    pub out_of_phase: Vec<f64>,
}

impl FittedMode {
    /// The mass-normalised shape at the responses' places, kg^-1/2, from a curve whose response is its reference.
    ///
    /// `None` where the constant of that curve is not positive, as it must be.
    #[must_use]
    pub fn shape(&self, driving_point: usize) -> Option<Vec<f64>> {
        let own = *self.constants.get(driving_point)?;
        (own > 0.0).then(|| self.constants.iter().map(|c| c / own.sqrt()).collect())
    }
}

/// Modes of measured curves and how well they follow them.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Fit {
    /// The modes in the band, by frequency.
    pub modes: Vec<FittedMode>,
    /// Residual flexibility of each curve for faster modes, m/N.
    pub residual: Vec<f64>,
    /// Misfit of each curve: root mean square of its residual, as a share of the curve's.
    pub misfit: Vec<f64>,
    /// Poles that were found but are none of a vibration in the band: frequencies, Hz.
    pub left_out_hz: Vec<f64>,
}

/// Fits so many modes to curves in a band of frequencies, Hz.
///
/// Method: rational fraction polynomials with a common denominator (Richardson & Formenti 1982) in orthogonal polynomials,
/// weighted anew (Sanathanan & Koerner 1963); then constants of each curve, `A/(w_k^2 - w^2 + 2 i zeta w_k w)`, with terms for
/// slower and faster modes, by linear least squares.
///
/// # Errors
/// No curve, curves at different frequencies, no mode, too few frequencies in the band, and a fit that finds fewer modes
/// than asked.
pub fn fit_modes(responses: &[MeasuredResponse], modes: usize, band_hz: [f64; 2]) -> Result<Fit> {
    let (frequencies, curves) = table(responses, modes, band_hz)?;
    let all = poles(&frequencies, &curves, modes, EXTRA).ok_or_else(|| {
        ChatterError::new(
            ChatterErrorKind::NotConverged,
            "fit of modes",
            "no poles",
            "another band or number of modes",
        )
    })?;
    let mut poles = Vec::new();
    let mut left_out_hz = Vec::new();
    for pole in all.into_iter().filter(|pole| pole.im > 0.0) {
        let hz = pole.norm() / TAU;
        let damping = -pole.re / pole.norm();
        let within = (band_hz[0]..=band_hz[1]).contains(&hz);
        match within && damping > 0.0 && damping < MOST_DAMPED {
            true => poles.push(pole),
            false => left_out_hz.push(hz),
        }
    }
    poles.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    if poles.len() < modes {
        return Err(ChatterError::new(
            ChatterErrorKind::Measurement,
            "modes in the band",
            format!("{} of {modes}", poles.len()),
            "fewer modes, or a band that holds them all with both sides of their peaks",
        ));
    }
    let mut fit = constants(&frequencies, &curves, &poles).ok_or_else(|| {
        ChatterError::new(
            ChatterErrorKind::NotConverged,
            "constants of the modes",
            "no solution",
            "fewer modes",
        )
    })?;
    fit.left_out_hz = left_out_hz;
    Ok(fit)
}

/// Angular frequencies of the band and receptances there, one column for each curve.
fn table(
    responses: &[MeasuredResponse],
    modes: usize,
    [low, high]: [f64; 2],
) -> Result<(Vec<f64>, DMatrix<Complex64>)> {
    let fault = |quantity: &str, found: String, expected: &str| {
        let kind = ChatterErrorKind::Measurement;
        ChatterError::new(kind, quantity, found, expected)
    };
    if !(1..=30).contains(&modes) {
        return Err(fault("number of modes", modes.to_string(), "1 to 30"));
    }
    if !(low >= 0.0 && high > low) {
        let found = format!("{low} to {high} Hz");
        return Err(fault(
            "band",
            found,
            "two frequencies, the second above the first",
        ));
    }
    let mut columns = Vec::new();
    let mut frequencies: Vec<f64> = Vec::new();
    for response in responses {
        let within: Vec<(f64, Complex64)> = response
            .receptance()
            .into_iter()
            .filter(|(f, _)| (low..=high).contains(f))
            .collect();
        let own: Vec<f64> = within.iter().map(|(f, _)| TAU * f).collect();
        if columns.is_empty() {
            frequencies = own;
        } else if own != frequencies {
            let expected = "the frequencies of the first one";
            return Err(fault("frequencies", response.name.clone(), expected));
        }
        columns.push(DVector::from_iterator(
            within.len(),
            within.iter().map(|(_, v)| *v),
        ));
    }
    if columns.is_empty() {
        return Err(fault("responses", "none".into(), "at least one"));
    }
    let least = 4 * modes + 2 * EXTRA;
    if frequencies.len() < least {
        let found = format!("{} frequencies in the band", frequencies.len());
        let expected = format!("at least {least} for {modes} modes");
        return Err(fault("band", found, &expected));
    }
    Ok((frequencies, DMatrix::from_columns(&columns)))
}

/// Constants of known poles: real and imaginary part of each mode's, one for faster modes, one for slower ones.
fn constants(frequencies: &[f64], curves: &DMatrix<Complex64>, poles: &[Complex64]) -> Option<Fit> {
    let (n, m) = (frequencies.len(), poles.len());
    let column = |i: usize, k: usize| -> Complex64 {
        let s = Complex64::new(0.0, frequencies[i]);
        match (k / 2, k % 2) {
            (mode, part) if mode < m => {
                let pole = poles[mode];
                // R/(s - p) + R*/(s - p*) with R = A/(2 i w_d).
                let (a, b) = ((s - pole).inv(), (s - pole.conj()).inv());
                let half = Complex64::new(0.0, 2.0 * pole.im).inv();
                match part {
                    0 => half * (a - b),
                    _ => half * Complex64::i() * (a + b),
                }
            }
            (_, 0) => Complex64::from(1.0),
            _ => Complex64::from(-(frequencies[0] / frequencies[i]).powi(2)),
        }
    };
    let width = 2 * m + 2;
    let mut matrix = DMatrix::from_fn(2 * n, width, |i, k| match i < n {
        true => column(i, k).re,
        false => column(i - n, k).im,
    });
    // Columns of one length, so that none is lost in rounding.
    let lengths: Vec<f64> = (0..width).map(|k| matrix.column(k).norm()).collect();
    for (k, length) in lengths.iter().enumerate() {
        matrix.column_mut(k).unscale_mut(*length);
    }
    let right = DMatrix::from_fn(2 * n, curves.ncols(), |i, o| match i < n {
        true => curves[(i, o)].re,
        false => curves[(i - n, o)].im,
    });
    let factored = matrix.clone().qr();
    let mut solution = factored
        .r()
        .solve_upper_triangular(&(factored.q().transpose() * &right))?;
    let left = &right - &matrix * &solution;
    for (k, length) in lengths.iter().enumerate() {
        solution.row_mut(k).unscale_mut(*length);
    }
    let curves_count = curves.ncols();
    let modes = poles
        .iter()
        .enumerate()
        .map(|(k, pole)| {
            let constants: Vec<f64> = solution.row(2 * k).iter().copied().collect();
            let most = constants.iter().map(|c| c.abs()).fold(0.0, larger);
            FittedMode {
                frequency_hz: pole.norm() / TAU,
                damping_ratio: -pole.re / pole.norm(),
                out_of_phase: (0..curves_count)
                    .map(|o| solution[(2 * k + 1, o)].abs() / most)
                    .collect(),
                constants,
            }
        })
        .collect();
    Some(Fit {
        modes,
        residual: solution.row(2 * m).iter().copied().collect(),
        misfit: (0..curves_count)
            .map(|o| left.column(o).norm() / right.column(o).norm())
            .collect(),
        left_out_hz: Vec::new(),
    })
}

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

//! Modes of measured curves: common poles by rational fraction polynomials, then constants by linear least squares.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::measured::rational;
use crate::measured::response::MeasuredResponse;
use crate::number::{Complex64, larger};

/// Degrees of the numerators beyond those of the modes: what lies outside of the band.
const EXTRA: usize = 3;
/// A fitted mode with more damping is none.
const MOST_DAMPED: f64 = 0.5;

/// One mode of measured curves.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    let all = rational::poles(&frequencies, &curves, modes, EXTRA).ok_or_else(|| {
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

//! Measured modes beside those of a model.

use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{ChatterError, ChatterErrorKind, Result};

/// A mode by frequency, damping and its shape at the places that are compared.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShapedMode {
    /// Natural frequency, Hz.
    pub frequency_hz: f64,
    /// Share of critical damping.
    pub damping_ratio: f64,
    /// Shape at the places, in any scale.
    pub shape: Vec<f64>,
}

/// A measured mode with that of the model which it resembles most.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ModePair {
    /// Number of the measured mode.
    pub measured: usize,
    /// Number of the model's.
    pub model: usize,
    /// Modal assurance criterion of the two shapes, 0 to 1.
    pub assurance: f64,
    /// Frequency of the model's above the measured one, share of it.
    pub frequency_apart: f64,
    /// Damping ratio of the model's above the measured one.
    pub damping_apart: f64,
}

/// Modal assurance criterion `(a . b)^2/((a . a)(b . b))` (Allemang & Brown 1982): 1 for shapes that differ in scale alone.
///
/// # Errors
/// Shapes of different length, or without any motion.
pub fn modal_assurance(a: &[f64], b: &[f64]) -> Result<f64> {
    let fault = |found: String, expected: &str| {
        let kind = ChatterErrorKind::Measurement;
        ChatterError::new(kind, "shapes to compare", found, expected)
    };
    if a.len() != b.len() || a.is_empty() {
        let found = format!("{} and {} places", a.len(), b.len());
        return Err(fault(found, "as many, and at least one"));
    }
    let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
    let sizes = dot(a, a) * dot(b, b);
    match sizes > 0.0 && sizes.is_finite() {
        true => Ok(dot(a, b).powi(2) / sizes),
        false => Err(fault(
            "a shape without motion".into(),
            "finite shapes that move",
        )),
    }
}

/// Pairs measured modes with a model's: the most alike first, each used once.
///
/// Alike are shapes by the modal assurance criterion, times closeness of frequency, so that two modes of one shape are told
/// apart. A pair of a low criterion stands in the answer as it is: look at it before you trust its frequency.
///
/// # Errors
/// Those of [`modal_assurance`]; a frequency that is not positive.
pub fn pair_modes(measured: &[ShapedMode], model: &[ShapedMode]) -> Result<Vec<ModePair>> {
    let odd = measured
        .iter()
        .chain(model)
        .find(|m| m.frequency_hz.is_nan() || m.frequency_hz <= 0.0);
    if let Some(mode) = odd {
        return Err(ChatterError::new(
            ChatterErrorKind::Measurement,
            "frequency of a mode",
            format!("{} Hz", mode.frequency_hz),
            "a positive one",
        ));
    }
    let mut all = Vec::new();
    for (i, a) in measured.iter().enumerate() {
        for (j, b) in model.iter().enumerate() {
            let assurance = modal_assurance(&a.shape, &b.shape)?;
            let ratio = b.frequency_hz / a.frequency_hz;
            let alike = assurance * (-ratio.ln().powi(2) / 0.5).exp();
            let pair = ModePair {
                measured: i,
                model: j,
                assurance,
                frequency_apart: ratio - 1.0,
                damping_apart: b.damping_ratio - a.damping_ratio,
            };
            all.push((alike, pair));
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut pairs: Vec<ModePair> = Vec::new();
    for (_, pair) in all {
        let used = |p: &ModePair| p.measured == pair.measured || p.model == pair.model;
        if !pairs.iter().any(used) {
            pairs.push(pair);
        }
    }
    pairs.sort_by_key(|pair| pair.measured);
    Ok(pairs)
}

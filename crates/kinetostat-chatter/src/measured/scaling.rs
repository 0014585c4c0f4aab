//! Modes of a model compared with measured ones, parameters scaled to them, and what the measurement cannot tell of them.
//!
//! Which parameters (stiffnesses of drives, damping) and which numbers (frequencies, damping ratios) is the caller's: a closure
//! takes the first to the second. Steps are those of Levenberg and Marquardt in logarithms, within bounds.

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::larger;

/// A positive parameter and its bounds.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Parameter {
    /// Name of the parameter.
    pub name: String,
    /// Value to begin with.
    pub start: f64,
    /// Smallest value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
}

/// Scaled parameters.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Scaled {
    /// Their values.
    pub values: Vec<f64>,
    /// Standard deviation of each as a share of its value, from the stated deviations of what was measured, or from what is
    /// left where that is more than they explain; `None` where the measurement does not tell it, or where a bound holds it.
    pub deviations: Vec<Option<f64>>,
    /// True for a parameter at a bound.
    pub at_bound: Vec<bool>,
    /// Singular values of the measured numbers (by their deviations) over the logarithms of the parameters, largest first.
    pub singular_values: Vec<f64>,
    /// Combinations of logarithms that the measurement does not tell: changes of the parameters that change nothing of it
    /// by one deviation while they change by a factor of e.
    pub untold: Vec<Vec<f64>>,
    /// Residuals: model minus measurement, each divided by its deviation.
    pub left: Vec<f64>,
    /// Number of evaluations of the model.
    pub evaluations: usize,
}

/// A combination is told where a factor of e changes the measured numbers by more than so many deviations.
const TOLD: f64 = 1.0;
/// Relative step of a difference.
const STEP: f64 = 1e-5;
const ROUNDS: usize = 100;

/// Scales parameters so that a model gives what was measured.
///
/// `measured` holds numbers with their standard deviations; `model` takes values of the parameters to the same numbers.
///
/// ```
/// use kinetostat_chatter::{Parameter, scale_parameters};
///
/// // A mass of 2 kg on a spring: what stiffness has 10 Hz?
/// let spring = Parameter { name: "k".into(), start: 5e3, least: 1e3, most: 1e5 };
/// let model = |k: &[f64]| Ok(vec![(k[0] / 2.0).sqrt() / std::f64::consts::TAU]);
/// let found = scale_parameters(&[spring], &[(10.0, 0.05)], model)?;
/// assert!((found.values[0] / 7895.68352 - 1.0).abs() < 1e-8);
/// assert!((found.deviations[0].unwrap() - 0.01).abs() < 1e-6); // twice that of the frequency
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
///
/// # Errors
/// No parameter, bounds that are not positive or do not hold the start, a deviation that is not positive, and errors of the
/// model.
pub fn scale_parameters(
    parameters: &[Parameter],
    measured: &[(f64, f64)],
    mut model: impl FnMut(&[f64]) -> Result<Vec<f64>>,
) -> Result<Scaled> {
    check(parameters, measured)?;
    let mut evaluations = 0;
    let mut left_at = |logs: &DVector<f64>| -> Result<DVector<f64>> {
        evaluations += 1;
        let values: Vec<f64> = logs.iter().map(|l| l.exp()).collect();
        let numbers = model(&values)?;
        let finite = numbers.iter().all(|value| value.is_finite());
        if numbers.len() != measured.len() || !finite {
            return Err(ChatterError::new(
                ChatterErrorKind::Measurement,
                "numbers of the model",
                format!("{} (finite: {finite})", numbers.len()),
                format!("{} finite ones, as measured", measured.len()),
            ));
        }
        let pairs = numbers.iter().zip(measured);
        let each = pairs.map(|(found, (value, deviation))| (found - value) / deviation);
        Ok(DVector::from_iterator(measured.len(), each))
    };
    let n = parameters.len();
    let bounds: Vec<(f64, f64)> = parameters
        .iter()
        .map(|p| (p.least.ln(), p.most.ln()))
        .collect();
    let mut logs = DVector::from_iterator(n, parameters.iter().map(|p| p.start.ln()));
    let mut left = left_at(&logs)?;
    let mut damping = 1e-3;
    for _ in 0..ROUNDS {
        let slopes = slopes(&logs, &bounds, &mut left_at)?;
        let gradient = slopes.transpose() * &left;
        // A parameter at its bound that would leave it stays there.
        let free: Vec<usize> = (0..n)
            .filter(|&k| {
                let (least, most) = bounds[k];
                !((logs[k] <= least && gradient[k] > 0.0) || (logs[k] >= most && gradient[k] < 0.0))
            })
            .collect();
        if free.is_empty() {
            break;
        }
        let kept = slopes.select_columns(&free);
        let square = kept.transpose() * &kept;
        let mut moved = 0.0;
        let mut better = false;
        while damping < 1e12 {
            let mut damped = square.clone();
            for k in 0..free.len() {
                damped[(k, k)] += damping * larger(square[(k, k)], 1e-12);
            }
            let step = damped
                .cholesky()
                .map(|c| c.solve(&(-kept.transpose() * &left)));
            let mut next = logs.clone();
            if let Some(step) = &step {
                for (k, change) in free.iter().zip(step) {
                    let (least, most) = bounds[*k];
                    next[*k] = (logs[*k] + change).clamp(least, most);
                }
            }
            let trial = left_at(&next)?;
            if step.is_some() && trial.norm() <= left.norm() {
                moved = (&next - &logs).norm();
                better = trial.norm() < left.norm();
                (logs, left) = (next, trial);
                damping = larger(0.1 * damping, 1e-12);
                break;
            }
            damping *= 10.0;
        }
        if moved < 1e-12 || !better {
            break;
        }
        damping = damping.min(1e6);
    }
    let slopes = slopes(&logs, &bounds, &mut left_at)?;
    Ok(judged(&logs, &bounds, &slopes, &left, evaluations))
}

/// Changes of the numbers by those of the logarithms, by central differences where the bounds leave room.
fn slopes(
    logs: &DVector<f64>,
    bounds: &[(f64, f64)],
    left_at: &mut impl FnMut(&DVector<f64>) -> Result<DVector<f64>>,
) -> Result<DMatrix<f64>> {
    let mut columns = Vec::with_capacity(logs.len());
    for (k, (least, most)) in bounds.iter().enumerate() {
        let (mut low, mut high) = (logs.clone(), logs.clone());
        low[k] = larger(logs[k] - STEP, *least);
        high[k] = (logs[k] + STEP).min(*most);
        let wide = high[k] - low[k];
        columns.push((left_at(&high)? - left_at(&low)?) / wide);
    }
    Ok(DMatrix::from_columns(&columns))
}

/// Statistics of the fitted parameters.
fn judged(
    logs: &DVector<f64>,
    bounds: &[(f64, f64)],
    slopes: &DMatrix<f64>,
    left: &DVector<f64>,
    evaluations: usize,
) -> Scaled {
    let n = logs.len();
    let at_bound: Vec<bool> = (0..n)
        .map(|k| logs[k] <= bounds[k].0 || logs[k] >= bounds[k].1)
        .collect();
    let eigen = (slopes.transpose() * slopes).symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let size = |k: usize| larger(eigen.eigenvalues[k], 0.0).sqrt();
    let told: Vec<usize> = order.iter().copied().filter(|k| size(*k) > TOLD).collect();
    let untold: Vec<Vec<f64>> = order
        .iter()
        .filter(|k| size(**k) <= TOLD)
        .map(|k| eigen.eigenvectors.column(*k).iter().copied().collect())
        .collect();
    // With more measured numbers than determined parameters the residual shows how well the model can fit them at all.
    let spare = left.len().saturating_sub(told.len());
    let worse = match spare {
        0 => 1.0,
        _ => larger(1.0, (left.norm_squared() / spare as f64).sqrt()),
    };
    let deviation = |p: usize| {
        let hidden = untold.iter().any(|v| v[p].abs() > 1e-3);
        let variance: f64 = told
            .iter()
            .map(|k| (eigen.eigenvectors[(p, *k)] / size(*k)).powi(2))
            .sum();
        (!hidden && !at_bound[p]).then(|| worse * variance.sqrt())
    };
    Scaled {
        values: logs.iter().map(|l| l.exp()).collect(),
        deviations: (0..n).map(deviation).collect(),
        at_bound,
        singular_values: order.iter().map(|k| size(*k)).collect(),
        untold,
        left: left.iter().copied().collect(),
        evaluations,
    }
}

fn check(parameters: &[Parameter], measured: &[(f64, f64)]) -> Result<()> {
    let kind = ChatterErrorKind::Measurement;
    if parameters.is_empty() || measured.is_empty() {
        return Err(ChatterError::new(
            kind,
            "scaling",
            format!(
                "{} parameters, {} numbers",
                parameters.len(),
                measured.len()
            ),
            "at least one of each",
        ));
    }
    for p in parameters {
        if !(p.least > 0.0 && p.least < p.most && p.most.is_finite()) {
            let found = format!("{} to {}", p.least, p.most);
            let expected = "positive ones, the second above the first";
            return Err(ChatterError::new(
                kind,
                format!("bounds of {}", p.name),
                found,
                expected,
            ));
        }
        if !(p.least..=p.most).contains(&p.start) {
            let expected = format!("{} to {}, its bounds", p.least, p.most);
            return Err(ChatterError::new(
                kind,
                format!("start of {}", p.name),
                p.start,
                expected,
            ));
        }
    }
    for (value, deviation) in measured {
        above(
            kind,
            "standard deviation of a measured number",
            *deviation,
            0.0,
            true,
            "",
        )?;
        if !value.is_finite() {
            return Err(ChatterError::new(
                kind,
                "measured number",
                value,
                "a finite one",
            ));
        }
    }
    Ok(())
}

/// A mode by frequency, damping and its shape at the places that are compared.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapedMode {
    /// Natural frequency, Hz.
    pub frequency_hz: f64,
    /// Share of critical damping.
    pub damping_ratio: f64,
    /// Shape at the places, in any scale.
    pub shape: Vec<f64>,
}

/// A measured mode with that of the model which it resembles most.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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

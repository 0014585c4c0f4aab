//! Linear propagation: derivatives by central differences, variance `g^T C g`.

use schemars::JsonSchema;
use serde::Serialize;

use crate::tolerance::uncertain::Uncertainties;

/// Step of the differences, in standard deviations.
const STEP: f64 = 0.01;

/// A number as a linear function of the uncertain ones.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Linear {
    /// Value for the numbers of the drawing.
    pub nominal: f64,
    /// Derivative by every number, per its own unit.
    pub derivatives: Vec<f64>,
    /// Standard deviation.
    pub standard_deviation: f64,
    /// Part of every number in the variance; those of correlated ones hold what they share half each. They add to 1.
    pub shares: Vec<f64>,
}

impl Linear {
    /// Value of the linear function for other numbers.
    #[must_use]
    pub fn at(&self, uncertainties: &Uncertainties, values: &[f64]) -> f64 {
        let each = uncertainties
            .each()
            .iter()
            .zip(values)
            .zip(&self.derivatives);
        self.nominal + each.map(|((u, x), g)| g * (x - u.value)).sum::<f64>()
    }
}

/// The points that derivatives need: the drawing, then each number more and less by a hundredth of its standard deviation.
#[must_use]
pub fn linear_points(uncertainties: &Uncertainties) -> Vec<Vec<f64>> {
    let nominal = uncertainties.nominal();
    let mut points = vec![nominal.clone()];
    for (i, u) in uncertainties.each().iter().enumerate() {
        let step = STEP * u.distribution.standard_deviation();
        for sign in [1.0, -1.0] {
            let mut moved = nominal.clone();
            moved[i] += sign * step;
            points.push(moved);
        }
    }
    points
}

/// Linear functions from the answers to [`linear_points`], one list of outputs for each point.
#[must_use]
pub fn linear(uncertainties: &Uncertainties, answers: &[Vec<f64>]) -> Vec<Linear> {
    let points = linear_points(uncertainties);
    let covariance = uncertainties.covariance();
    let outputs = answers.first().map_or(0, Vec::len);
    (0..outputs)
        .map(|k| {
            let derivatives: Vec<f64> = (0..uncertainties.each().len())
                .map(|i| {
                    let (more, less) = (2 * i + 1, 2 * i + 2);
                    // The steps as they were rounded.
                    let step = points[more][i] - points[less][i];
                    if step == 0.0 {
                        0.0
                    } else {
                        (answers[more][k] - answers[less][k]) / step
                    }
                })
                .collect();
            let part = |i: usize| {
                let row = derivatives
                    .iter()
                    .enumerate()
                    .map(|(j, g)| covariance[(i, j)] * g);
                derivatives[i] * row.sum::<f64>()
            };
            let parts: Vec<f64> = (0..derivatives.len()).map(part).collect();
            let variance: f64 = parts.iter().sum();
            let variance = if variance.is_nan() {
                variance
            } else {
                variance.max(0.0)
            };
            Linear {
                nominal: answers[0][k],
                standard_deviation: variance.sqrt(),
                shares: parts
                    .iter()
                    .map(|p| if variance > 0.0 { p / variance } else { 0.0 })
                    .collect(),
                derivatives,
            }
        })
        .collect()
}

/// Distance of draws from the linear function: the root mean square of the difference, over the standard deviation of the draws.
/// Beyond [`ENOUGH`] linear is not enough. Zero where nothing scatters.
#[must_use]
pub fn nonlinearity(exact: &[f64], by_line: impl Fn(usize) -> f64) -> f64 {
    let known = || exact.iter().enumerate().filter(|(_, x)| x.is_finite());
    let n = known().count() as f64;
    let mean = known().map(|(_, x)| x).sum::<f64>() / n;
    let variance = known().map(|(_, x)| (x - mean).powi(2)).sum::<f64>() / n;
    let off = known().map(|(i, x)| (x - by_line(i)).powi(2)).sum::<f64>() / n;
    // Rounding of a number that does not scatter is no nonlinearity.
    if off <= 1e-20 * mean * mean || off.sqrt() <= NOTHING {
        0.0
    } else {
        (off / variance).sqrt()
    }
}

/// Results up to this are rounding, mm and N/mm: a picometre.
pub const NOTHING: f64 = 1e-9;

/// Maximum error of linear propagation, in standard deviations, for it to be enough.
pub const ENOUGH: f64 = 0.1;

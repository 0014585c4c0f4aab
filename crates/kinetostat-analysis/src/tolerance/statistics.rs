//! Statistics of draws: mean, scatter and quantiles, each with its confidence.

use schemars::JsonSchema;
use serde::Serialize;
use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, StudentsT};

use crate::tolerance::draws::{Draws, REPLICATES};

/// Level of all confidence bounds.
pub const CONFIDENCE: f64 = 0.95;

/// Shares whose quantiles are given.
pub const SHARES: [f64; 5] = [0.025, 0.05, 0.5, 0.95, 0.975];

/// A number estimated from draws, and how far it may be off with [`CONFIDENCE`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Estimate {
    /// The estimate.
    #[schemars(with = "Option<f64>")]
    pub value: f64,
    /// Half width of its interval of confidence; NaN (null in JSON) where too few draws have an answer.
    #[schemars(with = "Option<f64>")]
    pub plus_minus: f64,
}

impl Estimate {
    /// Estimate from all draws together and from each replicate: they are independent, so that their mean scatters by Student's
    /// distribution.
    #[must_use]
    pub fn of_replicates(value: f64, replicates: &[f64]) -> Self {
        let n = replicates.len() as f64;
        let mean = replicates.iter().sum::<f64>() / n;
        let squares: f64 = replicates.iter().map(|x| (x - mean).powi(2)).sum();
        let student = StudentsT::new(0.0, 1.0, n - 1.0);
        let plus_minus = match student {
            Ok(student) if n >= 2.0 => {
                student.inverse_cdf(0.5 + 0.5 * CONFIDENCE) * (squares / (n - 1.0) / n).sqrt()
            }
            _ => f64::NAN,
        };
        Self { value, plus_minus }
    }
}

/// A quantile, with an interval that holds it with [`CONFIDENCE`] or more.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Quantile {
    /// Share of the draws below.
    pub share: f64,
    /// The quantile.
    pub value: f64,
    /// Lower bound; `None` if there are too few draws for one.
    pub low: Option<f64>,
    /// Upper bound.
    pub high: Option<f64>,
}

/// Statistics of one number over the draws.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Summary {
    /// Draws with an answer.
    pub answered: usize,
    /// Draws without one.
    pub unanswered: usize,
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation.
    pub standard_deviation: Estimate,
    /// Quantiles at [`SHARES`].
    pub quantiles: Vec<Quantile>,
}

impl Summary {
    /// Statistics of `values` of all draws in their order, NaN if there is no answer.
    #[must_use]
    pub fn of(draws: &Draws, values: &[f64]) -> Self {
        let mut known: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        let mut each = vec![Vec::new(); REPLICATES];
        for (draw, x) in values.iter().enumerate().filter(|(_, x)| x.is_finite()) {
            each[draws.replicate(draw)].push(*x);
        }
        each.retain(|own| own.len() > 1);
        let (mean, deviation) = mean_and_deviation(&known);
        let own: Vec<(f64, f64)> = each.iter().map(|own| mean_and_deviation(own)).collect();
        let means: Vec<f64> = own.iter().map(|(mean, _)| *mean).collect();
        let deviations: Vec<f64> = own.iter().map(|(_, deviation)| *deviation).collect();
        known.sort_unstable_by(f64::total_cmp);
        Self {
            answered: known.len(),
            unanswered: values.len() - known.len(),
            mean: Estimate::of_replicates(mean, &means),
            standard_deviation: Estimate::of_replicates(deviation, &deviations),
            quantiles: SHARES.iter().map(|s| quantile(&known, *s)).collect(),
        }
    }

    /// The quantile of one of [`SHARES`]; NaN of another.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        let found = self.quantiles.iter().find(|q| q.share == share);
        found.map_or(f64::NAN, |q| q.value)
    }
}

/// Mean and standard deviation (of a sample); NaN of too few.
#[must_use]
pub fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0)).sqrt())
}

/// A quantile of sorted values. Its bounds are values of the list: how many of `n` draws lie below the quantile is binomial, whatever
/// the distribution. They hold for independent draws; scrambled sequences scatter less.
#[must_use]
pub fn quantile(sorted: &[f64], share: f64) -> Quantile {
    let none = Quantile {
        share,
        value: f64::NAN,
        low: None,
        high: None,
    };
    let (n, Some(last)) = (sorted.len(), sorted.len().checked_sub(1)) else {
        return none;
    };
    // Between the two neighbours, as most programs do.
    let at = share * last as f64;
    let (below, part) = (at.floor() as usize, at.fract());
    let above = sorted[(below + 1).min(last)];
    let value = sorted[below] + part * (above - sorted[below]);
    let Ok(count) = Binomial::new(share, n as u64) else {
        return Quantile { value, ..none };
    };
    let tail = 0.5 * (1.0 - CONFIDENCE);
    // The k-th smallest lies below the quantile unless fewer than k draws do.
    let low = least_count(&count, tail);
    let high = least_count(&count, 1.0 - tail);
    Quantile {
        share,
        value,
        low: low.checked_sub(1).map(|k| sorted[k.min(last)]),
        high: sorted.get(high).copied(),
    }
}

/// Smallest count that is not exceeded with probability `p`. (The search of `statrs` panics where that is zero: few draws, small shares.)
fn least_count(count: &Binomial, p: f64) -> usize {
    let (mut low, mut high) = (0, count.n());
    while low < high {
        let middle = low + (high - low) / 2;
        if count.cdf(middle) >= p {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low as usize
}

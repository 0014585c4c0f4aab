//! Distributions of a number about its nominal value.

use statrs::distribution::{ContinuousCDF, Normal};

/// A distribution about zero, in the number's own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Distribution {
    /// Normal, by its standard deviation.
    Normal(f64),
    /// Everything from minus to plus the half width alike.
    Uniform(f64),
    /// Symmetric, most likely in the middle, zero at minus and plus the half width.
    Triangular(f64),
}

impl Distribution {
    /// Word in the file.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Normal(_) => "normal",
            Self::Uniform(_) => "uniform",
            Self::Triangular(_) => "triangular",
        }
    }

    /// Stated spread: standard deviation or half width.
    #[must_use]
    pub fn spread(self) -> f64 {
        match self {
            Self::Normal(spread) | Self::Uniform(spread) | Self::Triangular(spread) => spread,
        }
    }

    /// Standard deviation.
    ///
    /// ```
    /// use kinetostat_tolerance::Distribution;
    /// assert!((Distribution::Uniform(0.3).standard_deviation() - 0.3 / 3.0_f64.sqrt()).abs() < 1e-15);
    /// assert!((Distribution::Triangular(0.3).standard_deviation() - 0.3 / 6.0_f64.sqrt()).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn standard_deviation(self) -> f64 {
        match self {
            Self::Normal(deviation) => deviation,
            Self::Uniform(half) => half / 3.0_f64.sqrt(),
            Self::Triangular(half) => half / 6.0_f64.sqrt(),
        }
    }

    /// The deviation of which a share `u` of all is smaller, 0 < u < 1.
    ///
    /// ```
    /// use kinetostat_tolerance::Distribution;
    /// assert!((Distribution::Normal(2.0).quantile(0.975) - 2.0 * 1.959_963_984_540_054).abs() < 1e-9);
    /// assert!((Distribution::Triangular(1.0).quantile(0.125) + 0.5).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn quantile(self, u: f64) -> f64 {
        match self {
            Self::Normal(deviation) => deviation * score(u),
            Self::Uniform(half) => half * (2.0 * u - 1.0),
            Self::Triangular(half) if u < 0.5 => half * ((2.0 * u).sqrt() - 1.0),
            Self::Triangular(half) => half * (1.0 - (2.0 * (1.0 - u)).sqrt()),
        }
    }

    /// Smallest deviation that is drawn; of a normal distribution four standard deviations, which one in 30 000 exceeds.
    #[must_use]
    pub fn least(self) -> f64 {
        match self {
            Self::Normal(deviation) => -4.0 * deviation,
            Self::Uniform(half) | Self::Triangular(half) => -half,
        }
    }
}

/// Quantile of the standard normal distribution.
pub(crate) fn score(u: f64) -> f64 {
    Normal::standard().inverse_cdf(u)
}

/// Distribution function of the standard normal distribution.
pub(crate) fn share(score: f64) -> f64 {
    Normal::standard().cdf(score)
}

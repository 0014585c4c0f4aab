//! Distributions of a number about its nominal value, and quasi-random draws: Sobol's sequence, scrambled after Owen in Burley's way
//! (JCGT 9(4), 2020), several times over.
//!
//! One scrambled sequence fills the cube evenly, and says nothing of its own error. Several, scrambled independently, do: the scatter
//! of what each finds is the confidence of what all find together.

use sobol_burley::sample;
use statrs::distribution::{ContinuousCDF, Normal};

/// Sequences that are scrambled independently of each other.
pub const REPLICATES: usize = 16;

/// Maximum number of draws of the sequences.
pub const MOST_DRAWS: usize = REPLICATES << 16;

const DIMENSIONS: usize = 256;

/// Points in the unit cube, the same for the same seed on every machine and with any number of threads.
///
/// ```
/// use kinetostat_analysis::tolerance::Draws;
/// let draws = Draws::new(1600, 7);
/// let mean = (0..1600).map(|i| draws.point(i, 3)).sum::<f64>() / 1600.0;
/// assert!((mean - 0.5).abs() < 2e-3, "{mean}: independent draws would be off by 7e-3");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    count: usize,
    seed: u64,
}

impl Draws {
    /// Returns `count` draws, between [`REPLICATES`] and [`MOST_DRAWS`], rounded up so that all sequences are equally
    /// long.
    #[must_use]
    pub fn new(count: usize, seed: u64) -> Self {
        let each = count.clamp(1, MOST_DRAWS).div_ceil(REPLICATES);
        Self {
            count: each * REPLICATES,
            seed,
        }
    }

    /// Number of draws.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// False: there are draws.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The sequence that a draw belongs to.
    #[must_use]
    pub fn replicate(&self, draw: usize) -> usize {
        draw / (self.count / REPLICATES).max(1)
    }

    /// Coordinate of a draw, between 0 and 1, neither of them.
    #[must_use]
    pub fn point(&self, draw: usize, dimension: usize) -> f64 {
        let each = (self.count / REPLICATES).max(1);
        let scramble = [(draw / each) as u64, (dimension / DIMENSIONS) as u64];
        let seed = scramble
            .iter()
            .fold(mixed(self.seed), |s, k| mixed(s ^ mixed(*k)));
        let (index, axis) = ((draw % each) as u32, (dimension % DIMENSIONS) as u32);
        // Points are whole multiples of 2^-24: the middle of what each stands for.
        f64::from(sample(index, axis, seed as u32)) + 0.5_f64.powi(25)
    }
}

/// A number whose bits depend on all bits of another (splitmix64).
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

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
    /// use kinetostat_analysis::tolerance::Distribution;
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
    /// use kinetostat_analysis::tolerance::Distribution;
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

//! Uncertain numbers, independent or correlated, and draws of them.

use kinetostat_machining::UncertainNumber;
use nalgebra::DMatrix;

use crate::tolerance::draws::{Distribution, Draws, score, share};

/// A number that is not exactly what the drawing states.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertain {
    /// Name of the number.
    pub name: String,
    /// Nominal value, in its own unit.
    pub value: f64,
    /// Unit as people write it; empty if there is none.
    pub unit: String,
    /// Distribution about that, in the same unit.
    pub distribution: Distribution,
}

/// Error of contradictory correlations.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the correlations contradict each other: their matrix has the eigenvalue {least:.3} and no distribution has such correlations"
)]
pub struct Contradiction {
    /// Smallest eigenvalue of the matrix.
    pub least: f64,
}

/// Set of uncertain numbers. Correlated ones are joined by a normal copula: the correlation is that of their normal scores, and of
/// normal ones themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainties {
    each: Vec<Uncertain>,
    /// Correlation of the scores, and `A` with `A A^T` equal to it; `None` for independent numbers.
    correlated: Option<(DMatrix<f64>, DMatrix<f64>)>,
}

impl Uncertainties {
    /// Independent ones.
    #[must_use]
    pub fn independent(each: Vec<Uncertain>) -> Self {
        Self {
            each,
            correlated: None,
        }
    }

    /// Set with correlations of pairs, by their places in the list.
    ///
    /// # Errors
    /// [`Contradiction`] if the matrix of the correlations is not positive semidefinite.
    pub fn correlated(
        each: Vec<Uncertain>,
        pairs: &[(usize, usize, f64)],
    ) -> Result<Self, Contradiction> {
        if pairs.iter().all(|(_, _, r)| *r == 0.0) {
            return Ok(Self::independent(each));
        }
        let mut matrix = DMatrix::identity(each.len(), each.len());
        for &(i, j, r) in pairs {
            (matrix[(i, j)], matrix[(j, i)]) = (r, r);
        }
        let eigen = matrix.clone().symmetric_eigen();
        let least = eigen.eigenvalues.min();
        // Full correlation of several numbers has zeros, and roundings of them.
        if least < -1e-10 {
            return Err(Contradiction { least });
        }
        let mut root = eigen.eigenvectors;
        for (mut column, value) in root.column_iter_mut().zip(eigen.eigenvalues.iter()) {
            column *= value.max(0.0).sqrt();
        }
        Ok(Self {
            each,
            correlated: Some((matrix, root)),
        })
    }

    /// The numbers, in their order.
    #[must_use]
    pub fn each(&self) -> &[Uncertain] {
        &self.each
    }

    /// True where some are correlated.
    #[must_use]
    pub fn is_correlated(&self) -> bool {
        self.correlated.is_some()
    }

    /// The numbers as a result lists them.
    #[must_use]
    pub fn as_stated(&self) -> Vec<UncertainNumber> {
        let number = |u: &Uncertain| UncertainNumber {
            name: u.name.clone(),
            value: u.value,
            unit: u.unit.clone(),
            distribution: u.distribution.word().to_owned(),
            spread: u.distribution.spread(),
        };
        self.each.iter().map(number).collect()
    }

    /// Values of the drawing.
    #[must_use]
    pub fn nominal(&self) -> Vec<f64> {
        self.each.iter().map(|u| u.value).collect()
    }

    /// The values of a draw.
    #[must_use]
    pub fn drawn(&self, draws: &Draws, draw: usize) -> Vec<f64> {
        let points: Vec<f64> = (0..self.each.len()).map(|d| draws.point(draw, d)).collect();
        self.at(&points)
    }

    /// The values at a point of the unit cube.
    #[must_use]
    pub fn at(&self, points: &[f64]) -> Vec<f64> {
        let own = |u: &Uncertain, point: f64| u.value + u.distribution.quantile(point);
        let Some((_, root)) = &self.correlated else {
            return self
                .each
                .iter()
                .zip(points)
                .map(|(u, p)| own(u, *p))
                .collect();
        };
        let scores: Vec<f64> = points.iter().map(|p| score(*p)).collect();
        let correlated = self.each.iter().enumerate().map(|(i, u)| {
            let z: f64 = scores
                .iter()
                .enumerate()
                .map(|(j, z)| root[(i, j)] * z)
                .sum();
            match u.distribution {
                Distribution::Normal(deviation) => u.value + deviation * z,
                _ => own(u, share(z)),
            }
        });
        correlated.collect()
    }

    /// Covariance of the numbers themselves, in their units.
    #[must_use]
    pub fn covariance(&self) -> DMatrix<f64> {
        let n = self.each.len();
        let hermite: Vec<[f64; TERMS]> = match self.correlated {
            Some(_) => self
                .each
                .iter()
                .map(|u| in_hermite(u.distribution))
                .collect(),
            None => Vec::new(),
        };
        DMatrix::from_fn(n, n, |i, j| match &self.correlated {
            _ if i == j => self.each[i].distribution.standard_deviation().powi(2),
            None => 0.0,
            Some((matrix, _)) => (1..=TERMS)
                .map(|k| hermite[i][k - 1] * hermite[j][k - 1] * matrix[(i, j)].powi(k as i32))
                .sum(),
        })
    }
}

/// Terms of a distribution's expansion in Hermite polynomials.
const TERMS: usize = 9;

/// `x(z) = sum c_k He_k(z) / sqrt(k!)`, k = 1 ..: two variables whose scores have the correlation `r` have the covariance
/// `sum c_k d_k r^k` (Mehler).
fn in_hermite(distribution: Distribution) -> [f64; TERMS] {
    let mut out = [0.0; TERMS];
    if let Distribution::Normal(deviation) = distribution {
        out[0] = deviation;
        return out;
    }
    let cells = 20_000;
    for cell in 0..cells {
        let u = (f64::from(cell) + 0.5) / f64::from(cells);
        let (x, z) = (distribution.quantile(u), score(u));
        // Normalised: h_k+1 = (z h_k - sqrt(k) h_k-1) / sqrt(k + 1).
        let (mut before, mut now) = (1.0, z);
        for (k, c) in (1_i32..).zip(&mut out) {
            *c += x * now / f64::from(cells);
            let next = (z * now - f64::from(k).sqrt() * before) / f64::from(k + 1).sqrt();
            (before, now) = (now, next);
        }
    }
    out
}

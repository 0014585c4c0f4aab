//! A force that comes back with the spindle's turn or with every tooth.

use std::f64::consts::TAU;

use nalgebra::{Complex, Vector3};

use crate::cut::{MillingCut, checked_depth};
use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::{Complex64, cis};
use crate::stability::Chebyshev;

/// A periodic force on the tool, `F = Re sum_k c_k e^(i k n turn)` with `n` periods a revolution, N, in the axes of the cut.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicForce {
    per_revolution: usize,
    harmonics: Vec<Vector3<Complex<f64>>>,
}

/// Maximum number of harmonics that are kept.
const MOST: usize = 4096;

fn checked_harmonics(harmonics: usize) -> Result<usize> {
    match (1..=MOST).contains(&harmonics) {
        true => Ok(harmonics),
        false => Err(ChatterError::new(
            ChatterErrorKind::Setting,
            "harmonics of the force",
            harmonics,
            "1 to 4096",
        )),
    }
}

impl PeriodicForce {
    pub(crate) fn new(per_revolution: usize, harmonics: Vec<Vector3<Complex64>>) -> Self {
        Self {
            per_revolution,
            harmonics,
        }
    }

    /// Expands forces (N) at evenly spaced turns of one period, of which there are so many a revolution.
    ///
    /// # Errors
    /// No period a revolution, fewer than two samples for each harmonic (they would be read as lower ones), forces that are
    /// not finite.
    pub fn sampled(
        per_revolution: usize,
        samples: &[Vector3<f64>],
        harmonics: usize,
    ) -> Result<Self> {
        checked_harmonics(harmonics)?;
        let kind = ChatterErrorKind::Setting;
        if per_revolution == 0 {
            let expected = "at least one";
            return Err(ChatterError::new(kind, "periods a revolution", 0, expected));
        }
        if samples.len() <= 2 * harmonics {
            return Err(ChatterError::new(
                kind,
                "samples of the force",
                format!("{} for {harmonics} harmonics", samples.len()),
                "more than twice as many as harmonics",
            ));
        }
        if !samples.iter().all(|f| f.iter().all(|v| v.is_finite())) {
            let expected = "finite numbers, N";
            return Err(ChatterError::new(
                kind,
                "samples of the force",
                "one that is not finite",
                expected,
            ));
        }
        let n = samples.len();
        let of = |k: usize| {
            let scale = if k == 0 { 1.0 } else { 2.0 } / n as f64;
            let mut sum = Vector3::from_element(Complex64::default());
            for (i, force) in samples.iter().enumerate() {
                // The product is taken by the number of samples, so that the angle stays exact.
                let turned = cis(-TAU * (k * i % n) as f64 / n as f64) * scale;
                sum += force.map(|value| turned * value);
            }
            sum
        };
        Ok(Self::new(per_revolution, (0..=harmonics).map(of).collect()))
    }

    /// The force of the chips that the feed alone makes, without edge forces: `F = a D (c, 0, 0)` [D 8], with the depth `a` and
    /// the feed per tooth `c` in m. Harmonics are integrals over the smooth pieces, not sums of samples.
    ///
    /// # Errors
    /// A depth or a feed that is negative.
    pub fn of_chips(
        cut: &MillingCut,
        depth: f64,
        feed_per_tooth: f64,
        harmonics: usize,
    ) -> Result<Self> {
        checked_harmonics(harmonics)?;
        checked_depth(depth)?;
        let setting = ChatterErrorKind::Setting;
        let feed = above(setting, "feed per tooth", feed_per_tooth, 0.0, false, "m")?;
        let teeth = cut.teeth();
        let pitch = TAU / teeth as f64;
        let mut sums = vec![Vector3::from_element(Complex64::default()); harmonics + 1];
        for piece in cut.pieces(depth) {
            if piece.active.is_empty() {
                continue;
            }
            let waves = (harmonics * teeth) as f64 * piece.length / TAU;
            let chebyshev = Chebyshev::new((20.0 + 4.0 * waves).min(1500.0) as usize);
            let weights = chebyshev.weights(piece.length);
            for (share, weight) in chebyshev.nodes.iter().zip(&weights) {
                let turn = piece.start + piece.length * share;
                let force = piece.matrix(cut.coefficients(), turn).column(0) * (depth * feed);
                for (k, sum) in sums.iter_mut().enumerate() {
                    let scale = if k == 0 { 1.0 } else { 2.0 } / pitch;
                    let turned = cis(-((k * teeth) as f64) * turn) * (scale * weight);
                    *sum += force.map(|value| turned * value);
                }
            }
        }
        Ok(Self::new(teeth, sums))
    }

    /// Mean force, N.
    #[must_use]
    pub fn mean(&self) -> Vector3<f64> {
        self.harmonics[0].map(|value| value.re)
    }

    /// Periods in one revolution.
    #[must_use]
    pub fn per_revolution(&self) -> usize {
        self.per_revolution
    }

    /// Amplitudes by harmonic, the mean first, N.
    #[must_use]
    pub fn harmonics(&self) -> &[Vector3<Complex<f64>>] {
        &self.harmonics
    }
}

//! Forced vibration: teeth that come and go shake the tool, and what it does at the moment a tooth makes the wall is left on it.
//!
//! [`PeriodicForce`] is a periodic force by its harmonics; [`Vibration`] is the motion of a tool under it. A vibration that comes back with
//! every tooth leaves each tooth the track that it makes itself: the chip is that of the feed alone, and regeneration
//! changes nothing, however near a lobe is. Source: `dynamics.md` section 9.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, Vector3};

use crate::cut::{Milled, MillingCut, checked_depth, checked_speed};
use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::{Complex64, cis};
use crate::response::ToolResponse;
use crate::stability::Chebyshev;

/// One harmonic of a vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VibrationHarmonic {
    /// Frequency, Hz; 0 is the mean.
    pub frequency_hz: f64,
    /// Amplitude of each component with its phase, m.
    pub displacement: Vector3<Complex<f64>>,
}

/// Displacement of the tool over the turn of the spindle, in the axes of the cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Vibration {
    per_revolution: usize,
    harmonics: Vec<VibrationHarmonic>,
}

impl Vibration {
    /// `r(t) = Re sum_k G(i k n Omega) c_k e^(i k n Omega t)` (`dynamics.md` section 9).
    ///
    /// # Errors
    /// A speed that is not positive.
    pub fn new(response: &ToolResponse, force: &PeriodicForce, speed_rpm: f64) -> Result<Self> {
        let base = checked_speed(speed_rpm)? / 60.0 * force.per_revolution() as f64;
        let of = |(k, amplitude): (usize, &Vector3<Complex<f64>>)| VibrationHarmonic {
            frequency_hz: base * k as f64,
            displacement: response.receptance(base * k as f64) * amplitude,
        };
        Ok(Self {
            per_revolution: force.per_revolution(),
            harmonics: force.harmonics().iter().enumerate().map(of).collect(),
        })
    }

    /// Mean displacement, m: the static deflection, the only part that a compensation of the mean force removes.
    #[must_use]
    pub fn mean(&self) -> Vector3<f64> {
        self.harmonics[0].displacement.map(|value| value.re)
    }

    /// The vibration about the mean place.
    #[must_use]
    pub fn without_mean(mut self) -> Self {
        self.harmonics[0].displacement = Vector3::zeros();
        self
    }

    /// The strongest harmonic that is not the mean; the first of those that are as strong, and the mean of a force of no other.
    #[must_use]
    pub fn strongest(&self) -> &VibrationHarmonic {
        let size = |h: &VibrationHarmonic| h.displacement.map(|value| value.norm()).norm();
        let others = self.harmonics.iter().skip(1);
        let strongest = others.reduce(|a, b| if size(b) > size(a) { b } else { a });
        strongest.unwrap_or(&self.harmonics[0])
    }

    /// Displacement at a turn of the spindle, rad (tooth 0 at that angle), m.
    #[must_use]
    pub fn at(&self, turn: f64) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for (k, harmonic) in self.harmonics.iter().enumerate() {
            let turned = cis((k * self.per_revolution) as f64 * turn);
            sum += harmonic.displacement.map(|value| (turned * value).re);
        }
        sum
    }

    /// Displacement without its mean, root of the mean square of each component, m.
    #[must_use]
    pub fn root_mean_square(&self) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for harmonic in self.harmonics.iter().skip(1) {
            sum += harmonic.displacement.map(|value| 0.5 * value.norm_sqr());
        }
        sum.map(f64::sqrt)
    }

    /// Error of the wall at heights above the tip, m: positive where the tool has cut too deep.
    ///
    /// A point of the wall at height `z` is made when the edge there passes the wall: `phi = 0` in up milling (wall on the
    /// left), `phi = pi` in down milling, at the turn `phi + z lag` (`cutting.md`, `dynamics.md` section 9). Of all teeth the
    /// one that leaves least counts: the deepest.
    ///
    /// # Errors
    /// A height that is negative.
    pub fn surface_error(
        &self,
        cut: &MillingCut,
        milled: Milled,
        heights: &[f64],
    ) -> Result<Vec<f64>> {
        let (angle, into) = match milled {
            Milled::Up => (0.0, 1.0),
            Milled::Down => (PI, -1.0),
        };
        let pitch = TAU / cut.teeth() as f64;
        let at = |height: &f64| {
            checked_depth(*height)?;
            let turn = angle + height * cut.lag_per_depth();
            let of = |tooth: usize| into * self.at(turn - pitch * tooth as f64).y;
            Ok((1..cut.teeth()).map(of).fold(of(0), crate::number::larger))
        };
        heights.iter().map(at).collect()
    }
}

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

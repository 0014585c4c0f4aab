//! Receptance of the tool.

use std::f64::consts::TAU;

use nalgebra::{Complex, Matrix3};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;
use crate::response::frame::FeedFrame;
use crate::response::mode::Mode;

/// How the cutting point gives way to a force there: some modes, and the flexibility of all that is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolResponse {
    modes: Vec<Mode>,
    residual: Matrix3<f64>,
}

impl ToolResponse {
    /// From modes that are all there is.
    ///
    /// # Errors
    /// No mode.
    pub fn new(modes: Vec<Mode>) -> Result<Self> {
        if modes.is_empty() {
            return Err(ChatterError::new(
                ChatterErrorKind::Response,
                "modes of the tool",
                "none",
                "at least one mode: a tool without any does not vibrate",
            ));
        }
        Ok(Self {
            modes,
            residual: Matrix3::zeros(),
        })
    }

    /// The same with the static flexibility of the modes that are left out, m/N, in the axes of the shapes:
    /// `K_C^-1 - sum phi phi^T / w^2` (MacNeal 1971, Rubin 1975; `dynamics.md` section 8). It acts without inertia.
    ///
    /// # Errors
    /// Entries that are not finite.
    pub fn with_residual(mut self, residual: Matrix3<f64>) -> Result<Self> {
        if !residual.iter().all(|value| value.is_finite()) {
            return Err(ChatterError::new(
                ChatterErrorKind::Response,
                "residual flexibility",
                format!("{:?}", residual.as_slice()),
                "nine finite numbers, m/N",
            ));
        }
        self.residual = residual;
        Ok(self)
    }

    /// The same with the residual flexibility that makes the static compliance this one, m/N, in the axes of the shapes.
    ///
    /// # Errors
    /// Entries that are not finite.
    pub fn with_static_compliance(self, compliance: Matrix3<f64>) -> Result<Self> {
        let of_modes = self.compliance() - self.residual;
        self.with_residual(compliance - of_modes)
    }

    /// The modes.
    #[must_use]
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// Static flexibility of what is left out, m/N.
    #[must_use]
    pub fn residual(&self) -> &Matrix3<f64> {
        &self.residual
    }

    /// Static compliance, m/N: the receptance at 0 Hz.
    #[must_use]
    pub fn compliance(&self) -> Matrix3<f64> {
        self.modes.iter().fold(self.residual, spring)
    }

    /// Receptance, m/N: `G(w) = sum phi phi^T/(w_k^2 - w^2 + 2 i zeta w_k w) + G_res` (`dynamics.md` section 8).
    #[must_use]
    pub fn receptance(&self, frequency_hz: f64) -> Matrix3<Complex<f64>> {
        self.at(TAU * frequency_hz)
    }

    /// As [`Self::receptance`], at an angular frequency, rad/s.
    pub(crate) fn at(&self, angular_frequency: f64) -> Matrix3<Complex64> {
        let residual = self.residual.map(Complex64::from);
        self.modes.iter().fold(residual, |sum, mode| {
            let gain = mode.gain(angular_frequency);
            let shape = mode.shape();
            sum + (shape * shape.transpose()).map(|entry| gain * entry)
        })
    }

    /// The same response in the axes of the cut: `R^T G R`.
    ///
    /// ```
    /// use kinetostat_chatter::{FeedFrame, Mode, ToolResponse};
    ///
    /// let soft_along_y = Mode::along([0.0, 1.0, 0.0].into(), 50.0, 20.0, 0.03)?;
    /// let tool = ToolResponse::new(vec![soft_along_y])?;
    /// let fed_along_y = tool.in_frame(&FeedFrame::vertical(std::f64::consts::FRAC_PI_2)?);
    /// assert!((fed_along_y.compliance()[(0, 0)] / tool.compliance()[(1, 1)] - 1.0).abs() < 1e-12);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    #[must_use]
    pub fn in_frame(&self, frame: &FeedFrame) -> Self {
        let turned = frame.rotation().transpose();
        Self {
            modes: self
                .modes
                .iter()
                .map(|mode| mode.with_shape(turned * mode.shape()))
                .collect(),
            residual: turned * self.residual * turned.transpose(),
        }
    }

    /// The same with the modes in the order of their frequencies, of which all but the lowest `count` (at least one) are springs.
    pub(crate) fn with_lowest(&self, count: usize) -> Self {
        let mut modes = self.modes.clone();
        modes.sort_by(|a, b| a.frequency_hz().total_cmp(&b.frequency_hz()));
        let rest = modes.split_off(count.clamp(1, modes.len()));
        let residual = rest.iter().fold(self.residual, spring);
        Self { modes, residual }
    }

    /// The same with the modes above a frequency taken as springs: what they give statically joins the residual flexibility.
    ///
    /// # Errors
    /// No mode at or below the frequency.
    pub fn with_modes_up_to(&self, frequency_hz: f64) -> Result<Self> {
        let (kept, rest): (Vec<Mode>, Vec<Mode>) = self
            .modes
            .iter()
            .partition(|mode| mode.frequency_hz() <= frequency_hz);
        let residual = rest.iter().fold(self.residual, spring);
        Self::new(kept)?.with_residual(residual)
    }
}

/// A flexibility with that of a mode at rest.
fn spring(sum: Matrix3<f64>, mode: &Mode) -> Matrix3<f64> {
    let (shape, w) = (mode.shape(), mode.angular_frequency());
    sum + shape * shape.transpose() / (w * w)
}

//! One mode at the cutting point.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::Complex64;

/// One mode of the loaded machine, seen at the cutting point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    shape: Vector3<f64>,
    angular_frequency: f64,
    damping_ratio: f64,
}

impl Mode {
    /// A ratio up to which a mode has no damping: what rounding leaves of a damper that it does not move.
    pub const UNDAMPED: f64 = 1e-9;

    /// A mode by its mass-normalised shape.
    ///
    /// `shape` is the translation of the cutting point in the mode, divided by the root of the modal mass, kg^-1/2, base axes;
    /// `squared_frequency` is the signed square of the undamped angular frequency, (rad/s)^2; `damping_ratio` is that of
    /// critical damping, 0.03 for 3 %.
    ///
    /// # Errors
    /// A shape that is not finite; a square that is not positive (a posture that is unstable, or free to move, has no
    /// vibration to speak of: look at its statics); a damping ratio below 0, or of 1 and more.
    pub fn new(shape: Vector3<f64>, squared_frequency: f64, damping_ratio: f64) -> Result<Self> {
        let kind = ChatterErrorKind::Response;
        if !shape.iter().all(|value| value.is_finite()) {
            return Err(ChatterError::new(
                kind,
                "shape of the mode",
                format!("{:?}", shape.as_slice()),
                "finite numbers, kg^-1/2",
            ));
        }
        if !(squared_frequency.is_finite() && squared_frequency > 0.0) {
            return Err(ChatterError::new(
                kind,
                "squared angular frequency",
                format!("{squared_frequency} (rad/s)^2"),
                "a positive number: a mode with a negative one is an unstable posture, with zero a free motion",
            ));
        }
        if !(0.0..1.0).contains(&damping_ratio) {
            return Err(ChatterError::new(
                kind,
                "damping ratio",
                damping_ratio,
                "0 to below 1: a share of critical damping, 0.03 for 3 %",
            ));
        }
        Ok(Self {
            shape,
            angular_frequency: squared_frequency.sqrt(),
            damping_ratio,
        })
    }

    /// Creates a mode like [`Self::new`] that dampers may hold beyond critical damping, so that it decays without
    /// oscillating: by its rate `2 zeta w`, 1/s. For a tool with [coupled
    /// damping](crate::ToolResponse::with_coupled_damping), whose complex modes are its vibrations.
    ///
    /// ```
    /// use kinetostat_chatter::Mode;
    ///
    /// let held = Mode::with_rate([0.2, 0.0, 0.0].into(), 1e4, 500.0)?;
    /// assert!((held.damping_ratio() - 2.5).abs() < 1e-12);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Self::new`]; a rate that is negative or not a number.
    pub fn with_rate(shape: Vector3<f64>, squared_frequency: f64, rate: f64) -> Result<Self> {
        above(
            ChatterErrorKind::Response,
            "rate of damping",
            rate,
            0.0,
            false,
            "1/s",
        )?;
        let mode = Self::new(shape, squared_frequency, 0.0)?;
        Ok(Self {
            damping_ratio: 0.5 * rate / mode.angular_frequency,
            ..mode
        })
    }

    /// A mode that moves along one direction with a modal mass.
    ///
    /// ```
    /// use kinetostat_chatter::{Mode, ToolResponse};
    ///
    /// let mode = Mode::along([1.0, 0.0, 0.0].into(), 0.04, 900.0, 0.01)?; // kg, Hz
    /// let stiffness = 0.04 * (2.0 * std::f64::consts::PI * 900.0_f64).powi(2);
    /// let tool = ToolResponse::new(vec![mode])?;
    /// assert!((tool.compliance()[(0, 0)] * stiffness - 1.0).abs() < 1e-12);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    ///
    /// # Errors
    /// A direction without length, a mass or a frequency that is not positive, and those of [`Self::new`].
    pub fn along(
        direction: Vector3<f64>,
        mass_kg: f64,
        frequency_hz: f64,
        damping_ratio: f64,
    ) -> Result<Self> {
        let kind = ChatterErrorKind::Response;
        above(kind, "modal mass", mass_kg, 0.0, true, "kg")?;
        above(kind, "natural frequency", frequency_hz, 0.0, true, "Hz")?;
        above(
            kind,
            "length of the mode's direction",
            direction.norm(),
            0.0,
            true,
            "",
        )?;
        let shape = direction.normalize() / mass_kg.sqrt();
        Self::new(shape, (TAU * frequency_hz).powi(2), damping_ratio)
    }

    /// A mode that moves along one direction with a modal stiffness, N/m.
    ///
    /// # Errors
    /// As [`Self::along`].
    pub fn with_stiffness(
        direction: Vector3<f64>,
        stiffness: f64,
        frequency_hz: f64,
        damping_ratio: f64,
    ) -> Result<Self> {
        let kind = ChatterErrorKind::Response;
        above(kind, "modal stiffness", stiffness, 0.0, true, "N/m")?;
        above(kind, "natural frequency", frequency_hz, 0.0, true, "Hz")?;
        let mass = stiffness / (TAU * frequency_hz).powi(2);
        Self::along(direction, mass, frequency_hz, damping_ratio)
    }

    /// Mass-normalised translation of the cutting point, kg^-1/2.
    #[must_use]
    pub fn shape(&self) -> Vector3<f64> {
        self.shape
    }

    /// Undamped angular frequency, rad/s.
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        self.angular_frequency
    }

    /// Undamped natural frequency, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.angular_frequency / TAU
    }

    /// Share of critical damping.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    /// Largest amplitude across z by a harmonic force of 1 N in any direction, at any frequency, m/N; with the shape in axes of the
    /// cut this is across the tool axis.
    ///
    /// ```
    /// use kinetostat_chatter::Mode;
    ///
    /// let mode = Mode::with_stiffness([1.0, 0.0, 0.0].into(), 1e6, 20.0, 0.02)?; // N/m, Hz
    /// assert!((mode.peak_flexibility() * 1e6 * 2.0 * 0.02 - 1.0).abs() < 1e-3);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    #[must_use]
    pub fn peak_flexibility(&self) -> f64 {
        let zeta = self.damping_ratio;
        // |1 - r^2 + 2 i zeta r| is least at r^2 = 1 - 2 zeta^2, and from zeta^2 = 1/2 on at rest.
        let least = match 2.0 * zeta * zeta < 1.0 {
            true => 2.0 * zeta * (1.0 - zeta * zeta).sqrt(),
            false => 1.0,
        };
        let across = self.shape.xy().norm() * self.shape.norm();
        across / (least * self.angular_frequency * self.angular_frequency)
    }

    /// Returns the mode with another shape.
    pub(crate) fn with_shape(&self, shape: Vector3<f64>) -> Self {
        Self { shape, ..*self }
    }

    /// Rate of damping `2 zeta w`, 1/s.
    pub(crate) fn rate(&self) -> f64 {
        2.0 * self.damping_ratio * self.angular_frequency
    }

    /// Root of the first-order form with positive imaginary part, rad/s: `-zeta w + i w sqrt(1 - zeta^2)`.
    pub(crate) fn root(&self) -> Complex64 {
        let (zeta, w) = (self.damping_ratio, self.angular_frequency);
        Complex64::new(-zeta * w, w * (1.0 - zeta * zeta).sqrt())
    }

    /// `1/(w_k^2 - w^2 + 2 i zeta w_k w)`, s^2.
    pub(crate) fn gain(&self, angular_frequency: f64) -> Complex64 {
        let (zeta, w) = (self.damping_ratio, self.angular_frequency);
        Complex64::new(
            w * w - angular_frequency * angular_frequency,
            2.0 * zeta * w * angular_frequency,
        )
        .inv()
    }
}

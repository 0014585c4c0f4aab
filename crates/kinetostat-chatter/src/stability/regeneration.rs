//! A tool in a regenerative cut.

use crate::cut::Cut;
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;
use crate::cut::{checked_depth, checked_speed};
use crate::response::ToolResponse;
use crate::stability::krylov;
use crate::stability::multiplier::Multiplier;
use crate::stability::operator::Operator;
use crate::stability::period::Period;

/// A tool, in the axes of the cut, and what it cuts.
///
/// ```
/// use kinetostat_chatter::{Arc, Coefficients, MillingCut, Mode, Regeneration, ToolResponse};
///
/// let mode = Mode::along([1.0, 0.0, 0.0].into(), 0.03993, 922.0, 0.011)?; // kg, Hz
/// let cut = MillingCut::new(2, Arc::slot(), Coefficients::new(6e8, 2e8, 0.0)?)?;
/// let slot = Regeneration::new(ToolResponse::new(vec![mode])?, cut.into())?;
/// let multiplier = slot.multiplier(5000.0, 0.5e-3)?; // rpm, m
/// assert!((multiplier.size() - 1.07397559).abs() < 1e-6); // unstable
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Regeneration {
    response: ToolResponse,
    cut: Cut,
}

impl Regeneration {
    /// A response in the axes of the cut ([`ToolResponse::in_frame`]) and a cut.
    ///
    /// # Errors
    /// A mode without damping, which chatters at any depth; a tool that does not give way in any direction that changes the
    /// chip.
    pub fn new(response: ToolResponse, cut: Cut) -> Result<Self> {
        let kind = ChatterErrorKind::Response;
        let undamped = response
            .modes()
            .iter()
            .find(|mode| mode.damping_ratio() <= 0.0 && mode.shape().norm() > 0.0);
        if let Some(mode) = undamped {
            return Err(ChatterError::new(
                kind,
                "damping ratio",
                format!("0 in the mode at {:.4} Hz", mode.frequency_hz()),
                "a positive one: without damping the smallest cut chatters, and no lobe is left to compute",
            ));
        }
        let mean = cut.mean_matrix();
        let (bound, flexible) = (response.bound(), {
            let moved = |along: [f64; 3]| {
                let along = nalgebra::Vector3::from(along);
                response.modes().iter().any(|mode| mode.shape().dot(&along).abs() > 0.0)
                    || (response.residual().transpose() * along).norm() > 0.0
            };
            match &cut {
                Cut::Milling(_) => moved([1.0, 0.0, 0.0]) || moved([0.0, 1.0, 0.0]),
                Cut::Turning(cut) => moved(cut.factors().0.into()),
            }
        });
        if !(flexible && bound > 0.0 && mean.norm().is_finite()) {
            return Err(ChatterError::new(
                kind,
                "flexible directions",
                "none along which the chip changes",
                "a mode or residual flexibility across the tool axis (milling) or along the chip direction (turning)",
            ));
        }
        Ok(Self { response, cut })
    }

    /// The tool's response, in the axes of the cut.
    #[must_use]
    pub fn response(&self) -> &ToolResponse {
        &self.response
    }

    /// The cut.
    #[must_use]
    pub fn cut(&self) -> &Cut {
        &self.cut
    }

    /// The largest multiplier of one tooth period at a spindle speed (rpm) and a depth of cut (m).
    ///
    /// # Errors
    /// A speed that is not positive, a depth that is negative, and modes too fast for the speed ([`ToolResponse::with_modes_up_to`]).
    pub fn multiplier(&self, speed_rpm: f64, depth: f64) -> Result<Multiplier> {
        self.multiplier_with(speed_rpm, depth, 1.0)
    }

    /// As [`Self::multiplier`], with so many times the usual points of collocation: the difference says how exact it is.
    ///
    /// # Errors
    /// As [`Self::multiplier`]; a factor outside 0.3 to 10.
    pub fn multiplier_with(&self, speed_rpm: f64, depth: f64, fineness: f64) -> Result<Multiplier> {
        let period = self.period(speed_rpm, checked_depth(depth)?, fineness)?;
        let operator = Operator::new(&period, depth);
        let (value, vector) = krylov::largest(operator.size(), |x| operator.apply(x))?;
        Ok(Multiplier::new(value, &vector, &operator, depth, &self.response))
    }

    /// All multipliers `(real, imaginary)` of one tooth period, the largest first; dense, for a look at the whole spectrum.
    ///
    /// # Errors
    /// As [`Self::multiplier`].
    pub fn multipliers(&self, speed_rpm: f64, depth: f64) -> Result<Vec<(f64, f64)>> {
        let period = self.period(speed_rpm, checked_depth(depth)?, 1.0)?;
        let all: Vec<Complex64> = krylov::eigenvalues(Operator::new(&period, depth).dense()?)?;
        Ok(all.iter().map(|value| (value.re, value.im)).collect())
    }

    pub(crate) fn period(&self, speed_rpm: f64, depth: f64, fineness: f64) -> Result<Period> {
        checked_speed(speed_rpm)?;
        if !(0.3..=10.0).contains(&fineness) {
            return Err(ChatterError::new(
                ChatterErrorKind::Setting,
                "fineness of the collocation",
                fineness,
                "0.3 to 10 times the usual points",
            ));
        }
        Period::new(&self.response, &self.cut, speed_rpm, depth, fineness)
    }
}

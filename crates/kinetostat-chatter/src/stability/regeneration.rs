//! A tool in a regenerative cut.

use nalgebra::{Matrix3, Vector3};

use crate::branches::grid;
use crate::cut::{Cut, checked_depth, checked_speed};
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::{Complex64, larger};
use crate::response::{Mode, ToolResponse};
use crate::stability::eigenvalues::{ACCURATE, eigenvalues};
use crate::stability::multiplier::Multiplier;
use crate::stability::operator::Operator;
use crate::stability::period::Period;
use crate::stability::states::{State, receptance, states};
use crate::stability::swinging::{Selection, Swinging};

/// Change of a multiplier with a third more points that is accepted, share of it.
const RESOLVED: f64 = 1e-7;
/// Growth of the number of points, and most times the usual ones.
const FINER: f64 = 4.0 / 3.0;
const FINEST: f64 = 4.0;

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
    /// States of the modes, or the reason why they cannot be separated.
    states: Result<Vec<State>>,
    /// Upper bound of the displacement by a force of 1 N at any frequency, m/N.
    gain: f64,
    /// Selection of the dynamic modes; without it all are.
    selected: Option<Box<Selected>>,
}

/// The modes that swing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Selected {
    pub(crate) selection: Selection,
    /// The cut with those that do at most speeds.
    pub(crate) usual: Regeneration,
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
            .find(|mode| mode.damping_ratio() <= Mode::UNDAMPED && mode.shape().norm() > 0.0);
        if let Some(mode) = undamped {
            return Err(ChatterError::new(
                kind,
                "damping ratio",
                format!(
                    "{:.2e} in the mode at {:.4} Hz",
                    mode.damping_ratio(),
                    mode.frequency_hz()
                ),
                "one above 1e-9: without damping the smallest cut chatters, and no lobe is left to compute (a damper that a mode does not move gives it none)",
            ));
        }
        let moved = |along: Vector3<f64>| {
            let of_mode = |mode: &Mode| mode.shape().dot(&along) != 0.0;
            response.modes().iter().any(of_mode)
                || (response.residual().transpose() * along).norm() > 0.0
        };
        let flexible = match &cut {
            Cut::Milling(_) => moved(Vector3::x()) || moved(Vector3::y()),
            Cut::Turning(cut) => moved(cut.factors().0),
        };
        if !flexible {
            return Err(ChatterError::new(
                kind,
                "flexible directions",
                "none along which the chip changes",
                "a mode or residual flexibility across the tool axis (milling) or along the chip direction (turning)",
            ));
        }
        Ok(Self::of_all(response, cut))
    }

    /// Builds from valid data, all modes dynamic.
    fn of_all(response: ToolResponse, cut: Cut) -> Self {
        let all = Self {
            states: states(&response),
            response,
            cut,
            gain: f64::INFINITY,
            selected: None,
        };
        Self {
            gain: all.peak(),
            ..all
        }
    }

    /// The tool's receptance at an angular frequency, rad/s, m/N.
    pub(crate) fn at(&self, w: f64) -> Matrix3<Complex64> {
        match (self.response.coupling(), &self.states) {
            (Some(_), Ok(states)) => {
                self.response.at_once().map(Complex64::from) + receptance(states, w)
            }
            _ => self.response.at(w),
        }
    }

    /// Largest size of the receptance over all frequencies: at those that are close together at the peaks, and a little more.
    fn peak(&self) -> f64 {
        let size = |frequency: f64| self.at(frequency).map(|entry| entry.norm()).norm();
        let modes = self.response.modes().iter();
        let at_peaks = modes.map(|m| size(m.angular_frequency()));
        let all = grid(&self.response).into_iter().map(size).chain(at_peaks);
        1.05 * all.fold(size(0.0), larger)
    }

    /// Selects the modes kept dynamic for stability; the others enter as residual flexibility.
    ///
    /// ```
    /// use kinetostat_chatter::{Arc, Coefficients, MillingCut, Mode, Regeneration, Swinging, ToolResponse};
    ///
    /// let along = |hz, stiffness| Mode::with_stiffness([1.0, 0.0, 0.0].into(), stiffness, hz, 0.02);
    /// let tool = ToolResponse::new(vec![along(20.0, 1e6)?, along(700.0, 2e7)?, along(900.0, 1e9)?])?;
    /// let cut = MillingCut::new(2, Arc::slot(), Coefficients::new(6e8, 2e8, 0.0)?)?;
    /// let slot = Regeneration::new(tool, cut.into())?.with_swinging(Swinging::AtLeastTo(0.0));
    /// let stability = slot.stability_at(8000.0, 1e-3)?; // rpm, m
    /// assert!((stability.modes_up_to_hz - 700.0).abs() < 1e-6);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    #[must_use]
    pub fn with_swinging(self, swinging: Swinging) -> Self {
        let selection = Selection::new(&self.response, self.cut.bound(), swinging);
        let selected = |selection: Selection| Selected {
            usual: self.lowest(selection.count),
            selection,
        };
        let selected = selection.map(selected).map(Box::new);
        Self { selected, ..self }
    }

    /// Keeps the lowest modes dynamic, the others as springs.
    pub(crate) fn lowest(&self, count: usize) -> Self {
        Self::of_all(self.response.with_lowest(count), self.cut.clone())
    }

    pub(crate) fn selected(&self) -> Option<&Selected> {
        self.selected.as_deref()
    }

    /// The tool's response with all its modes, in the axes of the cut.
    #[must_use]
    pub fn response(&self) -> &ToolResponse {
        &self.response
    }

    pub(crate) fn gain(&self) -> f64 {
        self.gain
    }

    /// The cut.
    #[must_use]
    pub fn cut(&self) -> &Cut {
        &self.cut
    }

    /// The largest multiplier of one tooth period at a spindle speed (rpm) and a depth of cut (m), with points added until it
    /// changes by less than 1e-7 of itself.
    ///
    /// # Errors
    /// A speed that is not positive, a depth that is negative, and modes too fast for the speed ([`ToolResponse::with_modes_up_to`]).
    pub fn multiplier(&self, speed_rpm: f64, depth: f64) -> Result<Multiplier> {
        let mut fineness = 1.0;
        let mut last = self.multiplier_with(speed_rpm, depth, fineness)?;
        loop {
            fineness *= FINER;
            let next = self.multiplier_with(speed_rpm, depth, fineness)?;
            let change = (next.size() / last.size() - 1.0).abs();
            if change <= RESOLVED {
                return Ok(next);
            }
            if fineness >= FINEST {
                return Err(ChatterError::new(
                    ChatterErrorKind::NotConverged,
                    format!("largest multiplier at {speed_rpm} rpm and {depth:e} m"),
                    format!("changes by {change:.1e} of itself with a third more points"),
                    "a change below 1e-7: take faster modes as springs (modes up to a lower frequency)",
                ));
            }
            last = next;
        }
    }

    /// Multiplier as by [`Self::multiplier`], with so many times the usual points of collocation: the difference shows
    /// the accuracy.
    ///
    /// # Errors
    /// Those of [`Self::multiplier`]; a factor outside 0.3 to 10.
    pub fn multiplier_with(&self, speed_rpm: f64, depth: f64, fineness: f64) -> Result<Multiplier> {
        let period = self.period(speed_rpm, checked_depth(depth)?, fineness)?;
        let operator = Operator::new(&period, depth);
        let (value, vector) = operator.largest(ACCURATE, &mut None)?;
        Ok(Multiplier::new(value, &vector, &operator, depth, &|w| {
            self.at(w)
        }))
    }

    /// All multipliers `(real, imaginary)` of one tooth period, the largest first; dense, for a look at the whole spectrum.
    ///
    /// # Errors
    /// As [`Self::multiplier`].
    pub fn multipliers(&self, speed_rpm: f64, depth: f64) -> Result<Vec<(f64, f64)>> {
        let period = self.period(speed_rpm, checked_depth(depth)?, 1.0)?;
        let all: Vec<Complex64> = eigenvalues(Operator::new(&period, depth).dense()?)?;
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
        let states = self.states.clone()?;
        Period::new(
            &self.response,
            states,
            &self.cut,
            speed_rpm,
            depth,
            fineness,
        )
    }
}

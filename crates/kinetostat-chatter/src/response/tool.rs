//! Receptance of the tool, and the tool with a force by displacement as a system of first order.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, Matrix3, Vector3};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;
use crate::response::coupling::Coupling;
use crate::response::mode::Mode;

/// Response of the cutting point to a force there: some modes, and the residual flexibility of the omitted ones.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolResponse {
    modes: Vec<Mode>,
    residual: Matrix3<f64>,
    /// Coupling of the modes by damping.
    coupling: Option<Coupling>,
}

impl ToolResponse {
    /// Response by these modes alone.
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
            coupling: None,
        })
    }

    /// Adds damping that couples the modes, as dampers at joints do, with each other and with massless directions.
    ///
    /// `held` are directions without mass of unit stiffness that dampers hold, as translations of the cutting point, m per
    /// sqrt(N m), in the axes of the shapes; their flexibility `h h^T` is a part of the residual one. `rates` is the damping by modes in
    /// their order (1/s, with `2 zeta_k w_k` on the diagonal), then by these directions (s, with their times of relaxation on
    /// the diagonal).
    ///
    /// ```
    /// use kinetostat_chatter::{Mode, ToolResponse};
    /// use nalgebra::DMatrix;
    ///
    /// let mode = |x, y, hz| Mode::along([x, y, 0.0].into(), 50.0, hz, 0.02);
    /// let modes = vec![mode(1.0, 0.0, 20.0)?, mode(0.0, 1.0, 24.0)?];
    /// let own = |k: usize| 2.0 * 0.02 * modes[k].angular_frequency();
    /// let rates = DMatrix::from_row_slice(2, 2, &[own(0), 3.0, 3.0, own(1)]);
    /// let tool = ToolResponse::new(modes.clone())?.with_coupled_damping(rates, Vec::new())?;
    /// // A force along x moves the tool along y.
    /// assert!(tool.receptance(20.0)[(1, 0)].norm() > 0.04 * tool.receptance(20.0)[(0, 0)].norm());
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    ///
    /// # Errors
    /// A matrix of another size, not symmetric, with another diagonal, or that feeds energy to a vibration.
    pub fn with_coupled_damping(
        mut self,
        rates: DMatrix<f64>,
        held: Vec<Vector3<f64>>,
    ) -> Result<Self> {
        self.coupling = Coupling::new(&self.modes, rates, held)?;
        Ok(self)
    }

    /// Coupling of the modes by damping.
    pub(crate) fn coupling(&self) -> Option<&Coupling> {
        self.coupling.as_ref()
    }

    /// Flexibility without inertia and without dampers, m/N.
    pub(crate) fn at_once(&self) -> Matrix3<f64> {
        let held = self.coupling.iter().flat_map(Coupling::held);
        held.fold(self.residual, |sum, h| sum - h * h.transpose())
    }

    /// Adds the static flexibility of the omitted modes, m/N, in the axes of the shapes: `K_C^-1 - sum phi phi^T / w^2`
    /// (MacNeal 1971, Rubin 1975; `dynamics.md` section 8). It acts without inertia.
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

    /// Receptance, m/N: `G(w) = sum phi phi^T/(w_k^2 - w^2 + 2 i zeta w_k w) + G_res` (`dynamics.md` section 8), and with all rates
    /// where damping couples modes.
    #[must_use]
    pub fn receptance(&self, frequency_hz: f64) -> Matrix3<Complex<f64>> {
        self.at(TAU * frequency_hz)
    }

    /// Receptance as by [`Self::receptance`], at an angular frequency, rad/s.
    pub(crate) fn at(&self, angular_frequency: f64) -> Matrix3<Complex64> {
        if let Some(coupling) = &self.coupling {
            let of_all = coupling.receptance(&self.modes, angular_frequency);
            return self.at_once().map(Complex64::from) + of_all;
        }
        let residual = self.residual.map(Complex64::from);
        self.modes.iter().fold(residual, |sum, mode| {
            let gain = mode.gain(angular_frequency);
            let shape = mode.shape();
            sum + (shape * shape.transpose()).map(|entry| gain * entry)
        })
    }

    /// Transforms the response to the axes of the cut: `R^T G R`.
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
            coupling: self.coupling.as_ref().map(|c| c.turned(&turned)),
        }
    }

    /// Sorts the modes by frequency and turns all but the lowest `count` (at least one) into springs.
    pub(crate) fn with_lowest(&self, count: usize) -> Self {
        let mut order: Vec<usize> = (0..self.modes.len()).collect();
        let hz = |k: usize| self.modes[k].frequency_hz();
        order.sort_by(|a, b| hz(*a).total_cmp(&hz(*b)));
        let rest = order.split_off(count.clamp(1, order.len()));
        self.of(&order, &rest)
    }

    /// Keeps some of the modes, in this order, and turns others into springs.
    fn of(&self, kept: &[usize], springs: &[usize]) -> Self {
        let springs = springs.iter().map(|k| &self.modes[*k]);
        let modes: Vec<Mode> = kept.iter().map(|k| self.modes[*k]).collect();
        let coupling = self.coupling.as_ref();
        Self {
            residual: springs.fold(self.residual, spring),
            coupling: coupling.and_then(|coupling| coupling.of(&modes, kept)),
            modes,
        }
    }

    /// Turns the modes above a frequency into springs: their static flexibility joins the residual flexibility.
    ///
    /// # Errors
    /// No mode at or below the frequency.
    pub fn with_modes_up_to(&self, frequency_hz: f64) -> Result<Self> {
        let (kept, rest): (Vec<usize>, Vec<usize>) =
            (0..self.modes.len()).partition(|k| self.modes[*k].frequency_hz() <= frequency_hz);
        let found = self.of(&kept, &rest);
        // Refuses none.
        Self::new(found.modes.clone())?;
        Ok(found)
    }
}

/// A flexibility with that of a mode at rest.
fn spring(sum: Matrix3<f64>, mode: &Mode) -> Matrix3<f64> {
    let (shape, w) = (mode.shape(), mode.angular_frequency());
    sum + shape * shape.transpose() / (w * w)
}

/// Axes of the cut in those of the machine: the columns are feed, left of the feed, and tool axis towards the spindle.
///
/// ```
/// use kinetostat_chatter::FeedFrame;
///
/// // A vertical spindle, fed along the base's y: left of the feed is -x.
/// let frame = FeedFrame::new([0.0, 1.0, 0.0].into(), [0.0, 0.0, 1.0].into())?;
/// assert_eq!(frame.rotation().column(1).as_slice(), [-1.0, 0.0, 0.0]);
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedFrame {
    rotation: Matrix3<f64>,
}

/// Tolerance of the columns' right angles and unit lengths.
const TOLERANCE: f64 = 1e-6;

impl FeedFrame {
    /// Frame from the feed and the tool axis (from the tip towards the spindle), in base axes; a component of the feed
    /// along the axis is ignored.
    ///
    /// # Errors
    /// A direction that is not finite or has no length; a feed along the tool axis, which has no left side.
    pub fn new(feed: Vector3<f64>, towards_spindle: Vector3<f64>) -> Result<Self> {
        let kind = ChatterErrorKind::Cut;
        let unit = |vector: Vector3<f64>, quantity: &str| {
            vector
                .iter()
                .all(|value| value.is_finite())
                .then(|| vector.try_normalize(0.0))
                .flatten()
                .ok_or_else(|| {
                    ChatterError::new(
                        kind,
                        quantity,
                        format!("{:?}", vector.as_slice()),
                        "a direction: finite numbers, not all zero",
                    )
                })
        };
        let z = unit(towards_spindle, "tool axis")?;
        let along = unit(feed, "feed direction")?;
        let across = along - z * z.dot(&along);
        if across.norm() < TOLERANCE {
            return Err(ChatterError::new(
                kind,
                "feed direction",
                "along the tool axis",
                "a feed across the tool axis",
            ));
        }
        let x = across.normalize();
        Ok(Self {
            rotation: Matrix3::from_columns(&[x, z.cross(&x), z]),
        })
    }

    /// A vertical spindle (base z) fed at an angle from base x, rad.
    ///
    /// # Errors
    /// An angle that is not finite.
    pub fn vertical(angle: f64) -> Result<Self> {
        Self::new(Vector3::new(angle.cos(), angle.sin(), 0.0), Vector3::z())
    }

    /// Columns: feed, left of the feed, tool axis towards the spindle.
    #[must_use]
    pub fn rotation(&self) -> &Matrix3<f64> {
        &self.rotation
    }
}

/// The matrix of `W q`, `q'` and `z`, in which its entries are of one size; `force` is the force on the tool by displacement, N/m.
pub(crate) fn first_order(response: &ToolResponse, force: &Matrix3<f64>) -> DMatrix<f64> {
    let modes = response.modes();
    let m = modes.len();
    let own = |i: usize, j: usize| match i == j {
        true => modes[i].rate(),
        false => 0.0,
    };
    let coupling = response.coupling();
    let held = coupling.map_or(0, |coupling| coupling.held().len());
    let rates = coupling.map_or_else(|| DMatrix::from_fn(m, m, own), |c| c.rates().clone());
    let point = |k: usize| coupling.map_or_else(|| modes[k].shape(), |c| c.point(modes, k));
    let w = |k: usize| modes[k].angular_frequency();
    let pushed = |i: usize, j: usize| point(i).dot(&(force * point(j)));
    // R_zz z' = H^T F - z - R_zq q'
    let n = 2 * m + held;
    let mut relaxing = DMatrix::zeros(held, n);
    for i in 0..held {
        for j in 0..m {
            relaxing[(i, j)] = pushed(m + i, j) / w(j);
            relaxing[(i, m + j)] = -rates[(m + i, j)];
        }
        for j in 0..held {
            relaxing[(i, 2 * m + j)] = pushed(m + i, m + j) - f64::from(u8::from(i == j));
        }
    }
    if held > 0 {
        // Times of relaxation are positive: there is a solution.
        let times = rates.view((m, m), (held, held)).into_owned().lu();
        times.solve_mut(&mut relaxing);
    }
    // q'' = Phi^T F - W^2 q - R_qq q' - R_qz z'
    let mut driven = -(rates.view((0, m), (m, held)) * &relaxing);
    let mut matrix = DMatrix::zeros(n, n);
    for i in 0..m {
        matrix[(i, m + i)] = w(i);
        driven[(i, i)] -= w(i);
        for j in 0..m {
            driven[(i, j)] += pushed(i, j) / w(j);
            driven[(i, m + j)] -= rates[(i, j)];
        }
        for j in 0..held {
            driven[(i, 2 * m + j)] += pushed(i, m + j);
        }
    }
    matrix.view_mut((m, 0), (m, n)).copy_from(&driven);
    matrix.view_mut((2 * m, 0), (held, n)).copy_from(&relaxing);
    matrix
}

//! Mode-coupling chatter at low frequency: a process without delay that pushes back across two soft directions [D 10, D 11].
//!
//! `F = -Kc f (n . r)` for a single cut, or `F = a D0 r` for the tooth average of milling. Where the soft directions lie
//! badly to `n` and `f`, two modes take energy from the process in turn. All modes count, whatever their axes.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::branches::{Branches, Place};
use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::smaller;
use crate::response::{ToolResponse, first_order};
use crate::stability::eigenvalues;

/// Instability of a tool by a process without delay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coupled {
    /// Two modes feed each other: vibration.
    Flutter,
    /// The process pulls harder than the tool holds: it is drawn in without vibrating.
    StaticLoss,
}

/// The smallest process that makes a tool unstable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct CoupledLimit {
    /// Factor of the process: `Kc`, N/m, of a unit process, or the depth of cut, m.
    pub factor: f64,
    /// Type of the instability.
    pub kind: Coupled,
    /// Frequency of the vibration, Hz; 0 for static loss.
    pub frequency_hz: f64,
}

/// Force on the tool by displacement, per factor: `-f n^T` of a unit process stiffness, or the mean matrix of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Process {
    matrix: Matrix3<f64>,
}

impl Process {
    /// A displacement along `chip` thickens the chip, and the cut pushes back against `force`: `F = -Kc f (n . r)`, both made
    /// unit vectors; the factor is `Kc`, N/m (width times coefficient).
    ///
    /// # Errors
    /// A direction without length.
    pub fn new(chip: Vector3<f64>, force: Vector3<f64>) -> Result<Self> {
        let unit = |quantity: &str, vector: Vector3<f64>| {
            above(
                ChatterErrorKind::Cut,
                quantity,
                vector.norm(),
                0.0,
                true,
                "",
            )?;
            Ok(vector.normalize())
        };
        let chip = unit("length of the chip direction", chip)?;
        let force = unit("length of the force direction", force)?;
        Ok(Self {
            matrix: -force * chip.transpose(),
        })
    }
}

/// The smallest factor of a process at which a tool loses its stability; `None` where it never does.
///
/// ```
/// use kinetostat_chatter::{Mode, Process, ToolResponse, coupled_limit};
///
/// let axis = |x: f64, y: f64, k: f64| {
///     let frequency = (k / 50.0_f64).sqrt() / std::f64::consts::TAU;
///     Mode::along([x, y, 0.0].into(), 50.0, frequency, 0.02)
/// };
/// let tool = ToolResponse::new(vec![axis(1.0, 0.0, 1e6)?, axis(0.0, 1.0, 1.4e6)?])?;
/// let process = Process::new([1.0, 1.0, 0.0].into(), [1.0, -1.0, 0.0].into())?;
/// let limit = coupled_limit(&tool, &process)?.expect("flutter");
/// assert!((limit.factor / 210969.23 - 1.0).abs() < 1e-7); // N/m; the loss of stiffness 1.4e6 - 1e6 is 4e5
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
///
/// # Errors
/// Modes without damping: their limit is that of [`two_axis_limit`], from which the smallest damping may be far
/// (`dynamics.md` section 11).
pub fn coupled_limit(response: &ToolResponse, process: &Process) -> Result<Option<CoupledLimit>> {
    if let Some(mode) = response.modes().iter().find(|m| m.damping_ratio() <= 0.0) {
        return Err(ChatterError::new(
            ChatterErrorKind::Response,
            "damping ratio",
            format!("0 in the mode at {:.4} Hz", mode.frequency_hz()),
            "a positive one; two_axis_limit has the closed form without damping",
        ));
    }
    let branches = Branches {
        response,
        receptance: Box::new(|w| response.at(w)),
        mean: process.matrix,
    };
    let mut best = static_loss(&branches);
    branches.walk(|from, to| {
        // 1 = factor mu: mu real and positive, its argument a whole number of turns.
        let (low, high) = match from.argument < to.argument {
            true => (from.argument, to.argument),
            false => (to.argument, from.argument),
        };
        let turn = (low / TAU).ceil() * TAU;
        if turn >= high {
            return;
        }
        let place: Place = branches.closed_in(from, to, |place| place.argument - turn);
        let factor = place.mu.inv().re;
        if factor > 0.0 && best.is_none_or(|best| factor < best.factor) {
            best = Some(CoupledLimit {
                factor,
                kind: Coupled::Flutter,
                frequency_hz: place.frequency / TAU,
            });
        }
    });
    Ok(best)
}

/// Zero of `1 + Kc n^T K_C^-1 f`.
fn static_loss(branches: &Branches<'_>) -> Option<CoupledLimit> {
    let real = branches.eigenvalues(0.0).into_iter();
    let factors = real
        .filter(|mu| mu.re > 0.0 && mu.im.abs() <= 1e-9 * mu.norm())
        .map(|mu| mu.inv().re);
    factors.reduce(smaller).map(|factor| CoupledLimit {
        factor,
        kind: Coupled::StaticLoss,
        frequency_hz: 0.0,
    })
}

/// Roots `(real, imaginary)`, 1/s, of the tool with a process of a factor, the fastest growing first: eigenvalues of the
/// first-order form of `M s^2 + C s + K + Kc B f n^T B^T` [D 11], with the residual flexibility.
///
/// # Errors
/// A factor that is negative, or at which the residual flexibility alone gives way.
pub fn coupled_roots(
    response: &ToolResponse,
    process: &Process,
    factor: f64,
) -> Result<Vec<(f64, f64)>> {
    let kind = ChatterErrorKind::Setting;
    above(kind, "factor of the process", factor, 0.0, false, "")?;
    // r = Phi q + G_res F and F = a P r: F = a P (1 - a G_res P)^-1 Phi q.
    let inner = Matrix3::identity() - response.at_once() * process.matrix * factor;
    let inverse = inner.try_inverse().ok_or_else(|| {
        let found = format!("{factor}: the residual flexibility alone gives way");
        ChatterError::new(kind, "factor of the process", found, "a smaller one")
    })?;
    let force = process.matrix * inverse * factor;
    let matrix = first_order(response, &force);
    let mut all: Vec<(f64, f64)> = eigenvalues(matrix)?.iter().map(|s| (s.re, s.im)).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| b.1.total_cmp(&a.1)));
    Ok(all)
}

/// The process stiffness, N/m, from which two undamped modes of equal mass along right angles flutter [D 11]; `None` where
/// none does.
///
/// `k1`, `k2` are principal stiffnesses, N/m; `chip` and `force` the angles of chip and force direction from axis 1, rad:
/// `Kc = min positive of (k2 - k1)/(cos(a + b) +- sqrt(-sin 2a sin 2b))`, never below half the difference of stiffnesses.
///
/// ```
/// let limit = kinetostat_chatter::two_axis_limit(1e6, 1.4e6, 45_f64.to_radians(), -45_f64.to_radians())?;
/// assert!((limit.expect("flutter") / 2e5 - 1.0).abs() < 1e-12);
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
///
/// # Errors
/// A stiffness that is not positive, angles that are not finite.
pub fn two_axis_limit(k1: f64, k2: f64, chip: f64, force: f64) -> Result<Option<f64>> {
    let kind = ChatterErrorKind::Response;
    above(kind, "first stiffness", k1, 0.0, true, "N/m")?;
    above(kind, "second stiffness", k2, 0.0, true, "N/m")?;
    for (quantity, angle) in [("chip direction", chip), ("force direction", force)] {
        if !angle.is_finite() {
            let expected = "a finite angle, rad";
            return Err(ChatterError::new(
                ChatterErrorKind::Cut,
                quantity,
                angle,
                expected,
            ));
        }
    }
    let product = (2.0 * chip).sin() * (2.0 * force).sin();
    if product >= 0.0 {
        return Ok(None);
    }
    let root = (-product).sqrt();
    let sum = (chip + force).cos();
    let of = |sign: f64| (k2 - k1) / (sum + sign * root);
    let positive = [of(1.0), of(-1.0)].into_iter().filter(|k| *k >= 0.0);
    Ok(positive.reduce(smaller))
}

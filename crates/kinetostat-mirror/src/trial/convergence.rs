//! Rate at which the error falls, and bound on the relaxation below which it cannot rise.
//!
//! A machine that is sent to the path plus a correction `c` leaves the deviation `e(c) = e0 + (I + D) c` across the path: `D` is
//! how far its answer to a correction departs from the correction itself. The trial after it has
//! `c' = c - rho S e`, so that `e' = (I - rho (I + D) S) e` with the kernel's smoothing `S`.
//!
//! The Gaussian kernel is positive definite and no row of `S` sums to more than 1, so that in the metric `M = diag(w r)` (weight of a
//! point times the weight that its mean rests on) `S` is symmetric with eigenvalues from 0 to 1, however the points are spaced. The
//! remainder across the path is a projection, which keeps both. In the norm `|e|_S^2 = <e, S e>_M`
//! ([`passing_rms_mm`](crate::DeviationFigures::passing_rms_mm)) three things follow. This is proven for points at the same places of
//! the path in every trial, at which the correction acts as smoothed. Here it is kept at stations a quarter of the smoothing length
//! apart and runs on cubic curves between them, and the written program has its own tolerance: both are below what the tests tell
//! apart (`tests/mirror/trials.rs`).
//!
//! - `D = d`, a number above -1: a component that the kernel lets through with the share `mu` is multiplied by `1 - rho mu (1 + d)`
//!   in each trial; none grows while `0 < rho < 2 / (1 + d)`.
//! - `D` symmetric in `M`, `|D| < 1`: `0 <= S^(1/2) (I + D) S^(1/2) <= (1 + |D|) I`, and the norm falls while
//!   `0 < rho < 2 / (1 + |D|)`.
//! - any `D` with `|D| < 1`: from `|(I - rho B) y|^2 = |y|^2 - 2 rho <y, B y> + rho^2 |B y|^2` with
//!   `<y, B y> >= (1 - |D|) |S^(1/2) y|^2` and `|B y| <= (1 + |D|) |S^(1/2) y|` it never rises while
//!   `0 < rho <= 2 (1 - |D|) / (1 + |D|)^2`.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bound on the relaxation below which the error never rises, for a departure of at most this size, symmetric; `None` if it is
/// 1 or more.
///
/// ```
/// use kinetostat_mirror::bound_on_relaxation;
///
/// assert_eq!(bound_on_relaxation(0.25), Some(1.6));
/// assert_eq!(bound_on_relaxation(1.0), None);
/// ```
#[must_use]
pub fn bound_on_relaxation(departure: f64) -> Option<f64> {
    (departure.abs() < 1.0).then_some(2.0 / (1.0 + departure.abs()))
}

/// Response of the machine, from two trials in a row.
///
/// With the smoothed deviation `a = S e` of the trial before, mirrored with `rho`, the one after is `a' = a - rho S (I + D) a`. The
/// response `1 + d` is the number with which `rho (1 + d) S a` comes nearest to `a - a'`: only the part of the correction that the
/// kernel lets through counts (with all of it the response would seem smaller, and the bound larger, than they are). The residual of
/// `a - a'` is the variation of `D` along the path, and scatter; as a share of `rho S a` it is `spread`, and the bound is that of a
/// departure of `|d| + spread`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Convergence {
    /// Share of the smoothed error of the trial before that is left.
    pub factor: f64,
    /// Projection on it of the smoothed error that is left, negative if the correction was too large.
    pub signed_factor: f64,
    /// The departure `d` that explains the change best.
    pub departure: f64,
    /// Root mean square by which departures along the path differ from it, scatter included.
    #[serde(default)]
    pub spread: f64,
    /// The relaxation must stay below this: estimated, for the largest departure that one spread allows.
    pub relaxation_below: Option<f64>,
    /// The error has risen.
    pub risen: bool,
}

impl Convergence {
    /// Convergence from the smoothed deviations of two trials at the stations of a path, with the lengths that they stand for, and
    /// the first of them smoothed once more.
    pub(crate) fn between(
        [before, after, passed]: [&[Vector3<f64>]; 3],
        lengths_mm: &[f64],
        relaxation: f64,
    ) -> Option<Self> {
        let product = |a: &dyn Fn(usize) -> Vector3<f64>, b: &dyn Fn(usize) -> Vector3<f64>| {
            let all = lengths_mm.iter().enumerate();
            all.map(|(k, length)| length * a(k).dot(&b(k))).sum::<f64>()
        };
        let (of_before, of_after) = (|k: usize| before[k], |k: usize| after[k]);
        let (change, sent) = (
            |k: usize| before[k] - after[k],
            |k: usize| passed[k] * relaxation,
        );
        let square = product(&of_before, &of_before);
        let left = product(&of_after, &of_after);
        let sent_square = product(&sent, &sent);
        let found = square > 0.0 && left.is_finite() && relaxation > 0.0 && sent_square > 0.0;
        found.then(|| {
            let answer = product(&change, &sent) / sent_square;
            let over = |k: usize| change(k) - sent(k) * answer;
            let spread = (product(&over, &over) / sent_square).sqrt();
            let departure = answer - 1.0;
            Self {
                factor: (left / square).sqrt(),
                signed_factor: product(&of_before, &of_after) / square,
                departure,
                spread,
                relaxation_below: bound_on_relaxation(departure.abs() + spread),
                risen: left > square,
            }
        })
    }
}

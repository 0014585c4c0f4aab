//! The zeroth-order (single-frequency) approximation of Altintas and Budak [D 9].
//!
//! It replaces the directional matrix by its mean over the turn. It knows no flip, errs at low immersion, and is **not a
//! conservative bound**: on robots, whose structural modes meet half tooth frequencies at ordinary speeds, it was 1.6 to 3.7
//! times too optimistic (`dynamics.md` section 10). Screen with it, confirm with [`crate::Regeneration`]. For turning, whose
//! matrix is its mean, it is exact.

use std::f64::consts::{PI, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::branches::{Branches, Place};
use crate::error::Result;
use crate::number::{Complex64, smaller};
use crate::stability::Regeneration;

/// A limit of zeroth order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ZerothOrderLimit {
    /// Depth of cut, m.
    pub depth: f64,
    /// Chatter frequency, Hz.
    pub frequency_hz: f64,
}

/// `a_lim = |lam|^2/(2 Re lam)` [D 9]; none where the real part of `lam = 1/mu` is not positive.
fn depth(mu: Complex64) -> Option<f64> {
    let lam = mu.inv();
    (lam.re > 0.0).then(|| lam.norm_sqr() / (2.0 * lam.re))
}

/// The limit of zeroth order at a spindle speed, rpm; `None` where no frequency has a limit at this speed.
///
/// Each eigenvalue of `G(i w) D0` is followed over the frequency; wherever the phase equation of [D 9] holds for this speed,
/// its depth counts, and the smallest is the limit.
///
/// # Errors
/// A speed that is not positive.
pub fn limit(regeneration: &Regeneration, speed_rpm: f64) -> Result<Option<ZerothOrderLimit>> {
    limit_on(&steps(regeneration), regeneration, speed_rpm)
}

/// The steps of both branches over all frequencies, which are the same at every speed.
pub(crate) fn steps(regeneration: &Regeneration) -> Vec<(Place, Place)> {
    let mut steps = Vec::new();
    of(regeneration).walk(|from, to| steps.push((*from, *to)));
    steps
}

/// Limit as by [`limit`], with the [`steps`] of the branches.
pub(crate) fn limit_on(
    steps: &[(Place, Place)],
    regeneration: &Regeneration,
    speed_rpm: f64,
) -> Result<Option<ZerothOrderLimit>> {
    let delay = regeneration.cut().delay(speed_rpm)?;
    let branches = of(regeneration);
    let mut best: Option<ZerothOrderLimit> = None;
    for (from, to) in steps {
        within(&branches, delay, from, to, &mut best);
    }
    Ok(best)
}

fn of(regeneration: &Regeneration) -> Branches<'_> {
    Branches {
        response: regeneration.response(),
        receptance: Box::new(|w| regeneration.at(w)),
        mean: regeneration.cut().mean_matrix(),
    }
}

/// The smallest depth of all frequencies between two places at which the phase equation holds: `w tau + pi + 2 arg lam` is a
/// whole number of turns where `e^(-i w tau) = 1 - lam/a_lim`.
fn within(
    branches: &Branches<'_>,
    delay: f64,
    from: &Place,
    to: &Place,
    best: &mut Option<ZerothOrderLimit>,
) {
    // Places are so close that a depth between them is not far below both of theirs.
    let ends = [depth(from.mu), depth(to.mu)].into_iter().flatten();
    match (ends.reduce(smaller), best.map(|best| best.depth)) {
        (None, _) => return,
        (Some(least), Some(best)) if 0.5 * least > best => return,
        _ => {}
    }
    let phase = |place: &Place| place.frequency * delay + PI + 2.0 * place.argument;
    let (low, high) = (phase(from), phase(to));
    let (least, most) = if low < high { (low, high) } else { (high, low) };
    let mut turn = (least / TAU).ceil();
    while turn * TAU < most {
        let place = branches.closed_in(from, to, |place| phase(place) - turn * TAU);
        if let Some(depth) = depth(place.mu)
            && best.is_none_or(|best| depth < best.depth)
        {
            *best = Some(ZerothOrderLimit {
                depth,
                frequency_hz: place.frequency / TAU,
            });
        }
        turn += 1.0;
    }
}

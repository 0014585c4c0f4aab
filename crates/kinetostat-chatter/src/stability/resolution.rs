//! Number of collocation points of a stretch of the period, and the modes that it resolves.

use std::f64::consts::TAU;

use crate::cut::Cut;
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::larger;
use crate::stability::states::State;

/// Points of a stretch beside those for its vibrations.
const LEAST_POINTS: f64 = 14.0;
/// Points for each vibration of the fastest mode: pi of them begin to resolve one.
const POINTS_PER_CYCLE: f64 = 5.0;
/// Share of the largest peak of all states from which a state is resolved: what a stretch makes of a smaller one, which is small
/// and acts through itself once more, is off by about the square of its share. More points show whether that is so.
const RESOLVED: f64 = 1e-3;
/// Maximum number of points: more cost more than a stretch is worth.
const MOST_POINTS: f64 = 400.0;

/// Factor on the points by which a result is checked.
const CHECKED: f64 = 4.0 / 3.0;

/// Maximum number of cycles of a mode on a stretch with so many times the usual points.
fn most_cycles(fineness: f64) -> f64 {
    (MOST_POINTS / fineness - LEAST_POINTS) / POINTS_PER_CYCLE
}

/// Frequency of the fastest mode, Hz, that the stretches of a cut resolve at a speed for all depths up to one, m.
pub(crate) fn resolved_hz(cut: &Cut, speed_rpm: f64, up_to: f64) -> f64 {
    let turn = cut.longest(up_to);
    let cycles = most_cycles(CHECKED) - turn / TAU;
    cycles * (TAU * speed_rpm / 60.0) / turn
}

/// Number of nodes of a stretch.
pub(crate) fn points(states: &[State], duration: f64, turn: f64, fineness: f64) -> Result<usize> {
    // Decay counts like oscillation; a state that only decays is a boundary layer at the beginning, of which
    // polynomials need the square root (the coefficients of exp(-a x) fall as exp(-n^2/a)).
    let cycles_of = |state: &State| match state.root.im == 0.0 {
        true => (state.root.norm() * duration).sqrt(),
        false => state.root.norm() * duration / TAU,
    };
    let peak = |state: &State| state.gain.norm() / state.root.re.abs();
    let largest = states.iter().map(peak).fold(0.0, larger);
    let resolved = (states.iter()).filter(|state| peak(state) >= RESOLVED * largest);
    let most = resolved.map(cycles_of).fold(0.0, larger);
    let fastest = most / duration;
    let cycles = most + turn / TAU;
    let wanted = fineness * (LEAST_POINTS + POINTS_PER_CYCLE * cycles);
    match wanted <= MOST_POINTS {
        true => Ok(wanted.ceil() as usize),
        false => Err(ChatterError::new(
            // With the points of a check, a single speed has no answer; the request itself is valid.
            match fineness > CHECKED {
                true => ChatterErrorKind::NotConverged,
                false => ChatterErrorKind::Setting,
            },
            "mode against spindle speed",
            format!(
                "a mode at {fastest:.0} Hz vibrates {cycles:.0} times while a tooth is in the cut"
            ),
            format!(
                "at most about {:.0} times with as many points as the limit wants: take faster modes as springs (modes up to a lower frequency), or a higher speed",
                most_cycles(larger(fineness, CHECKED))
            ),
        )),
    }
}

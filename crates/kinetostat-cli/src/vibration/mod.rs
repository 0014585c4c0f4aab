//! A machine that vibrates at a place: what `modes`, `frf` and `lobes` share.
//!
//! It takes a model, a place, a load, what holds the tool, and damping, and gives the machine about its equilibrium.

use kinetostat_dynamics::Mode;

pub(crate) mod arguments;
pub(crate) mod damping;
pub(crate) mod damping_numbers;
pub(crate) mod pair;
pub(crate) mod stability;
pub(crate) mod subject;

/// Largest motion of a part with a straight path, times the natural length.
const SMALL: f64 = 1e-6;

/// Step along the shape of a mode (times `sqrt(kg)`) in which all parts move along straight lines, for drawings.
pub(crate) fn small_step(mode: &Mode) -> f64 {
    let most = mode.shape.amax();
    SMALL / if most > 0.0 { most } else { 1.0 }
}

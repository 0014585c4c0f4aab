//! The lowest natural frequencies of a place.

use kinetostat::{MechanismEquilibrium, Posture};
use kinetostat_dynamics::{Held, lowest_modes};

/// How many of them a map has.
pub(crate) const LOWEST: usize = 6;

/// About an equilibrium, the tool free, Hz: rising, negative where the machine goes away, zero where it is free. NaN
/// beyond the number of modes that there are.
pub(crate) fn lowest(posture: &Posture, at: &MechanismEquilibrium) -> [f64; LOWEST] {
    let mut own = [f64::NAN; LOWEST];
    if let Ok(modes) = lowest_modes(posture, at, &Held::nothing(), LOWEST) {
        for (own, hz) in own.iter_mut().zip(modes.frequencies_hz()) {
            *own = hz;
        }
    }
    own
}

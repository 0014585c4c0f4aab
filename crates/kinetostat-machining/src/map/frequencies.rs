//! The lowest natural frequencies of a place.

use kinetostat::machine::MechanismState;
use kinetostat::{Posture, Wrench};
use kinetostat_dynamics::{Held, lowest_modes_of_state};

/// Number of natural frequencies in a map.
pub(crate) const LOWEST: usize = 6;

/// About an equilibrium, the tool free, Hz: rising, negative where the machine goes away, zero where it is free. NaN
/// beyond the `count` that are asked for, and beyond the number of modes that there are.
pub(crate) fn lowest(
    posture: &Posture,
    state: &MechanismState,
    load: &Wrench,
    count: usize,
) -> [f64; LOWEST] {
    let mut own = [f64::NAN; LOWEST];
    if let Ok(modes) = lowest_modes_of_state(posture, state, load, &Held::nothing(), count) {
        for (own, hz) in own.iter_mut().zip(modes.frequencies_hz()).take(count) {
            *own = hz;
        }
    }
    own
}

//! The lowest modes of any machine, by the way that is the shorter one.

use kinetostat::machine::MechanismState;
use kinetostat::{MechanismEquilibrium, Posture, Wrench};

use crate::ends::Held;
use crate::error::Result;
use crate::linear::LinearDynamics;
use crate::linear::rotor::rotors_of;
use crate::modes::Modes;
use crate::swept::long_chain::LongChain;

/// Chains of fewer coordinates are as fast with dense matrices.
const SWEPT_FROM: usize = 40;

/// The lowest modes of a machine about an equilibrium: along the chain where it is a long one, by dense matrices otherwise.
/// All unstable and free ones are among them.
///
/// # Errors
/// As [`LinearDynamics::of_machine`] and [`LinearDynamics::modes`].
pub fn lowest_modes(
    posture: &Posture,
    at: &MechanismEquilibrium,
    held: &Held,
    count: usize,
) -> Result<Modes> {
    lowest_modes_of_state(posture, &at.state, &at.wrench, held, count)
}

/// Finds modes like [`lowest_modes`], at a state in equilibrium under a wrench on the tool ([`Posture::rest_under`]).
///
/// # Errors
/// See [`lowest_modes`].
pub fn lowest_modes_of_state(
    posture: &Posture,
    state: &MechanismState,
    wrench: &Wrench,
    held: &Held,
    count: usize,
) -> Result<Modes> {
    let machine = posture.mechanism();
    let limbs = machine.limbs().iter();
    let long = limbs.map(|l| l.actual.coordinate_count()).sum::<usize>() >= SWEPT_FROM;
    // Rotors have coordinates beside the chain.
    if long
        && rotors_of(machine).is_empty()
        && let Some(chain) = LongChain::of_state(posture, state, held)?
        && let Some(modes) = chain.lowest_modes(count)?
    {
        return Ok(modes);
    }
    let mut modes = LinearDynamics::of_state(posture, state, wrench, held)?.modes()?;
    let going = modes.counts.unstable + modes.counts.free;
    modes.modes.truncate(count.max(going));
    Ok(modes)
}

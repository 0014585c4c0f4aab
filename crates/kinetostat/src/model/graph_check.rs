//! Whether the numbers of a mechanism's platforms, of the loads on them, and of a state to start from are
//! numbers that can be calculated with.

use crate::error::{Error, Result};
use crate::machine::platforms::solver::MechanismState;
use crate::model::chain::{sensible, sensible_pose};
use crate::model::loads::platform::PlatformLoad;
use crate::model::mechanism::{Mechanism, Platform};

pub(crate) fn sensible_all<'a>(
    place: &str,
    what: &str,
    numbers: impl IntoIterator<Item = &'a f64>,
) -> Result<()> {
    let mut numbers = numbers.into_iter();
    numbers.try_for_each(|x| sensible(place, || what.to_owned(), *x))
}

/// Refuses a platform without a sensible home, mass or inertia.
pub(crate) fn check_platform(place: &str, platform: &Platform) -> Result<()> {
    let place = format!("{place}: platform '{}'", platform.name);
    sensible_pose(&place, "the home pose", &platform.home)?;
    sensible_all(&place, "the mass", [&platform.mass])?;
    sensible_all(&place, "the centre of mass", &platform.centre_of_mass)?;
    sensible_all(&place, "the inertia", &platform.inertia)?;
    if platform.mass < 0.0 {
        let reason = format!(
            "the mass is {} kg, a number that is not negative is needed",
            platform.mass
        );
        return Err(Error::model(place, reason));
    }
    Ok(())
}

/// Refuses a load on platforms whose numbers, or whose answers at home, are none.
pub(crate) fn check_platform_load(mechanism: &Mechanism, load: &PlatformLoad) -> Result<()> {
    let place = format!("mechanism '{}'", mechanism.name);
    if let PlatformLoad::Wrench { point, wrench, .. } = load {
        sensible_all(&place, "the place of a wrench on a platform", point)?;
        sensible_all(&place, "a wrench on a platform", &wrench.0)?;
    }
    load.check(mechanism)?;
    let home: Vec<_> = mechanism.platforms.iter().map(|p| p.home).collect();
    let (mut wrenches, mut tangents) = (Vec::new(), Vec::new());
    load.wrenches(&home, &mut wrenches);
    load.tangents(&home, &mut tangents);
    let what = "what a load on platforms answers at home";
    for (_, wrench) in &wrenches {
        sensible_all(&place, what, &wrench.0)?;
    }
    tangents
        .iter()
        .try_for_each(|tangent| sensible_all(&place, what, &tangent.matrix))
}

/// Refuses a state that is not one of this mechanism.
pub(crate) fn check_state(mechanism: &Mechanism, state: &MechanismState) -> Result<()> {
    let place = format!("mechanism '{}'", mechanism.name);
    let limbs = mechanism.limbs.len();
    let lists = [
        (
            "the state to start from, its platforms",
            mechanism.platforms.len(),
            state.platforms.len(),
        ),
        (
            "the state to start from, its coordinates by limb",
            limbs,
            state.coordinates.len(),
        ),
        (
            "the state to start from, its wrenches by limb",
            limbs,
            state.wrenches.len(),
        ),
    ];
    for (what, expected, found) in lists {
        if expected != found {
            return Err(Error::Size {
                place,
                what,
                expected,
                found,
            });
        }
    }
    let what = "a number of the state to start from";
    for pose in &state.platforms {
        sensible_pose(&place, what, pose)?;
    }
    for (limb, own) in mechanism.limbs.iter().zip(&state.coordinates) {
        let (expected, found) = (limb.nominal.coordinate_count(), own.len());
        if expected != found {
            return Err(Error::Size {
                place: format!("{place}: limb '{}'", limb.name),
                what: "the state to start from, its coordinates",
                expected,
                found,
            });
        }
        sensible_all(&place, what, own)?;
    }
    let mut wrenches = state.wrenches.iter();
    wrenches.try_for_each(|wrench| sensible_all(&place, what, &wrench.0))
}

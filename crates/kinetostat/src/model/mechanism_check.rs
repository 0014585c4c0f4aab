//! Checks the numbers of a mechanism's platforms, of the loads on them, and of a state to start from.

use crate::error::{Error, Part, Place, Result};
use crate::model::limits::{check_numbers, check_pose};
use crate::model::loads::platform::PlatformLoad;
use crate::model::mechanism::{MechanismParts, Platform};

/// Refuses a platform without a sensible home, mass or inertia.
pub(crate) fn check_platform(place: &Place, platform: &Platform) -> Result<()> {
    let place = place.with_part(Part::Platform(platform.name.clone()));
    check_pose(&place, "the home pose", &platform.home)?;
    check_numbers(&place, "the mass", [&platform.mass])?;
    check_numbers(&place, "the centre of mass", &platform.centre_of_mass)?;
    check_numbers(&place, "the inertia", &platform.inertia)?;
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
pub(crate) fn check_platform_load(mechanism: &MechanismParts, load: &PlatformLoad) -> Result<()> {
    let place = Place::mechanism(mechanism.name.as_str());
    if let PlatformLoad::Wrench { point, wrench, .. } = load {
        check_numbers(&place, "the place of a wrench on a platform", point)?;
        check_numbers(&place, "a wrench on a platform", &wrench.0)?;
    }
    check_platforms(mechanism, load)?;
    let home: Vec<_> = mechanism.platforms.iter().map(|p| p.home).collect();
    let (mut wrenches, mut tangents) = (Vec::new(), Vec::new());
    load.wrenches(&home, &mut wrenches);
    load.tangents(&home, &mut tangents);
    let what = "what a load on platforms answers at home";
    for (_, wrench) in &wrenches {
        check_numbers(&place, what, &wrench.0)?;
    }
    tangents
        .iter()
        .try_for_each(|tangent| check_numbers(&place, what, &tangent.matrix))
}

/// Checks that a load fits the platforms.
fn check_platforms(mechanism: &MechanismParts, load: &PlatformLoad) -> Result<()> {
    let fault = |reason: String| {
        let place = Place::mechanism(mechanism.name.as_str());
        Err(Error::model(place, reason))
    };
    let own = load.platforms();
    let count = mechanism.platforms.len();
    if let Some(wrong) = own.iter().find(|&&p| p == 0 || p >= count) {
        return fault(format!(
            "a load acts on platform {wrong}; those that move are 1 to {}",
            count - 1
        ));
    }
    match load {
        PlatformLoad::Wrench { point, wrench, .. } => {
            if !point.iter().chain(wrench.0.iter()).all(|x| x.is_finite()) {
                return fault("a wrench on a platform is not finite".into());
            }
        }
        PlatformLoad::Strut(strut) => {
            if own.is_empty() || own.len() == 2 && own[0] == own[1] {
                return fault(
                    "a strut begins and ends at the same platform, so that it does nothing".into(),
                );
            }
            if let Some(reason) = crate::model::loads::node_load::NodeLoad::fault(strut) {
                return fault(reason);
            }
        }
    }
    Ok(())
}

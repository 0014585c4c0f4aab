//! Machines that a plan accepts; all others are refused with the reason.

use kinetostat::model::{LengthLaw, Load, PlatformLoad, Role};
use kinetostat::{Directions, Mechanism};

use crate::error::{Error, Result};
use crate::input::MOST_JOINTS;
use crate::machine::model::MOST_PASSIVE;

/// Refuses a mechanism that [`crate::step`] cannot evaluate without allocating or without a search.
pub(crate) fn check(mechanism: &Mechanism) -> Result<()> {
    let refuse = |reason: String| {
        Err(Error::Unsupported {
            machine: mechanism.name().to_owned(),
            reason,
        })
    };
    if mechanism.platforms().len() != 2 {
        return refuse(
            "it has platforms between base and tool; one moving platform is supported".into(),
        );
    }
    if mechanism.actuator_count() == 0 || mechanism.actuator_count() > MOST_JOINTS {
        let found = mechanism.actuator_count();
        return refuse(format!(
            "it has {found} actuators; 1 to {MOST_JOINTS} are supported"
        ));
    }
    for (index, limb) in mechanism.limbs().iter().enumerate() {
        let name = &limb.name;
        if limb.from != 0 || limb.to != mechanism.tool() {
            return refuse(format!("limb '{name}' does not lead from base to tool"));
        }
        let passive = limb.actual.indices_of(Role::Passive).len();
        if mechanism.limbs().len() == 1 && passive > 0 {
            return refuse(format!(
                "its only limb '{name}' has passive joints, which nothing holds"
            ));
        }
        if passive > MOST_PASSIVE {
            return refuse(format!(
                "limb '{name}' has {passive} passive joints; {MOST_PASSIVE} are supported"
            ));
        }
        if mechanism.loads(index).iter().any(may_allocate) {
            return refuse(format!(
                "limb '{name}' bears a load given as a function, which may allocate; give it as a spring, gas spring or rope"
            ));
        }
    }
    if mechanism.platform_loads().iter().any(
        |load| matches!(load, PlatformLoad::Strut(s) if matches!(s.law, LengthLaw::Function(_))),
    ) {
        return refuse("a platform bears a load given as a function, which may allocate".into());
    }
    if mechanism.turns_as_it_moves() {
        return refuse("its tool turns as it moves; a position cannot be corrected alone".into());
    }
    Ok(())
}

/// Loads of the core describe themselves by numbers; functions of the caller do not.
fn may_allocate(load: &Load) -> bool {
    match load {
        Load::Custom(own) => own.numbers().is_none(),
        _ => false,
    }
}

/// Directions of `wanted` in which the actuators can move the tool at home, and those that are left out. Rotations are
/// corrected together or not at all: the core holds an orientation, not an angle.
pub(crate) fn correctable(
    mechanism: &Mechanism,
    wanted: Directions,
) -> Result<(Directions, Directions)> {
    let home = mechanism.platforms()[mechanism.tool()].home;
    let able = mechanism.posture(&home)?.correctable();
    let turns = (3..6).all(|k| wanted[k] && able[k]);
    let (mut kept, mut left) = (Directions::NONE, Directions::NONE);
    for k in wanted.iter() {
        if able[k] && (k < 3 || turns) {
            kept = kept.with(k);
        } else {
            left = left.with(k);
        }
    }
    if kept.is_empty() {
        return Err(Error::Unsupported {
            machine: mechanism.name().to_owned(),
            reason: format!("its actuators correct {able}, none of {wanted}"),
        });
    }
    Ok((kept, left))
}

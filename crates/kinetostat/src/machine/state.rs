//! The state of a machine: where its platforms are and what its limbs do.

use crate::error::{Error, Part, Result};
use crate::model::limits::{check_numbers, check_pose};
use crate::model::mechanism::Mechanism;
use crate::spatial::{Pose, Wrench};

/// Refuses a state that is not one of this mechanism.
pub(crate) fn check_state(mechanism: &Mechanism, state: &MechanismState) -> Result<()> {
    let place = mechanism.place();
    let limbs = mechanism.limbs().len();
    let lists = [
        (
            "the state to start from, its platforms",
            mechanism.platforms().len(),
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
        check_pose(&place, what, pose)?;
    }
    for (limb, own) in mechanism.limbs().iter().zip(&state.coordinates) {
        let (expected, found) = (limb.nominal.coordinate_count(), own.len());
        if expected != found {
            return Err(Error::Size {
                place: place.with_part(Part::Limb(limb.name.clone())),
                what: "the state to start from, its coordinates",
                expected,
                found,
            });
        }
        check_numbers(&place, what, own)?;
    }
    let mut wrenches = state.wrenches.iter();
    wrenches.try_for_each(|wrench| check_numbers(&place, what, &wrench.0))
}

/// Poses, coordinates and end wrenches of a mechanism: where an iteration starts and ends.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismState {
    /// Pose of every platform, the base included.
    pub platforms: Vec<Pose>,
    /// Coordinates of every limb, m or rad.
    pub coordinates: Vec<Vec<f64>>,
    /// Wrench on the tip of every limb, about it, base axes.
    pub wrenches: Vec<Wrench>,
}

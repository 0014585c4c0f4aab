//! The pose that a machine can take where the digits of a place, or its orientation, keep it from it.

use kinetostat::{Mechanism, Pose, PostureRequest, machine::LimbPosture};
use kinetostat_machining::number::{apart, mean_length};
use kinetostat_machining::{Warning, WarningCode, natural_length, posture_at};

use crate::place::orientation;
use crate::ui::failure::Answer;
use crate::ui::pose::pose_text;

/// A place whose orientation follows.
#[derive(Clone, Debug)]
pub(crate) struct Followed {
    pub(crate) limbs: Vec<LimbPosture>,
    pub(crate) turned_deg: f64,
}

/// The pose at the position of `target`, or at the nearest one where only its digits keep the machine
/// from it, whose orientation is nearest to that of `target`.
pub(crate) fn followed(
    m: &Mechanism,
    target: &Pose,
    requested: bool,
    warnings: &mut Vec<Warning>,
) -> Answer<(Pose, Option<Followed>)> {
    let rotation = &target.rotation;
    let posture = match m.posture(PostureRequest::position(
        &target.translation.vector,
        rotation,
    )) {
        Err(kinetostat::Error::Unreachable {
            distance_m,
            nearest,
            ..
        }) if distance_m <= ROUNDED * natural_length(m) => {
            warnings.push(nearest_used(format!(
                "the machine cannot take this place exactly; the nearest is used, {} away: {}",
                mean_length(1e3 * distance_m),
                pose_text(&nearest)
            )));
            m.posture(PostureRequest::position(
                &nearest.translation.vector,
                rotation,
            ))?
        }
        answer => answer?,
    };
    let pose = *posture.target();
    let turned_deg = pose.rotation.angle_to(rotation).to_degrees();
    warnings.push(orientation::follows(turned_deg, requested, false));
    let limbs = posture.limbs().to_vec();
    Ok((pose, Some(Followed { limbs, turned_deg })))
}

fn nearest_used(said: String) -> Warning {
    Warning::new(WarningCode::NearestPlace, said)
}

/// Share of the natural length by which a requested pose may differ from what the machine can take.
const ROUNDED: f64 = 1e-6;

/// Radius of the search for the nearest pose if a place cannot be reached, in natural lengths.
const AROUND: f64 = 0.1;

/// The place, or the nearest one that the machine can take where only the digits of the place keep it
/// from that; a place that cannot be reached is refused with the nearest pose.
pub(crate) fn reachable(m: &Mechanism, target: Pose, warnings: &mut Vec<Warning>) -> Answer<Pose> {
    let error = match posture_at(m, &target) {
        Err(error @ kinetostat::Error::Unreachable { .. }) => error,
        _ => return Ok(target),
    };
    let length = natural_length(m);
    let Some(nearest) = m.nearest_reachable(&target, AROUND * length) else {
        return Err(error.into());
    };
    let off = kinetostat::spatial::pose_residual(&nearest, &target);
    let (shift, turn) = (off.linear().norm(), off.angular().norm());
    if shift.max(length * turn) <= ROUNDED * length {
        warnings.push(nearest_used(format!(
            "the machine cannot take this place exactly; the nearest is used, {} away: {}",
            apart(1e3 * shift, turn.to_degrees()),
            pose_text(&nearest)
        )));
        return Ok(nearest);
    }
    Err(kinetostat::Error::Unreachable {
        place: kinetostat::Place::mechanism(m.name()),
        distance_m: shift,
        angle_rad: turn,
        nearest: Box::new(nearest),
    }
    .into())
}

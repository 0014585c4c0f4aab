//! Reasons for a map without figures.

use kinetostat::Wrench;
use kinetostat_machining::MapTask;

use crate::map::answer::Places;
use crate::place::orientation;
use crate::ui::failure::Failure;
use crate::ui::numbers::load_triple;

/// Failure if no place has figures.
pub(crate) fn without_figures(task: &MapTask<'_>, places: &Places) -> Option<Failure> {
    if places.with_figures() > 0 {
        return None;
    }
    if places.no_answer > 0 {
        return Some(no_equilibrium(task, places));
    }
    Some(Failure::unanswered(format!(
        "the machine {} with the tool {} (cannot be reached: {}; outside the limits of an actuator: {}); choose places inside the workspace (`kinetostat check` tells its size), another --rotation, or check the tool's length",
        match places.requested {
            1 => "cannot be put at the place".to_owned(),
            n => format!("can be put at none of the {n} places"),
        },
        orientation::description(&task.orientation),
        places.unreachable,
        places.outside_limits
    )))
}

/// Failure if places are within reach and none has an answer: the load is the reason.
fn no_equilibrium(task: &MapTask<'_>, places: &Places) -> Failure {
    let wrench = task.load.unwrap_or_else(Wrench::zero);
    let counts = match places.requested {
        1 => String::new(),
        _ => format!(
            " (no equilibrium: {}; cannot be reached: {}; outside the limits of an actuator: {})",
            places.no_answer, places.unreachable, places.outside_limits
        ),
    };
    Failure::unanswered(format!(
        "no equilibrium was found {} under the force {} N and the moment {} N m{counts}: the load may be beyond what the machine can carry; check the load and its unit, or try a part of it",
        match places.requested {
            1 => "at the place".to_owned(),
            n => format!("at any of the {n} places"),
        },
        load_triple(wrench.force().into()),
        load_triple(wrench.moment().into()),
    ))
}

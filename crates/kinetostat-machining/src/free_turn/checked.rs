//! Tasks that no sensible question asks.

use crate::free_turn::error::TurnError;
use crate::free_turn::task::{TipCompliance, TurnCriterion, TurnTask};

/// Maximum number of steps of a band.
const MOST_TURNS: f64 = 7200.0;

/// Checks that all numbers of a task are plausible.
pub(crate) fn checked(task: &TurnTask<'_>) -> Result<(), TurnError> {
    let refused = |what: String| Err(TurnError::Input { what });
    let positive = |x: f64| x.is_finite() && x > 0.0;
    let band = &task.band;
    let (from, to, step) = (band.from_deg, band.to_deg, band.step_deg);
    if !positive(task.station_mm) {
        return refused(format!(
            "stations are {} mm apart: a positive number is needed",
            task.station_mm
        ));
    }
    if ![from, to].iter().all(|x| x.is_finite() && x.abs() <= 720.0) {
        return refused(format!(
            "the band of turns goes from {from} to {to} deg: two numbers within 720 deg of zero are needed"
        ));
    }
    if to <= from {
        return refused(format!(
            "the band of turns from {from} to {to} deg is empty: its end must be larger than its start"
        ));
    }
    if to - from > 360.0 + 1e-9 {
        return refused(format!(
            "the band of turns from {from} to {to} deg is more than the whole circle: at most 360 deg are needed"
        ));
    }
    if !positive(step) || (to - from) / step > MOST_TURNS {
        return refused(format!(
            "the band of turns is divided in steps of {step} deg: a positive number is needed that makes at most {MOST_TURNS} steps"
        ));
    }
    let rate = task.bounds.rate_deg_per_mm;
    if !positive(rate) {
        return refused(format!(
            "the tool may be turned by {rate} deg/mm: a positive number is needed (for a turn that stays the same see \
             TurnChoice::best_constant)"
        ));
    }
    bounds(task)?;
    criteria(&task.criteria)?;
    placement(task)
}

fn bounds(task: &TurnTask<'_>) -> Result<(), TurnError> {
    let refused = |what: String| Err(TurnError::Input { what });
    let bounds = &task.bounds;
    let least = bounds.least_singular_value;
    if !(least.is_finite() && least > 0.0) {
        return refused(format!(
            "the smallest singular value is to stay above {least}: a positive number is needed"
        ));
    }
    let margin = bounds.limit_margin_deg;
    if !(margin.is_finite() && margin >= 0.0) {
        return refused(format!(
            "joints are to stay {margin} deg inside their limits: zero or a positive number is needed"
        ));
    }
    let step = bounds.joint_step_deg;
    if !(step > 0.0 && step <= 90.0) {
        return refused(format!(
            "joints may turn by {step} deg between two stations: a positive number of at most 90 is needed"
        ));
    }
    if bounds.checks_between > 1000 {
        return refused(format!(
            "{} places are to be looked at between two stations: at most 1000 are",
            bounds.checks_between
        ));
    }
    match bounds.configuration {
        Some(number) if number > 7 => refused(format!(
            "configuration {number} is asked for: an arm of six joints has those from 0 to 7"
        )),
        _ => Ok(()),
    }
}

fn criteria(criteria: &[TurnCriterion]) -> Result<(), TurnError> {
    let refused = |what: String| Err(TurnError::Input { what });
    let mut compliances = 0;
    for criterion in criteria {
        let weight = criterion.weight();
        if !(weight.is_finite() && weight >= 0.0) {
            return refused(format!(
                "a criterion counts with the weight {weight}: zero or a positive number is needed"
            ));
        }
        if let TurnCriterion::Compliance { of, .. } = criterion {
            compliances += 1;
            if let TipCompliance::Along(direction) = of
                && !(direction.norm().is_finite() && direction.norm() > 0.0)
            {
                return refused(format!(
                    "the compliance along [{}, {}, {}] is asked for: a direction is needed",
                    direction.x, direction.y, direction.z
                ));
            }
        }
    }
    match compliances {
        0 | 1 => Ok(()),
        _ => refused(format!(
            "{compliances} criteria ask for a compliance: one is taken into account"
        )),
    }
}

fn placement(task: &TurnTask<'_>) -> Result<(), TurnError> {
    let refused = |what: &str| {
        Err(TurnError::Input {
            what: what.to_owned(),
        })
    };
    let placement = &task.placement;
    if placement.orientation_follows {
        return Err(TurnError::NoFreedom {
            what: "the machine turns its tool as it moves (orientation_follows): there is no turn to choose".to_owned(),
        });
    }
    if !(placement.scale.is_finite() && placement.scale > 0.0) {
        return refused("the scale of the program is no positive number");
    }
    let pose = placement.base_from_part;
    let mut numbers = pose
        .translation
        .vector
        .iter()
        .chain(pose.rotation.coords.iter())
        .chain(placement.tool_orientation.coords.iter());
    match numbers.all(|x| x.is_finite()) {
        true => Ok(()),
        false => refused(
            "the placement of the part or the orientation of the tool has a number that is not finite",
        ),
    }
}

//! Equilibria of a machine while the load on its tool grows, as the page draws them.

use kinetostat::continuation::{CurveStability, SpecialKind};
use kinetostat::{
    CurveSettings, Direction, DirectionKind, EndCondition, MechanismEquilibrium, Parameter,
    Posture, Wrench,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_report::{Placed, Scene};

use crate::shown::answer::{CurveBranch, CurveMark, CurveOfState, CurvePlace};
use crate::ui::failure::{Answer, Failing};

/// Branches that are followed, and places of each that are shown with their shapes.
const BRANCHES: usize = 4;
const PLACES: usize = 60;

/// Largest factor of the load.
const MOST_FACTOR: f64 = 1e4;

/// The tool under a wrench whose factor goes from 0 to `largest`, and the branches that cross.
pub(crate) fn curve_of(posture: &Posture, wrench: &Wrench, largest: f64) -> Answer<CurveOfState> {
    if wrench.0.norm() == 0.0 {
        return Err(ErrorCode::Missing
            .failure("a load that grows begins with one: give a force or a moment"));
    }
    if !(largest > 0.0 && largest <= MOST_FACTOR) {
        return Err(ErrorCode::Value.failure(format!(
            "the load grows to a factor above 0 and at most {MOST_FACTOR}"
        )));
    }
    let free = |direction: &Direction| direction.kind == DirectionKind::Free;
    if posture.stiffness()?.directions.iter().any(free) {
        return Err(ErrorCode::ModelUnsuited.failure(
            "nothing holds the tool in one of its directions here: `kinetostat curve` follows it with the tool held (--hold, --free)",
        ));
    }
    let mut settings = CurveSettings::within(0.0, largest);
    settings.branches = BRANCHES;
    settings.largest_change = Some(largest / PLACES as f64);
    let grown = Parameter::end_wrench(*wrench);
    let held_by_nothing = EndCondition::wrench(Wrench::zero());
    let curves = posture.curves(&grown, &held_by_nothing, &settings)?;
    let (force, moment) = (wrench.force(), wrench.moment());
    let is_force = force.norm() > 0.0;
    let along = |found: &MechanismEquilibrium| match is_force {
        true => 1e3 * found.displacement.linear().dot(&force.normalize()),
        false => found
            .displacement
            .angular()
            .dot(&moment.normalize())
            .to_degrees(),
    };
    let branches = curves.branches.iter().map(|branch| {
        let step = branch.points.len().div_ceil(PLACES).max(1);
        let points = branch.points.iter().step_by(step);
        let last =
            (branch.points.last()).filter(|_| !(branch.points.len() - 1).is_multiple_of(step));
        let places = points.chain(last).map(|point| CurvePlace {
            factor: point.parameter,
            along: along(&point.equilibrium),
            stable: point.dead_load.stable(),
            shape: Scene::of(
                posture.mechanism(),
                &Placed::solved(posture, &point.equilibrium.state),
            ),
        });
        CurveBranch {
            places: places.collect(),
        }
    });
    let marks = curves.specials.iter().map(|special| CurveMark {
        words: words(special.kind).to_owned(),
        factor: special.point.parameter,
        along: along(&special.point.equilibrium),
    });
    Ok(CurveOfState {
        unit: if is_force { "mm" } else { "deg" },
        branches: branches.collect(),
        marks: marks.collect(),
        more_branches: curves.more_branches,
    })
}

fn words(kind: SpecialKind) -> &'static str {
    match kind {
        SpecialKind::LoadLimit => "largest load: it snaps through",
        SpecialKind::DisplacementLimit => "turns back: it snaps back if it is moved",
        SpecialKind::Pitchfork => "buckles",
        SpecialKind::Transcritical => "branches cross",
        SpecialKind::StabilityChange => "stability changes",
        SpecialKind::Multiple { .. } => "buckles in several ways",
        _ => "special point",
    }
}

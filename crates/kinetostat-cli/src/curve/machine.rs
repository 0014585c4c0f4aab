//! The curve of a machine of several limbs or platforms: its tool is moved or loaded, all limbs follow.

use kinetostat::{MechanismEquilibrium, continuation::BranchEnd, equilibrium::SpreadSettings};
use kinetostat_machining::{Warning, WarningCode};

use crate::curve::followed::{Followed, Shapes, add_shapes_off_the_curve, is_locked, settings};
use crate::curve::query::{CurveQuery, Measure};
use crate::end_condition::machine::CommandedMachine;
use crate::ui::background::Stage;
use crate::ui::failure::Answer;

/// Follows the curve of a machine, and the branches that cross it.
pub(crate) fn follow(
    machine: &CommandedMachine,
    q: &CurveQuery,
    stage: &Stage,
) -> Answer<Followed<MechanismEquilibrium>> {
    let (posture, end) = (&machine.posture, &q.holding.end);
    stage.is("looking for singular postures nearby");
    let far = match q.measure {
        Measure::Force(_) if !q.by_load() => q.range.0.abs().max(q.range.1.abs()),
        _ => 0.0,
    };
    let mut warnings = machine.near_singular(far)?;
    stage.is("following the curve");
    let mut curves = posture.curves(&q.parameter, end, &settings(q))?;
    let locked = !q.by_load() && is_locked(&curves.branches);
    if locked {
        warnings.push(Warning::new(
            WarningCode::CurveEnds,
            "the machine is stretched out and locked along this motion at the start: any load stays there without a displacement, and no step leads away from it. Shapes that a search finds at the ends of the range are followed instead (as with --all)",
        ));
    }
    if q.all || locked {
        let search = |value: f64| {
            let there = q.parameter.end_at(end, value);
            let all = posture.equilibria(&there, &SpreadSettings::default())?;
            let regular = all.found.into_iter().filter(|f| !f.singular);
            Ok(Shapes {
                list: regular.map(|f| f.equilibrium).collect(),
                exhausted: all.exhausted,
            })
        };
        let add = |shape: &MechanismEquilibrium, _| curves.add(shape);
        warnings.extend(add_shapes_off_the_curve(q, stage, search, add)?);
    }
    // Loads of a step where none moves the tool are no figures.
    if let Some(own) = curves.branches.first_mut().filter(|_| locked) {
        own.points = vec![own.points.swap_remove(own.start)];
        (own.start, own.ends) = (0, [BranchEnd::Range; 2]);
    }
    stage.is("looking where the jumps land");
    let jumps = curves.jumps()?;
    Ok(Followed {
        branches: curves.branches,
        specials: curves.specials,
        more_branches: curves.more_branches,
        jumps,
        // The stability and the special points say where stability ends.
        critical: Vec::new(),
        warnings,
    })
}

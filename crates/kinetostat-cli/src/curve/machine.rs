//! The curve of a machine of several limbs or platforms: its tool is moved or loaded, all limbs follow.

use kinetostat::{MechanismEquilibrium, equilibrium::SpreadSettings};

use crate::curve::followed::{Followed, Shapes, add_shapes_off_the_curve, settings};
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
    if q.all {
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

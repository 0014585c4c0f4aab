//! The curve of a chain: all branches that cross, and what happens on them.

use kinetostat::{
    ChainProblem, CurveSettings, Equilibrium, Settings, equilibria,
    equilibrium::{Bounds, SearchSettings},
    follow as follow_chain, solve_chain,
};
use kinetostat_analysis::degenerate::is_degenerate;
use kinetostat_analysis::serial_chain::{SerialChain, problem_at};
use kinetostat_machining::{Warning, WarningCode};

use crate::curve::critical::critical_loads;
use crate::curve::followed::{Followed, Shapes, add_shapes_off_the_curve, is_locked, settings};
use crate::curve::query::{CurveQuery, Measure};
use crate::ui::background::Stage;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::number;

/// Follows the curve of a chain, and the branches that cross it.
pub(crate) fn follow(
    chain: &SerialChain,
    q: &CurveQuery,
    stage: &Stage,
) -> Answer<Followed<Equilibrium>> {
    let problem = chain.problem(q.holding.end.clone());
    let mut settings = settings(q);
    let value = q.start();
    stage.is("looking for the equilibrium at the start");
    let there = problem_at(&problem, &q.parameter, value);
    let start =
        solve_chain(&there, &Settings::default()).map_err(|error| not_there(q, &there, error))?;
    stage.is("following the curve");
    let mut curves = follow_chain(&problem, &q.parameter, &start, value, &settings)?;
    let mut warnings: Vec<Warning> = Vec::new();
    if !q.by_load() && is_locked(&curves.branches) {
        warnings.extend(widen_for_locked(chain, q, value, &mut settings));
        curves = follow_chain(&problem, &q.parameter, &start, value, &settings)?;
    }
    if q.all {
        let search = |value: f64| shapes_at(chain, q, &problem, value);
        let add = |shape: &Equilibrium, value| curves.add(shape, value);
        warnings.extend(add_shapes_off_the_curve(q, stage, search, add)?);
    }
    stage.is("looking where the jumps land");
    let jumps = curves.jumps()?;
    stage.is("looking for the critical load");
    let critical = critical_loads(chain, q, &problem, &settings)?;
    Ok(Followed {
        branches: curves.branches,
        specials: curves.specials,
        more_branches: curves.more_branches,
        jumps,
        critical,
        warnings,
    })
}

/// The load grows at one displacement, the end of the range: rounding must not end the curve, and without limits
/// of the force nothing would.
fn widen_for_locked(
    chain: &SerialChain,
    q: &CurveQuery,
    value: f64,
    settings: &mut CurveSettings,
) -> Option<Warning> {
    let room = 1e-6 * (q.range.1 - q.range.0);
    if value <= q.range.0 {
        settings.range.0 -= room;
    }
    if value >= q.range.1 {
        settings.range.1 += room;
    }
    if q.force_limits.is_some() {
        return None;
    }
    // Chains of this stiffness and length buckle at about one of these units.
    let scale = chain.chain.scale();
    let (unit, word) = match q.measure {
        Measure::Moment(_) => (scale.stiffness * scale.length.powi(2), "N m"),
        _ => (scale.stiffness * scale.length, "N"),
    };
    let limit = 20.0 * unit;
    settings.conjugate_range = (-limit, limit);
    Some(Warning::new(
        WarningCode::CurveEnds,
        format!(
            "the chain is stretched out and locked at the start: the load grows there without any displacement. The curve was kept within {} {word} both ways; --force-limits LOW HIGH sets other limits",
            number(limit, 3)
        ),
    ))
}

/// All shapes at a value of the parameter, but for those at a limit.
fn shapes_at(
    chain: &SerialChain,
    q: &CurveQuery,
    problem: &ChainProblem<'_>,
    value: f64,
) -> Answer<Shapes<Equilibrium>> {
    let there = problem_at(problem, &q.parameter, value);
    let bounds = Bounds::of(&chain.chain);
    let all = equilibria(&there, &bounds, &SearchSettings::default())?;
    let regular = (all.found.into_iter()).filter(|f| !is_degenerate(chain, &there, f));
    Ok(Shapes {
        list: regular.map(|f| f.equilibrium).collect(),
        exhausted: all.exhausted,
    })
}

/// Explains why there is no equilibrium at the start.
fn not_there(q: &CurveQuery, there: &ChainProblem<'_>, error: kinetostat::Error) -> Failure {
    let loaded = !there.loads.is_empty() || there.end.wrench.0.amax() > 0.0;
    if q.by_load() || loaded || !matches!(error, kinetostat::Error::NotConverged { .. }) {
        return error.into();
    }
    let unit = match q.measure {
        Measure::Moment(_) => "deg",
        _ => "mm",
    };
    Failure::unanswered(format!(
        "{error}; nothing loads the chain: its tool may be out of reach where the curve starts, {} {unit} from the commanded place. Start nearer to that place",
        number(q.shown(q.start()), 6)
    ))
}

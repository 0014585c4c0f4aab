//! The curve of a chain: all branches that cross, and what happens on them.

use kinetostat::{
    ChainProblem, CurveSettings, Parameter, Settings,
    continuation::{BranchEnd, Curves},
    equilibria,
    equilibrium::{Bounds, SearchSettings},
    follow, solve_chain,
};
use kinetostat_analysis::degenerate::is_degenerate;
use kinetostat_analysis::rotation::ContinuousRotation;
use kinetostat_analysis::serial_chain::{SerialChain, problem_at};
use kinetostat_machining::{Warning, WarningCode};

use crate::curve::answer::{BranchAnswer, CurveAnswer, Units, grows, reached};
use crate::curve::chain_points::View;
use crate::curve::critical::critical_loads;
use crate::curve::query::{CurveQuery, Measure};
use crate::end_condition::chain::coordinates;
use crate::place::query::PlaceAnswer;
use crate::ui::background::Stage;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::number;

/// Follows the curve of a chain.
pub(crate) fn solve(
    chain: &SerialChain,
    q: &CurveQuery,
    place: PlaceAnswer,
    names: [String; 3],
    stage: &Stage,
) -> Answer<CurveAnswer> {
    let problem = chain.problem(q.holding.end.clone());
    let mut settings = settings(q);
    let value = q.start();
    stage.is("looking for the equilibrium at the start");
    let there = problem_at(&problem, &q.parameter, value);
    let start =
        solve_chain(&there, &Settings::default()).map_err(|error| not_there(q, &there, error))?;
    stage.is("following the curve");
    let mut curves = follow(&problem, &q.parameter, &start, value, &settings)?;
    let mut warnings: Vec<Warning> = Vec::new();
    if !q.by_load() && is_locked(&curves) {
        warnings.extend(widen_for_locked(chain, q, value, &mut settings));
        curves = follow(&problem, &q.parameter, &start, value, &settings)?;
    }
    if q.all {
        add_shapes_off_the_curve(chain, q, &problem, &mut curves, stage, &mut warnings)?;
    }
    let conjugate = match &q.parameter {
        Parameter::Displacement(twist) => twist.dot(&start.wrench),
        Parameter::Load(_) => 0.0,
    };
    stage.is("looking where the jumps land");
    let jumps = curves.jumps()?;
    let rotation = match q.measure {
        Measure::Moment(_) if q.by_load() => ContinuousRotation::of(&curves, &start.tip, value),
        _ => ContinuousRotation::none(),
    };
    let view = View {
        chain,
        q,
        curves: &curves,
        rotation,
    };
    let (named, jumps) = view.named((value, conjugate), &jumps);
    stage.is("looking for the critical load");
    let critical = critical_loads(chain, q, &problem, &settings)?;
    let branches: Vec<BranchAnswer> = view.branches(&named);
    warnings.extend(of_ends(&branches, q));
    warnings.extend(of_missing_branches(&curves, q));
    warnings.dedup();
    let own = curves.branches.first().map_or(&[][..], |b| &b.points);
    let [model, model_source, tool] = names;
    Ok(CurveAnswer {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model,
        model_source,
        tool,
        place,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        grows: grows(q),
        coordinates: coordinates(chain),
        named_points: named,
        jumps,
        critical_loads: critical,
        branches,
        more_branches: curves.more_branches,
        conservative: start.conservative,
        warnings,
        subject: q.holding.subject,
        units: Units::of(q),
        requested: (q.shown(q.range.0), q.shown(q.range.1)),
        reached: reached(own.iter().map(|p| q.shown(p.parameter))),
    })
}

fn settings(q: &CurveQuery) -> CurveSettings {
    let mut settings = CurveSettings::within(q.range.0, q.range.1);
    settings.branches = q.branches;
    settings.points = q.points;
    // Fine enough to be drawn.
    settings.largest_turn = 0.05;
    settings.largest_change = Some((q.range.1 - q.range.0) / 60.0);
    if let Some(limits) = q.force_limits {
        settings.conjugate_range = limits;
    }
    settings
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

/// Searches for shapes at the start and at both ends of the range, and follows those that no branch holds.
fn add_shapes_off_the_curve(
    chain: &SerialChain,
    q: &CurveQuery,
    problem: &ChainProblem<'_>,
    curves: &mut Curves<'_>,
    stage: &Stage,
    warnings: &mut Vec<Warning>,
) -> Answer<()> {
    let mut values = vec![q.start(), q.range.0, q.range.1];
    values.dedup();
    for v in values {
        stage.is("searching for shapes off the curve");
        let there = problem_at(problem, &q.parameter, v);
        let bounds = Bounds::of(&chain.chain);
        let all = equilibria(&there, &bounds, &SearchSettings::default())?;
        if !all.settled {
            warnings.push(Warning::new(
                WarningCode::SearchEnds,
                format!(
                    "the search at {} ended before it was complete: there may be more shapes",
                    q.shown(v)
                ),
            ));
        }
        for found in &all.found {
            stage.is("following the curve through another shape");
            if is_degenerate(chain, &there, found) {
                continue;
            }
            if let Err(error) = curves.add(&found.equilibrium, v) {
                warnings.push(Warning::new(
                    WarningCode::CurveEnds,
                    format!(
                        "a shape found at {} could not be followed: {error}",
                        q.shown(v)
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// Why branches end where they were not asked to.
fn of_ends(branches: &[BranchAnswer], q: &CurveQuery) -> Vec<Warning> {
    let ends = branches
        .iter()
        .flat_map(|b| b.ends.map(|end| (b.number, end)));
    let said = ends.filter_map(|(number, end)| match end {
        BranchEnd::Lost => Some(format!(
            "branch {number} was lost: beyond its end no further point was found"
        )),
        BranchEnd::Stalled => Some(format!(
            "branch {number} was given up: ever shorter steps made no progress at its end"
        )),
        BranchEnd::Points => Some(format!(
            "branch {number} ends after {} points; --points N allows more, --force-limits keeps it shorter",
            q.points
        )),
        _ => None,
    });
    said.map(|said| Warning::new(WarningCode::CurveEnds, said))
        .collect()
}

/// Branches that cross and were not followed.
fn of_missing_branches(curves: &Curves<'_>, q: &CurveQuery) -> Vec<Warning> {
    let lost = curves.specials.iter().filter(|s| s.lost_branch);
    let lost = lost.map(|special| {
        Warning::new(
            WarningCode::CurveEnds,
            format!(
                "a branch that crosses at {} could not be followed: its first step did not converge, and its shapes are missing here",
                q.shown(special.point.parameter)
            ),
        )
    });
    let more = curves.more_branches.then(|| {
        Warning::new(
            WarningCode::MoreBranches,
            format!(
                "more than {} branches cross; --branches N follows more",
                q.branches
            ),
        )
    });
    lost.chain(more).collect()
}

/// Why there is no equilibrium at the start.
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

/// The displacement stands still at the start.
fn is_locked(curves: &Curves<'_>) -> bool {
    let points = curves.branches.first().map(|b| b.points.as_slice());
    points.is_some_and(|list| list.iter().all(|p| !p.slope.is_finite()))
}

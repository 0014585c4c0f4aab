//! `kinetostat curve`: force against displacement of a chain or a machine, with everything that
//! happens on the way.
//!
//! It takes a model, a place, and what grows, and gives branches with limit points, bifurcations, jumps and
//! critical loads, as text, table and drawing.

mod answer;
pub(crate) mod arguments;
mod figures;
mod followed;
mod machine;
mod plot;
mod points;
mod query;
mod stability_text;
mod text;

use kinetostat::continuation::{Branch, CurveEquilibrium};
use kinetostat::equilibrium::{Bounds, CriticalLoad, SearchSettings, StabilityOf};
use kinetostat::{
    ChainProblem, CurveSettings, Equilibrium, Parameter, Settings, critical_load_factor,
    equilibria, follow as follow_chain, solve_chain,
};
use kinetostat_analysis::degenerate::is_degenerate;
use kinetostat_analysis::rotation::ContinuousRotation;
use kinetostat_analysis::serial_chain::{SerialChain, is_serial_chain, problem_at};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode, large_load};
use nalgebra::{UnitQuaternion, Vector3};

use crate::curve::answer::{
    CriticalAnswer, CurveAnswer, PointAnswer, Units, grows, kind_name, reached,
};
use crate::curve::arguments::CurveArgs;
use crate::curve::followed::{Followed, Shapes, add_shapes_off_the_curve, is_locked, settings};
use crate::curve::points::View;
use crate::curve::query::{CurveQuery, Measure, curve_query};
use crate::end_condition::answering::{CommandQuery, Work, answer_query};
use crate::end_condition::chain::{moves_of, serial_chain};
use crate::end_condition::coordinates::{WRENCH_AND_PLACE, column, yes};
use crate::end_condition::loads::with_loads;
use crate::end_condition::machine::CommandedMachine;
use crate::end_condition::subject::Subject;
use crate::files::answer_files::Shown;
use crate::place::query::{AnswerHead, PlaceAnswer, PlaceQuery};
use crate::ui::background::Stage;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::number;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<CurveAnswer>("force against displacement")];

pub(crate) fn run(args: &CurveArgs) -> Answer<()> {
    let command = CommandQuery {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let work_of = |query: &PlaceQuery| -> Answer<Work<CurveAnswer>> {
        let size = query.mechanism.size();
        if is_serial_chain(&query.mechanism) {
            let chain = with_loads(serial_chain(query)?, &args.end)?;
            let q = curve_query(&moves_of(&chain), Some(&chain), args)?;
            Ok(Box::new(move |head, stage| {
                let followed = follow(&chain, &q, stage)?;
                Ok(answer_of(&chain, &q, followed, head).with_plausibility_warnings(size))
            }))
        } else {
            let machine = CommandedMachine::of(query, &args.end)?;
            let q = curve_query(&machine.moves, None, args)?;
            Ok(Box::new(move |head, stage| {
                let followed = machine::follow(&machine, &q, stage)?;
                Ok(answer_of(&machine, &q, followed, head).with_plausibility_warnings(size))
            }))
        }
    };
    answer_query(
        &command,
        work_of,
        |answer| &mut answer.warnings,
        |heading, answer| {
            Ok(Shown {
                text: text::answer_text(heading, answer),
                csv: of_curve(answer)?,
                svg: plot::plot(answer).svg(),
                failure: answer.unanswered(),
            })
        },
    )
}

/// Displacement along the growing load where the curve starts, from the commanded place, m or rad. The conjugate of a
/// machine counts from there, that of a chain from the curve's start; so does that of forces on nodes, which have no
/// commanded place.
fn displacement_at_start<E: CurveEquilibrium>(
    q: &CurveQuery,
    branches: &[Branch<E>],
    place: &PlaceAnswer,
) -> f64 {
    let Parameter::Load(pattern) = &q.parameter else {
        return 0.0;
    };
    let own = branches.first().and_then(|b| b.points.get(b.start));
    let Some(start) = own.filter(|_| q.holding.subject == "chain") else {
        return 0.0;
    };
    let tool = start.equilibrium.tool();
    let along = |direction: Vector3<f64>, displacement: Vector3<f64>| {
        let direction = direction.try_normalize(0.0);
        direction.map_or(0.0, |direction| direction.dot(&displacement))
    };
    match q.measure {
        Measure::Force(_) => {
            let commanded = Vector3::from(place.position_mm) * 1e-3;
            along(pattern.end.force(), tool.translation.vector - commanded)
        }
        Measure::Moment(_) => {
            let commanded = Vector3::from(place.rotation_vector_deg).map(f64::to_radians);
            let turned = tool.rotation * UnitQuaternion::from_scaled_axis(commanded).inverse();
            along(pattern.end.moment(), turned.scaled_axis())
        }
        Measure::Work => 0.0,
    }
}

fn answer_of<S: Subject>(
    subject: &S,
    q: &CurveQuery,
    mut followed: Followed<S::Equilibrium>,
    head: AnswerHead,
) -> CurveAnswer {
    let critical_loads = std::mem::take(&mut followed.critical);
    let mut warnings = std::mem::take(&mut followed.warnings);
    warnings.extend(followed.what_is_missing(q));
    warnings.extend(large_load(&q.largest_load()));
    warnings.dedup();
    let (branches, specials) = (&followed.branches, &followed.specials);
    let view = View {
        subject,
        q,
        curves: &followed,
        rotation: match q.measure {
            Measure::Moment(_) if q.by_load() => ContinuousRotation::of(branches, specials),
            _ => ContinuousRotation::none(),
        },
        at_start: displacement_at_start(q, &followed.branches, &head.place),
    };
    let (named_points, jumps) = view.named();
    let own = branches.first().map_or(&[][..], |b| &b.points);
    // A limit point lies between two points, and farther out than both.
    let on_own = specials.iter().filter(|s| s.branches.contains(&0));
    let turns = on_own.map(|s| &s.point);
    let mut points = branches.iter().flat_map(|b| &b.points);
    CurveAnswer {
        head,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        grows: grows(q),
        coordinates: subject.coordinates(),
        branches: view.branches(&named_points),
        named_points,
        jumps,
        critical_loads,
        more_branches: followed.more_branches,
        conservative: points.all(|p| p.equilibrium.conservative()),
        warnings,
        force_limited: q.force_limits.is_some(),
        subject: q.holding.subject,
        units: Units::of(q),
        requested: (q.shown(q.range.0), q.shown(q.range.1)),
        reached: reached(own.iter().chain(turns).map(|p| q.shown(p.parameter))),
    }
}

/// Follows the curve of a chain, and the branches that cross it.
fn follow(chain: &SerialChain, q: &CurveQuery, stage: &Stage) -> Answer<Followed<Equilibrium>> {
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
    ErrorCode::NotConverged.failure(format!(
            "{error}; nothing loads the chain: its tool may be out of reach where the curve starts, {} {unit} from the commanded place. Start nearer to that place",
            number(q.shown(q.start()), 6)
        ),
    )
}

fn critical_loads(
    chain: &SerialChain,
    q: &CurveQuery,
    problem: &ChainProblem<'_>,
    settings: &CurveSettings,
) -> Answer<Vec<CriticalAnswer>> {
    let Parameter::Load(pattern) = &q.parameter else {
        return Ok(Vec::new());
    };
    if q.range.1 <= 0.0 || q.range.0 > 0.0 {
        return Ok(Vec::new());
    }
    let mut list = Vec::new();
    for (stability_of, name) in [
        (StabilityOf::Shape, "shape"),
        (StabilityOf::ShapeAndEnd, "shape_and_tool"),
    ] {
        let found = critical_load_factor(problem, pattern, stability_of, settings)?;
        list.push(critical_answer(chain, name, found));
    }
    Ok(list)
}

fn critical_answer(
    chain: &SerialChain,
    stability_of: &'static str,
    c: CriticalLoad,
) -> CriticalAnswer {
    let mode = c.exact.as_ref().map_or_else(Vec::new, |e| e.mode.clone());
    let caution = c.caution().unwrap_or_default();
    CriticalAnswer {
        stability_of,
        linear_factor: c.linear,
        linear_mode_in_words: chain.motion_description(&c.linear_mode),
        factor: c.exact.as_ref().map(|e| e.factor),
        kind: c.exact.as_ref().and_then(|e| e.kind).map(kind_name),
        mode_in_words: chain.motion_description(&mode),
        mode,
        followed_to_factor: c.reached,
        conservative: c.conservative,
        safe_below_factor: c.definite_until,
        caution,
    }
}

fn of_curve(a: &CurveAnswer) -> Answer<Vec<u8>> {
    let word = |name: &str, unit: &str| {
        let unit = unit
            .replace('/', " per ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join("_")
            .to_lowercase();
        let name = name.replace(' ', "_");
        if unit.is_empty() {
            name
        } else {
            format!("{name}_{unit}")
        }
    };
    let u = &a.units;
    let mut header: Vec<String> = vec!["branch".into(), "point".into(), "name".into()];
    if a.grows == "load" && !u.load_unit.is_empty() {
        header.push("load_factor".into());
    }
    header.push(word(u.displacement, u.displacement_unit));
    header.push(word(u.load, u.load_unit));
    header.push(word("slope", u.slope_unit));
    header.extend(
        [
            "stable_under_dead_load",
            "stable_under_prescribed_motion",
            "may_flutter",
            "share_to_buckling",
            "spring_energy_j",
        ]
        .map(String::from),
    );
    header.extend(WRENCH_AND_PLACE.map(String::from));
    header.extend(a.coordinates.iter().map(column));
    let mut rows = vec![header];
    let row = |branch: &str, point: &str, name: &str, p: &PointAnswer| {
        let mut row = vec![branch.to_owned(), point.to_owned(), name.to_owned()];
        if a.grows == "load" && !u.load_unit.is_empty() {
            row.push(cell(p.factor.unwrap_or(f64::NAN)));
        }
        row.extend(p.shown.iter().map(|x| cell(*x)));
        row.push(yes(p.stable_under_dead_load));
        row.push(yes(p.stable_under_prescribed_motion));
        row.push(yes(p.may_flutter));
        row.push(cell_if_any(p.share_to_buckling));
        row.push(cell(p.spring_energy_j));
        row.extend(
            [
                p.force_n,
                p.moment_n_m,
                p.position_mm,
                p.rotation_vector_deg,
            ]
            .iter()
            .flatten()
            .map(|x| cell(*x)),
        );
        row.extend(p.coordinates.iter().map(|x| cell(*x)));
        row
    };
    for branch in &a.branches {
        let number = branch.number.to_string();
        for (i, p) in branch.points.iter().enumerate() {
            rows.push(row(&number, &(i + 1).to_string(), "", p));
        }
    }
    // Named points lie between the points of their branches.
    for p in &a.named_points {
        let branch = p
            .branches
            .first()
            .map_or_else(String::new, usize::to_string);
        rows.push(row(
            &branch,
            "",
            &format!("{} {}", p.name, p.kind),
            &p.point,
        ));
    }
    written(&rows)
}

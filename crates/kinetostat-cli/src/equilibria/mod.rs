//! `kinetostat equilibria`: all shapes that a chain or a machine can take.
//!
//! It takes a model, a place, and what holds the tool or acts on it, and gives every equilibrium with its energy,
//! stability and forces, and how complete the list is.

mod answer;
pub(crate) mod arguments;
mod query;
mod text;

use kinetostat::continuation::CurveEquilibrium;
use kinetostat::equilibrium::{
    Bounds, Equilibria, FoundEquilibrium, LimbShapes, SearchSettings, SpreadSettings,
};
use kinetostat::number::{larger, smaller};
use kinetostat::{
    CartesianStiffness, DirectionKind, Equilibrium, MechanismEquilibrium, equilibria,
};
use kinetostat_analysis::degenerate::{is_degenerate, keep_one_of_each_shape};
use kinetostat_analysis::serial_chain::{SerialChain, is_serial_chain};
use kinetostat_machining::{Warning, large_load};
use kinetostat_report::{Plot, PlotLine, PlotMark};
use nalgebra::{Matrix6, Vector3};

use crate::end_condition::answering::{CommandQuery, Work, answer_query};
use crate::end_condition::chain::{moves_of, serial_chain};
use crate::end_condition::coordinates::{WRENCH_AND_PLACE, column, yes};
use crate::end_condition::loads::with_loads;
use crate::end_condition::machine::CommandedMachine;
use crate::end_condition::subject::Subject;
use crate::equilibria::answer::{Coverage, EquilibriaAnswer, LimbCoverage, ShapeAnswer};
use crate::equilibria::arguments::EquilibriaArgs;
use crate::equilibria::query::{EquilibriaQuery, equilibria_query};
use crate::files::answer_files::Shown;
use crate::place::query::{AnswerHead, PlaceQuery};
use crate::ui::background::Stage;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<EquilibriaAnswer>(
    "equilibria under one load",
)];

pub(crate) fn run(args: &EquilibriaArgs) -> Answer<()> {
    let command = CommandQuery {
        model: &args.model,
        place: &args.place,
        tool_length_mm: args.tool_length_mm,
        outputs: &args.outputs,
    };
    let work_of = |query: &PlaceQuery| -> Answer<Work<EquilibriaAnswer>> {
        let size = query.mechanism.size();
        if is_serial_chain(&query.mechanism) {
            let chain = with_loads(serial_chain(query)?, &args.end)?;
            let q = equilibria_query(&moves_of(&chain), args)?;
            Ok(Box::new(move |head, stage| {
                let (all, warnings) = of_chain(&chain, &q, stage)?;
                Ok(answer_of(&chain, &q, all, warnings, head).with_plausibility_warnings(size))
            }))
        } else {
            let machine = CommandedMachine::of(query, &args.end)?;
            let q = equilibria_query(&machine.moves, args)?;
            Ok(Box::new(move |head, stage| {
                let (all, warnings) = of_machine(&machine, &q, stage)?;
                Ok(answer_of(&machine, &q, all, warnings, head).with_plausibility_warnings(size))
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
                csv: of_equilibria(answer)?,
                svg: plot(answer).shape_svg(),
                failure: answer.unanswered(),
            })
        },
    )
}

fn answer_of<S: Subject>(
    subject: &S,
    q: &EquilibriaQuery,
    all: Equilibria<S::Equilibrium>,
    mut warnings: Vec<Warning>,
    head: AnswerHead,
) -> EquilibriaAnswer {
    warnings.extend(large_load(&q.end.wrench));
    let found = || all.found.iter().map(|f| &f.equilibrium);
    let shapes = all.found.iter().enumerate();
    EquilibriaAnswer {
        head,
        question: q.words.clone(),
        tool_held: q.holding.clone(),
        stiffness_along: q.along.map(Into::into),
        coordinates: subject.coordinates(),
        equilibria: shapes.map(|(i, f)| shape(subject, q, i + 1, f)).collect(),
        coverage: Coverage {
            starts: all.starts,
            ended_within_bounds: all.hits,
            ended_outside_bounds: all.outside,
            fruitless: all.fruitless,
            chance_of_more: Some(all.chance_of_more).filter(|chance| *chance > 0.0),
            chance_of_more_at_most: all.chance_of_more_at_most,
            exhausted: all.exhausted,
            incomplete: all.incomplete,
            known: all.count(),
            known_stable: all.stable_count(),
            limbs: all.limbs.iter().map(limb_coverage).collect(),
        },
        conservative: found().all(CurveEquilibrium::conservative),
        warnings,
        outlines: found().map(|e| subject.outline(e)).collect(),
    }
}

/// Stiffness along a unit direction; NaN where it is infinite.
fn along(stiffness: &Matrix6<f64>, d: &Vector3<f64>) -> f64 {
    let parts = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let parts = parts.filter(|&(i, j)| d[i] != 0.0 && d[j] != 0.0);
    parts.map(|(i, j)| d[i] * stiffness[(i, j)] * d[j]).sum()
}

fn limb_coverage(own: &LimbShapes) -> LimbCoverage {
    LimbCoverage {
        name: own.name.clone(),
        shapes: own.shapes,
        stable: own.stable,
        starts: own.starts,
        fruitless: own.fruitless,
        chance_of_more_at_most: own.chance_of_more_at_most,
        exhausted: own.exhausted,
    }
}

fn shape<S: Subject>(
    subject: &S,
    q: &EquilibriaQuery,
    number: usize,
    f: &FoundEquilibrium<S::Equilibrium>,
) -> ShapeAnswer {
    let e = &f.equilibrium;
    let matrix = *e.stiffness();
    let k = CartesianStiffness { matrix }.finite_entries(e.directions());
    // Smallest principal stiffness that is neither free nor rigid.
    let softest = || {
        let directions = e.directions().iter();
        directions
            .filter(|d| !matches!(d.kind, DirectionKind::Free | DirectionKind::Rigid))
            .map(|d| d.stiffness_n_per_m)
            .fold(f64::INFINITY, kinetostat::number::smaller)
    };
    ShapeAnswer {
        number,
        energy_j: f.energy(),
        stable: f.stable,
        may_flutter: f.may_flutter,
        shape_stable: e.shape_stable(),
        share_to_buckling: e.share_to_buckling().filter(|m| m.is_finite()),
        mode_in_words: subject.motion_description(e.buckling_mode()),
        singular: f.singular,
        found_by_spread_starts: f.hits,
        stiffness_n_per_mm: 1e-3
            * match q.along {
                Some(d) => along(&k, &d),
                None => softest(),
            },
        stiffness_n_m_rad: std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)])),
        force_n: e.wrench().force().into(),
        moment_n_m: e.wrench().moment().into(),
        position_mm: (e.tool().translation.vector * 1e3).into(),
        rotation_vector_deg: e.tool().rotation.scaled_axis().map(f64::to_degrees).into(),
        coordinates: subject.values(e),
    }
}

fn of_equilibria(a: &EquilibriaAnswer) -> Answer<Vec<u8>> {
    let mut header: Vec<String> = [
        "number",
        "energy_j",
        "stable",
        "may_flutter",
        "shape_stable",
        "share_to_buckling",
        "singular",
        "found_by_spread_starts",
        "stiffness_n_per_mm",
    ]
    .map(String::from)
    .to_vec();
    header.extend(WRENCH_AND_PLACE.map(String::from));
    header.extend(a.coordinates.iter().map(column));
    let mut rows = vec![header];
    for e in &a.equilibria {
        let mut row = vec![
            e.number.to_string(),
            cell(e.energy_j),
            yes(e.stable),
            yes(e.may_flutter),
            yes(e.shape_stable),
            cell_if_any(e.share_to_buckling),
            yes(e.singular),
            e.found_by_spread_starts.to_string(),
            cell(e.stiffness_n_per_mm),
        ];
        row.extend(
            [
                e.force_n,
                e.moment_n_m,
                e.position_mm,
                e.rotation_vector_deg,
            ]
            .iter()
            .flatten()
            .map(|x| cell(*x)),
        );
        row.extend(e.coordinates.iter().map(|x| cell(*x)));
        rows.push(row);
    }
    written(&rows)
}

fn of_chain(
    chain: &SerialChain,
    q: &EquilibriaQuery,
    stage: &Stage,
) -> Answer<(Equilibria<Equilibrium>, Vec<Warning>)> {
    stage.is("searching for equilibria");
    let problem = chain.problem(q.end.clone());
    let mut all = equilibria(&problem, &Bounds::of(&chain.chain), &q.settings)?;
    for found in &mut all.found {
        found.singular = is_degenerate(chain, &problem, found);
    }
    keep_one_of_each_shape(&mut all.found);
    Ok((all, Vec::new()))
}

fn of_machine(
    machine: &CommandedMachine,
    q: &EquilibriaQuery,
    stage: &Stage,
) -> Answer<(Equilibria<MechanismEquilibrium>, Vec<Warning>)> {
    stage.is("looking for singular postures nearby");
    let warnings = machine.near_singular(0.0)?;
    stage.is("searching for equilibria");
    let settings = SpreadSettings::default()
        .with_starts(q.settings.starts)
        // A start of a machine costs more than one of a chain.
        .with_fruitless(
            match q.settings.fruitless == SearchSettings::default().fruitless {
                true => SpreadSettings::default().fruitless,
                false => q.settings.fruitless,
            },
        );
    Ok((machine.posture.equilibria(&q.end, &settings)?, warnings))
}

/// Shapes that are drawn, those of least energy: names of more find no room.
const MOST_DRAWN: usize = 32;

/// The shapes over the two axes of the base in which they differ most.
fn plot(a: &EquilibriaAnswer) -> Plot {
    let outlines = &a.outlines[..a.outlines.len().min(MOST_DRAWN)];
    let left_out = match a.outlines.len() - outlines.len() {
        0 => String::new(),
        more => format!(" ({MOST_DRAWN} of least energy, {more} more)"),
    };
    let points = || outlines.iter().flatten();
    let extent = |k: usize| {
        let (low, high) = points().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| {
            (smaller(l, p[k]), larger(h, p[k]))
        });
        high - low
    };
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| extent(j).total_cmp(&extent(i)));
    let (mut u, mut v) = (order[0], order[1]);
    if v < u {
        (u, v) = (v, u);
    }
    let axes = ["x", "y", "z"];
    let at = |p: &Vector3<f64>| (1e3 * p[u], 1e3 * p[v]);
    let mut lines = Vec::new();
    let mut marks = Vec::new();
    for (e, outline) in a.equilibria.iter().zip(outlines) {
        lines.push(PlotLine {
            name: format!(
                "{}: {}, {} J",
                e.number,
                if e.stable { "stable" } else { "unstable" },
                a.energy(e, 4)
            ),
            colour: e.number - 1,
            dashed: !e.stable,
            points: outline.iter().map(at).collect(),
            ..PlotLine::default()
        });
        // The number stands where this shape is farthest from all others.
        let farthest = outline
            .iter()
            .map(|p| {
                let away = outlines
                    .iter()
                    .filter(|other| *other != outline)
                    .flat_map(|other| other.iter())
                    .map(|q| (p - q).norm())
                    .fold(f64::INFINITY, smaller);
                (away, p)
            })
            .max_by(|x, y| x.0.total_cmp(&y.0));
        if let Some((_, p)) = farthest {
            marks.push(PlotMark {
                at: at(p),
                name: e.number.to_string(),
                detail: format!(
                    "{}: energy {} J, {}",
                    e.number,
                    a.energy(e, 6),
                    if e.stable { "stable" } else { "unstable" }
                ),
            });
        }
    }
    // Ends shared by all shapes.
    for (name, end) in [
        ("base", outlines.first().and_then(|o| o.first())),
        ("tool", outlines.first().and_then(|o| o.last())),
    ] {
        let shared = |p: &Vector3<f64>| {
            outlines.iter().all(|o| {
                [o.first(), o.last()]
                    .iter()
                    .flatten()
                    .any(|q| (p - **q).norm() < 1e-9)
            })
        };
        if let Some(p) = end.filter(|p| shared(p)) {
            marks.push(PlotMark {
                at: at(p),
                name: name.into(),
                detail: format!("{name} of all shapes"),
            });
        }
    }
    Plot {
        title: format!("{}: shapes of equilibrium{left_out}", a.head.model),
        x_label: format!("{}, mm", axes[u]),
        y_label: format!("{}, mm", axes[v]),
        lines,
        marks,
    }
}

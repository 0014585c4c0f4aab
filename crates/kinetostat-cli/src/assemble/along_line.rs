//! Along a line: deviations alone, load alone, both together, and the sum of both alone
//! [R 6.5.2, figures 6.6 and 6.7].

use kinetostat::chain::FoundBy;
use kinetostat::number::larger;
use kinetostat::{Mechanism, MechanismEquilibrium, Pose, Posture, PostureRequest, Wrench};
use kinetostat_analysis::assembled::AssembledMachine;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::number::counted;
use kinetostat_machining::{Solving, Warning, WarningCode};
use kinetostat_report::{Plot, PlotLine};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::assemble::arguments::{AssembleArgs, Component};
use crate::assemble::query::AssemblyQuery;
use crate::options::vector;
use crate::place::orientation;
use crate::ui::csv_cell::digits;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{fixed, short, triple};
use crate::ui::warnings;

/// Upper limit of the points: more are a typing error.
const MOST_POINTS: usize = 100_000;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct AlongLine {
    schema: u32,
    kinetostat_version: &'static str,
    model: String,
    model_source: String,
    tool: String,
    from_mm: [f64; 3],
    to_mm: [f64; 3],
    force_n: [f64; 3],
    moment_n_m: [f64; 3],
    deviations: Vec<String>,
    /// Largest difference of the sum of both alone and both together, and its mean.
    pub(crate) largest_superposition_error_mm: f64,
    pub(crate) mean_superposition_error_mm: f64,
    points: Vec<Point>,
    warnings: Vec<Warning>,
}

/// Displacements of the tool's tip from its target, base axes.
#[derive(Serialize, JsonSchema)]
struct Point {
    /// Distance from the start of the line.
    distance_mm: f64,
    position_mm: [f64; 3],
    load_alone_mm: [f64; 3],
    deviations_alone_mm: [f64; 3],
    /// First-order result [R 6.15-6.20].
    deviations_alone_linear_mm: [f64; 3],
    together_mm: [f64; 3],
    sum_mm: [f64; 3],
    rotation_vector_together_deg: [f64; 3],
    /// Force on the limbs' ends, deviations alone.
    largest_internal_force_n: f64,
    largest_internal_moment_n_m: f64,
    stable: bool,
    /// Method by which the common equilibrium was found, unless it was found directly.
    #[serde(skip_serializing_if = "Option::is_none")]
    found_by: Option<FoundBy>,
}

/// The machine commanded for a point of the line, by its position only where its orientation follows.
fn at(
    mechanism: &Mechanism,
    target: &Pose,
    follows: bool,
    near: Option<&Posture>,
) -> kinetostat::Result<Posture> {
    let (position, rotation) = (&target.translation.vector, &target.rotation);
    match (follows, near) {
        (false, None) => mechanism.posture(target),
        (false, Some(near)) => mechanism.posture(PostureRequest::pose(target).near(near)),
        (true, None) => mechanism.posture(PostureRequest::position(position, rotation)),
        (true, Some(near)) => {
            mechanism.posture(PostureRequest::position(position, rotation).near(near))
        }
    }
}

/// The figures of one point, mm, `distance_mm` from the first.
fn point(solved: &AssembledMachine, place: Vector3<f64>, distance_mm: f64) -> Point {
    let mm = |e: &MechanismEquilibrium| e.displacement.linear() * 1e3;
    let [drawn, built] = &solved.rest;
    let deviations = mm(built) - mm(drawn);
    let (load, together, end) = match &solved.loaded {
        Some([drawn, built]) => (mm(drawn), mm(built), built),
        None => (mm(drawn), mm(built), built),
    };
    let turn = end.displacement.angular().map(f64::to_degrees);
    let inside = |of: fn(&Wrench) -> f64| {
        let own = built.limbs.iter().zip(&drawn.limbs);
        own.map(|(b, d)| of(&Wrench(b.wrench.0 - d.wrench.0)))
            .fold(0.0, larger)
    };
    Point {
        distance_mm,
        position_mm: place.into(),
        load_alone_mm: load.into(),
        deviations_alone_mm: deviations.into(),
        deviations_alone_linear_mm: (solved.linear.shift.linear() * 1e3).into(),
        together_mm: together.into(),
        sum_mm: (load + deviations).into(),
        rotation_vector_together_deg: turn.into(),
        largest_internal_force_n: inside(|w| w.force().norm()),
        largest_internal_moment_n_m: inside(|w| w.moment().norm()),
        stable: end.stable(),
        found_by: end.found_by.unless_directly(),
    }
}

pub(crate) fn answer(
    assembly: &AssemblyQuery,
    line: &[f64],
    args: &AssembleArgs,
) -> Answer<AlongLine> {
    let query = &assembly.query;
    let count = args.points.unwrap_or(41);
    if !(2..=MOST_POINTS).contains(&count) {
        return Err(ErrorCode::Value.failure(format!(
            "--points {count}: a line has 2 to {MOST_POINTS} points"
        )));
    }
    let from = vector("--along", line.get(..3).unwrap_or_default())?;
    let to = vector("--along", line.get(3..).unwrap_or_default())?;
    let length = (to - from).norm();
    if length.max(from.norm()).max(to.norm()) > 1e7 {
        return Err(
            ErrorCode::Value.failure("--along leads more than 10 km away; coordinates are in mm")
        );
    }
    let mut points = Vec::with_capacity(count);
    let follows = query.mechanism.turns_as_it_moves();
    let mut turned = 0.0_f64;
    let (mut near, mut near_drawn): (Option<Posture>, Option<Posture>) = (None, None);
    for k in 0..count {
        let share = k as f64 / (count - 1) as f64;
        let place = from + (to - from) * share;
        let target = Pose::from_parts((place * 1e-3).into(), query.target.rotation);
        let located = |error: kinetostat::Error| {
            Failure::from(error).within(&format!(
                "point {} of {count}, at {} mm",
                k + 1,
                triple(place.into(), short)
            ))
        };
        let posture = at(&query.mechanism, &target, follows, near.as_ref()).map_err(located)?;
        posture.within_limits().map_err(located)?;
        let drawn =
            at(&assembly.perfect, &target, follows, near_drawn.as_ref()).map_err(located)?;
        turned = larger(turned, posture.target().rotation.angle_to(&target.rotation));
        near = Some(posture.clone());
        let solved = AssembledMachine::solve(posture, &drawn, &query.wrench).map_err(located)?;
        near_drawn = Some(drawn);
        points.push(point(&solved, place, share * length));
    }
    let apart = |p: &Point| (Vector3::from(p.sum_mm) - Vector3::from(p.together_mm)).norm();
    let mut warnings = query.warnings.clone();
    if follows {
        warnings.push(orientation::follows(turned.to_degrees(), false, true));
    }
    let unstable = points.iter().filter(|p| !p.stable).count();
    if unstable > 0 {
        warnings.push(Warning::new(
            WarningCode::NotStable,
            format!(
                "the machine is NOT STABLE at {unstable} of {}",
                counted(count, "point")
            ),
        ));
    }
    Ok(AlongLine {
        schema: 2,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: query.name.clone(),
        model_source: query.source.clone(),
        tool: query.tool_words.clone(),
        from_mm: from.into(),
        to_mm: to.into(),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        deviations: query.deviations.clone(),
        largest_superposition_error_mm: points.iter().map(apart).fold(0.0, larger),
        mean_superposition_error_mm: points.iter().map(apart).sum::<f64>() / count as f64,
        points,
        warnings,
    })
}

fn part(v: [f64; 3], component: Component) -> f64 {
    match component {
        Component::X => v[0],
        Component::Y => v[1],
        Component::Z => v[2],
        Component::Size => Vector3::from(v).norm(),
    }
}

type Curve = (&'static str, fn(&Point) -> [f64; 3]);

const CURVES: [Curve; 5] = [
    ("load alone", |p| p.load_alone_mm),
    ("deviations alone", |p| p.deviations_alone_mm),
    ("deviations, linear", |p| p.deviations_alone_linear_mm),
    ("together", |p| p.together_mm),
    ("sum of both alone", |p| p.sum_mm),
];

pub(crate) fn plot(a: &AlongLine, component: Component) -> Plot {
    let words = match component {
        Component::X => "displacement along x",
        Component::Y => "displacement along y",
        Component::Z => "displacement along z",
        Component::Size => "displacement",
    };
    let loaded = a.force_n.iter().chain(&a.moment_n_m).any(|x| *x != 0.0);
    let lines = CURVES.iter().enumerate();
    Plot {
        title: format!(
            "{}: {words} of the tool by its deviations and its load",
            a.model
        ),
        x_label: format!(
            "way from {} to {}, mm",
            triple(a.from_mm, short),
            triple(a.to_mm, short)
        ),
        y_label: format!("{words}, mm"),
        lines: lines
            .filter(|(_, (name, _))| loaded || name.starts_with("deviations"))
            .map(|(colour, (name, of))| PlotLine {
                name: (*name).into(),
                colour,
                // Close to their neighbours: dashes let both be seen.
                dashed: matches!(colour, 2 | 4),
                points: a
                    .points
                    .iter()
                    .map(|p| (p.distance_mm, part(of(p), component)))
                    .collect(),
                ..PlotLine::default()
            })
            .collect(),
        marks: Vec::new(),
    }
}

pub(crate) fn csv(a: &AlongLine) -> Answer<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed =
        |e: csv::Error| ErrorCode::Output.failure(format!("the table cannot be written: {e}"));
    let mut header = vec!["distance_mm".to_owned()];
    for name in [
        "",
        "load_alone_",
        "deviations_alone_",
        "deviations_alone_linear_",
        "together_",
        "sum_",
    ] {
        header.extend(["x", "y", "z"].map(|axis| format!("{name}{axis}_mm")));
    }
    header.extend(["x", "y", "z"].map(|axis| format!("together_r{axis}_deg")));
    header.extend(
        [
            "largest_internal_force_n",
            "largest_internal_moment_n_m",
            "status",
        ]
        .map(str::to_owned),
    );
    writer.write_record(&header).map_err(failed)?;
    for p in &a.points {
        let mut row = vec![digits(p.distance_mm, 8)];
        for v in [
            &p.position_mm,
            &p.load_alone_mm,
            &p.deviations_alone_mm,
            &p.deviations_alone_linear_mm,
            &p.together_mm,
            &p.sum_mm,
            &p.rotation_vector_together_deg,
        ] {
            row.extend(v.iter().map(|x| digits(*x, 8)));
        }
        row.push(digits(p.largest_internal_force_n, 8));
        row.push(digits(p.largest_internal_moment_n_m, 8));
        row.push(if p.stable { "ok" } else { "unstable" }.to_owned());
        writer.write_record(&row).map_err(failed)?;
    }
    writer
        .into_inner()
        .map_err(|e| failed(csv::Error::from(e.into_error())))
}

/// Eleven points are what a screen holds.
const SHOWN: usize = 11;

pub(crate) fn answer_text(assembly: &AssemblyQuery, a: &AlongLine) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}), from {} to {} mm in {}",
            a.model,
            a.model_source,
            triple(a.from_mm, short),
            triple(a.to_mm, short),
            counted(a.points.len(), "point")
        ),
        0,
    );
    for deviation in &assembly.query.deviations {
        out.push_str(&wrapped(deviation, 0));
    }
    let size = |of: fn(&Point) -> [f64; 3]| {
        let sizes = a.points.iter().map(|p| part(of(p), Component::Size));
        sizes.fold(0.0, larger)
    };
    let moment = a.points.iter().map(|p| p.largest_internal_moment_n_m);
    out.push('\n');
    out.push_str(&wrapped(
        &format!(
            "The deviations alone move the tool by up to {} mm and leave up to {} N m in a limb. With the load it is off by up to {} mm; adding up both alone errs by {} mm at most, {} mm in the mean.",
            fixed(size(|p| p.deviations_alone_mm), 4),
            fixed(moment.fold(0.0, larger), 4),
            fixed(size(|p| p.together_mm), 4),
            fixed(a.largest_superposition_error_mm, 4),
            fixed(a.mean_superposition_error_mm, 4),
        ),
        2,
    ));
    out.push_str("\nSizes of the tool's displacement, mm\n");
    let mut rows = vec![
        [
            "way, mm",
            "load alone",
            "deviations alone",
            "linear",
            "together",
            "sum",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let step = a.points.len().saturating_sub(1).div_ceil(SHOWN - 1).max(1);
    for p in a.points.iter().step_by(step) {
        let mut row = vec![short(p.distance_mm)];
        row.extend(CURVES.map(|(_, of)| fixed(part(of(p), Component::Size), 5)));
        rows.push(row);
    }
    out.push_str(&columns(&rows, 2));
    let mut solving = Solving::default();
    for by in a.points.iter().filter_map(|p| p.found_by) {
        solving.note(by, 1);
    }
    for sentence in solving.sentences("point") {
        out.push_str(&wrapped(&sentence, 2));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

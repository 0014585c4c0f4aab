//! The answer of `curve`: branches, named points, jumps and critical loads, with stable names and
//! units.

use kinetostat::{
    Bounds, BranchEnd, ChainProblem, CriticalLoad, CurvePoint, CurveSettings, Curves, Judged,
    Parameter, Pose, Role, SearchSettings, Settings, Special, SpecialKind, Twist, Wrench,
    critical_load_factor, equilibria, follow, moved, solve_chain,
};
use kinetostat_machining::{Warning, WarningCode};
use nalgebra::Vector3;
use serde::Serialize;

use crate::curve_chain::{CoordinateName, SerialChain, mode_in_words};
use crate::curve_question::{Holding, Measure, Question};
use crate::curve_turns::Turns;
use crate::curve_work::Stage;
use crate::deflect::PlaceAsked;
use crate::equilibria_answer::degenerate;
use crate::failure::{Answer, Failure};

/// The answer, stable names with units.
#[derive(Serialize)]
pub(crate) struct CurveAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) tool: String,
    pub(crate) place: PlaceAsked,
    pub(crate) question: String,
    pub(crate) tool_held: Holding,
    /// What grows: displacement, rotation or load.
    pub(crate) grows: &'static str,
    /// Coordinates of the chain, in the order of `coordinates` of every point.
    pub(crate) coordinates: Vec<CoordinateName>,
    pub(crate) named_points: Vec<NamedPoint>,
    pub(crate) jumps: Vec<JumpAnswer>,
    pub(crate) critical_loads: Vec<CriticalAnswer>,
    pub(crate) branches: Vec<BranchAnswer>,
    /// True if branches that cross were left out because there were too many.
    pub(crate) more_branches: bool,
    /// True if everything that acts has a potential: statements about energy hold.
    pub(crate) conservative: bool,
    pub(crate) warnings: Vec<Warning>,
    /// `chain` or `machine`.
    #[serde(skip)]
    pub(crate) subject: &'static str,
    #[serde(skip)]
    pub(crate) units: Units,
    /// What was asked and what the start's own branch covers of it, as the parameter is shown.
    #[serde(skip)]
    pub(crate) asked: (f64, f64),
    #[serde(skip)]
    pub(crate) reached: (f64, f64),
}

/// A chain that is turned over moves its tip by twice its length: what goes further is stretched.
const STRETCHED: f64 = 2.5;

impl CurveAnswer {
    /// With a warning where the tool goes further than a machine of this length (m) can.
    pub(crate) fn judged(mut self, length: f64) -> Self {
        let points = self.branches.iter().flat_map(|b| &b.points);
        let places = points.map(|p| Vector3::from(p.position_mm));
        let start = self.branches.first().and_then(|b| b.points.first());
        let farthest = start.map_or(0.0, |start| {
            let start = Vector3::from(start.position_mm);
            places.map(|p| (p - start).norm()).fold(0.0, f64::max)
        });
        if farthest > STRETCHED * 1e3 * length {
            self.warnings.push(Warning::new(
                WarningCode::LargeDisplacement,
                format!(
                    "the tool goes {} times as far as the machine is long: its springs are stretched beyond all sense; check the range and its unit",
                    crate::screen::number(farthest / (1e3 * length), 2)
                ),
            ));
        }
        self
    }
}

/// Names of the quantities of a curve.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Units {
    pub(crate) displacement: &'static str,
    pub(crate) displacement_unit: &'static str,
    pub(crate) load: &'static str,
    pub(crate) load_unit: &'static str,
    pub(crate) slope_unit: &'static str,
}

impl Units {
    pub(crate) fn of(question: &Question) -> Self {
        match question.measure {
            Measure::Force(_) => Self {
                displacement: "displacement",
                displacement_unit: "mm",
                load: "force",
                load_unit: "N",
                slope_unit: "N/mm",
            },
            Measure::Moment(_) => Self {
                displacement: "rotation",
                displacement_unit: "deg",
                load: "moment",
                load_unit: "N m",
                slope_unit: "N m/deg",
            },
            Measure::Work => Self {
                displacement: "work per factor",
                displacement_unit: "J",
                load: "load factor",
                load_unit: "",
                slope_unit: "1/J",
            },
        }
    }
}

/// An equilibrium on a curve. Of displacement, load and slope only those of one unit are given.
#[derive(Clone, Serialize)]
pub(crate) struct PointAnswer {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) factor: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    displacement_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    work_per_factor_j: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    force_along_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    moment_along_n_m: Option<f64>,
    /// Null where the displacement stands still.
    #[serde(skip_serializing_if = "Option::is_none")]
    slope_n_per_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slope_n_m_per_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slope_per_j: Option<f64>,
    pub(crate) stable_under_dead_load: bool,
    pub(crate) stable_under_prescribed_motion: bool,
    /// Under the load, which has no potential, nothing goes away, but it may swing with growing
    /// amplitude; whether it does depends on the masses.
    pub(crate) may_flutter: bool,
    /// Largest share of the way to buckling while the tool is held where it is, as in `deflect`; null
    /// without inner freedom, and where a passive joint is pushed out of line.
    pub(crate) share_to_buckling: Option<f64>,
    pub(crate) spring_energy_j: f64,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) position_mm: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
    pub(crate) coordinates: Vec<f64>,
    /// Displacement, load and slope in the units of the answer.
    #[serde(skip)]
    pub(crate) shown: [f64; 3],
}

/// A point with a name.
#[derive(Clone, Serialize)]
pub(crate) struct NamedPoint {
    pub(crate) name: String,
    /// start, load_limit, displacement_limit, pitchfork, transcritical, multiple, crossing (of
    /// machines), landing or end.
    pub(crate) kind: &'static str,
    pub(crate) in_words: String,
    /// Numbers of the branches through it, from 1.
    pub(crate) branches: Vec<usize>,
    /// The critical mode (or the motion along the curve), largest component 1: m, rad.
    pub(crate) mode: Vec<f64>,
    pub(crate) mode_in_words: String,
    /// Whether stability ends here: under a dead load, under prescribed motion.
    #[serde(skip)]
    pub(crate) limits: [bool; 2],
    #[serde(flatten)]
    pub(crate) point: PointAnswer,
}

/// A jump from a limit point.
#[derive(Serialize)]
pub(crate) struct JumpAnswer {
    pub(crate) from: String,
    /// dead_load or prescribed_motion.
    pub(crate) under: &'static str,
    /// Names of the points where it may land, nearest first; empty if no branch that was followed
    /// holds a stable shape there.
    pub(crate) to: Vec<String>,
}

/// A critical load factor.
#[derive(Serialize)]
pub(crate) struct CriticalAnswer {
    /// shape (the tool held where it is) or shape_and_tool (as prescribed).
    pub(crate) judged: &'static str,
    /// From the stresses of the first load step alone; null if they never destabilise.
    pub(crate) linear_factor: Option<f64>,
    pub(crate) linear_mode_in_words: String,
    /// On the path; null if none was met.
    pub(crate) factor: Option<f64>,
    /// Name as in named points; null where the held shape alone becomes critical.
    pub(crate) kind: Option<&'static str>,
    pub(crate) mode: Vec<f64>,
    pub(crate) mode_in_words: String,
    pub(crate) followed_to_factor: f64,
    /// All loads have a potential; if not, the factor is that of divergence, flutter is left open.
    pub(crate) conservative: bool,
    /// Without a potential: below this factor nothing goes away, whatever the masses are; null with one, or
    /// if none was met.
    pub(crate) safe_below_factor: Option<f64>,
    /// What is left open, in words; empty if nothing is.
    pub(crate) caution: String,
}

/// A path of equilibria.
#[derive(Serialize)]
pub(crate) struct BranchAnswer {
    pub(crate) number: usize,
    /// Name of the point from which it was found; null for the start's and those of --all.
    pub(crate) from: Option<String>,
    /// Why it ends at its first and at its last point: range, angle, points, closed, lost, stalled.
    pub(crate) ends: [BranchEnd; 2],
    pub(crate) points: Vec<PointAnswer>,
}

/// What a special point is called.
pub(crate) fn kind_name(kind: SpecialKind) -> &'static str {
    match kind {
        SpecialKind::LoadLimit => "load_limit",
        SpecialKind::DisplacementLimit => "displacement_limit",
        SpecialKind::Pitchfork => "pitchfork",
        SpecialKind::Transcritical => "transcritical",
        SpecialKind::StabilityChange => "crossing",
        SpecialKind::Multiple { .. } => "multiple",
    }
}

pub(crate) fn kind_in_words(kind: &str) -> &'static str {
    match kind {
        "load_limit" => "limit of the load",
        "displacement_limit" => "limit of the motion",
        "pitchfork" => "pitchfork",
        "transcritical" => "transcritical crossing",
        "multiple" => "several modes at once",
        "crossing" => "stability changes",
        "landing" => "after a jump",
        "end" => "end",
        _ => "start",
    }
}

/// A, B, ... Z, AA, AB, ...
pub(crate) fn letter(index: usize) -> String {
    let mut rest = index;
    let mut text = String::new();
    loop {
        text.insert(0, char::from(b'A' + u8::try_from(rest % 26).unwrap_or(0)));
        if rest < 26 {
            return text;
        }
        rest = rest / 26 - 1;
    }
}

/// The problem with its end moved along the curve's displacement.
fn at<'a>(problem: &ChainProblem<'a>, parameter: &Parameter, value: f64) -> ChainProblem<'a> {
    let mut there = problem.clone();
    match parameter {
        Parameter::Displacement(twist) => {
            there.end.pose = moved(&problem.end.pose, &Twist(twist.0 * value));
        }
        Parameter::Load(pattern) => {
            there.end.wrench = problem.end.wrench + pattern.end * value;
            // Loads on nodes are dead forces: the options allow no others.
            there.loads.extend(pattern.loads.iter().map(|l| match l {
                kinetostat::Load::Dead { node, wrench } => {
                    kinetostat::Load::dead(*node, *wrench * value)
                }
                other => other.clone(),
            }));
        }
    }
    there
}

/// Follows the curve of a chain.
pub(crate) fn solve(
    chain: &SerialChain,
    q: &Question,
    place: PlaceAsked,
    spot: [String; 3],
    stage: &Stage,
) -> Answer<CurveAnswer> {
    let problem = chain.problem(q.holding.end.clone());
    let mut settings = CurveSettings::within(q.range.0, q.range.1);
    settings.branches = q.branches;
    settings.points = q.points;
    // Fine enough to be drawn.
    settings.largest_turn = 0.05;
    settings.largest_change = Some((q.range.1 - q.range.0) / 60.0);
    if let Some(limits) = q.force_limits {
        settings.conjugate_range = limits;
    }
    let value = q.start();
    stage.is("looking for the equilibrium at the start");
    let there = at(&problem, &q.parameter, value);
    let start =
        solve_chain(&there, &Settings::default()).map_err(|error| not_there(q, &there, error))?;
    stage.is("following the curve");
    let mut curves = follow(&problem, &q.parameter, &start, value, &settings)?;
    let mut warnings: Vec<Warning> = Vec::new();
    if !q.by_load() && is_locked(&curves) {
        // The load grows at one displacement, the end of the range: rounding must not end the curve.
        let room = 1e-6 * (q.range.1 - q.range.0);
        if value <= q.range.0 {
            settings.range.0 -= room;
        }
        if value >= q.range.1 {
            settings.range.1 += room;
        }
        if q.force_limits.is_none() {
            // Chains of this stiffness and length buckle at about one of these units.
            let scale = chain.chain.scale();
            let (unit, word) = match q.measure {
                Measure::Moment(_) => (scale.stiffness * scale.length.powi(2), "N m"),
                _ => (scale.stiffness * scale.length, "N"),
            };
            let limit = 20.0 * unit;
            settings.conjugate_range = (-limit, limit);
            warnings.push(Warning::new(WarningCode::CurveEnds, format!(
                "the chain is stretched out and locked at the start: the load grows there without any displacement. The curve was kept within {} {word} both ways; --force-limits LOW HIGH sets other limits",
                crate::screen::number(limit, 3)
            )));
        }
        curves = follow(&problem, &q.parameter, &start, value, &settings)?;
    }
    if q.all {
        let mut values = vec![value, q.range.0, q.range.1];
        values.dedup();
        for v in values {
            stage.is("searching for shapes off the curve");
            let there = at(&problem, &q.parameter, v);
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
                if degenerate(chain, &there, found) {
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
    }
    let conjugate = match &q.parameter {
        Parameter::Displacement(twist) => twist.dot(&start.wrench),
        Parameter::Load(_) => 0.0,
    };
    stage.is("looking where the jumps land");
    let jumps = curves.jumps()?;
    let turns = match q.measure {
        Measure::Moment(_) if q.by_load() => Turns::of(&curves, &start.tip, value),
        _ => Turns::none(),
    };
    let view = View {
        chain,
        q,
        curves: &curves,
        turns,
    };
    let (named, jumps) = view.named((value, conjugate), &jumps);
    stage.is("looking for the critical load");
    let critical = critical_loads(chain, q, &problem, &settings)?;
    let branches: Vec<BranchAnswer> = view.branches(&named);
    for b in &branches {
        for end in b.ends {
            match end {
                BranchEnd::Lost => warnings.push(Warning::new(WarningCode::CurveEnds, format!(
                    "branch {} was lost: beyond its end no further point was found",
                    b.number
                ))),
                BranchEnd::Stalled => warnings.push(Warning::new(WarningCode::CurveEnds, format!(
                    "branch {} was given up: ever shorter steps made no progress at its end",
                    b.number
                ))),
                BranchEnd::Points => warnings.push(Warning::new(WarningCode::CurveEnds, format!(
                    "branch {} ends after {} points; --points N allows more, --force-limits keeps it shorter",
                    b.number, q.points
                ))),
                _ => {}
            }
        }
    }
    for special in curves.specials.iter().filter(|s| s.lost_branch) {
        warnings.push(Warning::new(
            WarningCode::CurveEnds,
            format!(
                "a branch that crosses at {} could not be followed: its first step did not converge, and its shapes are missing here",
                q.shown(special.point.parameter)
            ),
        ));
    }
    if curves.more_branches {
        warnings.push(Warning::new(
            WarningCode::MoreBranches,
            format!(
                "more than {} branches cross; --branches N follows more",
                q.branches
            ),
        ));
    }
    warnings.dedup();
    let conservative = start.conservative;
    let own = curves.branches.first().map_or(&[][..], |b| &b.points);
    let [model, model_source, tool] = spot;
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
        coordinates: chain.coordinates(),
        named_points: named,
        jumps,
        critical_loads: critical,
        branches,
        more_branches: curves.more_branches,
        conservative,
        warnings,
        subject: q.holding.subject,
        units: Units::of(q),
        asked: (q.shown(q.range.0), q.shown(q.range.1)),
        reached: own
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                let x = q.shown(p.parameter);
                (low.min(x), high.max(x))
            }),
    })
}

/// Why there is no equilibrium at the start.
fn not_there(q: &Question, there: &ChainProblem<'_>, error: kinetostat::Error) -> Failure {
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
        crate::screen::number(q.shown(q.start()), 6)
    ))
}

/// The displacement stands still at the start.
fn is_locked(curves: &Curves<'_>) -> bool {
    let points = curves.branches.first().map(|b| b.points.as_slice());
    points.is_some_and(|list| list.iter().all(|p| !p.slope.is_finite()))
}

fn critical_loads(
    chain: &SerialChain,
    q: &Question,
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
    for (judged, name) in [
        (Judged::Shape, "shape"),
        (Judged::ShapeAndEnd, "shape_and_tool"),
    ] {
        let found = critical_load_factor(problem, pattern, judged, settings)?;
        list.push(critical_answer(chain, name, found));
    }
    Ok(list)
}

fn critical_answer(chain: &SerialChain, judged: &'static str, c: CriticalLoad) -> CriticalAnswer {
    let mode = c.exact.as_ref().map_or_else(Vec::new, |e| e.mode.clone());
    let caution = c.caution().unwrap_or_default();
    CriticalAnswer {
        judged,
        linear_factor: c.linear,
        linear_mode_in_words: if c.linear_mode.is_empty() {
            String::new()
        } else {
            mode_in_words(chain, &c.linear_mode)
        },
        factor: c.exact.as_ref().map(|e| e.factor),
        kind: c.exact.as_ref().and_then(|e| e.kind).map(kind_name),
        mode_in_words: if mode.is_empty() {
            String::new()
        } else {
            mode_in_words(chain, &mode)
        },
        mode,
        followed_to_factor: c.reached,
        conservative: c.conservative,
        safe_below_factor: c.definite_until,
        caution,
    }
}

/// An equilibrium on a curve of a chain or a machine, SI.
pub(crate) struct Found {
    pub(crate) parameter: f64,
    pub(crate) conjugate: f64,
    pub(crate) slope: f64,
    /// Under a dead load, under prescribed motion.
    pub(crate) stable: [bool; 2],
    pub(crate) may_flutter: bool,
    pub(crate) share_to_buckling: Option<f64>,
    pub(crate) energy: f64,
    pub(crate) wrench: Wrench,
    pub(crate) tip: Pose,
    /// In their units.
    pub(crate) coordinates: Vec<f64>,
}

impl Found {
    /// In the units of the question. `turned`: whole turns of the tool about the growing moment, rad.
    pub(crate) fn answer(self, q: &Question, turned: f64) -> PointAnswer {
        let by_load = q.by_load();
        let p = &self;
        let [displacement, load, slope] = match (q.measure, by_load) {
            (Measure::Force(_), false) => [1e3 * p.parameter, p.conjugate, 1e-3 * p.slope],
            (Measure::Force(f), true) => [
                1e3 * p.conjugate / f,
                f * p.parameter,
                1e-3 * f * f * p.slope,
            ],
            (Measure::Moment(_), false) => {
                [p.parameter.to_degrees(), p.conjugate, p.slope.to_radians()]
            }
            (Measure::Moment(m), true) => [
                (p.conjugate / m + turned).to_degrees(),
                m * p.parameter,
                (m * m * p.slope).to_radians(),
            ],
            (Measure::Work, _) => [p.conjugate, p.parameter, p.slope],
        };
        let of = |this: bool, x: f64| this.then_some(x);
        let force = matches!(q.measure, Measure::Force(_));
        let moment = matches!(q.measure, Measure::Moment(_));
        let work = q.measure == Measure::Work;
        PointAnswer {
            factor: of(by_load, p.parameter),
            displacement_mm: of(force, displacement),
            rotation_deg: of(moment, displacement),
            work_per_factor_j: of(work, displacement),
            force_along_n: of(force, load),
            moment_along_n_m: of(moment, load),
            slope_n_per_mm: of(force, slope),
            slope_n_m_per_deg: of(moment, slope),
            slope_per_j: of(work, slope),
            stable_under_dead_load: p.stable[0],
            stable_under_prescribed_motion: p.stable[1],
            may_flutter: p.may_flutter,
            share_to_buckling: p.share_to_buckling.filter(|m| m.is_finite()),
            spring_energy_j: p.energy,
            force_n: p.wrench.force().into(),
            moment_n_m: p.wrench.moment().into(),
            position_mm: (p.tip.translation.vector * 1e3).into(),
            rotation_vector_deg: p.tip.rotation.scaled_axis().map(f64::to_degrees).into(),
            coordinates: self.coordinates,
            shown: [displacement, load, slope],
        }
    }
}

/// What grows, by name.
pub(crate) fn grows(q: &Question) -> &'static str {
    match (q.by_load(), q.measure) {
        (true, _) => "load",
        (false, Measure::Moment(_)) => "rotation",
        (false, _) => "displacement",
    }
}

/// Curves as they are shown.
struct View<'v> {
    chain: &'v SerialChain,
    q: &'v Question,
    curves: &'v Curves<'v>,
    turns: Turns,
}

impl View<'_> {
    /// `more`: what a continuous rotation has more than the one within half a turn, about the moment
    /// that grows, rad.
    fn point(&self, p: &CurvePoint, more: &Vector3<f64>) -> PointAnswer {
        let e = &p.equilibrium;
        Found {
            parameter: p.parameter,
            conjugate: p.conjugate,
            slope: p.slope,
            stable: [p.dead.stable, p.held.stable],
            may_flutter: p.dead.may_flutter(),
            share_to_buckling: e.stability.share_to_buckling,
            energy: e.energy,
            wrench: e.wrench,
            tip: e.tip,
            coordinates: self.chain.values(&e.coordinates),
        }
        .answer(self.q, self.about(more))
    }

    /// The part of a rotation vector about the growing moment.
    fn about(&self, rotation: &Vector3<f64>) -> f64 {
        match &self.q.parameter {
            Parameter::Load(pattern) => {
                let axis = pattern.end.moment().try_normalize(0.0);
                axis.map_or(0.0, |axis| rotation.dot(&axis))
            }
            Parameter::Displacement(_) => 0.0,
        }
    }

    /// Number of the branch that comes nearest to a point, from 1.
    fn branch_of(&self, p: &CurvePoint) -> usize {
        let x = &p.equilibrium.coordinates;
        let coordinates = self.chain.chain.coordinates();
        let length = self.chain.chain.scale().length;
        let distance = |other: &CurvePoint| {
            x.iter()
                .zip(&other.equilibrium.coordinates)
                .zip(coordinates)
                .map(|((a, b), c)| {
                    let d = a - b;
                    match (c.kind, c.role) {
                        (kinetostat::MotionKind::Prismatic, _) => (d / length).powi(2),
                        (_, Role::Passive) => {
                            let turn = std::f64::consts::TAU;
                            (d - turn * (d / turn).round()).powi(2)
                        }
                        _ => d * d,
                    }
                })
                .sum::<f64>()
        };
        let mut best = (f64::INFINITY, 0);
        for (k, branch) in self.curves.branches.iter().enumerate() {
            for point in &branch.points {
                let d = distance(point);
                if d < best.0 {
                    best = (d, k);
                }
            }
        }
        best.1 + 1
    }

    fn named(
        &self,
        start: (f64, f64),
        jumps: &[kinetostat::Jump],
    ) -> (Vec<NamedPoint>, Vec<JumpAnswer>) {
        // A locked chain has many points at the start's displacement: the load tells them apart.
        let width = self.q.range.1 - self.q.range.0;
        let off = |p: &CurvePoint| {
            (p.parameter - start.0).abs() / width
                + (p.conjugate - start.1).abs() / (1.0 + start.1.abs())
        };
        let own = self.curves.branches.first();
        let first = own.and_then(|b| b.points.iter().min_by(|a, b| off(a).total_cmp(&off(b))));
        let same_place = |p: &CurvePoint, other: Option<&CurvePoint>| {
            other.is_some_and(|o| p.parameter == o.parameter && p.conjugate == o.conjugate)
        };
        let mut named: Vec<NamedPoint> = Vec::new();
        let mut add = |kind: &'static str,
                       words: String,
                       branches: Vec<usize>,
                       p: &CurvePoint,
                       mode: &[f64],
                       limits: [bool; 2]| {
            let name = letter(named.len());
            named.push(NamedPoint {
                name: name.clone(),
                kind,
                in_words: words,
                branches,
                mode: mode.to_vec(),
                mode_in_words: if mode.is_empty() {
                    String::new()
                } else {
                    mode_in_words(self.chain, mode)
                },
                limits,
                point: self.point(p, &self.turns.at(self.curves, p)),
            });
            name
        };
        if let Some(p) = first {
            let words = "where the curve starts".into();
            add("start", words, vec![1], p, &[], [false; 2]);
        }
        let mut specials = Vec::new();
        for s in &self.curves.specials {
            let branches: Vec<usize> = s.branches.iter().map(|b| b + 1).collect();
            specials.push(add(
                kind_name(s.kind),
                special_in_words(s),
                branches,
                &s.point,
                &s.mode,
                limits(s),
            ));
        }
        let mut told = Vec::new();
        for jump in jumps {
            let under = if jump.dead_load {
                "under a dead load"
            } else {
                "under prescribed motion"
            };
            let from = specials[jump.from].clone();
            let to = jump
                .to
                .iter()
                .map(|p| {
                    add(
                        "landing",
                        format!("where the jump from {from} {under} may land"),
                        vec![self.branch_of(p)],
                        p,
                        &[],
                        [false; 2],
                    )
                })
                .collect();
            told.push(JumpAnswer {
                from,
                under: if jump.dead_load {
                    "dead_load"
                } else {
                    "prescribed_motion"
                },
                to,
            });
        }
        for (k, branch) in self.curves.branches.iter().enumerate() {
            let ends = [branch.points.first(), branch.points.last()];
            for (p, end) in ends.into_iter().zip(branch.ends) {
                let words = match end {
                    BranchEnd::Range => "leaves the range",
                    BranchEnd::Angle => "a joint has turned by 180 deg",
                    BranchEnd::Points => "as many points as allowed",
                    BranchEnd::Lost => "no further point was found",
                    BranchEnd::Stalled => "ever shorter steps made no progress",
                    BranchEnd::Closed | BranchEnd::Found => continue,
                };
                // The start has a name already.
                if let Some(p) = p.filter(|p| k > 0 || !same_place(p, first)) {
                    let words = format!("end of branch {}: {words}", k + 1);
                    add("end", words, vec![k + 1], p, &[], [false; 2]);
                }
            }
        }
        (named, told)
    }

    fn branches(&self, named: &[NamedPoint]) -> Vec<BranchAnswer> {
        self.curves
            .branches
            .iter()
            .enumerate()
            .map(|(k, b)| BranchAnswer {
                number: k + 1,
                // The start is named first, then the special points in their order.
                from: b
                    .origin
                    .and_then(|s| named.get(s + 1))
                    .map(|n| n.name.clone()),
                ends: b.ends,
                points: b
                    .points
                    .iter()
                    .enumerate()
                    .map(|(i, p)| self.point(p, &self.turns.of_point(self.curves, k, i)))
                    .collect(),
            })
            .collect()
    }
}

/// Whether stability ends at a special point: under a dead load, under prescribed motion.
fn limits(s: &Special) -> [bool; 2] {
    if !s.stable_side {
        return [false; 2];
    }
    match s.kind {
        SpecialKind::LoadLimit => [true, false],
        SpecialKind::DisplacementLimit => [false, true],
        // The verdict of the point itself is a matter of rounding: it is at the limit of what holds.
        _ => [s.point.slope >= 0.0, true],
    }
}

fn special_in_words(s: &Special) -> String {
    let tail = if s.stable_side {
        ""
    } else {
        ", on a part of the curve that is unstable anyway"
    };
    let text = match s.kind {
        SpecialKind::LoadLimit if s.stable_side => {
            "the load has its extreme here: under a dead load the chain snaps".to_owned()
        }
        SpecialKind::DisplacementLimit if s.stable_side => {
            "the motion has its extreme here: under prescribed motion the chain snaps".to_owned()
        }
        SpecialKind::LoadLimit => "extreme of the load".to_owned(),
        SpecialKind::DisplacementLimit => "extreme of the motion".to_owned(),
        SpecialKind::Pitchfork if s.stable_side => {
            "pitchfork: the chain buckles to one side or the other".to_owned()
        }
        SpecialKind::Pitchfork => "pitchfork: two mirrored shapes branch off".to_owned(),
        SpecialKind::Transcritical => "two branches cross and both go on".to_owned(),
        SpecialKind::StabilityChange => {
            "stability changes here without a limit: another branch crosses".to_owned()
        }
        SpecialKind::Multiple { modes } => format!("{modes} modes become critical together"),
    };
    format!("{text}{tail}")
}

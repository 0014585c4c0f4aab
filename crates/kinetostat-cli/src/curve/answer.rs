//! The answer of `curve`: branches, named points, jumps and critical loads, with stable names and
//! units.

use kinetostat::continuation::{BranchEnd, SpecialKind};
use kinetostat::number::{larger, smaller};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, folds};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::curve::query::{CurveQuery, Measure};
use crate::end_condition::coordinates::CoordinateName;
use crate::end_condition::holding::Holding;
use crate::machine::displacement_warnings::{large_reaction, stretches};
use crate::place::query::AnswerHead;
use crate::ui::failure::{Failing, Failure};

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CurveAnswer {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) question: String,
    pub(crate) tool_held: Holding,
    /// Quantity that grows: displacement, rotation or load.
    pub(crate) grows: &'static str,
    /// Coordinates of the chain or of all limbs, in the order of `coordinates` of every point.
    pub(crate) coordinates: Vec<CoordinateName>,
    pub(crate) named_points: Vec<NamedPoint>,
    pub(crate) jumps: Vec<JumpAnswer>,
    /// Critical loads of a chain under a growing load; for a machine the named points give the end of stability.
    pub(crate) critical_loads: Vec<CriticalAnswer>,
    pub(crate) branches: Vec<BranchAnswer>,
    /// True if branches that cross were left out because there were too many.
    pub(crate) more_branches: bool,
    /// True if everything that acts has a potential: statements about energy hold.
    pub(crate) conservative: bool,
    pub(crate) warnings: Vec<Warning>,
    /// Limits of the force were given, which may leave nothing but the start.
    #[serde(skip)]
    pub(crate) force_limited: bool,
    /// `chain` or `machine`.
    #[serde(skip)]
    pub(crate) subject: &'static str,
    #[serde(skip)]
    pub(crate) units: Units,
    /// Requested range and the part of it that the start's own branch covers, as the parameter is shown.
    #[serde(skip)]
    pub(crate) requested: (f64, f64),
    #[serde(skip)]
    pub(crate) reached: (f64, f64),
}

impl CurveAnswer {
    /// Adds warnings of a tool that goes further than a machine of this size (m) can, of a growing load that it
    /// bears and that folds it over, and of a motion that takes more force than any cut has.
    pub(crate) fn with_plausibility_warnings(mut self, size: f64) -> Self {
        let Some(own) = self.branches.first() else {
            return self;
        };
        let Some(start) = own.points.first().map(|p| Vector3::from(p.position_mm)) else {
            return self;
        };
        let away = |p: &PointAnswer| 1e-3 * (Vector3::from(p.position_mm) - start).norm();
        let all = self.branches.iter().flat_map(|b| &b.points);
        let farthest = all.map(away).fold(0.0, larger);
        let borne = own.points.iter().take_while(|p| p.stable_under_dead_load);
        let by_load = (self.grows == "load").then(|| borne.map(away).fold(0.0, larger));
        let warning =
            stretches(farthest, size).or_else(|| by_load.and_then(|far| folds(far, size)));
        let reactions = own.points.iter().map(|p| Vector3::from(p.force_n).norm());
        let largest = (self.grows != "load").then(|| reactions.fold(0.0, larger));
        self.warnings.extend(warning);
        self.warnings
            .extend(largest.into_iter().flat_map(large_reaction));
        self.warnings.dedup();
        self
    }

    /// Returns a failure if the curve is empty: the start alone, within every force.
    pub(crate) fn unanswered(&self) -> Option<Failure> {
        let points: usize = self.branches.iter().map(|b| b.points.len()).sum();
        (points < 2 && !self.force_limited).then(|| {
            ErrorCode::NotConverged.failure("the curve could not be followed from its start: no second equilibrium was found near it. Check what grows and its unit, or how far",
            )
        })
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
    pub(crate) fn of(query: &CurveQuery) -> Self {
        match query.measure {
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
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct PointAnswer {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) factor: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) displacement_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rotation_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) work_per_factor_j: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) force_along_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) moment_along_n_m: Option<f64>,
    /// Null where the displacement stands still.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) slope_n_per_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) slope_n_m_per_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) slope_per_j: Option<f64>,
    pub(crate) stable_under_dead_load: bool,
    pub(crate) stable_under_prescribed_motion: bool,
    /// True if the state does not diverge under loads without a potential, but may swing with
    /// growing amplitude, depending on the masses.
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

/// A start, limit, bifurcation, landing or end of the curves, with the letter that drawing and text call it by.
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct NamedPoint {
    pub(crate) name: String,
    /// start, load_limit, displacement_limit, pitchfork, transcritical, multiple, crossing (stability
    /// changes in a limb or platform of a machine while its tool stands still), landing or end.
    pub(crate) kind: &'static str,
    pub(crate) in_words: String,
    /// Numbers of the branches through it, from 1.
    pub(crate) branches: Vec<usize>,
    /// The critical mode (or the motion along the curve), largest component 1: m, rad; of the coordinates
    /// of a chain, of the tool of a machine (x, y, z, rx, ry, rz).
    pub(crate) mode: Vec<f64>,
    pub(crate) mode_in_words: String,
    /// True if stability ends here: under a dead load, under prescribed motion.
    #[serde(skip)]
    pub(crate) limits: [bool; 2],
    #[serde(flatten)]
    pub(crate) point: PointAnswer,
}

/// A jump from a limit point.
#[derive(Serialize, JsonSchema)]
pub(crate) struct JumpAnswer {
    pub(crate) from: String,
    /// dead_load or prescribed_motion.
    pub(crate) under: &'static str,
    /// Names of the points where it may land, nearest first; empty if no branch that was followed
    /// holds a stable shape there.
    pub(crate) to: Vec<String>,
}

/// A critical load factor.
#[derive(Serialize, JsonSchema)]
pub(crate) struct CriticalAnswer {
    /// shape (the tool held where it is) or shape_and_tool (as prescribed).
    #[serde(rename = "judged")]
    pub(crate) stability_of: &'static str,
    /// Factor from the stresses of the first load step alone; null if they never destabilise.
    pub(crate) linear_factor: Option<f64>,
    pub(crate) linear_mode_in_words: String,
    /// Factor on the path; null if none was met.
    pub(crate) factor: Option<f64>,
    /// Name as in named points; null where the held shape alone becomes critical.
    pub(crate) kind: Option<&'static str>,
    pub(crate) mode: Vec<f64>,
    pub(crate) mode_in_words: String,
    pub(crate) followed_to_factor: f64,
    /// All loads have a potential; if not, the factor is that of divergence, flutter is left open.
    pub(crate) conservative: bool,
    /// Factor below which a state without a potential does not diverge, whatever the masses are; null with
    /// one, or if none was met.
    pub(crate) safe_below_factor: Option<f64>,
    /// Open questions in words; empty if there are none.
    pub(crate) caution: String,
}

/// A path of equilibria.
#[derive(Serialize, JsonSchema)]
pub(crate) struct BranchAnswer {
    pub(crate) number: usize,
    /// Name of the point from which it was found; null for the start's and those of --all.
    pub(crate) from: Option<String>,
    /// Reasons for the first and the last end: range, angle, points, closed, lost, stalled.
    pub(crate) ends: [BranchEnd; 2],
    pub(crate) points: Vec<PointAnswer>,
}

/// Name of a special point.
pub(crate) fn kind_name(kind: SpecialKind) -> &'static str {
    match kind {
        SpecialKind::LoadLimit => "load_limit",
        SpecialKind::DisplacementLimit => "displacement_limit",
        SpecialKind::Pitchfork => "pitchfork",
        SpecialKind::Transcritical => "transcritical",
        SpecialKind::StabilityChange => "crossing",
        SpecialKind::Multiple { .. } => "multiple",
        _ => "special",
    }
}

pub(crate) fn kind_description(kind: &str) -> &'static str {
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

/// Smallest and largest of the values of a curve's parameter.
pub(crate) fn reached(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (smaller(low, x), larger(high, x))
    })
}

/// Name of the growing quantity.
pub(crate) fn grows(q: &CurveQuery) -> &'static str {
    match (q.by_load(), q.measure) {
        (true, _) => "load",
        (false, Measure::Moment(_)) => "rotation",
        (false, _) => "displacement",
    }
}

//! Curves of equilibria by arc-length continuation (Keller): force against displacement, or
//! displacement against a load factor, around limit points and through bifurcations.
//!
//! A curve starts at an equilibrium, is followed both ways, and every further branch that crosses
//! it can be followed as well. Steps adapt to the curve; limit points and bifurcation points
//! between two steps are located by themselves ([`Special`]).
//!
//! Shapes that a motion turns into each other at no cost (a round rod that buckles in any direction)
//! are one family and one branch, followed at rest along that motion ([`CurvePoint::in_family`]).

use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::ChainProblem;
use crate::chain::stability::ShapeStability;
use crate::continuation::bifurcation::Special;
use crate::continuation::family::Family;
use crate::continuation::reduced::{Parameter, Reduced};
use crate::continuation::tracer::Tracer;
use crate::error::Result;
use crate::model::limits::sensible;
use crate::settings::{Settings, wrong};

/// How far and how finely curves are followed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurveSettings {
    /// The parameter stays between these values (m, rad or a factor).
    pub range: (f64, f64),
    /// Its conjugate stays between these values (N, N m or J). Default: no limit.
    pub conjugate_range: (f64, f64),
    /// Joint rotations stay within plus and minus this angle, rad. Default pi.
    pub largest_angle: f64,
    /// Largest rotation of any joint in one step, rad (slides: as a share of the natural length).
    /// Default 0.1.
    pub largest_turn: f64,
    /// Largest change of the parameter in one step. Default: a twentieth of a finite range.
    pub largest_change: Option<f64>,
    /// Smallest step before a branch is given up, as a share of the natural one. Default 1e-7.
    pub smallest_step: f64,
    /// Points of one branch, in each direction. Default 400.
    pub points: usize,
    /// Branches followed at most; 1 is the start's own only. Default 1.
    pub branches: usize,
    /// Tolerances of each point.
    pub solver: Settings,
}

impl CurveSettings {
    /// Defaults for a range of the parameter.
    #[must_use]
    pub fn within(from: f64, to: f64) -> Self {
        Self {
            range: (from.min(to), from.max(to)),
            conjugate_range: (f64::NEG_INFINITY, f64::INFINITY),
            largest_angle: PI,
            largest_turn: 0.1,
            largest_change: None,
            smallest_step: 1e-7,
            points: 400,
            branches: 1,
            solver: Settings::default(),
        }
    }

    /// Refuses what no curve can be followed with, naming it.
    pub(crate) fn check(&self, place: &str) -> Result<()> {
        for (what, (from, to)) in [
            ("range", self.range),
            ("conjugate_range", self.conjugate_range),
        ] {
            if from.partial_cmp(&to) != Some(Ordering::Less) {
                return Err(wrong(
                    place,
                    what,
                    (from, to),
                    "a smaller and a larger number",
                ));
            }
        }
        let largest_change = self.largest_change.unwrap_or(1.0);
        for (what, value, most, asked) in [
            (
                "largest_angle",
                self.largest_angle,
                f64::INFINITY,
                "an angle above 0",
            ),
            (
                "largest_turn",
                self.largest_turn,
                PI,
                "an angle above 0 and up to pi",
            ),
            (
                "largest_change",
                largest_change,
                f64::INFINITY,
                "a number above 0",
            ),
            (
                "smallest_step",
                self.smallest_step,
                1.0,
                "a share above 0 and up to 1",
            ),
        ] {
            if !(value > 0.0 && value <= most) {
                return Err(wrong(place, what, value, asked));
            }
        }
        for (what, count) in [("points", self.points), ("branches", self.branches)] {
            if count == 0 {
                return Err(wrong(place, what, 0, "at least 1"));
            }
        }
        self.solver.check(place)
    }
}

/// Why a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BranchEnd {
    /// The parameter or its conjugate reached a limit.
    Range,
    /// A joint reached the largest angle.
    Angle,
    /// As many points as allowed.
    Points,
    /// The branch came back to where it started.
    Closed,
    /// The smallest step found no further point.
    Lost,
    /// Ever shorter steps made no progress.
    Stalled,
    /// What was looked for has been found.
    Found,
}

/// An equilibrium on a curve.
#[derive(Clone, Debug)]
pub struct CurvePoint {
    /// Displacement (m, rad) or load factor.
    pub parameter: f64,
    /// Force (N, N m) along the displacement, or displacement along the load pattern (J per unit
    /// factor, since the curve's start).
    pub conjugate: f64,
    /// Coordinates, wrench, energy, stiffness and shape (the whole end held).
    pub equilibrium: Equilibrium,
    /// Load per displacement along the curve (N/m, N m/rad; for a load pattern factor per J):
    /// negative where a dead load runs away, infinite where the end is locked.
    pub slope: f64,
    /// Stability while the motion along the parameter's direction is prescribed.
    pub held: ShapeStability,
    /// Stability while a dead load acts along it instead.
    pub dead: ShapeStability,
    /// Arc length since the branch's first point, natural units.
    pub arc: f64,
    pub(crate) z: DVector<f64>,
    pub(crate) tangent: DVector<f64>,
    pub(crate) unstable: [usize; 2],
    pub(crate) family: Option<Arc<Family>>,
}

impl CurvePoint {
    /// Number of unstable modes while the motion along the parameter is prescribed, and under a
    /// dead load.
    #[must_use]
    pub fn unstable_modes(&self) -> [usize; 2] {
        self.unstable
    }

    /// True if the shape is one of a continuum at this value of the parameter: a motion leads from
    /// it to others that costs nothing (a buckled round rod turned about its axis). Stability then
    /// is that against all other motions, the neutral one counts as a zero of the inertia.
    #[must_use]
    pub fn in_family(&self) -> bool {
        self.family.is_some()
    }

    /// The parameter's load: the factor, or the force along the displacement.
    #[must_use]
    pub fn load(&self, parameter: &Parameter) -> f64 {
        match parameter {
            Parameter::Displacement(_) => self.conjugate,
            Parameter::Load(_) => self.parameter,
        }
    }
}

/// A smooth path of equilibria.
#[derive(Clone, Debug)]
pub struct Branch {
    /// In order along the path.
    pub points: Vec<CurvePoint>,
    /// Bifurcation point (index into [`Curves::specials`]) it was found from; `None`: the start.
    pub origin: Option<usize>,
    /// Why it ends, at the first and at the last point.
    pub ends: [BranchEnd; 2],
}

/// A curve of equilibria and the branches connected to it.
#[derive(Clone, Debug)]
pub struct Curves<'a> {
    /// The problem at parameter 0.
    pub problem: ChainProblem<'a>,
    /// What grows.
    pub parameter: Parameter,
    /// The start's own branch first.
    pub branches: Vec<Branch>,
    /// Limit points and bifurcation points, in the order found.
    pub specials: Vec<Special>,
    /// True if connected branches were left out because there were too many.
    pub more_branches: bool,
    pub(crate) settings: CurveSettings,
    pub(crate) start: (Vec<f64>, crate::spatial::Wrench, f64),
}

/// Follows the equilibrium path through `start` both ways, and the branches connected to it as far
/// as [`CurveSettings::branches`] allows. `value` is the parameter at the start; the problem
/// itself is the one at parameter 0.
///
/// # Errors
/// Wrong numbers or directions, a parameter that changes nothing, or a start that is no
/// equilibrium.
pub fn follow<'a>(
    problem: &ChainProblem<'a>,
    parameter: &Parameter,
    start: &Equilibrium,
    value: f64,
    settings: &CurveSettings,
) -> Result<Curves<'a>> {
    follow_until(problem, parameter, start, value, settings, None)
}

/// Tells that a point is what was looked for.
pub(crate) type Stop<'s> = Option<&'s dyn Fn(&CurvePoint) -> bool>;

pub(crate) fn follow_until<'a>(
    problem: &ChainProblem<'a>,
    parameter: &Parameter,
    start: &Equilibrium,
    value: f64,
    settings: &CurveSettings,
    stop: Stop<'_>,
) -> Result<Curves<'a>> {
    let place = format!("chain '{}'", problem.chain.name());
    settings.check(&place)?;
    sensible(&place, || "the parameter at the start".into(), value)?;
    problem.chain.check(&start.coordinates, &problem.commands)?;
    let mut curves = Curves {
        problem: problem.clone(),
        parameter: parameter.clone(),
        branches: Vec::new(),
        specials: Vec::new(),
        more_branches: false,
        settings: settings.clone(),
        start: (start.coordinates.clone(), start.wrench, value),
    };
    curves.grow(start, value, stop)?;
    Ok(curves)
}

impl Curves<'_> {
    /// Follows the path through a further equilibrium of the same problem, at a value of the
    /// parameter, and the branches connected to it as far as [`CurveSettings::branches`] allows for
    /// each start. False if the equilibrium lies on a branch that is known.
    ///
    /// # Errors
    /// The start is no equilibrium.
    pub fn add(&mut self, start: &Equilibrium, value: f64) -> Result<bool> {
        self.grow(start, value, None)
    }

    fn grow(&mut self, start: &Equilibrium, value: f64, stop: Stop<'_>) -> Result<bool> {
        let (problem, parameter) = (self.problem.clone(), self.parameter.clone());
        let settings = self.settings.clone();
        let mut reduced = Reduced::new(&problem, Some(&parameter), &settings.solver)?.by_sweeps();
        reduced.start(&self.start.0, &self.start.1, self.start.2)?;
        let z = reduced.state(&start.coordinates, &start.wrench, value);
        let mut tracer = Tracer {
            reduced,
            settings: &settings,
            specials: std::mem::take(&mut self.specials),
        };
        let answer = tracer.grow(&z, &mut self.branches, &mut self.more_branches, stop);
        self.specials = tracer.specials;
        answer
    }
}

/// One branch from its two halves, which share their first point.
pub(crate) fn join(mut halves: Vec<(Vec<CurvePoint>, BranchEnd)>, origin: Option<usize>) -> Branch {
    let (forward, last) = halves.pop().unwrap_or((Vec::new(), BranchEnd::Lost));
    let (backward, first) = halves.pop().unwrap_or((Vec::new(), BranchEnd::Lost));
    let mut points: Vec<CurvePoint> = backward;
    points.reverse();
    points.pop();
    for point in &mut points {
        point.tangent *= -1.0;
    }
    points.extend(forward);
    let mut arc = 0.0;
    for i in 0..points.len() {
        if i > 0 {
            arc += (&points[i].z - &points[i - 1].z).norm();
        }
        points[i].arc = arc;
    }
    Branch {
        points,
        origin,
        ends: [first, last],
    }
}

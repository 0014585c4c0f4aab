//! Critical load factor of a load pattern: how many times a pattern of loads can grow until the
//! chain loses its stability, by the eigenvalue of the first load step and by following the path.
//!
//! Loads without a potential (forces that follow the chain, moments about axes that turn) make the
//! tangent `T = N^T (K - H) N` unsymmetric. Then a neighbouring equilibrium, and with it divergence,
//! exists where `det T = 0`, not where the symmetric part of `T` is indefinite; and the chain may start
//! to swing with growing amplitude (flutter) before, which depends on its masses and is not answered
//! here (Ziegler 1952; Bolotin, Nonconservative Problems of the Theory of Elastic Stability, 1963).

use std::cell::RefCell;

use nalgebra::DVector;

use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::{ChainProblem, is_conservative};
use crate::chain::stability::ShapeStability;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::curve::{CurvePoint, Curves, SpecialKind};
use crate::continuation::follow::follow_until;
use crate::continuation::settings::{CurveSettings, LoadPattern, Parameter};
use crate::continuation::tracing::tracer::Tracer;
use crate::equilibrium::chain::solve_chain;
use crate::equilibrium::critical_tangent::{
    StabilityOf, Tangent, diverges, largest_one, largest_real, linear_prediction,
};
use crate::error::Result;
use crate::number::larger;
use crate::spatial::Wrench;

/// Point where stability is lost.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CriticalPoint {
    /// Load factor, 1 for the pattern as given.
    pub factor: f64,
    /// Kind of the point; `None` where the held shape alone becomes critical, which is no special point of the path.
    pub kind: Option<SpecialKind>,
    /// Motion of all coordinates in the critical mode (m, rad), largest component 1.
    pub mode: Vec<f64>,
    /// Equilibrium under `factor` times the pattern.
    pub equilibrium: Equilibrium,
}

/// Critical load factor of a pattern.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CriticalLoad {
    /// Linear prediction: `1/mu` of the stresses of the first load step in the unloaded posture;
    /// `None` if that load never destabilises it.
    pub linear: Option<f64>,
    /// Mode of the linear prediction (m, rad), largest component 1; empty without one.
    pub linear_mode: Vec<f64>,
    /// First loss of stability on the path; `None` if there is none up to `reached`.
    pub exact: Option<CriticalPoint>,
    /// Largest load factor to which the path was followed.
    pub reached: f64,
    /// All loads have a potential. If not, `exact` is the first divergence (a zero of the tangent's
    /// determinant), and flutter, for which masses are needed, may come before.
    pub conservative: bool,
    /// Factor at which, without a potential, the symmetric part of the tangent turns indefinite. Below it nothing goes
    /// away, whatever the masses are (every small motion takes work on the straight path there). `None` with a
    /// potential (then `exact` says it), or if it stays definite up to `reached`.
    pub definite_until: Option<f64>,
}

impl CriticalLoad {
    /// Caution about a load without a potential; `None` for one that has a potential.
    #[must_use]
    pub fn caution(&self) -> Option<String> {
        if self.conservative {
            return None;
        }
        let safe = match self.definite_until {
            Some(factor) => {
                format!("up to the factor {factor:.6} nothing goes away, whatever the masses are")
            }
            None => format!("up to the factor {:.6} neither can happen", self.reached),
        };
        Some(format!(
            "the loads follow the chain and have no potential: the critical factor is that of divergence (the tangent's determinant is zero); flutter, a swing that grows, may come before it and depends on masses and damping, which are not asked for here; {safe}"
        ))
    }
}

/// Smallest positive factor of `pattern` at which the chain becomes unstable, on the path from the
/// problem's own equilibrium (its loads count, the pattern comes on top).
/// `settings.range.1` is the largest factor tried, infinity if need be.
///
/// # Errors
/// Wrong input, or no equilibrium at factor 0. A chain that is unstable at factor 0 has the
/// critical factor 0.
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
/// # let chain = Chain::builder("column") // two bars of 0.5 m on springs of 100 N m/rad
/// #     .actuator("foot", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .actuator("middle", hinge(100.0))
/// #     .translation(vector![0.5, 0.0, 0.0])
/// #     .build()?;
/// let push = Wrench::new(vector![-1.0, 0.0, 0.0], Vector3::zeros()); // N
/// let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
/// let pattern = continuation::LoadPattern::on_end(push);
/// let settings = CurveSettings::within(0.0, 1e4);
/// let of = equilibrium::StabilityOf::ShapeAndEnd;
/// let critical = critical_load_factor(&problem, &pattern, of, &settings)?;
/// // Two equal bars on equal springs buckle at k / a (3 - sqrt 5) / 2.
/// let known = 100.0 / 0.5 * (3.0 - 5.0_f64.sqrt()) / 2.0;
/// assert!((critical.linear.unwrap() / known - 1.0).abs() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
pub fn critical_load_factor(
    problem: &ChainProblem<'_>,
    pattern: &LoadPattern,
    of: StabilityOf,
    settings: &CurveSettings,
) -> Result<CriticalLoad> {
    settings.check(&problem.chain.place())?;
    let parameter = Parameter::Load(pattern.clone());
    let start = solve_chain(problem, &settings.solver)?;
    let mut system = ChainSystem::new(problem, Some(&parameter), &settings.solver)?;
    let z = system.start(&start.coordinates, &start.wrench, 0.0)?;
    let mut whole = problem.clone();
    whole.loads.extend(pattern.loads.iter().cloned());
    whole.end.wrench = Wrench(whole.end.wrench.0 + pattern.end.0);
    let conservative = is_conservative(problem) && is_conservative(&whole);
    let (linear, linear_mode) = linear_prediction(&mut system, &z, of, conservative);
    let mut settings = settings.clone();
    settings.branches = 1;
    settings.range.0 = settings.range.0.min(-1e-9);
    if settings.largest_change.is_none() {
        settings.largest_change = linear.map(|f| f / 6.0);
    }
    let mut load = GrowingLoad {
        problem,
        parameter: &parameter,
        of,
        settings: &settings,
        conservative,
        diverged_before: false,
        start,
        z,
        there: RefCell::new(ChainSystem::new(
            problem,
            Some(&parameter),
            &settings.solver,
        )?),
    };
    load.diverged_before = load.diverges_at_start()?;
    let unstable = |p: &CurvePoint| load.unstable(p);
    let curves = follow_until(
        problem,
        &parameter,
        &load.start,
        0.0,
        &settings,
        Some(&unstable),
    )?;
    let points = &curves.branches[0].points;
    let mut reached = points.iter().map(|p| p.parameter).fold(0.0, larger);
    let indefinite = |p: &CurvePoint| load.indefinite(p);
    let definite_until = match points.iter().position(indefinite) {
        _ if conservative => None,
        Some(0) => Some(0.0),
        Some(i) => Some(load.change(points, i, &indefinite)?.parameter),
        None => None,
    };
    let first = points.iter().position(unstable);
    let exact = first.map(|i| load.critical_point(&curves, i)).transpose()?;
    if let Some(exact) = &exact {
        reached = larger(reached, exact.factor);
    }
    Ok(CriticalLoad {
        linear,
        linear_mode,
        exact,
        reached,
        conservative,
        definite_until,
    })
}

/// A chain under a pattern of loads that grows from factor 0.
struct GrowingLoad<'p, 'a> {
    problem: &'p ChainProblem<'a>,
    parameter: &'p Parameter,
    of: StabilityOf,
    settings: &'p CurveSettings,
    conservative: bool,
    /// A motion goes away at factor 0 already.
    diverged_before: bool,
    start: Equilibrium,
    /// State at factor 0.
    z: DVector<f64>,
    /// System for tangents of points of the path, which are computed one after the other.
    there: RefCell<ChainSystem<'p, 'a>>,
}

impl GrowingLoad<'_, '_> {
    fn diverges_at_start(&self) -> Result<bool> {
        let mut there = self.there.borrow_mut();
        there.start(&self.start.coordinates, &self.start.wrench, 0.0)?;
        let (springs, loads) = Tangent::at(&mut there, &self.z, &self.z, self.of).at_start();
        Ok(largest_real(&springs, &loads).is_some_and(|mu| mu >= 1.0))
    }

    fn stability(&self, p: &CurvePoint) -> ShapeStability {
        match self.of {
            StabilityOf::Shape => p.equilibrium.stability.clone(),
            StabilityOf::ShapeAndEnd => p.dead_load.clone(),
        }
    }

    /// True if the symmetric part is indefinite; before that, the chain is stable whatever its masses.
    fn indefinite(&self, p: &CurvePoint) -> bool {
        let stability = self.stability(p);
        !stability.stable || stability.may_flutter()
    }

    fn unstable(&self, p: &CurvePoint) -> bool {
        let diverged = || {
            let mut there = self.there.borrow_mut();
            diverges(&Tangent::at(&mut there, &p.z, &self.z, self.of))
        };
        !self.stability(p).stable && (self.conservative || self.diverged_before || diverged())
    }

    /// Change of stability between a point and the one before it.
    fn change(
        &self,
        points: &[CurvePoint],
        i: usize,
        unstable: &dyn Fn(&CurvePoint) -> bool,
    ) -> Result<CurvePoint> {
        let solver = &self.settings.solver;
        let mut system = ChainSystem::new(self.problem, Some(self.parameter), solver)?;
        system.start(&self.start.coordinates, &self.start.wrench, 0.0)?;
        let mut tracer = Tracer::new(system, self.settings);
        Ok(tracer.stability_change(&points[i - 1], &points[i], unstable))
    }

    /// The critical mode at a point, its largest component 1.
    fn mode(&self, p: &CurvePoint) -> Vec<f64> {
        if self.conservative {
            return self.stability(p).mode;
        }
        let mut there = self.there.borrow_mut();
        let tangent = Tangent::at(&mut there, &p.z, &self.z, self.of);
        let mut motion = DVector::zeros(there.count() + 1);
        let first = there.reactions();
        if let Some(v) = tangent.mode() {
            motion.rows_mut(first, v.len()).copy_from(&v);
        }
        largest_one(&there.motion(&motion))
    }

    /// Point where stability is lost: before the first unstable point of the path.
    fn critical_point(&self, curves: &Curves<'_>, first: usize) -> Result<CriticalPoint> {
        let points = &curves.branches[0].points;
        if first == 0 {
            return Ok(CriticalPoint {
                factor: 0.0,
                kind: None,
                mode: self.mode(&points[0]),
                // The first point of a curve may lie a little beside its start, where a motion is free.
                equilibrium: Equilibrium {
                    conservative: self.conservative,
                    ..self.start.clone()
                },
            });
        }
        let special = curves.specials.iter().find(|s| {
            self.of == StabilityOf::ShapeAndEnd
                && s.kind != SpecialKind::DisplacementLimit
                && between(&points[first - 1], &s.point, &points[first])
        });
        if let Some(s) = special {
            return Ok(CriticalPoint {
                factor: s.point.parameter,
                kind: Some(s.kind),
                mode: s.mode.clone(),
                equilibrium: s.point.equilibrium.clone(),
            });
        }
        let p = self.change(points, first, &|p| self.unstable(p))?;
        Ok(CriticalPoint {
            factor: p.parameter,
            kind: None,
            mode: self.mode(&p),
            equilibrium: p.equilibrium,
        })
    }
}

/// True if a state lies on the step from `a` to `b`.
fn between(a: &CurvePoint, s: &CurvePoint, b: &CurvePoint) -> bool {
    let along = (&s.z - &a.z).dot(&a.tangent);
    let step = (&b.z - &a.z).dot(&a.tangent);
    along >= -1e-9 && along <= step + 1e-9
}

//! The report's own iteration [R 4.15-4.16] and the exact Newton iteration, bare: no step control,
//! no second start, every step kept. [`solve_chain`](crate::solve_chain) is what finds equilibria;
//! this is what shows how each iteration behaves.
//!
//! The report solves, with loads and Jacobians of the last step (`H = 0`),
//!
//! ```text
//! [0 J_q J_th; J_q^T 0 0; J_th^T 0 -K] [F; dq; dth] = [closure; -J_q,j^T G; K (th - th0) - J_th,j^T G]
//! ```
//!
//! which is 4.16 with the term `- J_th th0` that its print lacks (errata, 4.16). The wrench of the
//! last step does not matter to it. Near an equilibrium its error changes by the factor
//! `max |mu|` over the eigenvalues of `(N^T K N)^-1 N^T H N`, `N` the null space of `J`: it can only
//! converge on stable shapes, slows down as `1/(1 - mu)` towards buckling, and fails on stable shapes
//! with `mu < -1` (tension), where it ends in a cycle of two states.

use nalgebra::{DMatrix, DVector};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::{ChainProblem, check_numbers};
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::tracing::system::Row;
use crate::error::{Place, Result};
use crate::linalg::complement::complement;
use crate::linalg::saddle::{RANK_TOLERANCE, Saddle};
use crate::model::chain::Chain;
use crate::number::larger;
use crate::settings::{Settings, wrong};
use crate::spatial::{MotionKind, Wrench};

/// When an iteration ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct IterationSettings {
    /// Converged when no coordinate changes by more in one step, rad (slides: as a share of the
    /// chain's natural length). Default 1e-10.
    pub tolerance: f64,
    /// Steps at most. Default 500.
    pub steps: usize,
}

impl IterationSettings {
    /// Refuses what no iteration can end by, naming it.
    fn check(&self, place: &Place) -> Result<()> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            let required = "a number between 0 and 1";
            return Err(wrong(place, "tolerance", self.tolerance, required));
        }
        if self.steps == 0 {
            return Err(wrong(place, "steps", 0, "at least 1"));
        }
        Ok(())
    }
}

crate::settings::setters!(IterationSettings {
    with_tolerance: tolerance: f64,
    with_steps: steps: usize,
});

impl Default for IterationSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            steps: 500,
        }
    }
}

/// Coordinates (m, rad) and the wrench on the end (N, N m; about its origin, base axes).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct ChainState {
    /// Coordinates, m or rad, in the chain's order.
    pub coordinates: Vec<f64>,
    /// Wrench on the end, N and N m, about its origin, base axes.
    pub wrench: Wrench,
}

/// Outcome of an iteration.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum IterationOutcome {
    /// Converged to the equilibrium that exact Newton finds from the same start.
    #[cfg_attr(feature = "serde", serde(rename = "settled"))]
    Converged,
    /// Converged to another equilibrium than exact Newton from the same start.
    Leaves,
    /// Alternation between two states, neither of which is an equilibrium.
    Cycle([ChainState; 2]),
    /// The states grew beyond all bounds, or a linear system had no finite solution.
    Diverged,
    /// Maximum number of steps without any of these.
    Spent,
}

/// Every step of an iteration and what became of it.
#[derive(Clone, Debug)]
pub struct ReportIteration {
    /// Outcome.
    pub outcome: IterationOutcome,
    /// Steps made.
    pub steps: usize,
    /// The start and the state after every step.
    pub path: Vec<ChainState>,
    /// Factor by which the last steps shrank (or grew), per step: geometric mean over four steps
    /// that are well above rounding; `None` if there were too few.
    pub observed_rate: Option<f64>,
    /// `max |mu|` at the equilibrium to which this iteration came, or else at the one that exact
    /// Newton finds from the same start: above 1 the report's iteration cannot stay there. Zero for
    /// a chain without inner freedom, infinite where a load holds or pushes a purely passive motion;
    /// `None` where no equilibrium is known.
    pub expected_rate: Option<f64>,
    /// Largest `|mu|` at the equilibrium nearest to the start (found by exact Newton).
    pub rate_at_start: Option<f64>,
    /// The equilibrium to which the iteration came, refined to rounding.
    pub equilibrium: Option<Equilibrium>,
    /// The equilibrium that exact Newton finds from the same start.
    pub nearest: Option<Equilibrium>,
}

impl ReportIteration {
    /// One sentence for people.
    #[must_use]
    pub fn words(&self) -> String {
        let rate = |r: Option<f64>| r.map_or_else(|| "unknown".to_owned(), |r| format!("{r:.4}"));
        let (n, expected) = (self.steps, rate(self.expected_rate));
        match &self.outcome {
            IterationOutcome::Converged => format!(
                "converged in {n} steps; each step left {} of the error (expected {expected})",
                rate(self.observed_rate)
            ),
            IterationOutcome::Leaves => format!(
                "left the equilibrium nearest to the start, where each step multiplies the error by {}, and converged to another one after {n} steps (rate {}, expected {expected})",
                rate(self.rate_at_start),
                rate(self.observed_rate)
            ),
            IterationOutcome::Cycle(_) => format!(
                "alternates between two states (cycle of period 2 after {n} steps), neither of which is an equilibrium; at the equilibrium each step would multiply the error by {expected}"
            ),
            IterationOutcome::Diverged => {
                format!("diverged after {n} steps (expected rate {expected})")
            }
            IterationOutcome::Spent => {
                format!("came to no end in {n} steps (expected rate {expected})")
            }
        }
    }
}

/// Largest change of a coordinate, rad or share of the natural length.
fn change(chain: &Chain, a: &[f64], b: &[f64]) -> f64 {
    let length = chain.scale().length;
    let units = chain.coordinates().iter().map(|c| match c.kind {
        MotionKind::Revolute => 1.0,
        MotionKind::Prismatic => length,
    });
    a.iter()
        .zip(b)
        .zip(units)
        .fold(0.0, |most, ((a, b), unit)| {
            larger(most, (a - b).abs() / unit)
        })
}

/// The report's iteration [R 4.15, 4.16 with the erratum] from a start (`None`: the problem's
/// posture, no wrench).
///
/// # Errors
/// Wrong input. That the iteration fails is a result.
pub fn report_iteration(
    problem: &ChainProblem<'_>,
    start: Option<ChainState>,
    settings: &IterationSettings,
) -> Result<ReportIteration> {
    iterate(problem, start, settings, false)
}

/// Exact Newton, bare: the same system with the loads' Hessian.
///
/// # Errors
/// Wrong input. That the iteration fails is a result.
pub fn newton_iteration(
    problem: &ChainProblem<'_>,
    start: Option<ChainState>,
    settings: &IterationSettings,
) -> Result<ReportIteration> {
    iterate(problem, start, settings, true)
}

fn iterate(
    problem: &ChainProblem<'_>,
    start: Option<ChainState>,
    settings: &IterationSettings,
    exact: bool,
) -> Result<ReportIteration> {
    let chain = problem.chain;
    let mut system = ChainSystem::new(problem, None, &Settings::default())?;
    let start = start.unwrap_or_else(|| ChainState {
        coordinates: problem.posture.clone(),
        wrench: Wrench::zero(),
    });
    settings.check(&chain.place())?;
    chain.check(&start.coordinates, &problem.commands)?;
    check_numbers(problem, "the wrench of the start", &start.wrench.0)?;
    let mut z = system.state(&start.coordinates, &start.wrench, 0.0);
    let begin = z.clone();
    let mut path = vec![start];
    let mut sizes: Vec<f64> = Vec::new();
    let mut outcome = IterationOutcome::Spent;
    while path.len() <= settings.steps {
        let Some(step) = step(&mut system, &z, exact) else {
            outcome = IterationOutcome::Diverged;
            break;
        };
        sizes.push(step.norm());
        z += step;
        let state = ChainState {
            coordinates: system.coordinates(&z),
            wrench: system.wrench(&z),
        };
        let changed = |back: usize| {
            let earlier = path.len().checked_sub(back).and_then(|i| path.get(i));
            earlier.map_or(f64::INFINITY, |e| {
                change(chain, &state.coordinates, &e.coordinates)
            })
        };
        let (last, before) = (changed(1), changed(2));
        let far = state.coordinates.iter().any(|x| !x.is_finite()) || z.norm() > 1e9;
        path.push(state);
        if far {
            outcome = IterationOutcome::Diverged;
            break;
        }
        if last <= settings.tolerance && nearly_in_equilibrium(&mut system, &z, settings.tolerance)
        {
            outcome = IterationOutcome::Converged;
            break;
        }
        if before <= settings.tolerance && last > 1e3 * settings.tolerance.max(1e-12) {
            let two = [path[path.len() - 2].clone(), path[path.len() - 1].clone()];
            outcome = IterationOutcome::Cycle(two);
            break;
        }
    }
    let steps = path.len() - 1;
    let nearest = from_nearby(&mut system, &begin);
    let mut here = None;
    if outcome == IterationOutcome::Converged {
        here = refined(&mut system, &z);
        let other = match (&here, &nearest) {
            (Some((a, _)), Some((b, _))) => {
                change(chain, &a.coordinates, &b.coordinates) > 1e4 * settings.tolerance
            }
            _ => false,
        };
        if other {
            outcome = IterationOutcome::Leaves;
        }
    }
    let rate_at_start = nearest.as_ref().map(|(_, rate)| *rate);
    Ok(ReportIteration {
        outcome,
        steps,
        observed_rate: observed(&sizes),
        expected_rate: here.as_ref().map(|(_, rate)| *rate).or(rate_at_start),
        rate_at_start,
        equilibrium: here.map(|(e, _)| e),
        nearest: nearest.map(|(e, _)| e),
        path,
    })
}

/// One full step; `None` without a finite solution.
fn step(system: &mut ChainSystem<'_, '_>, z: &DVector<f64>, exact: bool) -> Option<DVector<f64>> {
    let (residual, _) = system.evaluate(z);
    let m = system.count();
    let matrix = if exact {
        system.matrix()
    } else {
        system.lagged_matrix()
    };
    if !matrix.iter().chain(residual.iter()).all(|x| x.is_finite()) {
        return None;
    }
    let ones = vec![1.0; m];
    let mut b = DMatrix::from_fn(m, 1, |i, _| -residual[i]);
    Saddle::new(matrix, &ones, &ones).solve(&mut b);
    let step = DVector::from_fn(m + 1, |i, _| if i < m { b[(i, 0)] } else { 0.0 });
    step.iter().all(|x| x.is_finite()).then_some(step)
}

/// Torques and closure are as small as a change of the coordinates by `tolerance` makes them: tells
/// an equilibrium from a place where the iteration merely stands still.
fn nearly_in_equilibrium(
    system: &mut ChainSystem<'_, '_>,
    z: &DVector<f64>,
    tolerance: f64,
) -> bool {
    let (_, norms) = system.evaluate(z);
    norms.closure <= 1e2 * tolerance.max(1e-14)
        && norms.torque <= 1e3 * tolerance.max(1e-14) * norms.loads.max(1e-9)
}

/// Exact Newton from a state, with what is known about the equilibrium and the rate there.
fn refined(system: &mut ChainSystem<'_, '_>, z: &DVector<f64>) -> Option<(Equilibrium, f64)> {
    let found = system.correct(z, &Row::Parameter(0.0), 30)?;
    system.evaluate(&found.z);
    let rate = rate_here(system);
    Some((system.equilibrium(&found), rate))
}

/// Newton from a start as it is; where that fails, from one step of the report's iteration (which
/// brings the wrench).
fn from_nearby(system: &mut ChainSystem<'_, '_>, z: &DVector<f64>) -> Option<(Equilibrium, f64)> {
    let lagged = step(system, z, false).map(|s| z + s);
    let with_wrench = lagged.as_ref().map(|l| {
        let mut start = z.clone();
        let r = system.reactions();
        start.rows_mut(0, r).copy_from(&l.rows(0, r));
        start
    });
    let starts = with_wrench.into_iter().chain(lagged);
    starts
        .chain(std::iter::once(z.clone()))
        .find_map(|start| refined(system, &start))
}

/// `max |mu|` over the eigenvalues of `(N^T K N)^-1 N^T H N` at the evaluated state.
fn rate_here(system: &ChainSystem<'_, '_>) -> f64 {
    let n = system.coordinates_count();
    let rows = system.reaction_rows();
    let r = rows.nrows();
    let neutral = system.neutral_motions();
    let held = neutral.as_ref().map_or(0, DMatrix::ncols);
    let mut taken = DMatrix::zeros(n, r + held);
    taken.columns_mut(0, r).copy_from(&rows.transpose());
    if let Some(v) = &neutral {
        taken.columns_mut(r, held).copy_from(v);
    }
    let null = complement(&crate::linalg::saddle::column_space(&taken));
    if null.ncols() == 0 {
        return 0.0;
    }
    let h = null.transpose() * system.load_hessian() * &null;
    let k = null.transpose() * system.spring_tangent() * &null;
    if !h.iter().chain(k.iter()).all(|x| x.is_finite()) {
        return f64::INFINITY;
    }
    let singular = crate::linalg::singular_values::SingularValues::of(&k);
    if singular.least() <= 1e2 * RANK_TOLERANCE * singular.largest() {
        return f64::INFINITY;
    }
    k.lu().solve(&h).map_or(f64::INFINITY, spectral_radius)
}

/// Largest absolute value of the (complex) eigenvalues, by Gelfand's formula
/// `lim |M^n|^(1/n)` with n doubled by squaring. nalgebra's Schur form is not used: at equal absolute
/// values (rotations, clusters) its iteration may never end.
fn spectral_radius(mut m: DMatrix<f64>) -> f64 {
    let mut logarithm = 0.0;
    let mut share = 1.0;
    for _ in 0..60 {
        let size = m.norm();
        if size == 0.0 {
            return 0.0;
        }
        if !size.is_finite() {
            return f64::INFINITY;
        }
        logarithm += share * size.ln();
        share *= 0.5;
        m.unscale_mut(size);
        m = &m * &m;
    }
    logarithm.exp()
}

/// Shrinking of the steps, from the last ones that rounding does not touch.
fn observed(sizes: &[f64]) -> Option<f64> {
    let most = sizes.iter().fold(0.0_f64, |m, s| larger(m, *s));
    let last = sizes.iter().rposition(|s| *s > 1e-8 * most)?;
    let span = last.min(4);
    if span == 0 {
        return None;
    }
    #[allow(clippy::cast_precision_loss)] // at most 4
    let rate = (sizes[last] / sizes[last - span]).powf(1.0 / span as f64);
    rate.is_finite().then_some(rate)
}

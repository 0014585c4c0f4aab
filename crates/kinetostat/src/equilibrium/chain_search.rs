//! The search of a chain's equilibria: Newton's iteration from a start, deflation, which two shapes are one.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::problem::{ChainProblem, Prescribed};
use crate::chain::scaling::step_limit;
use crate::chain::stability::ShapeStability;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::follow::follow;
use crate::continuation::settings::{CurveSettings, LoadPattern, Parameter};
use crate::continuation::tracing::describe::family_of;
use crate::continuation::tracing::system::{Corrected, wrapped};
use crate::equilibrium::chain_starts::{Bounds, around, spread, structured};
use crate::equilibrium::inner_motion::places_without_work;
use crate::equilibrium::search::{Entry, SearchOutcome, Searched};
use crate::error::Result;
use crate::linalg::saddle::{Saddle, pseudo_inverse};
use crate::linalg::singular_values::SingularValues;
use crate::model::chain::{Chain, Role};
use crate::settings::Settings;
use crate::spatial::{MotionKind, Twist};

/// Parameter that connects equilibria with each other: the distance of the end from the base where it is held, else all
/// loads together.
fn sweep_parameter(problem: &ChainProblem<'_>) -> Option<Parameter> {
    let end = &problem.end;
    let back = end.axes.inverse();
    let mut away = back * (end.pose.translation.vector - problem.base.translation.vector);
    for k in 0..3 {
        if end.prescribed[k] != Prescribed::Pose {
            away[k] = 0.0;
        }
    }
    if away.norm() > 1e-9 {
        let direction = end.axes * away.normalize();
        return Some(Parameter::Displacement(Twist::new(
            direction,
            Vector3::zeros(),
        )));
    }
    let mut wrench = end.wrench.rotated(&back);
    for k in 0..6 {
        if end.prescribed[k] == Prescribed::Pose {
            wrench.0[k] = 0.0;
        }
    }
    let pattern = LoadPattern {
        end: wrench.rotated(&end.axes),
        loads: problem.loads.clone(),
    };
    (pattern.end.0.amax() > 0.0 || !pattern.loads.is_empty()).then_some(Parameter::Load(pattern))
}

/// Full turns (rad) of passive joints, 0 elsewhere.
fn turns(chain: &Chain) -> Vec<f64> {
    let whole = |i: usize| {
        chain.elements().iter().all(|e| match e {
            crate::model::chain::Element::Motion(m) => m
                .coordinate
                .is_none_or(|d| d.index != i || d.ratio.abs() == 1.0),
            _ => true,
        })
    };
    chain
        .coordinates()
        .iter()
        .enumerate()
        .map(|(i, c)| {
            if c.role == Role::Passive && c.kind == MotionKind::Revolute && whole(i) {
                std::f64::consts::TAU
            } else {
                0.0
            }
        })
        .collect()
}

/// Share of the largest singular value below which the least one makes an equilibrium degenerate.
const SINGULAR: f64 = 1e-7;

/// Scaled coordinates of a locked shape are known to this: what closes within 1e-12 leaves the joints of a limb that is
/// stretched out within the root of that.
const LOCKED: f64 = 1e-5;

/// Relative difference of energies per relative residual: soft motions amplify it.
const LEFT_OPEN: f64 = 1e3;

/// An equilibrium that is known.
pub(crate) struct Known {
    z: DVector<f64>,
    pub equilibrium: Equilibrium,
    pub stable: bool,
    pub may_flutter: bool,
    /// Number of unstable modes under the conditions as prescribed.
    unstable: usize,
    /// Smallest singular value of the conditions' derivative, scaled.
    least: f64,
    /// Share of the loads that is not in equilibrium: of very stiff springs, what rounding allows.
    residual: f64,
}

impl Known {
    /// True at a limit or bifurcation point, or for one of a family of neutral equilibria.
    pub fn singular(&self) -> bool {
        self.least < SINGULAR
    }
}

/// An equilibrium in the form in which equilibria are compared.
pub(crate) struct Candidate {
    c: Corrected,
    /// Coordinates that take part in motions that change nothing.
    idle: Vec<bool>,
    energy: f64,
    residual: f64,
    stability: ShapeStability,
}

/// Search for the equilibria of a chain.
pub(crate) struct ChainSearch<'p, 'a, 'b> {
    system: ChainSystem<'p, 'a>,
    bounds: &'b Bounds,
    turns: Vec<f64>,
    /// Parameter of the curves, if they are followed.
    along: Option<Parameter>,
    /// The last start and its state.
    guessed: Option<(Vec<f64>, Option<DVector<f64>>)>,
}

impl<'p, 'a, 'b> ChainSearch<'p, 'a, 'b> {
    /// `curves`: they are followed through what is found.
    pub fn new(
        problem: &'p ChainProblem<'a>,
        bounds: &'b Bounds,
        solver: &Settings,
        curves: bool,
    ) -> Result<Self> {
        Ok(Self {
            system: ChainSystem::new(problem, None, solver)?,
            bounds,
            turns: turns(problem.chain),
            along: curves.then(|| sweep_parameter(problem)).flatten(),
            guessed: None,
        })
    }

    fn chain(&self) -> &'p Chain {
        self.system.problem.chain
    }

    /// The state of a start, calculated once.
    fn state_of(&mut self, x: &[f64]) -> Option<DVector<f64>> {
        if self.guessed.as_ref().is_none_or(|(last, _)| last != x) {
            let z = self.guess(x);
            self.guessed = Some((x.to_vec(), z));
        }
        self.guessed.as_ref().and_then(|(_, z)| z.clone())
    }

    /// Closes the chain from a start and estimates the reactions nearest to equilibrium.
    fn guess(&mut self, x: &[f64]) -> Option<DVector<f64>> {
        let (r, m) = (self.system.reactions(), self.system.count());
        let chain = self.system.problem.chain;
        let mut z = self.system.state(x, &self.system.problem.end.wrench, 0.0);
        for _ in 0..12 {
            let (residual, norms) = self.system.evaluate(&z);
            if r == 0 || norms.closure < 1e-3 {
                break;
            }
            let rows = self.system.matrix().view((0, r), (r, m - r)).into_owned();
            let step = pseudo_inverse(&rows).0 * residual.rows(0, r);
            let mut whole = DVector::zeros(m + 1);
            whole.rows_mut(r, m - r).copy_from(&(-step));
            let length = step_limit(chain, self.system.motion(&whole).into_iter());
            z = self.system.strained(&z, &z + whole * length);
        }
        // Reactions by least squares: torques are linear in them.
        let (residual, _) = self.system.evaluate(&z);
        if r > 0 {
            let columns = self.system.matrix().view((r, 0), (m - r, r)).into_owned();
            let a = pseudo_inverse(&columns).0 * residual.rows(r, m - r);
            let mut head = z.rows_mut(0, r);
            head -= a;
        }
        z.iter().all(|v| v.is_finite()).then_some(z)
    }

    /// Newton under step control; known equilibria repel if there are any.
    fn newton(
        &mut self,
        start: &DVector<f64>,
        repelled_by: Option<&[Entry<Known>]>,
    ) -> Option<Corrected> {
        let m = self.system.count();
        let chain = self.system.problem.chain;
        let ones = vec![1.0; m];
        let mut z = start.clone();
        let (mut residual, mut norms) = self.system.evaluate(&z);
        let mut small = false;
        for iteration in 0..self.system.settings.iterations.max(1) {
            if small && self.system.converged(&norms) {
                let mut matrix = DMatrix::zeros(m, m + 1);
                matrix.columns_mut(0, m).copy_from(&self.system.matrix());
                return Some(Corrected {
                    z,
                    matrix: self.system.whole(matrix),
                    norms,
                    iterations: iteration,
                });
            }
            let matrix = self.system.matrix();
            if !matrix.iter().chain(residual.iter()).all(|v| v.is_finite()) {
                return None;
            }
            let mut step = DMatrix::zeros(m, 1);
            step.column_mut(0).copy_from(&(-&residual));
            Saddle::new(matrix, &ones, &ones).solve(&mut step);
            let mut whole = DVector::zeros(m + 1);
            whole.rows_mut(0, m).copy_from(&step.column(0));
            if let Some(known) = repelled_by {
                // Newton on eta(z) G(z), eta = prod (1 + 1 / d^2): the same step, stretched.
                let slope = self.deflation_slope(known, &z, &whole);
                whole *= (1.0 / (1.0 - slope)).clamp(-20.0, 20.0);
            }
            if !whole.iter().all(|v| v.is_finite()) {
                return None;
            }
            let mut length = step_limit(chain, self.system.motion(&whole).into_iter());
            let merit = residual.norm();
            let mut best = (f64::INFINITY, length);
            let tries = if repelled_by.is_some() { 1 } else { 7 };
            for k in 0..tries {
                let trial = self.system.strained(&z, &z + &whole * length);
                let (after, _) = self.system.evaluate(&trial);
                let size = after.norm();
                if size < best.0 {
                    best = (size, length);
                }
                if size <= merit * (1.0 - 0.1 * length) || size < 1e-13 {
                    break;
                }
                if k + 1 < tries {
                    length *= 0.5;
                }
            }
            if !best.0.is_finite() {
                return None;
            }
            // If no length lowers it, the best one still leads out of a bad place.
            z = self.system.strained(&z, &z + &whole * best.1);
            (residual, norms) = self.system.evaluate(&z);
            small = whole.norm() * best.1 < 1e-7 * (1.0 + z.norm()) || norms.torque < 1e-14;
        }
        None
    }

    /// Derivative of the logarithm of the deflation along a step.
    fn deflation_slope(
        &self,
        known: &[Entry<Known>],
        z: &DVector<f64>,
        step: &DVector<f64>,
    ) -> f64 {
        let turns = self.scaled_turns();
        known
            .iter()
            .map(|k| {
                let d = wrapped(z, &k.known.z, &turns);
                let d2 = d.norm_squared().max(1e-12);
                let eta = 1.0 + 1.0 / d2;
                (-2.0 / (d2 * d2)) * d.dot(step) / eta
            })
            .sum()
    }

    /// Full turns of the unknowns.
    fn scaled_turns(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.system.count() + 1];
        for (i, turn) in self.turns.iter().enumerate() {
            all[self.system.reactions() + i] = turn / self.system.unit_of_coordinate(i);
        }
        all
    }

    /// Coordinates that take part in motions that change nothing. One that does so alone (an end
    /// hinge that nothing turns) goes back to the posture's value.
    fn idle(&self, z: &mut DVector<f64>) -> Vec<bool> {
        let n = self.system.coordinates_count();
        let Some(motions) = self.system.neutral_motions() else {
            return vec![false; n];
        };
        let posture = self.system.state(
            &self.system.problem.posture,
            &crate::spatial::Wrench::zero(),
            0.0,
        );
        let offset = self.system.reactions();
        (0..n)
            .map(|i| {
                let part = motions.row(i).norm();
                if part > 1.0 - 1e-9 {
                    z[offset + i] = posture[offset + i];
                }
                part > 1e-6
            })
            .collect()
    }

    /// Normalises: without full turns of passive joints, and with neutral ones where the posture has them.
    fn normalised(&mut self, mut c: Corrected) -> SearchOutcome<Candidate> {
        let offset = self.system.reactions();
        let turns = self.scaled_turns();
        // Full turns of passive joints out.
        let bounds = self.bounds.low.iter().zip(&self.bounds.high);
        let middle: Vec<f64> = bounds
            .map(|(l, h)| match (l + h).is_finite() {
                true => 0.5 * (l + h),
                false => 0.0,
            })
            .collect();
        let x = self.system.coordinates(&c.z);
        for (i, turn) in self.turns.iter().enumerate() {
            if *turn > 0.0 {
                let count = ((x[i] - middle[i]) / turn).round();
                c.z[offset + i] -= count * turns[offset + i];
            }
        }
        self.system.evaluate(&c.z);
        let mut rested = c.z.clone();
        let idle = self.idle(&mut rested);
        // A motion that changes nothing at first may change a lot further on.
        c.norms = self.system.evaluate(&rested).1;
        if self.system.converged(&c.norms) {
            c.z = rested;
        } else {
            c.norms = self.system.evaluate(&c.z).1;
        }
        if !self.bounds.hold(&self.system.coordinates(&c.z)) {
            return SearchOutcome::Outside;
        }
        SearchOutcome::Equilibrium(Candidate {
            energy: self.system.equations.energy,
            residual: c.norms.torque / c.norms.loads.max(f64::MIN_POSITIVE),
            stability: self.system.stability(&c, false),
            idle,
            c,
        })
    }

    /// Held in more directions than it can move in, a chain carries any force along the others: one shape.
    /// `d`: the difference of two states, without full turns.
    fn is_locked_as(&self, k: &Known, d: &DVector<f64>) -> bool {
        let coordinates = d.rows(self.system.reactions(), self.system.coordinates_count());
        k.least < SINGULAR && coordinates.norm() <= LOCKED
    }

    fn converged_to(&mut self, c: Option<Corrected>) -> SearchOutcome<Candidate> {
        c.map_or(SearchOutcome::Nothing, |c| self.normalised(c))
    }
}

impl Searched for ChainSearch<'_, '_, '_> {
    type Start = Vec<f64>;
    type Candidate = Candidate;
    type Known = Known;

    fn structured(&mut self) -> Vec<Vec<f64>> {
        structured(&self.system.problem.posture, self.chain())
    }

    fn suggested(&mut self, known: &Known) -> Vec<Vec<f64>> {
        let from = &known.equilibrium.coordinates;
        let more = around(&known.equilibrium, self.chain()).into_iter();
        let mut starts: Vec<_> = more
            .map(|x| self.system.strained_coordinates(from, x))
            .collect();
        let turns = self.scaled_turns();
        starts.extend(places_without_work(&mut self.system, &known.z, &turns));
        starts
    }

    fn spread(&mut self, from: usize, count: usize) -> Vec<Vec<f64>> {
        let home = self.chain().home_coordinates();
        (from + 1..=from + count)
            .map(|index| {
                let x = spread(&self.system, self.bounds, index);
                self.system.strained_coordinates(&home, x)
            })
            .collect()
    }

    /// Each start is repelled by what those before it found.
    fn side_by_side(&self) -> usize {
        1
    }

    fn patience(&self) -> usize {
        4
    }

    fn solve(&mut self, starts: &[Vec<f64>]) -> Vec<SearchOutcome<Candidate>> {
        let solved = starts.iter().map(|x| {
            let z = self.state_of(x);
            let c = z.and_then(|z| self.newton(&z, None));
            self.converged_to(c)
        });
        solved.collect()
    }

    fn deflated(&mut self, start: &Vec<f64>, known: &[Entry<Known>]) -> SearchOutcome<Candidate> {
        let z = self.state_of(start);
        let c = z.and_then(|z| self.newton(&z, Some(known)));
        self.converged_to(c)
    }

    fn same(&self, k: &Known, candidate: &Candidate) -> bool {
        let offset = self.system.reactions();
        let (energy, idle) = (candidate.energy, &candidate.idle);
        let near = if k.unstable == candidate.stability.unstable_modes || k.least < 1e-8 {
            (1e-8 / k.least.max(1e-12)).clamp(1e-6, 1e-2)
        } else {
            // A different number of unstable modes means a different shape, however near (the partner at a fold),
            // except where neither is known better.
            (1e-11 / k.least).clamp(1e-10, 1e-4)
        };
        let d = wrapped(&candidate.c.z, &k.z, &self.scaled_turns());
        let alike = (k.equilibrium.energy - energy).abs()
            <= (1e-8 + LEFT_OPEN * (k.residual + candidate.residual))
                * (energy.abs() + k.equilibrium.energy.abs())
                + 1e-14;
        // Members of a family that moves for nothing differ in the joints that move.
        let fixed = (0..d.len())
            .filter(|&i| i < offset || !idle.get(i - offset).is_some_and(|idle| *idle))
            .map(|i| d[i] * d[i])
            .sum::<f64>()
            .sqrt();
        let moves = idle.contains(&true) && fixed <= near;
        let degenerate = k.least < SINGULAR
            && d.rows(0, offset).norm() <= 1e-6 * (1.0 + k.z.rows(0, offset).norm());
        let member = alike && (moves || degenerate);
        d.norm() <= near || member || self.is_locked_as(k, &d)
    }

    /// A locked chain is listed with the least of the forces that it may carry.
    fn prefers(&self, candidate: &Candidate, k: &Known) -> bool {
        let offset = self.system.reactions();
        let reaction = |z: &DVector<f64>| z.rows(0, offset).norm();
        let d = wrapped(&candidate.c.z, &k.z, &self.scaled_turns());
        self.is_locked_as(k, &d) && reaction(&candidate.c.z) < 0.9 * reaction(&k.z)
    }

    fn described(&mut self, candidate: Candidate) -> Option<Known> {
        let Candidate {
            c,
            mut stability,
            residual,
            ..
        } = candidate;
        self.system.evaluate(&c.z);
        let square = self.system.matrix();
        let least = if square.is_empty() {
            1.0
        } else {
            let singular = SingularValues::of(&square);
            singular.least() / singular.largest().max(f64::MIN_POSITIVE)
        };
        // A motion that costs nothing is neither stable nor unstable, whatever rounding says.
        let mut equilibrium = None;
        if least < SINGULAR {
            let mut still = DVector::zeros(c.z.len());
            still[c.z.len() - 1] = 1.0;
            self.system.family = family_of(&mut self.system, &c.z, &still).map(Arc::new);
            if self.system.family.is_some() {
                stability = self.system.stability(&c, false);
                equilibrium = Some(self.system.equilibrium(&c));
                self.system.family = None;
            }
        }
        let unstable = stability.unstable_modes;
        let equilibrium = equilibrium.unwrap_or_else(|| self.system.equilibrium(&c));
        Some(Known {
            z: c.z,
            equilibrium,
            stable: stability.stable && unstable == 0,
            may_flutter: stability.may_flutter(),
            unstable,
            least,
            residual,
        })
    }

    fn curves_first(&self) -> bool {
        false
    }

    fn most_curves(&self) -> usize {
        match self.along {
            Some(_) => usize::MAX,
            None => 0,
        }
    }

    /// Equilibria where the curve through it returns to the problem's own conditions.
    fn connected(&mut self, from: Option<&Known>) -> Vec<SearchOutcome<Candidate>> {
        let (Some(parameter), Some(known)) = (self.along.clone(), from) else {
            return Vec::new();
        };
        let length = self.chain().scale().length;
        let mut settings = match parameter {
            Parameter::Displacement(_) => CurveSettings::within(-0.6 * length, 0.6 * length),
            Parameter::Load(_) => CurveSettings::within(-2.0, 2.0),
        };
        settings.points = 120;
        settings.solver = self.system.settings;
        let problem = self.system.problem;
        let curves = follow(problem, &parameter, &known.equilibrium, 0.0, &settings);
        let Ok(points) = curves.and_then(|c| c.at(0.0)) else {
            return Vec::new();
        };
        let solved = points.iter().map(|point| {
            let e = &point.equilibrium;
            let z = self.system.state(&e.coordinates, &e.wrench, 0.0);
            let c = self.newton(&z, None);
            self.converged_to(c)
        });
        solved.collect()
    }
}

//! All equilibria of a chain under one set of conditions, as far as they can be found.
//!
//! Newton on the conditions of equilibrium converges to stable and unstable shapes alike. It is
//! started from the posture, from every shape found (mirrored, pushed along its critical mode) and
//! from a sequence that fills the coordinates' bounds evenly; each start that ends where another
//! one ended is run once more with the known equilibria deflated. When a stated number of starts
//! was fruitless, the curve through every equilibrium is followed for others that it connects. The
//! result says how often each equilibrium was found and how likely another start is to find a new
//! one. It is deterministic.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3};
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::found_by::FoundBy;
use crate::chain::potential::load_energy;
use crate::chain::problem::{ChainProblem, Prescribed};
use crate::chain::scaling::step_limit;
use crate::continuation::chain_system::ChainSystem;
use crate::continuation::family_of::family_of;
use crate::continuation::follow::follow;
use crate::continuation::parameter::{LoadPattern, Parameter};
use crate::continuation::settings::CurveSettings;
use crate::continuation::state_distance::wrapped;
use crate::continuation::system::Corrected;
use crate::error::{Error, Result};
use crate::linalg::saddle::{Saddle, pseudo_inverse};
use crate::linalg::singular_values::SingularValues;
use crate::model::chain::{Chain, Role};
use crate::settings::Settings;
use crate::spatial::{MotionKind, Twist};

/// Limits of the coordinates within which equilibria count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Lowest value of every coordinate, m or rad.
    pub low: Vec<f64>,
    /// Highest value of every coordinate, m or rad.
    pub high: Vec<f64>,
}

impl Bounds {
    /// Rotations within plus and minus pi, passive slides within two natural lengths of the chain,
    /// springs that slide within half of one. The rotations of springs of six coordinates (pieces of
    /// elastic links) stay within plus and minus a quarter turn: three turns about x, y, z describe
    /// the same orientation as the turns by `a + pi`, `pi - b`, `c + pi`, so that farther out the
    /// same shape would count again.
    #[must_use]
    pub fn of(chain: &Chain) -> Self {
        let length = chain.scale().length;
        let mut high: Vec<f64> = chain
            .coordinates()
            .iter()
            .map(|c| match (c.kind, c.role) {
                (MotionKind::Revolute, _) => std::f64::consts::PI,
                (MotionKind::Prismatic, Role::Passive) => 2.0 * length,
                (MotionKind::Prismatic, Role::Spring) => 0.5 * length,
            })
            .collect();
        for block in chain.springs().iter().filter(|s| s.len() == 6) {
            for (high, c) in high
                .iter_mut()
                .zip(chain.coordinates())
                .skip(block.first)
                .take(6)
            {
                if c.kind == MotionKind::Revolute {
                    *high = high.min(std::f64::consts::FRAC_PI_2);
                }
            }
        }
        Self {
            low: high.iter().map(|x| -x).collect(),
            high,
        }
    }

    fn check(&self, chain: &Chain) -> Result<()> {
        let n = chain.coordinate_count();
        for (what, list) in [("lower bounds", &self.low), ("upper bounds", &self.high)] {
            if list.len() != n {
                return Err(Error::Size {
                    place: format!("chain '{}'", chain.name()),
                    what,
                    expected: n,
                    found: list.len(),
                });
            }
        }
        match (0..n)
            .find(|&i| self.low[i].partial_cmp(&self.high[i]) != Some(std::cmp::Ordering::Less))
        {
            Some(i) => Err(Error::model(
                format!("chain '{}'", chain.name()),
                format!(
                    "the bounds of '{}' are {} and {}: the first must be less than the second",
                    chain.coordinates()[i].name,
                    self.low[i],
                    self.high[i]
                ),
            )),
            None => Ok(()),
        }
    }

    /// Whether the springs among the coordinates stay within them.
    pub(crate) fn hold_springs(&self, chain: &Chain, x: &[f64]) -> bool {
        let springs = chain.springs().iter();
        let mut springs = springs.flat_map(|s| s.first..s.first + s.len());
        springs.all(|i| x[i] > self.low[i] && x[i] < self.high[i])
    }

    fn hold(&self, x: &[f64]) -> bool {
        x.iter()
            .enumerate()
            .all(|(i, x)| *x > self.low[i] - 1e-9 && *x < self.high[i] + 1e-9)
    }
}

/// How long to search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchSettings {
    /// The search stops after this many evenly spread starts in a row that found nothing new (four
    /// times as many while some equilibrium was hit only once). Default 400.
    pub fruitless: usize,
    /// Evenly spread starts at most. Default 5000.
    pub starts: usize,
    /// The search stops when this many equilibria are known. Default 100.
    pub most: usize,
    /// Follow the curve through every equilibrium for others that it connects. Default true.
    pub sweep: bool,
    /// Tolerances of each equilibrium; `iterations` bounds each start.
    pub solver: Settings,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            fruitless: 400,
            starts: 5000,
            most: 100,
            sweep: true,
            solver: Settings::default(),
        }
    }
}

/// One equilibrium among all.
#[derive(Clone, Debug)]
pub struct FoundEquilibrium {
    /// Coordinates (rotations of passive joints within the bounds), wrench, stiffness, shape.
    pub equilibrium: Equilibrium,
    /// Whether it holds under the conditions as prescribed: dead wrench where the wrench is
    /// prescribed, held where the pose is.
    pub stable: bool,
    /// Under loads without a potential it does not go away, but may swing with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// Potential energy of springs and loads, J, up to a constant of the problem; `None` where a
    /// load has none (see [`crate::model::loads::potential`]).
    pub potential: Option<f64>,
    /// How many evenly spread starts ended here; 0: found from another equilibrium only.
    pub hits: usize,
    /// True if the equilibrium is degenerate: at a limit or bifurcation point, or one of a family
    /// that moves for nothing.
    pub singular: bool,
}

/// All equilibria found, by rising potential energy (where a load has none: by the springs'
/// energy), and how sure it is that there are no more.
#[derive(Clone, Debug)]
pub struct Equilibria {
    /// By rising potential energy.
    pub found: Vec<FoundEquilibrium>,
    /// Evenly spread starts made.
    pub starts: usize,
    /// Evenly spread starts that ended at an equilibrium within the bounds.
    pub hits: usize,
    /// Evenly spread starts that ended at an equilibrium outside the bounds.
    pub outside: usize,
    /// Starts since the last new equilibrium.
    pub fruitless: usize,
    /// Good-Turing estimate of the chance that one more successful start finds something new: the
    /// share of successful starts whose equilibrium was found just once (never, by spread starts,
    /// counts too).
    pub chance_of_more: f64,
    /// Upper end of that chance (95 %; the rule of three where no equilibrium was found just once).
    pub chance_of_more_at_most: f64,
    /// True if the search ended because nothing new was found, not because starts ran out or the
    /// largest number was reached.
    pub settled: bool,
}

/// Finds all equilibria of a chain within bounds: prescribed pose, wrench or a mixture.
///
/// # Errors
/// Wrong input. That nothing was found is a result.
pub fn equilibria(
    problem: &ChainProblem<'_>,
    bounds: &Bounds,
    settings: &SearchSettings,
) -> Result<Equilibria> {
    bounds.check(problem.chain)?;
    let mut search = Search {
        system: ChainSystem::new(problem, None, &settings.solver)?,
        bounds,
        turns: turns(problem.chain),
        known: Vec::new(),
        outside: 0,
        starts: 0,
        since: 0,
    };
    let chain = problem.chain;
    let mut queue = structured(&problem.posture, chain);
    let (mut suggested, mut swept, mut index) = (0, 0, 0_usize);
    let sweep = settings.sweep.then(|| sweep_parameter(problem)).flatten();
    while search.known.len() < settings.most {
        // What every new equilibrium suggests.
        while suggested < search.known.len() {
            let from = search.known[suggested].equilibrium.coordinates.clone();
            let more = around(&search.known[suggested], chain).into_iter();
            queue.extend(more.map(|x| search.system.strained_coordinates(&from, x)));
            suggested += 1;
        }
        if let Some(x) = queue.pop() {
            search.start(&x, false);
        } else if !search.enough(settings) && search.starts < settings.starts {
            index += 1;
            let x = spread(&search, index);
            let home = chain.home_coordinates();
            let x = search.system.strained_coordinates(&home, x);
            search.start(&x, true);
        } else if let Some(parameter) = sweep.as_ref().filter(|_| swept < search.known.len()) {
            search.sweep(parameter, swept);
            swept += 1;
        } else {
            break;
        }
    }
    Ok(search.finish(settings))
}

/// What is varied to connect equilibria with each other: the distance of the end from the base
/// where it is held, else all loads together.
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

/// Chance that one more successful start finds something new, and its upper end (95 %): by how many
/// equilibria were found at most once in so many successful starts (Good and Turing; the rule of
/// three where there is none).
pub(crate) fn chance_of_more(hits: usize, once: usize) -> (f64, f64) {
    if hits == 0 {
        return (1.0, 1.0);
    }
    let (n, once) = (hits as f64, once as f64);
    let room = match once == 0.0 {
        true => 3.0,
        false => once + 1.96 * once.sqrt() + 2.0,
    };
    ((once / n).min(1.0), (room / n).min(1.0))
}

/// Starts that a person would try: the posture, home, their mirror images, the stretched chain.
fn structured(posture: &[f64], chain: &Chain) -> Vec<Vec<f64>> {
    let home = chain.home_coordinates();
    let mirrored = |x: &[f64]| x.iter().map(|v| -v).collect::<Vec<f64>>();
    let mut list = vec![mirrored(&home), home, mirrored(posture), posture.to_vec()];
    for size in [0.05, 0.5, -0.5] {
        list.push(crate::chain::scaling::nudged(chain, posture, size));
    }
    list
}

/// Starts suggested by an equilibrium: its mirror image, and both ways along its critical mode.
fn around(known: &Known, chain: &Chain) -> Vec<Vec<f64>> {
    let x = &known.equilibrium.coordinates;
    let mut list = vec![x.iter().map(|v| -v).collect::<Vec<f64>>()];
    let mode = &known.equilibrium.stability.mode;
    if mode.len() == x.len() {
        for size in [0.4, -0.4, 1.2, -1.2] {
            let along = x.iter().zip(mode).zip(chain.coordinates());
            list.push(
                along
                    .map(|((x, m), c)| match c.kind {
                        MotionKind::Revolute => x + size * m,
                        MotionKind::Prismatic => x + size * m * chain.scale().length,
                    })
                    .collect(),
            );
        }
    }
    list
}

/// Point `index` of an additive recurrence that fills the bounds evenly. Springs are spread over
/// what the natural energy can deflect, a third of it, and a tenth of it in turn; where some are very much
/// stiffer than others, what a turn by one radian of the softest one stores.
fn spread(search: &Search<'_, '_, '_>, index: usize) -> Vec<f64> {
    let chain = search.system.problem.chain;
    let n = chain.coordinate_count();
    // Root of g^(n+1) = g + 1: the most even recurrence in n dimensions.
    let mut g = 2.0_f64;
    for _ in 0..60 {
        g = (1.0 + g).powf(1.0 / (n as f64 + 1.0));
    }
    let share = [4.0, 1.5, 0.4][index % 3];
    let mut one = DVector::zeros(search.system.count() + 1);
    one.rows_mut(search.system.reactions(), n).fill(share);
    let mut reach = search.system.coordinates(&one);
    if spread_of_springs(chain, &reach) > UNEVEN {
        let rotations = chain.coordinates().iter().zip(&reach);
        let softest = rotations
            .filter(|(c, _)| c.role == Role::Spring && c.kind == MotionKind::Revolute)
            .fold(0.0_f64, |most, (_, x)| most.max(*x));
        if softest > share {
            reach.iter_mut().for_each(|x| *x *= share / softest);
        }
    }
    let mut weight = 1.0;
    (0..n)
        .map(|i| {
            weight /= g;
            let u = (0.5 + index as f64 * weight).fract();
            let c = &chain.coordinates()[i];
            let (mut low, mut high) = (search.bounds.low[i], search.bounds.high[i]);
            if c.role == Role::Spring {
                low = low.max(-reach[i]);
                high = high.min(reach[i]);
            }
            let wide = match c.kind {
                MotionKind::Revolute => std::f64::consts::PI,
                MotionKind::Prismatic => 2.0 * chain.scale().length,
            };
            (low, high) = (low.max(-wide.max(-high)), high.min(wide.max(low)));
            low + u * (high - low)
        })
        .collect()
}

/// Springs of which one is this many times as stiff as another are spread by the energy of the softest.
const UNEVEN: f64 = 1e4;

/// Stiffness of the stiffest spring over that of the softest, from deflections of equal energy.
fn spread_of_springs(chain: &Chain, reach: &[f64]) -> f64 {
    let length = chain.scale().length;
    let springs = chain.coordinates().iter().zip(reach);
    let springs = springs.filter(|(c, _)| c.role == Role::Spring);
    let moved = springs.map(|(c, x)| match c.kind {
        MotionKind::Prismatic => *x,
        MotionKind::Revolute => x * length,
    });
    let (least, most) = moved.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    (most / least).powi(2)
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

struct Known {
    z: DVector<f64>,
    equilibrium: Equilibrium,
    stable: bool,
    may_flutter: bool,
    /// Number of unstable modes under the conditions as prescribed.
    unstable: usize,
    hits: usize,
    /// Least singular value of the conditions' derivative, balanced.
    least: f64,
    /// Share of the loads that is not balanced: of very stiff springs, what rounding allows.
    residual: f64,
}

/// Share of the largest singular value below which the least one makes an equilibrium degenerate.
const SINGULAR: f64 = 1e-7;

/// Relative difference of energies per relative residual: soft motions amplify it.
const LEFT_OPEN: f64 = 1e3;

struct Search<'p, 'a, 'b> {
    system: ChainSystem<'p, 'a>,
    bounds: &'b Bounds,
    turns: Vec<f64>,
    known: Vec<Known>,
    outside: usize,
    starts: usize,
    since: usize,
}

impl Search<'_, '_, '_> {
    /// Nothing new for long enough; four times as long while some equilibrium was hit only once.
    fn enough(&self, settings: &SearchSettings) -> bool {
        let rare = self.known.iter().any(|k| k.hits <= 1);
        self.since >= settings.fruitless * if rare { 4 } else { 1 }
    }

    /// Follows the curve through a known equilibrium both ways and books every equilibrium where it
    /// comes back to the problem's own conditions.
    fn sweep(&mut self, parameter: &Parameter, index: usize) {
        let length = self.system.problem.chain.scale().length;
        let mut settings = match parameter {
            Parameter::Displacement(_) => CurveSettings::within(-0.6 * length, 0.6 * length),
            Parameter::Load(_) => CurveSettings::within(-2.0, 2.0),
        };
        settings.points = 120;
        settings.solver = self.system.settings;
        let start = self.known[index].equilibrium.clone();
        let curves = follow(self.system.problem, parameter, &start, 0.0, &settings);
        let Ok(points) = curves.and_then(|c| c.at(0.0)) else {
            return;
        };
        for point in points {
            let e = &point.equilibrium;
            let z = self.system.state(&e.coordinates, &e.wrench, 0.0);
            if let Some(c) = self.newton(&z, false) {
                self.note(c, false);
            }
        }
    }

    /// Newton from one start, and once more with deflation where it only found a known equilibrium.
    fn start(&mut self, x: &[f64], counted: bool) {
        if counted {
            self.starts += 1;
            self.since += 1;
        }
        let Some(z) = self.guess(x) else { return };
        let plain = self.newton(&z, false);
        let repeated = match plain {
            Some(c) => self.note(c, counted),
            None => false,
        };
        if repeated && let Some(c) = self.newton(&z, true) {
            self.note(c, false);
        }
    }

    /// Closes the chain from a start and estimates the reactions that balance it best.
    fn guess(&mut self, x: &[f64]) -> Option<DVector<f64>> {
        let (r, m) = (self.system.reactions(), self.system.count());
        let chain = self.system.problem.chain;
        let mut z = self.system.state(x, &self.system.problem.end.wrench, 0.0);
        for _ in 0..12 {
            let (lack, balance) = self.system.evaluate(&z);
            if r == 0 || balance.closure < 1e-3 {
                break;
            }
            let rows = self.system.matrix().view((0, r), (r, m - r)).into_owned();
            let step = pseudo_inverse(&rows).0 * lack.rows(0, r);
            let mut whole = DVector::zeros(m + 1);
            whole.rows_mut(r, m - r).copy_from(&(-step));
            let length = step_limit(chain, self.system.motion(&whole).into_iter());
            z = self.system.strained(&z, &z + whole * length);
        }
        // Reactions by least squares: torques are linear in them.
        let (lack, _) = self.system.evaluate(&z);
        if r > 0 {
            let columns = self.system.matrix().view((r, 0), (m - r, r)).into_owned();
            let a = pseudo_inverse(&columns).0 * lack.rows(r, m - r);
            let mut head = z.rows_mut(0, r);
            head -= a;
        }
        z.iter().all(|v| v.is_finite()).then_some(z)
    }

    /// Newton under step control; with `deflate` the known equilibria repel.
    fn newton(&mut self, start: &DVector<f64>, deflate: bool) -> Option<Corrected> {
        let m = self.system.count();
        let chain = self.system.problem.chain;
        let ones = vec![1.0; m];
        let mut z = start.clone();
        let (mut lack, mut balance) = self.system.evaluate(&z);
        let mut small = false;
        for iteration in 0..self.system.settings.iterations.max(1) {
            if small && self.system.converged(&balance) {
                let mut matrix = DMatrix::zeros(m, m + 1);
                matrix.columns_mut(0, m).copy_from(&self.system.matrix());
                return Some(Corrected {
                    z,
                    matrix: self.system.whole(matrix),
                    balance,
                    iterations: iteration,
                });
            }
            let matrix = self.system.matrix();
            if !matrix.iter().chain(lack.iter()).all(|v| v.is_finite()) {
                return None;
            }
            let mut step = DMatrix::zeros(m, 1);
            step.column_mut(0).copy_from(&(-&lack));
            Saddle::new(matrix, &ones, &ones).solve(&mut step);
            let mut whole = DVector::zeros(m + 1);
            whole.rows_mut(0, m).copy_from(&step.column(0));
            if deflate {
                // Newton on eta(z) G(z), eta = prod (1 + 1 / d^2): the same step, stretched.
                let slope = self.deflation_slope(&z, &whole);
                whole *= (1.0 / (1.0 - slope)).clamp(-20.0, 20.0);
            }
            if !whole.iter().all(|v| v.is_finite()) {
                return None;
            }
            let mut length = step_limit(chain, self.system.motion(&whole).into_iter());
            let merit = lack.norm();
            let mut best = (f64::INFINITY, length);
            let tries = if deflate { 1 } else { 7 };
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
            // Where no length lowers it, the best one still leads out of a bad place.
            z = self.system.strained(&z, &z + &whole * best.1);
            (lack, balance) = self.system.evaluate(&z);
            small = whole.norm() * best.1 < 1e-7 * (1.0 + z.norm()) || balance.torque < 1e-14;
        }
        None
    }

    /// Derivative of the logarithm of the deflation along a step.
    fn deflation_slope(&self, z: &DVector<f64>, step: &DVector<f64>) -> f64 {
        let turns = self.balanced_turns();
        self.known
            .iter()
            .map(|k| {
                let d = wrapped(z, &k.z, &turns);
                let d2 = d.norm_squared().max(1e-12);
                let eta = 1.0 + 1.0 / d2;
                (-2.0 / (d2 * d2)) * d.dot(step) / eta
            })
            .sum()
    }

    /// Full turns of the unknowns.
    fn balanced_turns(&self) -> Vec<f64> {
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

    /// Books an equilibrium; true if it was known.
    fn note(&mut self, mut c: Corrected, plain: bool) -> bool {
        let offset = self.system.reactions();
        let turns = self.balanced_turns();
        // Full turns of passive joints out.
        let middle: Vec<f64> = self
            .bounds
            .low
            .iter()
            .zip(&self.bounds.high)
            .map(|(l, h)| {
                if (l + h).is_finite() {
                    0.5 * (l + h)
                } else {
                    0.0
                }
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
        c.balance = self.system.evaluate(&rested).1;
        if self.system.converged(&c.balance) {
            c.z = rested;
        } else {
            c.balance = self.system.evaluate(&c.z).1;
        }
        let x = self.system.coordinates(&c.z);
        if !self.bounds.hold(&x) {
            self.outside += usize::from(plain);
            return false;
        }
        let energy = self.system.equations.energy;
        let residual = c.balance.torque / c.balance.loads.max(f64::MIN_POSITIVE);
        let stability = self.system.stability(&c, false);
        let unstable = stability.unstable_modes;
        for k in &mut self.known {
            let near = if k.unstable == unstable || k.least < 1e-8 {
                (1e-8 / k.least.max(1e-12)).clamp(1e-6, 1e-2)
            } else {
                // Another number of unstable modes is another shape, however near (the partner at a
                // fold), except where neither is known better.
                (1e-11 / k.least).clamp(1e-10, 1e-4)
            };
            let d = wrapped(&c.z, &k.z, &turns);
            let alike = (k.equilibrium.energy - energy).abs()
                <= (1e-8 + LEFT_OPEN * (k.residual + residual))
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
            if d.norm() <= near || member {
                k.hits += usize::from(plain);
                return true;
            }
        }
        let square = self.system.matrix();
        let least = if square.is_empty() {
            1.0
        } else {
            let singular = SingularValues::of(&square);
            singular.least() / singular.largest().max(f64::MIN_POSITIVE)
        };
        // A motion that costs nothing is neither stable nor unstable, whatever rounding says.
        let (mut stability, mut equilibrium) = (stability, None);
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
        self.known.push(Known {
            z: c.z,
            equilibrium,
            stable: stability.stable && unstable == 0,
            may_flutter: stability.may_flutter(),
            unstable,
            hits: usize::from(plain),
            least,
            residual,
        });
        self.since = 0;
        false
    }

    fn finish(self, settings: &SearchSettings) -> Equilibria {
        let problem = self.system.problem;
        let known = self.known.len();
        let hits: usize = self.known.iter().map(|k| k.hits).sum();
        let once = self.known.iter().filter(|k| k.hits <= 1).count();
        let (chance, most) = chance_of_more(hits, once);
        let mut found: Vec<FoundEquilibrium> = self
            .known
            .into_iter()
            .map(|k| FoundEquilibrium {
                potential: load_energy(problem, &k.equilibrium.coordinates)
                    .ok()
                    .flatten()
                    .map(|loads| k.equilibrium.energy + loads),
                stable: k.stable,
                may_flutter: k.may_flutter,
                hits: k.hits,
                singular: k.least < SINGULAR,
                equilibrium: Equilibrium {
                    found_by: FoundBy::OtherStart,
                    ..k.equilibrium
                },
            })
            .collect();
        let rank = |f: &FoundEquilibrium| f.potential.unwrap_or(f.equilibrium.energy);
        found.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
        Equilibria {
            found,
            starts: self.starts,
            hits,
            outside: self.outside,
            fruitless: self.since,
            chance_of_more: chance,
            chance_of_more_at_most: most,
            settled: self.since >= settings.fruitless && known < settings.most,
        }
    }
}

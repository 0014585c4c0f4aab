//! The lowest modes of a long chain, none of them missed.

use kinetostat::machine::MechanismState;
use kinetostat::number::larger;
use kinetostat::{MechanismEquilibrium, Posture, Wrench};
use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use crate::ends::Held;
use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::rotor::rotors_of;
use crate::modes::{DirectionCounts, Mode, Modes, kind_of, rigid_of};
use crate::swept::factor::Factor;
use crate::swept::long_chain::LongChain;
use crate::swept::stages::Stages;

impl LongChain {
    /// The `count` lowest modes, and all that are unstable or free; directions are counted as
    /// [`crate::LinearDynamics::modes`] counts them. `None` where a direction has neither mass nor stiffness, a massless one a
    /// negative stiffness, or the end is held and something has no mass: dense matrices tell more of these.
    ///
    /// # Errors
    /// [`Error::NoMass`].
    pub fn lowest_modes(&self, count: usize) -> Result<Option<Modes>> {
        let with_mass = self.stages.with_mass();
        if with_mass == 0 {
            return Err(Error::NoMass(self.name.clone()));
        }
        let held = self.held.directions.ncols();
        let motions = self.stages.count - held;
        if held > 0 && with_mass < self.stages.count {
            return Ok(None);
        }
        let with_mass = with_mass.min(motions);
        let Some(factor) = self.definite() else {
            return Ok(None);
        };
        let going = match factor.shift == 0.0 {
            true => 0,
            // Free ones are at zero: a little above it they are below.
            false => {
                Factor::new(&self.stages, &self.held, -1e-3 * factor.shift).map_or(0, |f| f.below)
            }
        };
        let wanted = count.max(going).min(with_mass);
        let Some(found) = self.found(&factor, wanted, with_mass) else {
            return Ok(None);
        };
        let mut modes: Vec<Mode> = found.into_iter().map(|r| self.mode(r, &factor)).collect();
        modes.sort_by(|a, b| a.squared.total_cmp(&b.squared));
        Ok(Some(Modes {
            counts: DirectionCounts {
                massless: motions - with_mass,
                rigid: self.rigid(),
                ..DirectionCounts::of(&modes, with_mass)
            },
            modes,
            neutral: Vec::new(),
        }))
    }

    /// A shift at which all is stable: none, or about the square of the first mode that is not free (of the
    /// largest that runs away), so that what is free does not drown the others.
    fn definite(&self) -> Option<Factor> {
        let factor = |shift: f64| Factor::new(&self.stages, &self.held, shift);
        let stable = |shift: f64| factor(shift).filter(|factor| factor.below == 0);
        if let Some(found) = stable(0.0) {
            return Some(found);
        }
        // Rayleigh quotient of some motion: energies of springs and of speed.
        let x = &self.units;
        let mass = self.stages.mass_times(x);
        let mass: f64 = mass.iter().zip(x).map(|(m, x)| m * x).sum();
        let size = self.stages.turnover(x) / mass;
        let steps = || (-12..8).map(|k| size * 30.0_f64.powi(k));
        let below = |shift: f64| factor(shift).map(|factor| factor.below);
        let least = steps().find_map(below)?;
        let first = steps().find(|s| below(*s).is_some_and(|below| below > least))?;
        steps().filter(|s| *s >= first).find_map(|s| stable(-s))
    }

    /// Modes until the wanted ones stand still and none below the last of them is missed.
    fn found(&self, factor: &Factor, wanted: usize, most: usize) -> Option<Vec<Ritz>> {
        let mut krylov = Krylov::new(&self.stages, factor);
        (0..BLOCK).for_each(|_| {
            krylov.start();
        });
        let mut next_look = wanted + BLOCK;
        loop {
            if !krylov.advance() && !krylov.start() {
                // All that has mass is spanned.
                return Some(krylov.lowest(wanted));
            }
            if krylov.done() == most {
                return Some(krylov.lowest(wanted));
            }
            if krylov.done() < next_look {
                continue;
            }
            if krylov.done() > LONGEST.max(8 * wanted) {
                return None;
            }
            next_look = krylov.done() + 4;
            let found = krylov.lowest(wanted + BLOCK);
            let settled =
                found.len() >= wanted && found[..wanted].iter().all(|r| r.residual < SETTLED);
            if !settled {
                continue;
            }
            match self.missed(factor, &found, wanted) {
                Some(0) => {
                    let mut found = found;
                    found.truncate(wanted);
                    return Some(found);
                }
                Some(missed) => (0..missed.min(BLOCK)).for_each(|_| {
                    krylov.start();
                }),
                None => return None,
            }
        }
    }

    /// Modes up to the last wanted one that are not among those found.
    fn missed(&self, factor: &Factor, found: &[Ritz], wanted: usize) -> Option<usize> {
        let last = found[..wanted]
            .iter()
            .map(|r| r.squared)
            .fold(f64::NEG_INFINITY, larger);
        let size = last.abs().max(factor.shift.abs());
        [1e-7, 3e-7, 1e-6, 1e-5].into_iter().find_map(|share| {
            let bound = last + share * size;
            let below = Factor::new(&self.stages, &self.held, bound)?.below;
            let known = found.iter().filter(|r| r.squared < bound).count();
            Some(below.saturating_sub(known))
        })
    }

    fn mode(&self, ritz: Ritz, factor: &Factor) -> Mode {
        let size = self.stages.turnover(&ritz.shape) + ritz.squared.abs();
        let (kind, squared) = kind_of(ritz.squared, size, -factor.shift);
        let scaled = ritz.shape.iter().zip(&self.units).map(|(x, u)| x / u);
        let largest = scaled.fold(0.0_f64, |m, x| if x.abs() > m.abs() { x } else { m });
        let sign = if largest < 0.0 { -1.0 } else { 1.0 };
        let shape = DVector::from_vec(ritz.shape) * sign;
        let tool: Vector6<f64> = self.tool * self.stages.tip(shape.as_slice());
        Mode {
            squared,
            kind,
            shape,
            tool,
        }
    }

    /// Motions that the tool cannot make.
    fn rigid(&self) -> usize {
        let unit = |k: usize| if k < 3 { 1.0 / self.length } else { 1.0 };
        let mut gram = Matrix6::zeros();
        for stage in &self.stages.stages {
            for (i, twist) in stage.twists.column_iter().enumerate() {
                let moved = self.tool * twist * self.units[stage.first + i];
                let moved = Vector6::from_fn(|k, _| moved[k] * unit(k));
                gram.ger(1.0, &moved, &moved, 1.0);
            }
        }
        let most = gram.diagonal().iter().copied().fold(0.0, larger);
        rigid_of(&gram, most) + self.held.directions.ncols()
    }
}

/// Starts at a time: modes may come in pairs, as those of a round bar do.
const BLOCK: usize = 3;

/// Residual from which on a mode stands still: its frequency is off by the square of it.
const SETTLED: f64 = 1e-7;

/// Vectors without an answer after which dense matrices take over.
const LONGEST: usize = 240;

/// Relative size of a vector's remainder that counts as rounding.
const EXHAUSTED: f64 = 1e-9;

/// Vectors orthonormal by mass, and the operator in them.
pub(crate) struct Krylov<'a> {
    chain: &'a Stages,
    factor: &'a Factor,
    vectors: Vec<Vector>,
    /// The operator of the first vectors, in all vectors that there were then.
    columns: Vec<Vec<f64>>,
    seed: u64,
}

struct Vector {
    x: Vec<f64>,
    /// `M x`.
    mass: Vec<f64>,
}

/// An approximate mode.
pub(crate) struct Ritz {
    /// `w^2`.
    pub squared: f64,
    /// Mass-normalised.
    pub shape: Vec<f64>,
    /// Residual as a share of the eigenvalue: the error of that is its square, by the gap to the next.
    pub residual: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<'a> Krylov<'a> {
    pub fn new(chain: &'a Stages, factor: &'a Factor) -> Self {
        Self {
            chain,
            factor,
            vectors: Vec::new(),
            columns: Vec::new(),
            seed: 1,
        }
    }

    /// Vectors that the operator has been applied to.
    pub fn done(&self) -> usize {
        self.columns.len()
    }

    /// A further start; false where there is none: all that has mass is spanned.
    pub fn start(&mut self) -> bool {
        // Numbers without a pattern, the same in every run.
        let force: Vec<f64> = (0..self.chain.count)
            .map(|_| {
                self.seed = self
                    .seed
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (self.seed >> 33) as f64 / (1u64 << 30) as f64 - 1.0
            })
            .collect();
        // Twice: what stays of the first force in directions without mass is none.
        let once = self.factor.solve(self.chain, &force);
        let x = self.factor.solve(self.chain, &self.chain.mass_times(&once));
        self.append(x, &mut Vec::new())
    }

    /// Applies the operator to the next vector; false where none is left.
    pub fn advance(&mut self) -> bool {
        let Some(next) = self.vectors.get(self.columns.len()) else {
            return false;
        };
        let x = self.factor.solve(self.chain, &next.mass);
        let mut column = Vec::new();
        self.append(x, &mut column);
        self.columns.push(column);
        true
    }

    /// Takes what of a vector is orthogonal to all others; its parts along them go into `column`.
    fn append(&mut self, mut x: Vec<f64>, column: &mut Vec<f64>) -> bool {
        let size = dot(&x, &self.chain.mass_times(&x)).max(0.0).sqrt();
        column.resize(self.vectors.len(), 0.0);
        for _ in 0..2 {
            for (own, part) in self.vectors.iter().zip(column.iter_mut()) {
                let share = dot(&x, &own.mass);
                *part += share;
                x.iter_mut().zip(&own.x).for_each(|(x, o)| *x -= share * o);
            }
        }
        let mut mass = self.chain.mass_times(&x);
        let left = dot(&x, &mass).max(0.0).sqrt();
        if left.is_nan() || left <= EXHAUSTED * size {
            return false;
        }
        x.iter_mut().chain(&mut mass).for_each(|v| *v /= left);
        column.push(left);
        self.vectors.push(Vector { x, mass });
        true
    }

    /// The lowest modes in what is spanned, at most so many.
    pub fn lowest(&self, count: usize) -> Vec<Ritz> {
        let m = self.columns.len();
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or(0.0);
        let reduced = DMatrix::from_fn(m, m, |i, j| match i <= j {
            true => entry(i, j),
            false => entry(j, i),
        });
        let eigen = reduced.symmetric_eigen();
        let mut order: Vec<usize> = (0..m).filter(|&i| eigen.eigenvalues[i] > 0.0).collect();
        order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
        order.truncate(count);
        let each = order.into_iter().map(|k| {
            let (value, y) = (eigen.eigenvalues[k], eigen.eigenvectors.column(k));
            let mut shape = DVector::zeros(self.chain.count);
            for (own, share) in self.vectors.iter().zip(y.iter()) {
                shape.axpy(*share, &DVector::from_column_slice(&own.x), 1.0);
            }
            let beyond = (m..self.vectors.len())
                .map(|i| (0..m).map(|j| entry(i, j) * y[j]).sum::<f64>().powi(2));
            Ritz {
                squared: 1.0 / value + self.factor.shift,
                residual: beyond.sum::<f64>().sqrt() / value,
                shape: shape.as_slice().to_vec(),
            }
        });
        each.collect()
    }
}

/// Chains of fewer coordinates are as fast with dense matrices.
const SWEPT_FROM: usize = 40;

/// The lowest modes of a machine about an equilibrium: along the chain where it is a long one, by dense matrices otherwise.
/// All unstable and free ones are among them.
///
/// # Errors
/// As [`LinearDynamics::of_machine`] and [`LinearDynamics::modes`].
pub fn lowest_modes(
    posture: &Posture,
    at: &MechanismEquilibrium,
    held: &Held,
    count: usize,
) -> Result<Modes> {
    lowest_modes_of_state(posture, &at.state, &at.wrench, held, count)
}

/// Finds modes like [`lowest_modes`], at a state in equilibrium under a wrench on the tool ([`Posture::rest_under`]).
///
/// # Errors
/// See [`lowest_modes`].
pub fn lowest_modes_of_state(
    posture: &Posture,
    state: &MechanismState,
    wrench: &Wrench,
    held: &Held,
    count: usize,
) -> Result<Modes> {
    let machine = posture.mechanism();
    let limbs = machine.limbs().iter();
    let long = limbs.map(|l| l.actual.coordinate_count()).sum::<usize>() >= SWEPT_FROM;
    // Rotors have coordinates beside the chain.
    if long
        && rotors_of(machine).is_empty()
        && let Some(chain) = LongChain::of_state(posture, state, held)?
        && let Some(modes) = chain.lowest_modes(count)?
    {
        return Ok(modes);
    }
    let mut modes = LinearDynamics::of_state(posture, state, wrench, held)?.modes()?;
    let going = modes.counts.unstable + modes.counts.free;
    modes.modes.truncate(count.max(going));
    Ok(modes)
}

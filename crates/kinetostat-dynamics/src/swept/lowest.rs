//! The lowest modes of a long chain or of a machine that is one, none of them missed.

use kinetostat::chain::ChainPieces;
use kinetostat::number::larger;
use kinetostat::spatial::{hat, shift_matrix};
use kinetostat::{ChainProblem, MechanismEquilibrium, MotionKind, Posture, Wrench};
use nalgebra::{DVector, Matrix6, Matrix6xX, Vector6};

use crate::ends::Held;
use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::mass::body;
use crate::modes::{DirectionCounts, Mode, Modes, kind_of, rigid_of};
use crate::swept::factor::{Factor, HeldEnd};
use crate::swept::krylov::{Krylov, Ritz};
use crate::swept::stages::{Stages, symmetric};

/// Chains of fewer coordinates are as fast with dense matrices.
const SWEPT_FROM: usize = 60;

/// A long chain about its equilibrium: modes at a cost that grows with the number of its coordinates and no faster.
///
/// It serves chains in which every joint and spring has coordinates of its own, and no load ties distant nodes
/// together; [`LinearDynamics`] serves all.
#[derive(Clone, Debug)]
pub struct LongChain {
    name: String,
    stages: Stages,
    held: HeldEnd,
    /// Motion of the tool by that of the tip.
    tool: Matrix6<f64>,
    /// Natural units of the coordinates, and the natural length, m.
    units: Vec<f64>,
    length: f64,
}

impl LongChain {
    /// As [`LinearDynamics::of_chain`]; `None` of a chain that it does not serve.
    ///
    /// # Errors
    /// As [`LinearDynamics::of_chain`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::vector;
    /// # use kinetostat::*;
    /// use kinetostat::model::LinkMass;
    /// use kinetostat_dynamics::{Held, LongChain};
    ///
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03); // Pa, m
    /// let spec = LinkSpec::beam(bar, 1.5).segments(64).with_mass(LinkMass::of_section(&bar, 7850.0));
    /// let boom = Chain::builder("boom").link_with("bar", &spec).build()?;
    /// let problem = ChainProblem::new(&boom, EndCondition::wrench(Wrench::zero()));
    /// let at = solve_chain(&problem, &Settings::default())?;
    /// let long = LongChain::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())?.ok_or("no such chain")?;
    /// let modes = long.lowest_modes(4)?.ok_or("not found")?;
    /// assert_eq!(modes.counts.vibrating, 384);
    /// let hertz = modes.frequencies_hz();
    /// assert!((hertz[0] / hertz[1] - 1.0).abs() < 1e-9, "a round bar bends alike in both planes");
    /// assert!((hertz[2] / hertz[0] - 6.2669).abs() < 0.02);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_chain(
        problem: &ChainProblem<'_>,
        coordinates: &[f64],
        wrench: &Wrench,
        held: &Held,
    ) -> Result<Option<Self>> {
        let pieces = ChainPieces::at(problem, coordinates, wrench)?;
        let chain = problem.chain;
        let Some(stages) = Stages::new(chain, &pieces)? else {
            return Ok(None);
        };
        let scale = chain.scale();
        let axes = held.axes.matrix();
        let mut end = HeldEnd {
            directions: Matrix6xX::zeros(0),
            stiffness: Vec::new(),
        };
        for k in (0..6).filter(|&k| held.directions[k]) {
            let part = 3 * (k / 3);
            let along = Vector6::from_fn(|i, _| match i / 3 == k / 3 {
                true => axes[(i - part, k % 3)],
                false => 0.0,
            });
            let at = end.directions.ncols();
            end.directions = end.directions.insert_column(at, 0.0);
            end.directions.set_column(at, &along);
            end.stiffness.push(match k < 3 {
                true => scale.stiffness,
                false => scale.stiffness * scale.length * scale.length,
            });
        }
        let units = chain.coordinates().iter().map(|c| match c.kind {
            MotionKind::Prismatic => scale.length,
            MotionKind::Revolute => 1.0,
        });
        Ok(Some(Self {
            name: chain.name().to_owned(),
            stages,
            held: end,
            tool: Matrix6::identity(),
            units: units.collect(),
            length: scale.length,
        }))
    }

    /// As [`LinearDynamics::of_machine`], of a machine that is one limb with a platform; `None` of one that it does not serve.
    ///
    /// # Errors
    /// As [`LinearDynamics::of_machine`].
    pub fn of_machine(
        posture: &Posture,
        at: &MechanismEquilibrium,
        held: &Held,
    ) -> Result<Option<Self>> {
        let machine = posture.mechanism();
        let [limb] = machine.limbs() else {
            return Ok(None);
        };
        if machine.platforms().len() != 2 || !machine.platform_loads().is_empty() {
            return Ok(None);
        }
        let problem = posture.limb_problem(0, &at.state)?;
        let wrench = at.state.wrenches[0];
        let coordinates = &at.state.coordinates[0];
        let Some(mut own) = Self::of_chain(&problem, coordinates, &wrench, held)? else {
            return Ok(None);
        };
        let platform = &machine.platforms()[limb.to];
        body::check(&platform.name, platform.mass, &platform.inertia)?;
        let pose = at.state.platforms[limb.to];
        let rotation = *pose.rotation.to_rotation_matrix().matrix();
        // From the platform's origin to the tip, and to its centre of mass.
        let arm = pose.rotation * limb.platform_from_tip.translation.vector;
        let centre = rotation * platform.centre_of_mass;
        let weight = machine.gravity() * platform.mass;
        let turned = hat(&weight) * hat(&centre) - hat(&wrench.force()) * hat(&arm);
        own.tool = shift_matrix(&-arm);
        let to_tip = own.tool;
        own.held.directions = to_tip.transpose() * &own.held.directions;
        let tip = own.stages.between.last_mut();
        if let Some(tip) = tip {
            let mut form = Matrix6::zeros();
            form.fixed_view_mut::<3, 3>(3, 3).copy_from(&turned);
            tip.loads += symmetric(&form);
            let (mass, inertia) = (platform.mass, &platform.inertia);
            tip.masses += body::about_point(mass, inertia, &rotation, &(centre - arm));
        }
        machine.name().clone_into(&mut own.name);
        own.length = machine.natural_length();
        Ok(Some(own))
    }

    /// The `count` lowest modes, and all that are unstable or free; directions are counted as
    /// [`LinearDynamics::modes`] counts them. `None` where a direction has neither mass nor stiffness, a massless one a
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
        // Of some motion: energies of springs and of speed.
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
    let limbs = posture.mechanism().limbs().iter();
    let long = limbs.map(|l| l.actual.coordinate_count()).sum::<usize>() >= SWEPT_FROM;
    if long && let Some(chain) = LongChain::of_machine(posture, at, held)? {
        if let Some(modes) = chain.lowest_modes(count)? {
            return Ok(modes);
        }
    }
    let mut modes = LinearDynamics::of_machine(posture, at, held)?.modes()?;
    let going = modes.counts.unstable + modes.counts.free;
    modes.modes.truncate(count.max(going));
    Ok(modes)
}

/// Starts at a time: modes may come in pairs, as those of a round bar do.
const BLOCK: usize = 3;

/// Residual from which on a mode stands still: its frequency is off by the square of it.
const SETTLED: f64 = 1e-7;

/// Vectors without an answer after which dense matrices take over.
const LONGEST: usize = 240;

//! An equilibrium of a machine, linearised with all its coordinates: what each part stores of a small deflection, and where the
//! equilibrium goes as the machine itself changes.
//!
//! The tangent of all equations is symmetric but for moments and loads without a potential. For a small load `f` on the tool, its motion
//! `u`, and any motion `v` that the machine can make, virtual work says
//!
//! ```text
//! v_tool . f = sum over springs  v_b^T K_b u_b                           elastic
//!            - sum over limbs    v^T H u                                 loads on limbs and at their ends, geometric
//!            + sum over platforms v^T (arms of the limbs' forces, weights, loads) u
//! ```
//!
//! exactly [R 4.15-4.16, 5.28 corrected]: with `v = u` the left side is the compliance in the direction of `f`.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use crate::chain::problem::{ChainProblem, EndCondition};
use crate::chain::residual::Residual;
use crate::chain::tangent::ChainTangent;
use crate::error::Result;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::posture::Posture;
use crate::machine::state::{MechanismState, check_state};
use crate::spatial::{Twist, Wrench, hat, moved, rotational};

/// An equilibrium whose tangents are known.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
/// let table = Chain::builder("table")
///     .actuator("long", slide(Vector3::x(), 8e7)) // N/m
///     .actuator("cross", slide(Vector3::y(), 2e7))
///     .build()?;
/// let table = Mechanism::serial(table, Pose::identity(), Vector3::zeros())?;
/// let posture = table.posture(&Pose::identity())?.as_drawn();
/// let mut tangent = posture.linearised_at_rest();
/// let diagonal = Wrench::new(vector![0.6, 0.8, 0.0], Vector3::zeros()); // N
/// let motion = tangent.under(&diagonal).ok_or("nothing moves it")?;
/// let work: Vec<f64> = tangent.work(&motion, &motion).iter().map(|term| term.work).collect();
/// assert!((work[0] - 0.36 / 8e7).abs() < 1e-20 && (work[1] - 0.64 / 2e7).abs() < 1e-20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct LinearisedMachine<'p> {
    solver: PlatformSolver<'p>,
}

/// A small motion of a machine near an equilibrium.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MachineMotion {
    /// Motions of every platform, the base included, about its origin, base axes, m and rad.
    pub platforms: Vec<Twist>,
    /// Motions of every coordinate of every limb, m or rad.
    pub coordinates: Vec<Vec<f64>>,
    /// Change of the wrench on every limb's tip, N and N m.
    pub wrenches: Vec<Wrench>,
}

/// Residual of an equilibrium, or its derivative by a parameter.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MachineResidual {
    /// Motions from the tip of every limb to where its platform wants it, m and rad.
    pub closures: Vec<Vector6<f64>>,
    /// Torque of the loads less that of the springs, by limb and coordinate, N or N m.
    pub torques: Vec<Vec<f64>>,
    /// Wrenches on every platform, the base included, about its origin, N and N m.
    pub platforms: Vec<Wrench>,
}

impl MachineResidual {
    /// `sum factor_k residual_k`; all are of machines of the same parts.
    #[must_use]
    pub fn combined(parts: &[(f64, &Self)]) -> Option<Self> {
        let (_, first) = parts.first()?;
        let mut sum = (*first).clone();
        sum.closures.iter_mut().for_each(|c| c.fill(0.0));
        sum.torques.iter_mut().for_each(|t| t.fill(0.0));
        sum.platforms.iter_mut().for_each(|w| w.0.fill(0.0));
        for (factor, part) in parts {
            for (own, other) in sum.closures.iter_mut().zip(&part.closures) {
                *own += other * *factor;
            }
            let torques = sum.torques.iter_mut().flatten();
            for (own, other) in torques.zip(part.torques.iter().flatten()) {
                *own += other * factor;
            }
            for (own, other) in sum.platforms.iter_mut().zip(&part.platforms) {
                own.0 += other.0 * *factor;
            }
        }
        Some(sum)
    }
}

/// Source of a work in [`LinearisedMachine::work`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum WorkOf {
    /// A spring of a limb: its material stiffness. Limb, and index among [`crate::Chain::springs`].
    Spring(usize, usize),
    /// Geometric stiffness of a spring (a link that bows), see [`crate::chain`]: limb, spring.
    SpringLoad(usize, usize),
    /// Loads on a limb, weights among them, and the force at its end, as its coordinates and its platform turn.
    LimbLoads(usize),
    /// A load between platforms, index among [`crate::Mechanism::platform_loads`]: a spring between two of them, say.
    PlatformLoad(usize),
    /// The weight of a platform whose arm turns.
    Weight(usize),
}

/// A part of a virtual work.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WorkTerm {
    /// Whose.
    pub of: WorkOf,
    /// J, for motions in m and rad.
    pub work: f64,
}

/// Tangents of a machine at a state with all coordinates of its limbs and all motions of its platforms kept.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MachineTangents {
    /// Tangents of every limb, as it is built; with six motions of its base where it starts at a platform that moves.
    pub limbs: Vec<ChainTangent>,
    /// Contribution of the arms of the limbs' forces, of weights and of loads on platforms, 6P x 6P (moving platforms,
    /// about their origins, base axes): `hat(f) hat(s)` and the like [R 5.28 corrected].
    pub platforms: DMatrix<f64>,
}

impl Posture {
    /// Tangents at a state with everything kept, and nothing solved: what dynamics starts from.
    ///
    /// # Errors
    /// A state of another machine.
    ///
    /// # Examples
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    /// let table = Chain::builder("table")
    ///     .actuator("long", slide(Vector3::x(), 8e7)) // N/m
    ///     .actuator("cross", slide(Vector3::y(), 2e7))
    ///     .build()?;
    /// let table = Mechanism::serial(table, Pose::identity(), Vector3::zeros())?;
    /// let posture = table.posture(&Pose::identity())?.as_drawn();
    /// let pushed = Wrench::new(vector![300.0, 0.0, 0.0], Vector3::zeros()); // N
    /// let equilibrium = posture.deflected_by(&pushed)?;
    /// let tangents = posture.tangents_at(&equilibrium.state, &pushed)?;
    /// // The slides' stiffness on the diagonal; no moving platform but the tool.
    /// let springs = &tangents.limbs[0].springs; // N/m
    /// assert_eq!((springs[(0, 0)], springs[(0, 1)], springs[(1, 1)]), (8e7, 0.0, 2e7));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn tangents_at(&self, state: &MechanismState, wrench: &Wrench) -> Result<MachineTangents> {
        check_state(&self.mechanism, state)?;
        let solver = self.evaluated(state.clone(), wrench, 1.0);
        let size = 6 * (state.platforms.len() - 1);
        let mut platforms = DMatrix::zeros(size, size);
        let mut add = |on: usize, by: usize, block: &Matrix6<f64>| {
            let mut view = platforms.view_mut((6 * (on - 1), 6 * (by - 1)), (6, 6));
            view += block;
        };
        for (i, limb) in self.mechanism.limbs().iter().enumerate() {
            add(limb.to, limb.to, &solver.turned_force(i, state));
        }
        solver.add_platform_loads(state, &mut add);
        let limbs = solver.linear.into_iter();
        Ok(MachineTangents {
            limbs: limbs
                .map(|linear| ChainTangent::of(linear.system))
                .collect(),
            platforms,
        })
    }

    /// One limb at a state by itself, its end free under the wrench that it has there: what acts on it between its ends is
    /// that of the machine.
    ///
    /// # Errors
    /// A state of another machine.
    ///
    /// # Examples
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    /// let table = Chain::builder("table")
    ///     .actuator("long", slide(Vector3::x(), 8e7)) // N/m
    ///     .actuator("cross", slide(Vector3::y(), 2e7))
    ///     .build()?;
    /// let table = Mechanism::serial(table, Pose::identity(), Vector3::zeros())?;
    /// let posture = table.posture(&Pose::identity())?.as_drawn();
    /// let pushed = Wrench::new(vector![300.0, 0.0, 0.0], Vector3::zeros()); // N
    /// let equilibrium = posture.deflected_by(&pushed)?;
    /// let alone = posture.limb_problem(0, &equilibrium.state)?;
    /// assert_eq!(alone.chain.coordinate_count(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn limb_problem(&self, limb: usize, state: &MechanismState) -> Result<ChainProblem<'_>> {
        check_state(&self.mechanism, state)?;
        let own = &self.mechanism.limbs()[limb];
        let joints = &self.limbs[limb];
        Ok(ChainProblem {
            chain: &own.actual,
            base: state.platforms[own.from],
            commands: joints.commands.clone(),
            posture: joints.coordinates.clone(),
            loads: self.mechanism.acting(limb),
            end: EndCondition::wrench(state.wrenches[limb]),
        })
    }

    /// Returns the posture of the machine as drawn: without weights and other loads of its model, without deviations.
    #[must_use]
    pub fn as_drawn(&self) -> Self {
        let mut drawn = self.clone();
        drawn.others.clear();
        drawn.mechanism = self.mechanism.without_own_loads();
        for limb in &mut drawn.mechanism.parts_mut().limbs {
            limb.actual = limb.nominal.clone();
        }
        drawn
    }

    /// Tangents at an equilibrium of this posture.
    ///
    /// ```
    /// # use kinetostat::nalgebra::Vector3;
    /// # use kinetostat::*;
    /// # let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e6); // N/m
    /// # let chain = Chain::builder("rail").actuator("trolley", slide).build()?;
    /// # let mut machine = Mechanism::builder("crane");
    /// # let tool = machine.platform(Platform::new("tool", Pose::identity()));
    /// # let machine = machine.limb(Limb::between("rail", 0, tool, chain)).build()?;
    /// # let posture = machine.posture(&Pose::identity())?;
    /// let wrench = Wrench::new(Vector3::x(), Vector3::zeros());
    /// let loaded = posture.deflected_by(&wrench)?;
    /// let tangent = posture.linearised(&loaded)?;
    /// let again = posture.linearised_state(&loaded.state, &loaded.wrench)?;
    /// // Nothing is missing for the equilibrium that was found.
    /// let missing = posture.residual_at(&loaded.state, &loaded.wrench)?;
    /// let same = posture.as_if_in_equilibrium(&loaded.state, &loaded.wrench)?;
    /// assert_eq!(same.state, loaded.state);
    /// # let _ = (tangent, again, missing);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// A state of another machine.
    pub fn linearised(&self, at: &MechanismEquilibrium) -> Result<LinearisedMachine<'_>> {
        self.linearised_state(&at.state, &at.wrench)
    }

    /// Linearises at a state that is known to be in equilibrium under a wrench on the tool.
    ///
    /// # Errors
    /// A state of another machine.
    pub fn linearised_state(
        &self,
        state: &MechanismState,
        wrench: &Wrench,
    ) -> Result<LinearisedMachine<'_>> {
        check_state(&self.mechanism, state)?;
        Ok(self.linearised_with(state.clone(), wrench, 1.0))
    }

    /// Tangents where all springs are at rest and nothing acts: those of the unloaded stiffness, of the machine as it is built
    /// (see [`Self::as_drawn`]).
    #[must_use]
    pub fn linearised_at_rest(&self) -> LinearisedMachine<'_> {
        self.linearised_with(self.rest_state(), &Wrench::zero(), 0.0)
    }

    fn linearised_with(
        &self,
        state: MechanismState,
        wrench: &Wrench,
        share: f64,
    ) -> LinearisedMachine<'_> {
        let mut solver = self.evaluated(state, wrench, share);
        solver.linearise_exactly();
        LinearisedMachine { solver }
    }

    /// Everything evaluated at a state, with dense matrices, platforms where the state says.
    fn evaluated(&self, state: MechanismState, wrench: &Wrench, share: f64) -> PlatformSolver<'_> {
        let mut solver = self.solver(state, Unknowns::Pose);
        solver.wrench = *wrench;
        solver.share = share;
        solver.leads = true;
        for linear in &mut solver.linear {
            linear.system.make_dense();
        }
        solver.evaluate();
        solver
    }

    /// Residual at a state, under a wrench on the tool: nothing is solved.
    ///
    /// # Errors
    /// A state of another machine.
    pub fn residual_at(&self, state: &MechanismState, wrench: &Wrench) -> Result<MachineResidual> {
        check_state(&self.mechanism, state)?;
        let mut solver = self.evaluated(state.clone(), wrench, 1.0);
        let (_, platforms) = solver.evaluate();
        let limbs = solver.linear.iter();
        Ok(MachineResidual {
            closures: limbs.clone().map(|l| l.closure.0).collect(),
            torques: limbs
                .map(|l| {
                    let n = l.system.spring_torque.len();
                    (0..n).map(|row| l.system.unbalanced(row)).collect()
                })
                .collect(),
            platforms,
        })
    }

    /// Stiffness and stability at a state as if it were in equilibrium: nothing is solved. A derivative along a path of
    /// equilibria needs them beside the path, to first order.
    ///
    /// # Errors
    /// A state of another machine; a tangent that is no number.
    pub fn as_if_in_equilibrium(
        &self,
        state: &MechanismState,
        wrench: &Wrench,
    ) -> Result<MechanismEquilibrium> {
        check_state(&self.mechanism, state)?;
        let mut solver = self.solver(state.clone(), Unknowns::Pose);
        solver.wrench = *wrench;
        let residual = Residual::default();
        conclude(&mut solver, residual)
    }
}

impl MechanismState {
    /// The state moved by a small motion.
    #[must_use]
    pub fn moved_by(&self, motion: &MachineMotion, factor: f64) -> Self {
        let mut next = self.clone();
        for (pose, twist) in next.platforms.iter_mut().zip(&motion.platforms) {
            *pose = moved(pose, &Twist(twist.0 * factor));
        }
        let own = next.coordinates.iter_mut().flatten();
        for (x, change) in own.zip(motion.coordinates.iter().flatten()) {
            *x += factor * change;
        }
        for (wrench, change) in next.wrenches.iter_mut().zip(&motion.wrenches) {
            wrench.0 += change.0 * factor;
        }
        next
    }
}

impl LinearisedMachine<'_> {
    /// Motion under a small wrench on the tool (N, N m), about its origin, base axes. `None` if the system has no
    /// finite solution. Free motions are not in it.
    #[must_use]
    pub fn under(&mut self, push: &Wrench) -> Option<MachineMotion> {
        let mut platforms = vec![Wrench::zero(); self.solver.state.platforms.len()];
        platforms[self.solver.mechanism.tool()] = *push;
        for linear in &mut self.solver.linear {
            linear.closure = Twist::zero();
            linear.solution.column_mut(0).fill(0.0);
        }
        self.step(&platforms)
    }

    /// Motion of the equilibrium that removes `residual`. With the derivative of the residual by a parameter at a fixed
    /// state it is the derivative of the equilibrium (implicit function theorem). `None` as for [`Self::under`].
    #[must_use]
    pub fn removing(&mut self, residual: &MachineResidual) -> Option<MachineMotion> {
        let own = residual.closures.iter().zip(&residual.torques);
        for (linear, (closure, torques)) in self.solver.linear.iter_mut().zip(own) {
            linear.closure = Twist(*closure);
            linear.system.spring_torque.fill(0.0);
            for (into, torque) in linear.system.torque.iter_mut().zip(torques) {
                *into = *torque;
            }
        }
        if !self.solver.renew_residuals() {
            return None;
        }
        self.step(&residual.platforms)
    }

    fn step(&self, unbalanced: &[Wrench]) -> Option<MachineMotion> {
        let solver = &self.solver;
        let step = solver.platform_step(unbalanced, &solver.state)?;
        let limbs = solver.limb_steps(&step, &solver.state);
        let mut platforms = vec![Twist::zero()];
        platforms.extend(step.motions);
        let coordinates = limbs
            .iter()
            .map(|l| l.rows(6, l.len() - 6).iter().copied().collect());
        let finite = limbs.iter().flat_map(|l| l.iter()).all(|x| x.is_finite());
        finite.then(|| MachineMotion {
            platforms,
            coordinates: coordinates.collect(),
            wrenches: (limbs.iter())
                .map(|l| Wrench(l.fixed_rows::<6>(0).into_owned()))
                .collect(),
        })
    }

    /// The virtual work of every part along `virtual_motion`, of the changes that `motion` makes: limb by limb its springs in the
    /// chain's order, then its loads; then what acts on platforms. The sum is the work of the tool's load along the virtual motion.
    #[must_use]
    pub fn work(&self, virtual_motion: &MachineMotion, motion: &MachineMotion) -> Vec<WorkTerm> {
        let mut terms = Vec::new();
        for limb in 0..self.solver.linear.len() {
            self.limb_work(limb, virtual_motion, motion, &mut terms);
        }
        self.platform_work(virtual_motion, motion, &mut terms);
        terms
    }

    fn limb_work(
        &self,
        i: usize,
        virtual_motion: &MachineMotion,
        motion: &MachineMotion,
        terms: &mut Vec<WorkTerm>,
    ) {
        let solver = &self.solver;
        let limb = &solver.mechanism.limbs()[i];
        let (v, u) = (&virtual_motion.coordinates[i], &motion.coordinates[i]);
        let mut torque = vec![0.0; u.len()];
        for (k, block) in limb.actual.springs().iter().enumerate() {
            let first = block.first;
            let mut all = 0.0;
            let mut geometric = Vec::new();
            let mut entry = |row: usize, column: usize, value: f64| {
                all += v[first + row] * value * u[first + column]
            };
            block.add(
                &solver.state.coordinates[i],
                &solver.posture[i].coordinates,
                solver.share,
                &mut torque,
                &mut entry,
                &mut geometric,
            );
            let own = |x: &[f64]| Vector6::from_fn(|j, _| x[first + j]);
            let added: f64 = geometric
                .iter()
                .map(|(_, matrix): &(usize, Matrix6<f64>)| own(v).dot(&(matrix * own(u))))
                .sum();
            terms.push(WorkTerm {
                of: WorkOf::Spring(i, k),
                work: all - added,
            });
            if !geometric.is_empty() {
                terms.push(WorkTerm {
                    of: WorkOf::SpringLoad(i, k),
                    work: added,
                });
            }
        }
        let system = &solver.linear[i].system;
        let velocities = |of: &MachineMotion| {
            let all = system.hessian.nrows();
            let mut y = DVector::zeros(all);
            for (into, x) in y.iter_mut().zip(&of.coordinates[i]) {
                *into = *x;
            }
            if limb.from != 0 {
                y.rows_mut(all - 6, 6).copy_from(&of.platforms[limb.from].0);
            }
            y
        };
        let hessian: &DMatrix<f64> = &system.hessian;
        let along = velocities(virtual_motion).dot(&(hessian * velocities(motion)));
        let turned = solver.turned_force(i, &solver.state);
        let (a, b) = (
            &virtual_motion.platforms[limb.to].0,
            &motion.platforms[limb.to].0,
        );
        terms.push(WorkTerm {
            of: WorkOf::LimbLoads(i),
            work: a.dot(&(turned * b)) - along,
        });
    }

    fn platform_work(
        &self,
        virtual_motion: &MachineMotion,
        motion: &MachineMotion,
        terms: &mut Vec<WorkTerm>,
    ) {
        let (solver, m) = (&self.solver, self.solver.mechanism);
        let (v, u) = (&virtual_motion.platforms, &motion.platforms);
        for (k, load) in m.platform_loads().iter().enumerate() {
            let mut tangents = Vec::new();
            load.tangents(&solver.state.platforms, &mut tangents);
            let tangents = tangents.iter().filter(|t| t.on > 0 && t.by > 0);
            let work = tangents.map(|t| v[t.on].0.dot(&(t.matrix * u[t.by].0)));
            terms.push(WorkTerm {
                of: WorkOf::PlatformLoad(k),
                work: -solver.share * work.sum::<f64>(),
            });
        }
        for (k, platform) in m.platforms().iter().enumerate().skip(1) {
            let weight = m.gravity() * (platform.mass * solver.share);
            let arm = solver.state.platforms[k].rotation * platform.centre_of_mass;
            let block = -rotational(&(hat(&weight) * hat(&arm)));
            let work = v[k].0.dot(&(block * u[k].0));
            if platform.mass != 0.0 {
                terms.push(WorkTerm {
                    of: WorkOf::Weight(k),
                    work,
                });
            }
        }
    }
}

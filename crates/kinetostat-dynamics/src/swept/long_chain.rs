//! A long chain, or a machine that is one, about its equilibrium.

use kinetostat::chain::ChainPieces;
use kinetostat::machine::MechanismState;
use kinetostat::spatial::{hat, shift_matrix};
use kinetostat::{ChainProblem, MechanismEquilibrium, MotionKind, Posture, Wrench};
use nalgebra::{Matrix6, Matrix6xX, Vector6};

use crate::ends::Held;
use crate::error::Result;
use crate::linear::rotor::rotors_of_chain;
use crate::mass::body;
use crate::swept::factor::HeldEnd;
use crate::swept::stages::{Stages, symmetric};

/// A long chain about its equilibrium: modes at a cost that grows with the number of its coordinates and no faster.
///
/// It serves chains in which every joint and spring has coordinates of its own, and no load ties distant nodes
/// together; [`crate::LinearDynamics`] serves all.
#[derive(Clone, Debug)]
pub struct LongChain {
    pub(crate) name: String,
    pub(crate) stages: Stages,
    pub(crate) held: HeldEnd,
    /// Motion of the tool by that of the tip.
    pub(crate) tool: Matrix6<f64>,
    /// Natural units of the coordinates, and the natural length, m.
    pub(crate) units: Vec<f64>,
    pub(crate) length: f64,
}

impl LongChain {
    /// Linearises like [`crate::LinearDynamics::of_chain`]; `None` for a chain that this method does not support.
    ///
    /// # Errors
    /// See [`crate::LinearDynamics::of_chain`].
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
        let stages = Stages::new(chain, &pieces)?;
        // Rotors of drives have coordinates beside the chain.
        let Some(stages) = stages.filter(|_| rotors_of_chain(chain, "").is_empty()) else {
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

    /// Linearises like [`crate::LinearDynamics::of_machine`] a machine of one limb with a platform; `None` for a
    /// machine that this method does not support.
    ///
    /// # Errors
    /// See [`crate::LinearDynamics::of_machine`].
    pub fn of_machine(
        posture: &Posture,
        at: &MechanismEquilibrium,
        held: &Held,
    ) -> Result<Option<Self>> {
        Self::of_state(posture, &at.state, held)
    }

    pub(crate) fn of_state(
        posture: &Posture,
        state: &MechanismState,
        held: &Held,
    ) -> Result<Option<Self>> {
        let machine = posture.mechanism();
        let [limb] = machine.limbs() else {
            return Ok(None);
        };
        if machine.platforms().len() != 2 || !machine.platform_loads().is_empty() {
            return Ok(None);
        }
        let problem = posture.limb_problem(0, state)?;
        let wrench = state.wrenches[0];
        let coordinates = &state.coordinates[0];
        let Some(mut own) = Self::of_chain(&problem, coordinates, &wrench, held)? else {
            return Ok(None);
        };
        let platform = &machine.platforms()[limb.to];
        body::check(&platform.name, platform.mass, &platform.inertia)?;
        let pose = state.platforms[limb.to];
        let rotation = *pose.rotation.to_rotation_matrix().matrix();
        // Arms from the platform's origin to the tip, and to its centre of mass.
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
}

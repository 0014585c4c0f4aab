//! Deflection of a machine under a load, `f^-1(F | t0)` [R 6.28-6.30].

use crate::error::Result;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::spatial::Wrench;

impl Posture {
    /// `f^-1(F | t0)`: where the tool goes under a dead wrench at its origin [R 6.28-6.30], with
    /// gravity, preloads and assembly errors of the model.
    ///
    /// # Errors
    /// [`Error::NotConverged`](crate::Error::NotConverged) with the last state and share of the load, and the limit point if
    /// one lies before it; [`Error::FreeDirection`](crate::Error::FreeDirection) where the load pushes on along a motion that
    /// nothing holds, as far as it can be followed.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let pull = Wrench::new(vector![0.0, 200.0, 0.0], Vector3::zeros()); // N, N m
    /// let loaded = arm.posture(&home)?.deflected_by(&pull)?;
    /// assert!(loaded.stable());
    /// let shift = 1e3 * loaded.displacement.linear().y; // mm
    /// assert!(shift > 0.0 && shift < 5.0);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn deflected_by(&self, wrench: &Wrench) -> Result<MechanismEquilibrium> {
        self.deflected_from(wrench, self.rest_state())
    }

    /// Deflects like [`Self::deflected_by`], starting from the state of a neighbouring equilibrium.
    ///
    /// # Errors
    /// See [`Self::deflected_by`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = arm.posture(&home)?;
    /// let pull = Wrench::new(vector![0.0, 200.0, 0.0], Vector3::zeros()); // N, N m
    /// let first = posture.deflected_by(&pull)?;
    /// let next = posture.deflected_from(&(1.1 * pull), first.state.clone())?;
    /// assert!(next.displacement.linear().y > first.displacement.linear().y);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn deflected_from(
        &self,
        wrench: &Wrench,
        start: MechanismState,
    ) -> Result<MechanismEquilibrium> {
        let (mut solver, residual) = self.converged_solver(wrench, start)?;
        let found = conclude(&mut solver, residual)?;
        Ok(self.by_growing_load(wrench, &found).unwrap_or(found))
    }

    /// Only where the platforms and limbs come to rest: [`Self::deflected_from`] without stiffness
    /// and stability, for fields of many points.
    ///
    /// # Errors
    /// As [`Self::deflected_by`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("gantry")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .build()?;
    /// # let home = Pose::translation(0.1, -0.2, 0.0);
    /// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// let posture = gantry.posture(&home)?;
    /// let mut state = posture.rest_state();
    /// for force in [100.0, 250.0, 400.0] {
    ///     let cutting = Wrench::new(vector![force, -0.5 * force, 0.0], Vector3::zeros()); // N
    ///     state = posture.rest_under(&cutting, state)?; // each from the one before
    ///     let gone = state.platforms[gantry.tool()].translation.vector - home.translation.vector;
    ///     assert!((gone - vector![force, -0.5 * force, 0.0] / 5e7).norm() < 1e-15, "the springs of its drives");
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn rest_under(&self, wrench: &Wrench, start: MechanismState) -> Result<MechanismState> {
        let (solver, residual) = self.converged_solver(wrench, start)?;
        self.stable_state(wrench, solver, residual)
    }
}

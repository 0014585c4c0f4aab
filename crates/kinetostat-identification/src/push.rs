//! Small pushes at a machine at rest, as drawn: what it does under a load, and under the unit wrench of a reading.

use kinetostat::machine::{LinearisedMachine, MachineMotion, MachineResidual, MechanismState};
use kinetostat::{Posture, Wrench};
use nalgebra::Vector3;

use crate::body::PlacedBody;
use crate::error::IdentificationError;
use crate::experiment::{Observation, Reading, ReadingOf, TestLoad};

/// A machine at rest that is pushed.
pub(crate) struct Push<'p> {
    observation: &'p Observation,
    posture: &'p Posture,
    tangent: LinearisedMachine<'p>,
    rest: MechanismState,
    zero: MachineResidual,
}

impl<'p> Push<'p> {
    /// The posture of an observation, as drawn.
    pub fn at_rest(
        posture: &'p Posture,
        observation: &'p Observation,
    ) -> Result<Self, IdentificationError> {
        let rest = posture.rest_state();
        Ok(Self {
            observation,
            posture,
            tangent: posture.linearised_at_rest(),
            zero: no_residual(posture, &rest).map_err(|reason| observation.refused(reason))?,
            rest,
        })
    }

    /// Motion of the machine under a wrench on a body, about its origin.
    pub fn by(
        &mut self,
        body: &PlacedBody,
        wrench: &Wrench,
    ) -> Result<MachineMotion, IdentificationError> {
        let motion = body.motion_under(wrench, &mut self.tangent, &self.zero);
        motion.ok_or_else(|| self.observation.free())
    }

    /// Motion of the machine under a load.
    pub fn by_load(&mut self, load: &TestLoad) -> Result<MachineMotion, IdentificationError> {
        let body = PlacedBody::of(load.at.on, self.posture, &self.rest);
        let arm = body.pose.rotation * load.arm_to(load.at.on, load.at.at);
        let wrench = Wrench::new(load.force, load.moment + arm.cross(&load.force));
        self.by(&body, &wrench)
    }

    /// The body of a reading, and the unit wrench on it whose work is the reading.
    pub fn unit(&self, reading: &Reading) -> (PlacedBody, Wrench) {
        let marker = &reading.marker;
        let body = PlacedBody::of(marker.on, self.posture, &self.rest);
        let arm = body.pose.rotation * self.observation.load.arm_to(marker.on, marker.at);
        let wrench = match reading.of {
            ReadingOf::Along(n) | ReadingOf::Place(n) => Wrench::new(n, arm.cross(&n)),
            ReadingOf::About(n) => Wrench::new(Vector3::zeros(), n),
        };
        (body, wrench)
    }
}

/// A residual of nothing.
pub(crate) fn no_residual(
    posture: &Posture,
    at: &MechanismState,
) -> kinetostat::Result<MachineResidual> {
    let own = posture.residual_at(at, &Wrench::zero())?;
    Ok(MachineResidual::combined(&[(0.0, &own)]).unwrap_or(own))
}

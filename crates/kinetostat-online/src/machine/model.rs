//! What never changes of a machine: its limbs, the body that carries the tool, and the directions that are corrected.

use kinetostat::model::PlatformLoad;
use kinetostat::spatial::{Pose, Twist};
use kinetostat::{Directions, Mechanism};
use nalgebra::{Vector3, Vector6};

use crate::machine::limb::LimbPlan;

/// What never changes of a machine.
#[derive(Clone, Debug)]
pub(crate) struct MachinePlan {
    pub name: String,
    pub limbs: Vec<LimbPlan>,
    /// One limb without passive joints.
    pub is_serial: bool,
    pub joints: usize,
    pub home: Pose,
    /// Index of the platform that carries the tool.
    pub tool: usize,
    pub weight: Vector3<f64>,
    pub centre_of_mass: Vector3<f64>,
    pub loads: Vec<PlatformLoad>,
    /// Directions in which the tool is held where the program has it.
    pub directions: Directions,
    /// Natural length, m.
    pub length: f64,
}

impl MachinePlan {
    /// For a mechanism that is supported, see [`crate::machine::supported`].
    pub(crate) fn new(mechanism: &Mechanism, directions: Directions) -> Self {
        let (mut limbs, mut joints) = (Vec::new(), 0);
        for index in 0..mechanism.limbs().len() {
            let limb = LimbPlan::new(mechanism, index, joints);
            joints = limb.joints.end;
            limbs.push(limb);
        }
        let platform = &mechanism.platforms()[mechanism.tool()];
        Self {
            name: mechanism.name().to_owned(),
            is_serial: limbs.len() == 1 && limbs[0].passive.is_empty(),
            limbs,
            joints,
            home: platform.home,
            tool: mechanism.tool(),
            weight: mechanism.gravity() * platform.mass,
            centre_of_mass: platform.centre_of_mass,
            loads: mechanism.platform_loads().to_vec(),
            directions,
            length: mechanism.natural_length(),
        }
    }

    /// The part of a twist along the corrected directions, and the part along the others.
    pub(crate) fn split(&self, twist: &Twist) -> (Twist, Twist) {
        let kept = Twist(Vector6::from_fn(|k, _| {
            if self.directions[k] { twist.0[k] } else { 0.0 }
        }));
        (kept, *twist - kept)
    }
}

//! Constant part of a machine: its limbs, the body that carries the tool, and the directions that are corrected.

use std::ops::Range;

use kinetostat::model::{Load, PlatformLoad, Role};
use kinetostat::spatial::{Pose, Twist};
use kinetostat::{Chain, Directions, Mechanism};
use nalgebra::{Vector3, Vector6};

/// Passive joints of a limb at most; more are redundant.
pub(crate) const MOST_PASSIVE: usize = 6;

/// A limb from the base to the tool.
#[derive(Clone, Debug)]
pub(crate) struct LimbPlan {
    pub nominal: Chain,
    pub actual: Chain,
    pub loads: Vec<Load>,
    pub base: Pose,
    pub platform_from_tip: Pose,
    /// Coordinates that are passive joints.
    pub passive: Vec<usize>,
    /// Range of its actuators among the joints of the machine.
    pub joints: Range<usize>,
    /// Natural length (m, of the machine) and stiffness (N/m).
    pub length: f64,
    pub stiffness: f64,
}

impl LimbPlan {
    fn new(mechanism: &Mechanism, index: usize, first_joint: usize) -> Self {
        let limb = &mechanism.limbs()[index];
        let gravity = mechanism.gravity();
        let weight = (gravity != Vector3::zeros()).then(|| Load::gravity(gravity));
        let loads = mechanism.loads(index).iter().cloned();
        Self {
            nominal: limb.nominal.clone(),
            actual: limb.actual.clone(),
            loads: weight.into_iter().chain(loads).collect(),
            base: mechanism.platforms()[limb.from].home,
            platform_from_tip: limb.platform_from_tip,
            passive: limb.actual.indices_of(Role::Passive),
            joints: first_joint..first_joint + limb.nominal.actuators().len(),
            length: mechanism.natural_length(),
            stiffness: limb.actual.scale().stiffness,
        }
    }

    /// A twist with its rotation at the natural length.
    pub(crate) fn in_length(&self, twist: Vector6<f64>) -> Vector6<f64> {
        Vector6::from_fn(|k, _| twist[k] * if k < 3 { 1.0 } else { self.length })
    }
}

/// A machine of one moving platform.
#[derive(Clone, Debug)]
pub(crate) struct MachinePlan {
    pub name: String,
    pub limbs: Vec<LimbPlan>,
    /// One limb without passive joints.
    pub is_serial: bool,
    /// Number of joints.
    pub joints: usize,
    pub home: Pose,
    /// Index of the platform that carries the tool.
    pub tool: usize,
    /// Weight of that platform, N, and its centre of mass.
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
        let kept = |k: usize| if self.directions[k] { twist.0[k] } else { 0.0 };
        let kept = Twist(Vector6::from_fn(|k, _| kept(k)));
        (kept, *twist - kept)
    }
}

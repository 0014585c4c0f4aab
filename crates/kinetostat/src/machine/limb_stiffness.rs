//! Stiffness of every limb as it is summed up at its platform, with the motions of its joints and springs [R 4.25, 6.5, 6.8].
//!
//! ```text
//! dq_i = K_Cq T_i dt,   dtheta_i = K_Ctheta T_i dt,   T_i = [I, -hat(s_i); 0, I]
//! K    = sum (T_i^T K_C T_i + blkdiag(0, hat(f_i) hat(s_i)))
//! ```

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::stiffness::ChainStiffness;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::posture::Posture;
use crate::machine::stiffness::UnloadedStiffness;
use crate::model::chain::{Chain, Role};
use crate::model::mechanism::{Limb, Mechanism};
use crate::spatial::{Pose, Wrench, hat};

/// Motion of a passive joint or spring per motion of its limb's end.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JointSensitivity {
    /// Name of the coordinate in its chain.
    pub name: String,
    /// A row of `K_Cq` or `K_Ctheta`: rad or m per m (three) and per rad (three).
    pub per_motion_of_end: [f64; 6],
}

/// Tangent stiffness of a limb at its end, base axes.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LimbStiffness {
    /// Name of the limb.
    pub name: String,
    /// Platform at its end.
    pub platform: String,
    /// Arm from the platform's reference point to the limb's end, m: the `s_i` of `T_i`.
    pub arm_m: [f64; 3],
    /// `K_C`, NaN along axes that the limb cannot move along.
    #[cfg_attr(feature = "schema", schemars(with = "[[Option<f64>; 6]; 6]"))]
    pub stiffness_n_m_rad: [[f64; 6]; 6],
    /// `K_Cq` of the passive joints.
    pub passive_joints: Vec<JointSensitivity>,
    /// `K_Ctheta` of the springs, those of the drives among them.
    pub springs: Vec<JointSensitivity>,
    /// `hat(f_i) hat(s_i)`, N m/rad: the lever that turns with the platform under the limb's force; zero without a load.
    pub lever_n_m_per_rad: [[f64; 3]; 3],
}

impl LimbStiffness {
    fn of(
        mechanism: &Mechanism,
        limb: &Limb,
        chain: &Chain,
        stiffness: &ChainStiffness,
        place: &Pose,
        wrench: &Wrench,
    ) -> Self {
        let arm = place.rotation * limb.platform_from_tip.translation.vector;
        let rows = |role, matrix: &nalgebra::DMatrix<f64>| {
            let own = chain.indices_of(role).into_iter().enumerate();
            own.map(|(k, index)| JointSensitivity {
                name: chain.coordinates()[index].name.clone(),
                per_motion_of_end: std::array::from_fn(|j| matrix[(k, j)]),
            })
            .collect()
        };
        let k = stiffness.cartesian.finite_entries(&stiffness.directions);
        let lever = hat(&wrench.force()) * hat(&arm);
        Self {
            name: limb.name.clone(),
            platform: mechanism.platforms()[limb.to].name.clone(),
            arm_m: arm.into(),
            stiffness_n_m_rad: std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)])),
            passive_joints: rows(Role::Passive, &stiffness.passive),
            springs: rows(Role::Spring, &stiffness.springs),
            lever_n_m_per_rad: std::array::from_fn(|i| std::array::from_fn(|j| lever[(i, j)])),
        }
    }
}

impl UnloadedStiffness {
    /// Stiffness of every limb of the posture that this is the stiffness of.
    #[must_use]
    pub fn limb_stiffnesses(&self, posture: &Posture) -> Vec<LimbStiffness> {
        let m = posture.mechanism();
        let own = m.limbs().iter().zip(&self.limbs);
        own.map(|(limb, k)| {
            let (place, none) = (&posture.platforms()[limb.to], Wrench::zero());
            LimbStiffness::of(m, limb, &limb.nominal, k, place, &none)
        })
        .collect()
    }
}

impl MechanismEquilibrium {
    /// Tangent stiffness of every limb of the machine that this is an equilibrium of.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    /// # let chain = Chain::builder("table").actuator("x", slide(Vector3::x(), 8e7)).actuator("y", slide(Vector3::y(), 2e7)).build()?;
    /// # let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
    /// let load = Wrench::new(vector![100.0, 0.0, 0.0], Vector3::zeros()); // N
    /// let loaded = table.posture(&Pose::identity())?.deflected_by(&load)?;
    /// let limb = &loaded.limb_stiffnesses(&table)[0];
    /// assert!((limb.stiffness_n_m_rad[1][1] / 2e7 - 1.0).abs() < 1e-9);
    /// assert!((limb.springs[0].per_motion_of_end[0] - 1.0).abs() < 1e-9, "the first slide takes all of x");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn limb_stiffnesses(&self, mechanism: &Mechanism) -> Vec<LimbStiffness> {
        let own = mechanism.limbs().iter().zip(&self.limbs);
        own.map(|(limb, e)| {
            let place = &self.state.platforms[limb.to];
            let chain = &limb.actual;
            LimbStiffness::of(mechanism, limb, chain, &e.stiffness, place, &e.wrench)
        })
        .collect()
    }
}

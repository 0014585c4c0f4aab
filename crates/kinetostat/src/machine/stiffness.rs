//! Stiffness of an unloaded machine at its tool [R 3.10, 3.13], and of every limb as it is summed up at its platform, with the
//! motions of its joints and springs [R 4.25, 6.5, 6.8].

use crate::chain::compliance::{CartesianCompliance, stiffness_against_force};
use crate::chain::directions::{Direction, DirectionKind, Share};
use crate::chain::stiffness::ChainStiffness;
use crate::error::Result;
use crate::machine::directions::{condensed_directions, scaled_directions};
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::graded::GradedPlatforms;
use crate::machine::network::Network;
use crate::machine::participation::{name_participation, participation_of_limbs};
use crate::machine::posture::Posture;
use crate::model::chain::{Chain, Role};
use crate::model::mechanism::{Limb, Mechanism};
use crate::spatial::{CartesianStiffness, Pose, Twist, Wrench, hat};
use nalgebra::Matrix6;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

impl Posture {
    /// Unloaded stiffness of the nominal mechanism, at the tool's origin, base axes [R 3.10, 3.13],
    /// all other platforms free.
    ///
    /// # Errors
    /// Wrong sizes only; a singular stiffness is a result.
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
    /// let stiffness = arm.posture(&home)?.stiffness()?;
    /// assert_eq!(stiffness.rank(), 6);
    /// let softest = &stiffness.directions[0];
    /// assert_eq!(softest.kind, DirectionKind::Finite);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn stiffness(&self) -> Result<UnloadedStiffness> {
        let m = &self.mechanism;
        let network = Network::new(self)?;
        let scale = m.scale();
        // The stiffness without loads is that of the limbs.
        let scales = m.limbs().iter().map(|limb| limb.nominal.scale());
        let own = network.limbs.iter().zip(scales.clone());
        let own = own.zip(&network.motions).map(|((k, s), e)| (k, s, e));
        let graded = GradedPlatforms::of(scale, network.moving(), own);
        let (matrix, mut directions) = if m.platforms().len() > 2 {
            let (total, rigid) = (network.stiffness(), network.rows());
            condensed_directions(&total, graded.as_ref(), &rigid, m.tool() - 1, scale)
        } else {
            let mut total = Matrix6::zeros();
            for (k, ends) in network.limbs.iter().zip(&network.motions) {
                total += ends.to.1.transpose() * k.cartesian.matrix * ends.to.1;
            }
            let arms = m
                .limbs()
                .iter()
                .map(|limb| self.target.rotation * limb.platform_from_tip.translation.vector);
            let own = network.limbs.iter().zip(arms).zip(scales);
            let own = own.map(|((k, arm), scale)| (k, arm, scale));
            let directions = scaled_directions(&total, graded.as_ref(), scale, own);
            (total, directions)
        };
        name_participation(&mut directions, |twist| {
            participation_of_limbs(m, &self.target, network.limbs.iter(), twist)
        });
        Ok(UnloadedStiffness {
            length: scale.length,
            cartesian: CartesianStiffness { matrix },
            directions,
            limbs: network.limbs,
        })
    }
}

/// Unloaded stiffness of a mechanism and its limbs.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
/// # let ei = 2.1e11 * bar.second_moment_z; // N m^2
/// # let chain = Chain::builder("boom").link("bar", &bar, length).build()?;
/// # let home = Pose::translation(length, 0.0, 0.0);
/// # let boom = Mechanism::serial(chain, home, Vector3::zeros())?;
/// let stiffness = boom.posture(&home)?.stiffness()?;
/// assert_eq!(stiffness.rank(), 6);
/// // A hand that pushes the end feels 3 E I / L^3, as the end may turn; held straight it is four times as stiff.
/// let bending = 3.0 * ei / length.powi(3); // N/m
/// assert!((stiffness.stiffness_against_force() / bending - 1.0).abs() < 1e-9);
/// assert!((stiffness.cartesian.matrix[(1, 1)] / (4.0 * bending) - 1.0).abs() < 1e-9);
/// let compliance = stiffness.compliance();
/// assert!((compliance.springs[(2, 2)] * bending - 1.0).abs() < 1e-9, "a round bar, across in any direction");
/// assert!(compliance.free.is_empty() && compliance.rigid.is_empty());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct UnloadedStiffness {
    /// `K_C` of the platform at the tool's origin, base axes.
    pub cartesian: CartesianStiffness,
    /// Principal directions of that stiffness, rotations referred to the natural length.
    pub directions: Vec<Direction>,
    /// `K_C^(i)` of every limb at its tip.
    pub limbs: Vec<ChainStiffness>,
    /// Natural length, m: what a rotation is multiplied with to be compared with a translation.
    pub length: f64,
}

impl UnloadedStiffness {
    /// Compliance of the tool: it exists where the stiffness is infinite (rigid directions) or zero
    /// (free ones).
    #[must_use]
    pub fn compliance(&self) -> CartesianCompliance {
        CartesianCompliance::of(&self.cartesian.matrix, &self.directions, self.length)
    }

    /// Stiffness as by
    /// [`MechanismEquilibrium::stiffness_against_force`](crate::MechanismEquilibrium::stiffness_against_force).
    #[must_use]
    pub fn stiffness_against_force(&self) -> f64 {
        let own = self.cartesian.symmetric();
        stiffness_against_force(&own, &self.directions, self.length)
    }

    /// Number of directions with stiffness.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.directions
            .iter()
            .filter(|d| d.kind != DirectionKind::Free)
            .count()
    }
}

impl UnloadedStiffness {
    /// Joints and springs that move when the tool of the posture (the one that this is the
    /// stiffness of) moves by a small twist (m, rad; base axes, at the tool's origin), named
    /// `limb: joint`, the most first. Only limbs that run from the base to the tool are listed.
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
    /// let aside = Twist::new(vector![0.0, 1.0, 0.0], Vector3::zeros());
    /// let shares = posture.stiffness()?.participation(&posture, &aside);
    /// assert!(shares.iter().any(|share| share.name.contains("shoulder")));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn participation(&self, posture: &Posture, twist: &Twist) -> Vec<Share> {
        let limbs = self.limbs.iter();
        participation_of_limbs(posture.mechanism(), posture.target(), limbs, twist)
    }
}

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
///
/// ```text
/// dq_i = K_Cq T_i dt,   dtheta_i = K_Ctheta T_i dt,   T_i = [I, -hat(s_i); 0, I]
/// K    = sum (T_i^T K_C T_i + blkdiag(0, hat(f_i) hat(s_i)))
/// ```
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

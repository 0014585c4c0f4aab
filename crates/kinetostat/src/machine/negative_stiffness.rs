//! Springs that the loads beat: which joint runs away, and what pushes it.
//!
//! A compensator, a weight above its joint or an end wrench adds a stiffness of its own to a joint, and
//! it may be negative. Where it takes away more than the joint's spring gives, the joint leaves its
//! place as soon as it may: the machine is unstable, or only its neighbours hold it.

use crate::chain::equilibrium::System;
use crate::error::Result;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::posture::Posture;
use crate::model::chain::Role;
use crate::model::loads::load::Load;
use crate::spatial::{MotionKind, Wrench};

/// A spring coordinate whose own stiffness the loads on its limb outdo while all other coordinates of
/// the limb stand still and what follows in the limb rides along.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NegativeNetStiffness {
    /// Limb, its index.
    pub limb: usize,
    /// Coordinate, as in [`crate::Chain::coordinates`].
    pub coordinate: String,
    /// Slides (stiffnesses in N/m) or turns (N m/rad).
    pub kind: MotionKind,
    /// Tangent stiffness of the spring.
    pub spring: f64,
    /// Stiffness by everything that acts on the limb, weights and the wrench at its end included;
    /// below `-spring`.
    pub by_all: f64,
    /// Part of `by_all` that the weights on the limb make, N/m or N m/rad by `kind`.
    pub by_gravity: f64,
    /// Stiffness by every load, in the order of [`crate::Mechanism::loads`].
    pub by_load: Vec<f64>,
}

impl Posture {
    /// Springs that the loads beat at an equilibrium of this posture, the weakest against its loads
    /// first. None in a machine that is stable joint by joint; a stable machine may have some, held by
    /// their neighbours or by other limbs.
    ///
    /// # Errors
    /// An equilibrium of another machine.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (mass, height, g) = (80.0, 1.2, 9.81); // kg, m, m/s^2
    /// let chain = Chain::builder("mast")
    ///     .actuator("foot", ActuatorSpec::new(MotionKind::Revolute, Vector3::x(), 700.0)) // N m/rad
    ///     .body("lamp", mass, vector![0.0, 0.0, height], nalgebra::Matrix3::zeros())
    ///     .translation(vector![0.0, 0.0, 1.5])
    ///     .build()?;
    /// let home = Pose::translation(0.0, 0.0, 1.5);
    /// let mast = Mechanism::serial(chain, home, vector![0.0, 0.0, -g])?;
    /// let posture = mast.posture(&home)?;
    /// let upright = posture.wrench_at(&home)?; // held there
    /// let beaten = &posture.negative_net_stiffnesses(&upright)?[0];
    /// assert_eq!(beaten.coordinate, "foot");
    /// // An upside-down pendulum: its weight takes m g h from the spring, more than there is.
    /// assert!((beaten.by_gravity + mass * g * height).abs() < 1e-9 && beaten.spring == 700.0);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn negative_net_stiffnesses(
        &self,
        at: &MechanismEquilibrium,
    ) -> Result<Vec<NegativeNetStiffness>> {
        let m = &self.mechanism;
        let mut found = Vec::new();
        for (index, (limb, here)) in m.limbs().iter().zip(&at.limbs).enumerate() {
            let (chain, joints) = (&limb.actual, &self.limbs[index]);
            chain.check(&here.coordinates, &joints.commands)?;
            let base = at.state.platforms[limb.from];
            let tangents = |loads: &[Load], wrench: &Wrench| {
                let mut system =
                    System::new(chain, &base, &joints.coordinates, &joints.commands, false);
                system.evaluate(
                    chain,
                    &base,
                    &joints.coordinates,
                    &joints.commands,
                    loads,
                    &here.coordinates,
                    wrench,
                    1.0,
                );
                system
            };
            let all = tangents(&m.acting(index), &here.wrench);
            let of_loads: Vec<System> = m
                .loads(index)
                .iter()
                .map(|load| tangents(std::slice::from_ref(load), &Wrench::zero()))
                .collect();
            let weights = tangents(&[Load::Gravity(m.gravity())], &Wrench::zero());
            for i in chain.indices_of(Role::Spring) {
                let (spring, loads) = (all.spring_tangent[(i, i)], -all.hessian[(i, i)]);
                if spring + loads > 0.0 {
                    continue;
                }
                let coordinate = &chain.coordinates()[i];
                found.push(NegativeNetStiffness {
                    limb: index,
                    coordinate: coordinate.name.clone(),
                    kind: coordinate.kind,
                    spring,
                    by_all: loads,
                    by_gravity: -weights.hessian[(i, i)],
                    by_load: of_loads.iter().map(|s| -s.hessian[(i, i)]).collect(),
                });
            }
        }
        let excess = |s: &NegativeNetStiffness| s.spring / s.by_all.abs();
        found.sort_by(|a, b| excess(a).total_cmp(&excess(b)));
        Ok(found)
    }
}

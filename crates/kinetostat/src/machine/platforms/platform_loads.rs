//! Contribution of weights, loads on the platforms and turning forces of limbs to the platforms' tangent.

use nalgebra::Matrix6;

use crate::machine::platforms::solver::PlatformSolver;
use crate::machine::state::MechanismState;
use crate::spatial::{hat, rotational};

impl PlatformSolver<'_> {
    /// Contribution of a limb's force to the stiffness of the platform at its tip as the arm turns.
    pub fn turned_force(&self, limb: usize, at: &MechanismState) -> Matrix6<f64> {
        let f = at.wrenches[limb].force();
        rotational(&(hat(&f) * hat(&self.arm(limb, at))))
    }

    /// Adds the tangents of what acts on the platforms themselves, `-dW / d(motion)`.
    pub fn add_platform_loads(
        &self,
        at: &MechanismState,
        mut add: impl FnMut(usize, usize, &Matrix6<f64>),
    ) {
        let m = self.mechanism;
        // A weight keeps its direction while its lever arm turns.
        for (k, platform) in m.platforms().iter().enumerate().skip(1) {
            let weight = m.gravity() * (platform.mass * self.share);
            let arm = at.platforms[k].rotation * platform.centre_of_mass;
            let block = -rotational(&(hat(&weight) * hat(&arm)));
            add(k, k, &block);
        }
        let mut own = Vec::new();
        for load in m.platform_loads() {
            load.tangents(&at.platforms, &mut own);
        }
        for tangent in own {
            let block = tangent.matrix * -self.share;
            // The base does not move, nor does it matter what acts on it.
            if tangent.on > 0 && tangent.by > 0 {
                add(tangent.on, tangent.by, &block);
            }
        }
    }
}

//! Which joints and springs of which limb move when a machine's tool moves.

use crate::chain::directions::{Direction, DirectionKind, Share, largest};
use crate::chain::stiffness::ChainStiffness;
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::posture::Posture;
use crate::machine::stiffness::UnloadedStiffness;
use crate::model::mechanism::Mechanism;
use crate::spatial::{Pose, Twist};

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

    /// With names at its free directions.
    pub(crate) fn named(mut self, posture: &Posture) -> Self {
        for i in 0..self.directions.len() {
            if loose(&self.directions[i]) {
                self.directions[i].participation =
                    self.participation(posture, &self.directions[i].twist);
            }
        }
        self
    }
}

/// A direction whose participation is of interest: nothing holds it, or loads drive it away.
fn loose(direction: &Direction) -> bool {
    matches!(
        direction.kind,
        DirectionKind::Free | DirectionKind::Negative
    )
}

impl MechanismEquilibrium {
    /// As [`UnloadedStiffness::participation`], under load.
    #[must_use]
    pub fn participation(&self, mechanism: &Mechanism, twist: &Twist) -> Vec<Share> {
        let limbs = self.limbs.iter().map(|limb| &limb.stiffness);
        participation_of_limbs(mechanism, &self.tool, limbs, twist)
    }

    /// With names at its free and negative directions.
    pub(crate) fn named(mut self, mechanism: &Mechanism) -> Self {
        for i in 0..self.directions.len() {
            if loose(&self.directions[i]) {
                self.directions[i].participation =
                    self.participation(mechanism, &self.directions[i].twist);
            }
        }
        self
    }
}

fn participation_of_limbs<'a>(
    mechanism: &Mechanism,
    tool: &Pose,
    limbs: impl Iterator<Item = &'a ChainStiffness>,
    twist: &Twist,
) -> Vec<Share> {
    let mut all: Vec<Share> = Vec::new();
    let mut total = 0.0;
    for (limb, stiffness) in mechanism.limbs().iter().zip(limbs) {
        if limb.from != 0 || limb.to != mechanism.tool() {
            continue;
        }
        let arm = tool.rotation * limb.platform_from_tip.translation.vector;
        let prefix = format!("{}: ", limb.name);
        let own = stiffness.participation_named(&limb.actual, &prefix, &twist.shifted(&arm));
        // Shares of one limb become shares of the machine.
        let length = limb.actual.scale().length;
        for mut share in own {
            share.share = share.size(length).powi(2);
            total += share.share;
            all.push(share);
        }
    }
    for share in &mut all {
        share.share /= total.max(f64::MIN_POSITIVE);
    }
    largest(all)
}

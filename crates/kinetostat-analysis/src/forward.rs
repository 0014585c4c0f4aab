//! Forward kinematics without loads, for searches that ask thousands of times.

use kinetostat::{
    Mechanism, Pose, PostureRequest,
    model::{Role, unloaded_tip},
};

/// The tool of a machine for the commands of its actuators, nothing deflected.
#[derive(Clone, Copy, Debug)]
pub struct ForwardKinematics<'m> {
    mechanism: &'m Mechanism,
    plain_product: bool,
}

impl<'m> ForwardKinematics<'m> {
    /// Prepares forward kinematics of a machine.
    #[must_use]
    pub fn of(mechanism: &'m Mechanism) -> Self {
        let limbs = mechanism.limbs();
        Self {
            mechanism,
            plain_product: limbs.len() == 1
                && limbs[0].nominal.indices_of(Role::Passive).is_empty(),
        }
    }

    /// One limb without passive joints: the tool is a product of joint motions, and no joint has to be found.
    #[must_use]
    pub fn is_plain_product(&self) -> bool {
        self.plain_product
    }

    /// The tool in the base for commands in m and rad; none where the machine cannot stand there.
    #[must_use]
    pub fn tool(&self, commands: &[f64]) -> Option<Pose> {
        let m = self.mechanism;
        if !self.plain_product {
            return m
                .posture(PostureRequest::commands(commands))
                .ok()
                .map(|p| *p.target());
        }
        let limb = &m.limbs()[0];
        let base = &m.platforms()[limb.from].home;
        let tip = unloaded_tip(
            &limb.nominal,
            base,
            &limb.nominal.home_coordinates(),
            commands,
        );
        Some(tip * limb.platform_from_tip.inverse())
    }
}

//! Which joints and springs of which limb move when a machine's tool moves.
//!
//! ```text
//! share of coordinate i = x_i^2 / sum x_j^2, x the motion of all coordinates with the tool, turns at the natural length
//! ```

use crate::chain::directions::{Direction, DirectionKind, Share, largest};
use crate::chain::stiffness::ChainStiffness;
use crate::model::mechanism::Mechanism;
use crate::spatial::{Pose, Twist};

/// Names what takes part at the directions where that is of interest: nothing holds them, or loads drive them away.
pub(crate) fn name_participation(
    directions: &mut [Direction],
    participation: impl Fn(&Twist) -> Vec<Share>,
) {
    for direction in directions {
        if matches!(
            direction.kind,
            DirectionKind::Free | DirectionKind::Negative
        ) {
            direction.participation = participation(&direction.twist);
        }
    }
}

/// Joints and springs that move when the tool moves by a twist, the most first.
pub(crate) fn participation_of_limbs<'a>(
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

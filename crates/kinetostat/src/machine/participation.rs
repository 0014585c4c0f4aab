//! Participation of joints and springs of each limb in the motion of a machine's tool.
//!
//! ```text
//! share of coordinate i = x_i^2 / sum x_j^2, x the motion of all coordinates with the tool, turns at the natural length
//! ```

use crate::chain::directions::{Direction, DirectionKind, Share, largest};
use crate::chain::stiffness::ChainStiffness;
use crate::linalg::singular_values::SingularValues;
use crate::machine::platforms::solver::PlatformSolver;
use crate::model::chain::Chain;
use crate::model::kinematics::Kinematics;
use crate::model::mechanism::Mechanism;
use crate::number::smaller;
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

/// Joints that move this many times as far as the tool make the direction rigid under a load: its tangent stiffness would be
/// that of a motion below 1 um per metre of the machine.
const NEARLY_RIGID: f64 = 1e3;

/// Such a direction is at least this many times as stiff as the softest.
pub(crate) const NEARLY_RIGID_SPREAD: f64 = NEARLY_RIGID * NEARLY_RIGID;

/// Rank of the limb's Jacobian at a posture, lengths in units of the machine's.
fn rank(chain: &Chain, base: &Pose, [coordinates, commands]: [&[f64]; 2], length: f64) -> usize {
    let at = Kinematics::new(chain, base, coordinates, commands);
    let mut jacobian = at.jacobian(chain.tip());
    jacobian.rows_mut(0, 3).scale_mut(1.0 / length);
    SingularValues::of(&jacobian).rank(SAME_RANK)
}

/// Singular values below this share of the largest count as zero.
const SAME_RANK: f64 = 1e-9;

/// True if some limb is singular in the commanded posture, and no longer where the load has moved it (a wrist that is stretched as
/// commanded).
fn only_the_load_unlocks(solver: &PlatformSolver<'_>, length: f64) -> bool {
    let limbs = solver.mechanism.limbs().iter().enumerate();
    limbs.zip(&solver.posture).any(|((i, limb), own)| {
        let commanded = [own.coordinates.as_slice(), own.commands.as_slice()];
        let loaded = [solver.state.coordinates[i].as_slice(), commanded[1]];
        let (before, now) = (
            &solver.nominal[limb.from],
            &solver.state.platforms[limb.from],
        );
        rank(&limb.nominal, before, commanded, length) < rank(&limb.actual, now, loaded, length)
    })
}

/// Declares rigid what only the deflection under the load lets move, see [`only_the_load_unlocks`].
pub(crate) fn lock_nearly_rigid(
    directions: &mut [Direction],
    solver: &PlatformSolver<'_>,
    participation: impl Fn(&Twist) -> Vec<Share>,
) {
    let length = solver.mechanism.scale().length;
    let finite = |d: &&Direction| d.kind == DirectionKind::Finite;
    let softest = directions
        .iter()
        .filter(finite)
        .map(|d| d.stiffness_n_per_m);
    let stiff = NEARLY_RIGID_SPREAD * softest.fold(f64::INFINITY, smaller);
    let is_stiff = |d: &Direction| finite(&d) && d.stiffness_n_per_m >= stiff;
    if !directions.iter().any(is_stiff) || !only_the_load_unlocks(solver, length) {
        return;
    }
    for direction in directions {
        if direction.kind != DirectionKind::Finite || direction.stiffness_n_per_m < stiff {
            continue;
        }
        let motion = participation(&direction.twist);
        let square: f64 = motion.iter().map(|s| s.size(length).powi(2)).sum();
        if square > NEARLY_RIGID_SPREAD {
            direction.kind = DirectionKind::Rigid;
            direction.stiffness_n_per_m = f64::INFINITY;
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

//! Self-motions of one limb with the tool fixed, and directions that one limb holds.

use kinetostat::{
    Mechanism, Posture, PostureRequest,
    model::{Kinematics, Role},
};
use nalgebra::DMatrix;

/// Actuators of a limb, by their number in it, that can move while both its ends stay, its passive joints following.
#[must_use]
pub fn redundant_actuators(posture: &Posture, limb: usize) -> Vec<usize> {
    let index = limb;
    let m = posture.mechanism();
    let limb = &m.limbs()[index];
    let (chain, joints) = (&limb.nominal, &posture.limbs()[index]);
    let base = &posture.platforms()[limb.from];
    let k = Kinematics::new(chain, base, &joints.coordinates, &joints.commands);
    let all = k.jacobian(chain.tip());
    let n = chain.coordinate_count();
    let length = chain.scale().length;
    let passive = chain.indices_of(Role::Passive).into_iter();
    let own = (0..chain.actuators().len()).map(|a| n + a);
    let columns: Vec<usize> = own.chain(passive).collect();
    let count = columns.len();
    if count == 0 {
        return Vec::new();
    }
    let a = DMatrix::from_fn(6, count, |i, j| {
        all[(i, columns[j])] * if i < 3 { 1.0 } else { length }
    });
    // Motions that leave the end where it is are the zero directions of the square.
    let eigen = (a.transpose() * &a).symmetric_eigen();
    let zero = 1e-12 * eigen.eigenvalues.amax();
    let moves = |joint: usize| {
        (0..count)
            .filter(|&k| eigen.eigenvalues[k].abs() <= zero)
            .any(|k| eigen.eigenvectors[(joint, k)].abs() > 1e-6)
    };
    let actuators = chain.actuators().iter().enumerate();
    actuators
        .filter(|(i, _)| moves(*i))
        .map(|(i, _)| i)
        .collect()
}

/// Directions of the tool in which one limb by itself leaves no motion, links taken as rigid; none of
/// machines with platforms between base and tool.
#[must_use]
pub fn directions_held_by_limb(posture: &Posture, limb: usize) -> Option<usize> {
    let m = posture.mechanism();
    let mut builder = Mechanism::builder(m.name());
    for platform in m.platforms().iter().skip(1) {
        builder.platform(platform.clone());
    }
    if m.platforms().len() != 2 {
        return None;
    }
    let single = builder.limb(m.limbs()[limb].clone()).build().ok()?;
    let own = single
        .posture(PostureRequest::joints(
            posture.target(),
            vec![posture.limbs()[limb].clone()],
        ))
        .ok()?;
    Some(6 - own.mobility().ncols())
}

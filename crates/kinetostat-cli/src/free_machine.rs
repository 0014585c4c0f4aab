//! How near a load brings the machine to instability while nothing holds its tool.

use kinetostat::{LimbPosture, MechanismEquilibrium, Posture};
use nalgebra::{DMatrix, Matrix6};

/// How far a dead load has brought the machine with its tool free: 0 unloaded, 1 where its stiffness
/// is lost, negative where the load stiffens it. `1 - s` of the smallest `s` in `K v = s K_e v`, with
/// the stiffness under load `K` and that of the same bent machine with its springs alone, `K_e`.
/// Both are condensed to the tool, which makes the share nearly straight in the load. `None` where
/// no direction is elastic.
pub(crate) fn share(posture: &Posture<'_>, loaded: &MechanismEquilibrium) -> Option<f64> {
    let limbs = posture.limbs().iter().zip(&loaded.limbs);
    let joints = limbs.map(|(own, bent)| LimbPosture {
        commands: own.commands.clone(),
        coordinates: bent.coordinates.clone(),
    });
    let bent = posture
        .mechanism()
        .posture_from_joints(&loaded.tool, joints.collect())
        .ok()?;
    let elastic = bent.stiffness().ok()?;
    // Rotations as motions at the natural length.
    let unit = |i: usize| if i < 3 { 1.0 } else { loaded.length };
    let scaled = |m: &Matrix6<f64>, sign: i32| {
        Matrix6::from_fn(|i, j| m[(i, j)] * (unit(i) * unit(j)).powi(sign))
    };
    let compliance = scaled(&elastic.compliance().springs, 1);
    let stiffness = scaled(&loaded.stiffness.symmetric(), -1);
    let eigen = compliance.symmetric_eigen();
    let least = 1e-10 * eigen.eigenvalues.amax();
    let held: Vec<usize> = (0..6).filter(|&i| eigen.eigenvalues[i] > least).collect();
    if held.is_empty() {
        return None;
    }
    let root = DMatrix::from_fn(6, held.len(), |i, j| {
        eigen.eigenvectors[(i, held[j])] * eigen.eigenvalues[held[j]].sqrt()
    });
    let whole = DMatrix::from_fn(6, 6, |i, j| stiffness[(i, j)]);
    let kept = root.transpose() * whole * &root;
    let share = 1.0 - kept.symmetric_eigenvalues().min();
    share.is_finite().then_some(share)
}

//! Stiffnesses of two machines at the same posture.

use kinetostat::{
    Mechanism, PostureRequest, UnloadedStiffness,
    spatial::{shift_matrix, turn_matrix},
};
use nalgebra::Matrix6;

use crate::comparison::mapping::Mapping;

/// Stiffnesses against a force at one posture, the tool free to turn, seen at the tool of `a`.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessComparison {
    /// Commands of `a` there, m or rad.
    pub commands: Vec<f64>,
    /// Stiffness of `a`, the softest direction first, N/mm.
    pub a_n_per_mm: [f64; 3],
    /// Stiffness of `b`, likewise.
    pub b_n_per_mm: [f64; 3],
}

/// Compares the stiffnesses; `None` where one machine is singular, free or rigid there.
pub(crate) fn stiffness(
    m: &Mechanism,
    n: &Mechanism,
    mapping: &Mapping,
    commands: &[f64],
) -> Option<StiffnessComparison> {
    let one = m.posture(PostureRequest::commands(commands)).ok()?;
    let other = n
        .posture(PostureRequest::commands(&mapping.joints(commands)))
        .ok()?;
    let compliance =
        |k: UnloadedStiffness| (k.rank() == 6).then(|| k.cartesian.compliance()).flatten();
    let a = compliance(one.stiffness().ok()?)?;
    let b = compliance(other.stiffness().ok()?)?;
    // Transforms to A's axes, then from B's tool to A's.
    let turn = turn_matrix(&mapping.base.rotation.to_rotation_matrix());
    let arm = one.target().translation.vector - (mapping.base * other.target()).translation.vector;
    let shift = shift_matrix(&arm);
    let b = shift * turn * b * turn.transpose() * shift.transpose();
    Some(StiffnessComparison {
        commands: commands.to_vec(),
        a_n_per_mm: against_force(&a)?,
        b_n_per_mm: against_force(&b)?,
    })
}

/// Inverse eigenvalues of the block of forces, N/mm; none where a direction is rigid.
fn against_force(compliance: &Matrix6<f64>) -> Option<[f64; 3]> {
    let block = compliance.fixed_view::<3, 3>(0, 0).into_owned();
    let mut values: Vec<f64> = block.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(|x, y| y.total_cmp(x));
    (values[2] > 1e-9 * values[0]).then(|| [0, 1, 2].map(|i| 1e-3 / values[i]))
}

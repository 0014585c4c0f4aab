//! Chains of the report's chapters 4 and 5, all planar in x y, links of 1 m, springs of 1 N m/rad.

use kinetostat::{
    Chain, ChainProblem, EndCondition, Load, MotionKind, Pose, Prescribed, Wrench,
    model::Kinematics,
};
use nalgebra::{Matrix2x3, Matrix3, Matrix3xX, Vector3, vector};

/// Inclination of the links of the chains of section 4.6 at rest: 15 degrees.
pub const REST: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Section 4.6.1: hinge, rigid link, spring at rest at -30 degrees, rigid link, hinge. The node
/// `middle` carries the load.
///
/// # Errors
/// None: the chain is right.
pub fn two_links() -> kinetostat::Result<Chain> {
    let z = Vector3::z();
    Chain::builder("two links")
        .passive("q1", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .node("middle")
        .spring("theta", MotionKind::Revolute, z, 1.0, -2.0 * REST)
        .translation(vector![1.0, 0.0, 0.0])
        .passive("q2", MotionKind::Revolute, z, 0.0)
        .build()
}

/// Section 4.6.2: the same with links that stretch (200 N/m), inclined by `a0` (rad) at rest.
///
/// # Errors
/// None: the chain is right.
pub fn two_elastic_links(a0: f64) -> kinetostat::Result<Chain> {
    let (z, x) = (Vector3::z(), Vector3::x());
    Chain::builder("two elastic links")
        .passive("q1", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("stretch 1", MotionKind::Prismatic, x, 200.0, 0.0)
        .node("middle")
        .spring("theta", MotionKind::Revolute, z, 1.0, -2.0 * a0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("stretch 2", MotionKind::Prismatic, x, 200.0, 0.0)
        .passive("q2", MotionKind::Revolute, z, 0.0)
        .build()
}

/// Section 5.5: hinge, three rigid links with two springs between them, hinge. `rest` are the
/// springs' angles at rest, rad: zero is the report's S chain, -30 and +30 degrees its Z chain.
///
/// # Errors
/// None: the chain is right.
pub fn three_links(rest: [f64; 2]) -> kinetostat::Result<Chain> {
    let z = Vector3::z();
    Chain::builder("three links")
        .passive("q", MotionKind::Revolute, z, 0.0)
        .translation(vector![1.0, 0.0, 0.0])
        .spring("theta1", MotionKind::Revolute, z, 1.0, rest[0])
        .translation(vector![1.0, 0.0, 0.0])
        .spring("theta2", MotionKind::Revolute, z, 1.0, rest[1])
        .translation(vector![1.0, 0.0, 0.0])
        .passive("end", MotionKind::Revolute, z, 0.0)
        .build()
}

/// The end held at `x` (m) on the line through the base, free to turn.
#[must_use]
pub fn held(chain: &Chain, x: f64) -> ChainProblem<'_> {
    let mut end = EndCondition::pose(Pose::translation(x, 0.0, 0.0));
    end.prescribed[5] = Prescribed::Wrench;
    ChainProblem::new(chain, end)
}

/// A dead force of `g` (N) downwards, on the node `middle`.
///
/// # Errors
/// A chain without such a node.
pub fn weight(chain: &Chain, g: f64) -> kinetostat::Result<Load> {
    let wrench = Wrench::new(vector![0.0, -g, 0.0], Vector3::zeros());
    Ok(Load::dead(chain.node("middle")?, wrench))
}

/// Eigenvalues of the report's shape criterion `S_c = V^T (H - K) V` [R 5.21] of a three-link chain
/// whose end is held in x and y under a dead force along x (N): `V` is an orthonormal basis of
/// the motions of `(theta1, theta2, q)` that leave the end where it is. Rising order.
#[must_use]
pub fn shape_criterion(chain: &Chain, coordinates: &[f64], force: f64) -> Vec<f64> {
    const ORDER: [usize; 3] = [1, 2, 0];
    let kinematics = Kinematics::new(chain, &Pose::identity(), coordinates, &[]);
    let pushed = Wrench::new(vector![force, 0.0, 0.0], Vector3::zeros());
    let (all, load) = (
        kinematics.jacobian(chain.tip()),
        kinematics.hessian(&[(chain.tip(), pushed)]),
    );
    let jacobian = Matrix2x3::from_fn(|i, j| all[(i, ORDER[j])]);
    let mut curvature = Matrix3::from_fn(|i, j| load[(ORDER[i], ORDER[j])]);
    curvature[(0, 0)] -= 1.0; // the springs
    curvature[(1, 1)] -= 1.0;
    let gram = (jacobian.transpose() * jacobian).symmetric_eigen();
    let still: Vec<_> = (0..3)
        .filter(|&i| gram.eigenvalues[i] < 1e-9)
        .map(|i| gram.eigenvectors.column(i).into_owned())
        .collect();
    let v = Matrix3xX::from_columns(&still);
    let criterion = v.transpose() * curvature * &v;
    let mut values: Vec<f64> = criterion.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

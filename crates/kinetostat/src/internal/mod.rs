//! Access to internals for this crate's own tests in `tests/core/internal`. It is not part of the interface and changes
//! without notice.
//!
//! A module of tests inside a source would compile the whole crate once more.

mod chain_curve;

use nalgebra::DMatrix;
use pulp::Scalar;

use crate::batch::Batch;
use crate::batch::limb::law;
use crate::batch::numbers::lanes::Lanes;
use crate::model::mechanism::Mechanism;
use crate::model::springs::block::SpringBlock;
use crate::model::springs::law::SpringLaw;

pub use self::chain_curve::{ChainCurve, CurveState, CurveTangent};
pub use crate::batch::numbers::instruction_set::InstructionSet;
pub use crate::chain::divergence::{TangentMotions, diverging_motions};
pub use crate::chain::passive::scaled_jacobian;
pub use crate::chain::scaling::scales_of;
pub use crate::chain::stability::stability_within;
pub use crate::chain::stiffness::{chain_stiffness, swept_stiffness};
pub use crate::chain::sweep::end_spring::END_SPRINGS;
pub use crate::chain::sweep::solve::{Bordered, EndMotions, EndRows, shape};
pub use crate::chain::sweep::stages::{ChainMethod, Form, SWEEP_FROM};
pub use crate::chain::system::{Hessian, System};
pub use crate::equilibrium::chain::solve_along;
pub use crate::linalg::block_elimination::{BlockFactors, Pivots};
pub use crate::linalg::complement::complement;
pub use crate::linalg::derivatives::{Forward, Number, Real};
pub use crate::linalg::krylov::largest_eigenvalues;
pub use crate::linalg::saddle::{Saddle, column_space, inertia, pseudo_inverse};
pub use crate::linalg::singular_values::shortest_and_free;
pub use crate::linalg::sparse::Sparse;
pub use crate::model::springs::curved::CurvedLaw;
pub use crate::model::springs::single::SingleLaw;

/// A machine compiled for postures that lie along a path.
#[must_use]
pub fn batch_along_path(mechanism: &Mechanism) -> Batch {
    Batch::new(mechanism).along_path()
}

/// Energy, torques and tangent of a spring of six coordinates at these values of them.
#[must_use]
pub fn spring_response(block: &SpringBlock, values: &[f64; 6]) -> (f64, Vec<f64>, DMatrix<f64>) {
    let (mut torque, mut tangent) = (vec![0.0; 6], DMatrix::zeros(6, 6));
    let mut add = |i, j, value| tangent[(i, j)] += value;
    let energy = block.add(
        values,
        &[0.0; 6],
        1.0,
        &mut torque,
        &mut add,
        &mut Vec::new(),
    );
    (energy, torque, tangent)
}

/// Torques of a spring of six coordinates as the kernels compute them, in single numbers.
#[must_use]
pub fn kernel_torque(law: &SpringLaw, at: &[f64; 6]) -> [f64; 6] {
    let (torque, _) = law::torque(law, &at.map(|x| Lanes::new(Scalar, x)));
    torque.map(number)
}

/// The tangent stiffness that belongs to [`kernel_torque`].
#[must_use]
pub fn kernel_tangent(law: &SpringLaw, at: &[f64; 6]) -> [[f64; 6]; 6] {
    law::tangent(law, &at.map(|x| Lanes::new(Scalar, x))).map(|row| row.map(number))
}

/// Sine and cosine as the kernels compute them.
#[must_use]
pub fn kernel_sine_and_cosine(x: f64) -> (f64, f64) {
    let (sine, cosine) = Lanes::new(Scalar, x).sin_cos();
    (number(sine), number(cosine))
}

/// The batch as if no kernel knew its machine without load.
#[must_use]
pub fn without_unloaded_kernels(batch: Batch) -> Batch {
    batch.without_unloaded_kernels()
}

fn number(x: Lanes<Scalar>) -> f64 {
    let mut out = [0.0];
    x.store(&mut out);
    out[0]
}

//! Access to internals for this crate's own tests in `tests/core/internal`. It is not part of the interface and changes
//! without notice.
//!
//! A module of tests inside a source would compile the whole crate once more.

use nalgebra::{DMatrix, DVector};
use pulp::Scalar;

use crate::batch::Batch;
use crate::batch::limb::law;
use crate::batch::numbers::lanes::Lanes;
use crate::chain::problem::ChainProblem;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::settings::Parameter;
use crate::error::Result;
use crate::model::mechanism::Mechanism;
use crate::model::springs::block::{SpringBlock, SpringLaw};
use crate::settings::Settings;
use crate::spatial::Wrench;

pub use crate::batch::numbers::instruction_set::InstructionSet;
pub use crate::chain::directions::scaled_jacobian;
pub use crate::chain::scaling::scales_of;
pub use crate::chain::stability::{TangentMotions, diverging_motions, stability_within};
pub use crate::chain::stiffness::{chain_stiffness, swept_stiffness};
pub use crate::chain::sweep::factor::END_SPRINGS;
pub use crate::chain::sweep::solve::{Bordered, EndMotions, EndRows, shape};
pub use crate::chain::sweep::stages::{ChainMethod, Form, SWEEP_FROM};
pub use crate::chain::system::{Hessian, System};
pub use crate::equilibrium::chain::solve_along;
pub use crate::linalg::block_elimination::{BlockFactors, Pivots};
pub use crate::linalg::complement::complement;
pub use crate::linalg::derivatives::{Forward, Number, Real};
pub use crate::linalg::saddle::{Saddle, column_space, inertia, pseudo_inverse};
pub use crate::linalg::singular_values::shortest_and_free;
pub use crate::linalg::sparse::{Sparse, largest_eigenvalues};
pub use crate::model::springs::bilinear::SingleLaw;
pub use crate::model::springs::curved::CurvedLaw;

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

/// The equations of a chain's curve.
pub struct ChainCurve<'p, 'a>(ChainSystem<'p, 'a>);

/// The direction in which equilibrium persists, with sign and logarithm of the determinant.
pub struct CurveTangent {
    /// Unit vector along the curve.
    pub direction: DVector<f64>,
    /// Sign of the determinant of the matrix with this direction below it.
    pub sign: f64,
    /// Logarithm of that determinant's size.
    pub logarithm: f64,
}

/// First-order equations at one state.
pub struct CurveState {
    /// Residual of the equilibrium, scaled.
    pub residual: DVector<f64>,
    matrix: CurveMatrix,
}

impl<'p, 'a> ChainCurve<'p, 'a> {
    /// Solves by dense matrices.
    ///
    /// # Errors
    /// A problem that cannot be solved as it is stated.
    pub fn dense(problem: &'p ChainProblem<'a>, parameter: &'p Parameter) -> Result<Self> {
        ChainSystem::new(problem, Some(parameter), &Settings::default()).map(Self)
    }

    /// Solves by sweeps along the chain.
    ///
    /// # Errors
    /// See [`ChainCurve::dense`].
    pub fn swept(problem: &'p ChainProblem<'a>, parameter: &'p Parameter) -> Result<Self> {
        Self::dense(problem, parameter).map(|own| Self(own.0.by_sweeps()))
    }

    /// Number of unknowns without the parameter.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.count()
    }

    /// Begins a curve at an equilibrium.
    ///
    /// # Errors
    /// As the curve itself.
    pub fn start(&mut self, coordinates: &[f64], wrench: &Wrench, value: f64) -> Result<()> {
        self.0.start(coordinates, wrench, value).map(|_| ())
    }

    /// An equilibrium as a point of the curve's space.
    #[must_use]
    pub fn state(&self, coordinates: &[f64], wrench: &Wrench, value: f64) -> DVector<f64> {
        self.0.state(coordinates, wrench, value)
    }

    /// The equations to first order.
    pub fn linearised(&mut self, z: &DVector<f64>) -> CurveState {
        let (residual, _, matrix) = self.0.linearised(z);
        CurveState { residual, matrix }
    }
}

impl CurveState {
    /// True if the matrix is that of a sweep.
    #[must_use]
    pub fn is_swept(&self) -> bool {
        matches!(self.matrix, CurveMatrix::Swept(_))
    }

    /// The last column: derivatives by the parameter.
    #[must_use]
    pub fn gradient(&self) -> DVector<f64> {
        self.matrix.gradient()
    }

    /// The step that removes a residual, and goes so far along `normal`.
    #[must_use]
    pub fn step(
        &self,
        normal: &DVector<f64>,
        residual: &DVector<f64>,
        beside: f64,
    ) -> Option<DVector<f64>> {
        self.matrix.step(normal, residual, beside, None)
    }

    /// The tangent, oriented along `guide`.
    #[must_use]
    pub fn tangent(&self, guide: &DVector<f64>) -> Option<CurveTangent> {
        let own = self.matrix.tangent(guide, None)?;
        Some(CurveTangent {
            direction: own.direction,
            sign: own.sign,
            logarithm: own.logarithm,
        })
    }

    /// The tangent where a sweep shows that it is the only one.
    #[must_use]
    pub fn only_direction(&self) -> Option<DVector<f64>> {
        self.matrix.only_direction()
    }
}

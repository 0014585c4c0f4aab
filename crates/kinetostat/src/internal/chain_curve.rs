//! One state of a chain's curve: its linearised equations, by sweeps or dense.

use nalgebra::DVector;

use crate::chain::problem::ChainProblem;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::parameter::Parameter;
use crate::error::Result;
use crate::settings::Settings;
use crate::spatial::Wrench;

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

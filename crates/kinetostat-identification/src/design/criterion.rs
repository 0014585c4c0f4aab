//! What a design makes small, and how it is searched.

use nalgebra::DMatrix;

/// Scalar measure of the covariance `M^-1`, to be minimised.
///
/// [`Criterion::TestPoses`] and the choice of postures by [`Criterion::Determinant`] do not depend on the units of the parameters.
/// The other two do: the caller scales the columns, for instance by the nominal size of each parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Criterion {
    /// L-optimality, `trace(L M^-1)`, with `L` the mean of `A_0^T A_0` over the test poses (parameters x parameters). The value is the
    /// mean square of the error left after compensation, in the squared unit of the rows of `A_0`.
    TestPoses(DMatrix<f64>),
    /// A-optimality, `trace(M^-1)`: sum of the variances of the parameters.
    Average,
    /// D-optimality, `det(M)^(-1/p)` for `p` parameters: geometric mean of the variances along the principal axes.
    Determinant,
    /// E-optimality, the largest eigenvalue of `M^-1`: variance of the worst combination of unit length.
    WorstDirection,
}

/// Settings of the search for a design.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignSettings {
    /// Information `M_0` that is always present, of earlier measurements or of a prior (parameters x parameters, positive
    /// semidefinite). A prior with the covariance `P` has the information `P^-1`.
    pub fixed_information: Option<DMatrix<f64>>,
    /// True if a posture may be measured more than once.
    pub repeats: bool,
    /// Requested relative gap between the value of the continuous design and its certified bound.
    pub gap: f64,
    /// Number of starts of the exchange algorithm.
    pub starts: usize,
    /// Seed of the random starts. Equal seeds give equal designs.
    pub seed: u64,
}

impl Default for DesignSettings {
    fn default() -> Self {
        Self {
            fixed_information: None,
            repeats: false,
            gap: 1e-9,
            starts: 20,
            seed: 0,
        }
    }
}

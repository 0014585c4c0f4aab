//! Reasons why there is no design.

use nalgebra::DMatrix;

/// Reason why there is no design.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The list of candidates is empty, or they have no columns.
    #[error("there are no candidate postures with parameters: give at least one")]
    NoCandidates,
    /// A candidate has no rows or another number of columns than the first one.
    #[error(
        "candidate posture {candidate} has {rows} rows and {columns} columns: at least 1 row and {expected} columns are needed"
    )]
    CandidateShape {
        /// Index of the candidate.
        candidate: usize,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Columns of the first candidate.
        expected: usize,
    },
    /// A candidate contains NaN, an infinity or numbers whose squares overflow.
    #[error(
        "candidate posture {0} contains numbers that are not finite or too large: check the posture and the standard deviations"
    )]
    CandidateNotFinite(usize),
    /// The matrix of the test poses or the fixed information has the wrong shape, is not finite, not symmetric or has negative
    /// eigenvalues.
    #[error(
        "the {matrix} is not a finite, symmetric and positive semidefinite {parameters} x {parameters} matrix"
    )]
    NotSemidefinite {
        /// Name of the matrix.
        matrix: &'static str,
        /// Number of parameters.
        parameters: usize,
    },
    /// The test poses do not depend on any parameter: the matrix `L` is zero.
    #[error("the test poses depend on no parameter: give a test pose with a load")]
    ZeroTestPoses,
    /// No posture is to be chosen, or more than there are candidates although repetition is not allowed.
    #[error(
        "{count} postures are wanted of {candidates} candidates: choose at least 1 and give more candidates or allow repetition"
    )]
    Count {
        /// Wanted postures.
        count: usize,
        /// Candidates.
        candidates: usize,
    },
    /// A posture to be evaluated is not in the list of candidates.
    #[error("posture {index} does not exist: there are {candidates} candidates, counted from 0")]
    UnknownPosture {
        /// Index of the posture.
        index: usize,
        /// Candidates.
        candidates: usize,
    },
    /// [`DesignSettings::gap`](super::DesignSettings::gap) is outside its range.
    #[error("the gap is {0}: it must be above 0 and below 1")]
    Gap(f64),
    /// Even all candidates together do not identify all parameters.
    #[error(
        "all candidate postures together identify {rank} of {parameters} parameters: add other loads or postures, fix parameters or give a prior"
    )]
    NotIdentifiable {
        /// Number of identifiable combinations.
        rank: usize,
        /// Number of parameters.
        parameters: usize,
        /// Basis of the changes of the parameters that leave every observation as it is (parameters x (parameters - rank)). The
        /// largest entry of each column has the absolute value one.
        combinations: DMatrix<f64>,
    },
    /// The candidates identify all parameters, but no set of so many postures that was tried does.
    #[error(
        "{count} postures identify {rank} of {parameters} parameters: measure more postures, fix parameters or give a prior"
    )]
    TooFewObservations {
        /// Postures.
        count: usize,
        /// Largest rank that was found.
        rank: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// E-optimality has no continuous design here, since its value is not differentiable.
    #[error(
        "the worst direction has no continuous design: choose an exact one or another criterion"
    )]
    NoContinuousDesign,
}

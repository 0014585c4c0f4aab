//! Reasons why there is no design.

use std::fmt;

use nalgebra::DMatrix;

/// Combinations of parameters that no candidate posture observes.
#[derive(Clone, Debug, PartialEq)]
pub struct Unobservable {
    /// Number of identifiable combinations.
    pub rank: usize,
    /// Number of parameters.
    pub parameters: usize,
    /// Basis of the changes of the parameters that leave every observation as it is (parameters x (parameters - rank)). The largest
    /// entry of each column has the absolute value one.
    pub combinations: DMatrix<f64>,
}

/// Symmetric matrix among the inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputMatrix {
    /// Matrix `L` of [`Criterion::TestPoses`](super::Criterion::TestPoses).
    TestPoses,
    /// [`DesignSettings::fixed_information`](super::DesignSettings::fixed_information).
    FixedInformation,
}

impl fmt::Display for InputMatrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TestPoses => "matrix of the test poses",
            Self::FixedInformation => "fixed information",
        })
    }
}

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
        "candidate posture {candidate} contains numbers that are not finite or too large: check the posture and the standard deviations"
    )]
    CandidateNotFinite {
        /// Index of the candidate.
        candidate: usize,
    },
    /// A symmetric matrix has the wrong shape.
    #[error("the {matrix} is {rows} x {columns}: {parameters} x {parameters} is needed")]
    MatrixShape {
        /// Matrix concerned.
        matrix: InputMatrix,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// A matrix is not finite, not symmetric or has negative eigenvalues.
    #[error("the {matrix} is not finite, symmetric and positive semidefinite")]
    NotSemidefinite {
        /// Matrix concerned.
        matrix: InputMatrix,
    },
    /// The test poses do not depend on any parameter: the matrix `L` is zero.
    #[error("the test poses depend on no parameter: give a test pose with a load")]
    ZeroTestPoses,
    /// No posture is to be chosen.
    #[error("the number of postures is 0: give at least 1")]
    ZeroCount,
    /// More postures are wanted than there are candidates, and repetition is not allowed.
    #[error(
        "{count} postures are wanted of {candidates} candidates: give more candidates or allow repetition"
    )]
    TooFewCandidates {
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
    /// A setting is outside its range.
    #[error("the {setting} is {value}: it must be above 0 and below 1")]
    SettingOutsideRange {
        /// Name of the setting.
        setting: &'static str,
        /// Value given.
        value: f64,
    },
    /// Even all candidates together do not identify all parameters.
    #[error(
        "all candidate postures together identify {} of {} parameters: add other loads or postures, fix parameters or give a prior",
        .0.rank, .0.parameters
    )]
    NotIdentifiable(Unobservable),
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

//! Choice of measurement postures for the identification of compliances and geometry.
//!
//! Each candidate posture `x` adds the information `A_x^T A_x` of its weighted observation rows `A_x` to the information matrix
//! `M = M_0 + sum A_x^T A_x`, and `M^-1` is the covariance of the estimated parameters. A design is a choice of candidates that makes
//! a measure of `M^-1` small:
//!
//! - [`continuous`] distributes weights on all candidates. The problem is convex and its optimum is certified by the equivalence
//!   theorem (Kiefer and Wolfowitz, The equivalence of two extremum problems, Canadian Journal of Mathematics 12, 1960; Pukelsheim,
//!   Optimal Design of Experiments, 1993).
//! - [`exact`] chooses a whole number of postures by exchanges (Fedorov, Theory of Optimal Experiments, 1972) and measures the result
//!   against the certified bound.
//! - [`evaluate`] measures a given set of postures in the same way.
//!
//! The error left after compensation at a working pose with the deflection regressor `A_0` has the mean square
//! `sigma^2 trace(A_0 M^-1 A_0^T)`: the test-pose approach (Klimchik, Wu, Pashkevich, Caro and Furet, Optimal selection of measurement
//! configurations for stiffness model calibration of anthropomorphic manipulators, Applied Mechanics and Materials 162, 2012).

use nalgebra::DMatrix;

mod continuous;
mod criterion;
mod error;
mod exact;
mod objective;
mod problem;

pub use criterion::{Criterion, DesignSettings};
pub use error::DesignError;

use problem::Problem;

/// Optimal continuous design: the share of the observations that each candidate receives.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuousDesign {
    /// Weight of each candidate, not negative, with the sum one.
    pub weights: Vec<f64>,
    /// Candidates with a weight above 1e-6, in ascending order.
    pub support: Vec<usize>,
    /// Value of the criterion for the requested number of observations.
    pub value: f64,
    /// Certified lower bound: no design of as many observations, exact or continuous, has a smaller value under the same rule for
    /// repetition.
    pub bound: f64,
    /// Certified relative gap, `value / bound - 1`. It exceeds the requested gap if the iteration stalled at rounding.
    pub gap: f64,
}

/// Set of postures with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactDesign {
    /// Indices of the candidates in ascending order; an index that occurs twice is measured twice.
    pub postures: Vec<usize>,
    /// Value of the criterion.
    pub value: f64,
    /// Certified lower bound for every design of as many postures under the same rule for repetition; `None` for
    /// [`Criterion::WorstDirection`].
    pub bound: Option<f64>,
    /// Efficiency, `bound / value`, at most one; `None` for [`Criterion::WorstDirection`].
    pub efficiency: Option<f64>,
}

/// Computes the optimal continuous design with the total weight of `observations` postures.
///
/// If [`DesignSettings::repeats`] is false, no candidate receives more than one observation: weights are at most `1 / observations`.
/// Otherwise, and without fixed information, the weights do not depend on `observations` and the value is inversely proportional to it.
///
/// `candidates` holds the observation rows of each posture (rows x parameters), already divided by the standard deviation.
///
/// # Errors
/// [`DesignError`] if an input is invalid, if the candidates together cannot identify all parameters, or if the criterion is
/// [`Criterion::WorstDirection`].
pub fn continuous(
    candidates: &[DMatrix<f64>],
    criterion: &Criterion,
    observations: usize,
    settings: &DesignSettings,
) -> Result<ContinuousDesign, DesignError> {
    if *criterion == Criterion::WorstDirection {
        return Err(DesignError::NoContinuousDesign);
    }
    let problem = Problem::new(candidates, criterion, observations, settings)?;
    let solution = continuous::optimise(&problem, settings.gap)?;
    let support = (0..candidates.len()).filter(|x| solution.weights[*x] > 1e-6);
    Ok(ContinuousDesign {
        support: support.collect(),
        value: solution.value,
        bound: solution.value * solution.ratio,
        gap: 1.0 / solution.ratio - 1.0,
        weights: solution.weights,
    })
}

/// Searches the best set of `count` postures.
///
/// Starts are a greedy choice, the rounded continuous design and random sets; each is improved by exchanges of single postures until
/// none helps. The search is deterministic. It does not prove optimality: [`ExactDesign::efficiency`] limits what a better set could
/// gain.
///
/// # Errors
/// [`DesignError`] if an input is invalid or if no set of `count` postures was found that identifies all parameters.
pub fn exact(
    candidates: &[DMatrix<f64>],
    criterion: &Criterion,
    count: usize,
    settings: &DesignSettings,
) -> Result<ExactDesign, DesignError> {
    let problem = Problem::new(candidates, criterion, count, settings)?;
    let (weights, bound) = if *criterion == Criterion::WorstDirection {
        // Without a continuous design of its own, the starts follow that of A-optimality.
        let average = Problem::new(candidates, &Criterion::Average, count, settings)?;
        (continuous::optimise(&average, 1e-2)?.weights, None)
    } else {
        let solution = continuous::optimise(&problem, settings.gap)?;
        (solution.weights, Some(solution.value * solution.ratio))
    };
    let (postures, value) = exact::search(&problem, &weights, bound, settings)?;
    Ok(rated(postures, value, bound))
}

/// Evaluates a given set of postures, with the bound for as many postures of the same list.
///
/// If the set contains a posture twice, the bound is that for designs with repetition, whatever the settings are.
///
/// # Errors
/// [`DesignError`] if an input is invalid or if the postures do not identify all parameters.
pub fn evaluate(
    candidates: &[DMatrix<f64>],
    postures: &[usize],
    criterion: &Criterion,
    settings: &DesignSettings,
) -> Result<ExactDesign, DesignError> {
    if let Some(index) = postures.iter().find(|x| **x >= candidates.len()) {
        return Err(DesignError::UnknownPosture {
            index: *index,
            candidates: candidates.len(),
        });
    }
    let mut postures = postures.to_vec();
    postures.sort_unstable();
    let count = postures.len();
    let settings = DesignSettings {
        repeats: settings.repeats || postures.windows(2).any(|pair| pair[0] == pair[1]),
        ..settings.clone()
    };
    let problem = Problem::new(candidates, criterion, count, &settings)?;
    let information = problem.sum(&problem.fixed, &postures);
    let value = (problem.objective.value(information, f64::INFINITY))
        .ok_or_else(|| problem.too_few_observations(problem.rank(&postures)))?;
    let bound = if *criterion == Criterion::WorstDirection {
        None
    } else {
        let solution = continuous::optimise(&problem, settings.gap)?;
        Some(solution.value * solution.ratio)
    };
    Ok(rated(postures, value, bound))
}

/// Result with its efficiency. The bound is at most the value: a set that reaches it exceeds one by rounding only.
fn rated(postures: Vec<usize>, value: f64, bound: Option<f64>) -> ExactDesign {
    let bound = bound.map(|b| b.min(value));
    ExactDesign {
        postures,
        value,
        bound,
        efficiency: bound.map(|b| (b / value).min(1.0)),
    }
}

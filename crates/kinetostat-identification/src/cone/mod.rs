//! Least squares with physical constraints: non-negative and positive semi-definite unknowns.
//!
//! Deflections are linear in compliances, and an elastic body stores energy: the compliance
//! of a joint is not negative, the 6x6 compliance matrix of a link is positive semi-definite. [`ConeLeastSquares`] minimises
//!
//! ```text
//! 1/2 |A x - y|^2 + 1/2 (x - x0)^T P (x - x0)
//! ```
//!
//! over the unknowns that meet these constraints. The rows of `A` and `y` are already divided by the standard deviation of
//! their measurement, therefore `|A x - y|^2` is chi-squared. The problem is convex: every optimum is a global one.
//!
//! # Method
//!
//! 1. *Scaling.* Metres and radians differ by factors of 1e3 to 1e6. Unknowns are measured in nominal sizes, or in sizes that
//!    give the columns of `A` unit length. A matrix is scaled from both sides, `X = D Xs D`, which keeps it semi-definite.
//! 2. *Reduction.* Householder reflections turn all rows into an upper triangle of the size of the unknowns, once.
//! 3. *Unconstrained answer.* If it meets the constraints, it is the result.
//! 4. *Interior point.* Otherwise Newton's method follows the minimisers of `objective - mu log det X` for decreasing `mu`, in
//!    the primal-dual form of Nesterov and Todd (1997) with the predictor and corrector of Mehrotra (1992), see Vandenberghe,
//!    *The CVXOPT linear and quadratic cone program solvers* (2010). The duality gap is `mu` times the sum of the block orders.
//!    Every step is a least-squares problem, solved by reflections; normal equations would lose half of the digits.
//!
//! # Combinations that the data do not see
//!
//! If the rows (and the prior) leave some combinations of unknowns undetermined, infinitely many answers fit equally well, and the
//! barrier alone has no minimum. The result is then the answer nearest to the reference `x0` (zero if none is given), measured
//! in scaled unknowns. It is computed by adding `1/2 w |N^T (x - x0)|^2`, where the columns of `N` span the unseen combinations.
//! The weight `w` is so small that the fit does not suffer: [`ConeSolution::penalty`] is at most about 1e-8 of the objective, or
//! 1e-20 of `|y|^2` if the data can be fitted exactly. [`ConeSolution::rank`] and [`ConeSolution::unseen`] report the deficiency.
//!
//! An optimum may also lie at infinity: if noise makes a seen diagonal entry of a matrix zero, seen off-diagonal entries of the same
//! row need infinite diagonal entries elsewhere, and those may be unseen. The penalty keeps the answer finite, but large, and
//! its share of the objective is larger than usual. A prior is the remedy.

mod newton;
mod reduced;
mod scaling;
mod solution;
pub(crate) mod symmetric;

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

pub use solution::{BlockState, ConeSolution, KktResidual};

use reduced::Reduced;

/// Limit of the optimisations with other weights of the penalty.
const PENALTY_ROUNDS: usize = 4;

/// Physical constraint on one unknown, or on the unknowns that form a symmetric matrix.
///
/// A column belongs to one constraint at most. Columns without a constraint are free.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Constraint {
    /// The unknown of this column is not negative, such as the compliance of a joint.
    NonNegative(usize),
    /// The unknowns of these columns form a positive semi-definite symmetric matrix, such as the compliance of a link.
    ///
    /// They are the upper triangle of an n x n matrix, row by row: (0,0), (0,1), ..., (0,n-1), (1,1), ...; n(n+1)/2 columns, 21
    /// for a link. An off-diagonal unknown stands for both entries (i,j) and (j,i).
    PositiveSemidefinite(Vec<usize>),
}

/// Reason why a problem has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConeError {
    /// Sizes that do not fit together, or a matrix without entries.
    #[error("{what} has {found} entries; {expected} are required")]
    Size {
        /// Name of the vector or matrix.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries required.
        expected: usize,
    },
    /// An infinite number or NaN.
    #[error("{0} contains a number that is not finite")]
    NotFinite(&'static str),
    /// A nominal size that is not positive.
    #[error("the nominal size of column {column} is {size}; it must be positive")]
    NominalSize {
        /// Column of the unknown.
        column: usize,
        /// Size found.
        size: f64,
    },
    /// A prior precision that is not symmetric and positive semi-definite.
    #[error("the prior precision is not symmetric and positive semi-definite")]
    Precision,
    /// A constraint on a column that does not exist or that has a constraint already.
    #[error(
        "a constraint names column {column}; each of the columns 0 to {columns}, the last one excluded, may be named once"
    )]
    Column {
        /// Column named.
        column: usize,
        /// Columns of the matrix.
        columns: usize,
    },
    /// A number of columns that is no triangle of a matrix.
    #[error("a symmetric matrix has n(n+1)/2 columns (1, 3, 6, 10, 15, 21, ...), not {0}")]
    Triangle(usize),
    /// A duality gap that did not become small enough.
    #[error(
        "the duality gap is {gap:.1e} of the objective after {steps} Newton steps; scale the columns by nominal sizes"
    )]
    NotConverged {
        /// Newton steps made.
        steps: usize,
        /// Smallest gap reached, relative to the objective.
        gap: f64,
    },
}

/// Linear least-squares problem with physical constraints.
#[derive(Clone, Debug)]
pub struct ConeLeastSquares<'a> {
    matrix: &'a DMatrix<f64>,
    data: &'a DVector<f64>,
    constraints: &'a [Constraint],
    reference: Option<&'a DVector<f64>>,
    precision: Option<&'a DMatrix<f64>>,
    nominal: Option<&'a [f64]>,
}

impl<'a> ConeLeastSquares<'a> {
    /// Problem without prior; `matrix` N x p and `data` N have rows divided by the standard deviations of the measurements.
    #[must_use]
    pub fn new(
        matrix: &'a DMatrix<f64>,
        data: &'a DVector<f64>,
        constraints: &'a [Constraint],
    ) -> Self {
        Self {
            matrix,
            data,
            constraints,
            reference: None,
            precision: None,
            nominal: None,
        }
    }

    /// Sets the reference `x0` (p), to which combinations that the data do not see are drawn. It need not meet the constraints.
    #[must_use]
    pub fn reference(mut self, reference: &'a DVector<f64>) -> Self {
        self.reference = Some(reference);
        self
    }

    /// Sets a prior: mean `x0` (p) and precision `P` (p x p, inverse covariance, symmetric positive semi-definite).
    #[must_use]
    pub fn prior(mut self, mean: &'a DVector<f64>, precision: &'a DMatrix<f64>) -> Self {
        self.reference = Some(mean);
        self.precision = Some(precision);
        self
    }

    /// Sets nominal sizes of the unknowns (p, positive, units of the unknowns); for a matrix only those of its diagonal matter.
    ///
    /// Without them columns are scaled to unit length, which turns a column of rounding errors into a full one unless it is
    /// shorter than 1e-13 of the longest. Give them if loads may have no effect on an unknown.
    #[must_use]
    pub fn nominal_sizes(mut self, sizes: &'a [f64]) -> Self {
        self.nominal = Some(sizes);
        self
    }

    /// Solves the problem.
    ///
    /// # Errors
    /// [`ConeError`] for sizes that do not fit, numbers that are not finite, or a duality gap above 1e-7 of the objective.
    pub fn solve(&self) -> Result<ConeSolution, ConeError> {
        self.check()?;
        let mut reduced = Reduced::new(self)?;
        let mut optimum = newton::minimise(&reduced)?;
        for _ in 0..PENALTY_ROUNDS {
            if let Some(adapted) = reduced.adapted(&optimum.u)
                && let Ok(mut next) = newton::minimise(&adapted)
            {
                next.steps += optimum.steps;
                (reduced, optimum) = (adapted, next);
            }
        }
        Ok(solution::unscale(self, &reduced, &optimum))
    }

    fn check(&self) -> Result<(), ConeError> {
        let (rows, columns) = self.matrix.shape();
        // At least one row and one unknown.
        let entries = (rows * columns).max(1);
        let mut inputs = vec![
            ("the matrix", self.matrix.as_slice(), entries),
            ("the data vector", self.data.as_slice(), rows),
        ];
        inputs.extend(
            self.reference
                .map(|v| ("the reference", v.as_slice(), columns)),
        );
        let precision = self.precision.map(DMatrix::as_slice);
        inputs.extend(precision.map(|v| ("the prior precision", v, columns * columns)));
        inputs.extend(
            self.nominal
                .map(|v| ("the list of nominal sizes", v, columns)),
        );
        for (what, values, expected) in inputs {
            let found = values.len();
            if found != expected {
                return Err(ConeError::Size {
                    what,
                    found,
                    expected,
                });
            }
            if !values.iter().all(|v| v.is_finite()) {
                return Err(ConeError::NotFinite(what));
            }
        }
        for (column, &size) in self.nominal.unwrap_or_default().iter().enumerate() {
            if size <= 0.0 {
                return Err(ConeError::NominalSize { column, size });
            }
        }
        let mut used = vec![false; columns];
        for constraint in self.constraints {
            if constraint.order().is_none() {
                return Err(ConeError::Triangle(constraint.columns().len()));
            }
            for &column in constraint.columns() {
                if used.get(column) != Some(&false) {
                    return Err(ConeError::Column { column, columns });
                }
                used[column] = true;
            }
        }
        Ok(())
    }
}

impl Constraint {
    /// Columns of the constrained unknowns.
    #[must_use]
    pub fn columns(&self) -> &[usize] {
        match self {
            Self::NonNegative(column) => std::slice::from_ref(column),
            Self::PositiveSemidefinite(columns) => columns,
        }
    }

    /// True if the unknowns meet the constraint.
    #[must_use]
    pub fn holds(&self, unknowns: &DVector<f64>) -> bool {
        let own: Vec<f64> = self.columns().iter().map(|c| unknowns[*c]).collect();
        let n = self.order().unwrap_or(0);
        let entry = |i: usize, k: usize| own[symmetric::triangle_index(n, i, k)];
        if (0..n).any(|i| entry(i, i) <= 0.0) {
            return false;
        }
        // Metres and radians are compared alike.
        let scaled = DMatrix::from_fn(n, n, |i, k| {
            entry(i, k) / (entry(i, i) * entry(k, k)).sqrt()
        });
        scaled.cholesky().is_some()
    }

    /// Order n of the constrained n x n matrix, 1 for a scalar; `None` if the number of columns is not n(n+1)/2.
    #[must_use]
    pub fn order(&self) -> Option<usize> {
        let columns = self.columns().len();
        (1..=columns).find(|n| n * (n + 1) / 2 == columns)
    }
}

//! Least squares with physical constraints: compliances that are not negative, matrices that are positive semi-definite.
//!
//! An elastic body stores energy, so that the compliance of a joint is not negative and the 6 x 6 compliance matrix of a link is
//! positive semi-definite. Least squares with that are convex: every optimum is the global one. Newton's method follows the minimisers
//! of
//!
//! ```text
//! 1/2 |A x - y|^2 - mu sum log det X
//! ```
//!
//! for a falling `mu`; the duality gap at each is `mu` times the sum of the orders of the matrices X (1 for a single compliance), and
//! `Z = mu X^-1` are the dual matrices of the conditions of Karush, Kuhn and Tucker (Boyd and Vandenberghe, Convex Optimization,
//! 2004, chapter 11).
//!
//! Combinations that no row sees are drawn to a reference: the barrier alone has no minimum along them. The weight of that is far
//! below what the rows have, and along what they do not see nothing contradicts it.

use kinetostat::linalg::SingularValues;
use kinetostat::number::larger;
use nalgebra::{DMatrix, DVector};

/// Relative singular value below which the readings do not see a combination of unknowns: far above rounding, far below the least
/// that a measurement could use.
pub const UNSEEN: f64 = 1e-9;

/// Physical constraint on one unknown, or on the unknowns that form a symmetric matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Constraint {
    /// The unknown of this column is not negative.
    NonNegative(usize),
    /// The unknowns of these columns are the upper triangle of a positive semi-definite matrix, row by row: n (n + 1) / 2 of them.
    PositiveSemidefinite(Vec<usize>),
}

/// Rows with constraints.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedRows<'a> {
    /// Rows, each divided by the standard deviation of its reading.
    pub matrix: &'a DMatrix<f64>,
    /// Readings.
    pub values: &'a DVector<f64>,
    /// No unknown is in two of them.
    pub constraints: &'a [Constraint],
    /// What combinations that no row sees are drawn to.
    pub reference: &'a DVector<f64>,
    /// Sizes of the unknowns, above zero; of a matrix those of the diagonal decide.
    pub sizes: &'a DVector<f64>,
}

/// The optimum.
#[derive(Clone, Debug)]
pub struct Constrained {
    /// Unknowns, in their own units: they meet the constraints.
    pub estimate: DVector<f64>,
    /// `1/2 |A x - y|^2`.
    pub objective: f64,
    /// No estimate that meets the constraints has an objective that is less by more than this.
    pub gap: f64,
    /// Residual of the conditions of Karush, Kuhn and Tucker: gradient less that of the dual matrices, beside that of the whole readings.
    pub kkt: f64,
    /// For each constraint: number of eigenvalues at zero, their bound.
    pub at_bound: Vec<usize>,
    /// Newton steps.
    pub steps: usize,
}

/// The optimum was not reached.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the least squares with compliances that are not negative were not solved: a gap of {gap:.1e} of the squares is left"
)]
pub struct NotSolved {
    /// Gap in the objective.
    pub gap: f64,
}

/// Gap relative to the objective at which the optimum is reached.
const GAP: f64 = 1e-10;
/// The same relative to the squares of the readings, where they can be fitted exactly.
const LEAST: f64 = 1e-20;
/// Weight of the way to the reference along combinations that no row sees, relative to the longest column.
const DRAWN: f64 = 1e-7;
/// Most Newton steps, several for each of some twenty values of `mu`.
const MOST_STEPS: usize = 400;

impl Constraint {
    /// Columns of the constrained unknowns.
    #[must_use]
    pub fn columns(&self) -> &[usize] {
        match self {
            Self::NonNegative(column) => std::slice::from_ref(column),
            Self::PositiveSemidefinite(columns) => columns,
        }
    }

    /// Order of the matrix, 1 of a single unknown.
    #[must_use]
    pub fn order(&self) -> usize {
        let columns = self.columns().len();
        (1..=columns)
            .find(|n| n * (n + 1) / 2 >= columns)
            .unwrap_or(0)
    }

    /// True if the unknowns meet the constraint, with a margin that rounding does not use up.
    #[must_use]
    pub fn holds(&self, unknowns: &DVector<f64>) -> bool {
        let matrix = self.matrix(unknowns);
        let diagonal = matrix.diagonal();
        if diagonal.iter().any(|d| *d <= 0.0) {
            return false;
        }
        // Metres and radians are compared alike.
        let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
            matrix[(i, k)] / (diagonal[i] * diagonal[k]).sqrt()
        });
        scaled.cholesky().is_some()
    }

    fn matrix(&self, unknowns: &DVector<f64>) -> DMatrix<f64> {
        let n = self.order();
        let mut matrix = DMatrix::zeros(n, n);
        for ((i, k), column) in upper(n).zip(self.columns()) {
            matrix[(i, k)] = unknowns[*column];
            matrix[(k, i)] = unknowns[*column];
        }
        matrix
    }
}

/// Row and column of the upper triangle of a matrix of order n, row by row.
fn upper(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |row| (row..n).map(move |column| (row, column)))
}

impl ConstrainedRows<'_> {
    /// Solves the problem.
    ///
    /// # Errors
    /// [`NotSolved`] if the gap cannot be closed, as for numbers that are not finite.
    pub fn solve(&self) -> Result<Constrained, NotSolved> {
        // Unknowns without a constraint count from the reference: a place in metres is a million times its error, and the squares of
        // the readings would round away those of the residuals.
        let mut shift = self.reference.clone();
        for column in self.constraints.iter().flat_map(|c| c.columns()) {
            shift[*column] = 0.0;
        }
        let values = self.values - self.matrix * &shift;
        let size = values.norm();
        let size = if size > 0.0 { size } else { 1.0 };
        let mut sizes = self.sizes.clone();
        for constraint in self.constraints {
            let diagonal: Vec<f64> = constraint
                .matrix(self.sizes)
                .diagonal()
                .iter()
                .map(|d| d.sqrt())
                .collect();
            for ((i, k), column) in upper(constraint.order()).zip(constraint.columns()) {
                sizes[*column] = diagonal[i] * diagonal[k];
            }
        }
        let scaled = DMatrix::from_fn(self.matrix.nrows(), sizes.len(), |i, j| {
            self.matrix[(i, j)] * sizes[j] / size
        });
        let found = SingularValues::of(&scaled);
        let longest = found.largest().powi(2);
        let free = found.null_space(UNSEEN);
        let drawn = &free * free.transpose() * (DRAWN * longest.max(f64::MIN_POSITIVE));
        let reference = (self.reference - &shift).component_div(&sizes);
        let values = values / size;
        let curvature = scaled.tr_mul(&scaled);
        let problem = Scaled {
            slope: scaled.tr_mul(&values),
            rows: scaled,
            values,
            curvature,
            drawn,
            reference,
            constraints: self.constraints,
        };
        let optimum = problem.optimum()?;
        let mut estimate = shift + optimum.0.component_mul(&sizes);
        let at_bound: Vec<usize> = self
            .constraints
            .iter()
            .map(|c| problem.at_bound(c, &optimum))
            .collect();
        for (constraint, _) in self
            .constraints
            .iter()
            .zip(&at_bound)
            .filter(|(_, count)| **count > 0)
        {
            if let Constraint::NonNegative(column) = constraint {
                estimate[*column] = 0.0;
            }
        }
        let orders: usize = self.constraints.iter().map(Constraint::order).sum();
        Ok(Constrained {
            objective: 0.5 * (self.matrix * &estimate - self.values).norm_squared(),
            gap: orders as f64 * optimum.1 * size * size,
            kkt: problem.gradient(&optimum.0, optimum.1).amax()
                / problem.slope.amax().max(f64::MIN_POSITIVE),
            at_bound,
            steps: optimum.2,
            estimate,
        })
    }
}

/// The problem in units of the sizes, with readings of length one.
struct Scaled<'a> {
    rows: DMatrix<f64>,
    values: DVector<f64>,
    curvature: DMatrix<f64>,
    slope: DVector<f64>,
    /// Curvature that draws combinations that no row sees to the reference.
    drawn: DMatrix<f64>,
    reference: DVector<f64>,
    constraints: &'a [Constraint],
}

/// Unknowns, the last `mu`, and the number of steps.
type Optimum = (DVector<f64>, f64, usize);

impl Scaled<'_> {
    fn optimum(&self) -> Result<Optimum, NotSolved> {
        let orders: usize = self.constraints.iter().map(Constraint::order).sum();
        let orders = orders.max(1) as f64;
        let mut at = self.inside();
        let mut mu = self.objective(&at).max(LEAST) / orders;
        let mut steps = 0;
        loop {
            // Steps for this mu, until the rest is far below what the barrier weighs.
            while steps < MOST_STEPS {
                steps += 1;
                let (step, decrement) =
                    self.newton(&at, mu).ok_or(NotSolved { gap: orders * mu })?;
                let Some(next) = self.along(&at, &step, mu) else {
                    break;
                };
                at = next;
                // Below that the merit is rounding.
                if decrement <= (1e-8 * mu).max(1e-15 * self.objective(&at)) {
                    break;
                }
            }
            let enough = GAP * self.objective(&at) + LEAST;
            if orders * mu <= enough {
                return Ok((at, mu, steps));
            }
            if steps >= MOST_STEPS || !mu.is_finite() {
                return Err(NotSolved { gap: orders * mu });
            }
            mu = (0.1 * mu).max(0.5 * enough / orders);
        }
    }

    /// The reference where it meets the constraints, else the unit of each that it does not meet.
    fn inside(&self) -> DVector<f64> {
        let mut at = self.reference.clone();
        for constraint in self
            .constraints
            .iter()
            .filter(|c| !c.holds(&self.reference))
        {
            for ((i, k), column) in upper(constraint.order()).zip(constraint.columns()) {
                at[*column] = if i == k { 1.0 } else { 0.0 };
            }
        }
        at
    }

    fn objective(&self, at: &DVector<f64>) -> f64 {
        let away = at - &self.reference;
        0.5 * (&self.rows * at - &self.values).norm_squared()
            + 0.5 * away.dot(&(&self.drawn * &away))
    }

    /// Objective with the barrier; none outside.
    fn merit(&self, at: &DVector<f64>, mu: f64) -> Option<f64> {
        let mut barrier = 0.0;
        for constraint in self.constraints {
            let factor = constraint.matrix(at).cholesky()?;
            barrier -= 2.0
                * factor
                    .l_dirty()
                    .diagonal()
                    .iter()
                    .map(|d| d.ln())
                    .sum::<f64>();
        }
        Some(self.objective(at) + mu * barrier)
    }

    fn gradient(&self, at: &DVector<f64>, mu: f64) -> DVector<f64> {
        // By the residual, not by normal equations: it is right to its own rounding.
        let residual = &self.rows * at - &self.values;
        let mut gradient = self.rows.tr_mul(&residual) + &self.drawn * (at - &self.reference);
        for constraint in self.constraints {
            let Some(inverse) = constraint.matrix(at).cholesky().map(|c| c.inverse()) else {
                continue;
            };
            for ((i, k), column) in upper(constraint.order()).zip(constraint.columns()) {
                gradient[*column] -= mu
                    * if i == k {
                        inverse[(i, i)]
                    } else {
                        2.0 * inverse[(i, k)]
                    };
            }
        }
        gradient
    }

    /// Newton's step, and by how much the merit would fall along it, doubled.
    fn newton(&self, at: &DVector<f64>, mu: f64) -> Option<(DVector<f64>, f64)> {
        let gradient = self.gradient(at, mu);
        let mut hessian = &self.curvature + &self.drawn;
        for constraint in self.constraints {
            let inverse = constraint.matrix(at).cholesky()?.inverse();
            let pairs: Vec<(usize, usize)> = upper(constraint.order()).collect();
            for (p, (i, k)) in pairs.iter().enumerate() {
                for (q, (l, m)) in pairs.iter().enumerate() {
                    // trace(X^-1 E_ik X^-1 E_lm) with symmetric E.
                    let one = inverse[(*m, *i)] * inverse[(*k, *l)];
                    let other = inverse[(*l, *i)] * inverse[(*k, *m)];
                    let sum = match (i == k, l == m) {
                        (true, true) => one,
                        (true, false) | (false, true) => one + other,
                        (false, false) => 2.0 * (one + other),
                    };
                    hessian[(constraint.columns()[p], constraint.columns()[q])] += mu * sum;
                }
            }
        }
        // Unit diagonal: numbers near their bound are stiff.
        let root = hessian
            .diagonal()
            .map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 });
        let mut scaled = DMatrix::from_fn(root.len(), root.len(), |i, j| {
            hessian[(i, j)] * root[i] * root[j]
        });
        for _ in 0..8 {
            if let Some(factor) = scaled.clone().cholesky() {
                let step = -factor
                    .solve(&gradient.component_mul(&root))
                    .component_mul(&root);
                let decrement = -gradient.dot(&step);
                return Some((step, decrement)).filter(|(_, d)| d.is_finite());
            }
            // Rounding of what is hardly seen.
            (0..root.len()).for_each(|k| scaled[(k, k)] += 1e-14);
        }
        None
    }

    /// The step as far as it stays inside and the merit falls; none where rounding allows no step.
    fn along(&self, at: &DVector<f64>, step: &DVector<f64>, mu: f64) -> Option<DVector<f64>> {
        let now = self.merit(at, mu)?;
        let slope = self.gradient(at, mu).dot(step);
        let mut share = 1.0;
        for _ in 0..60 {
            let next = at + step * share;
            if self
                .merit(&next, mu)
                .is_some_and(|merit| merit <= now + 1e-4 * share * slope)
            {
                return Some(next);
            }
            share *= 0.5;
        }
        None
    }

    /// Eigenvalues of a constrained matrix at zero: where its dual pushes harder than the rows would give way.
    fn at_bound(&self, constraint: &Constraint, (at, mu, _): &Optimum) -> usize {
        let columns = constraint.columns();
        let stiffest = columns
            .iter()
            .map(|c| self.curvature[(*c, *c)] + self.drawn[(*c, *c)])
            .fold(0.0, larger);
        let eigenvalues = constraint.matrix(at).symmetric_eigenvalues();
        eigenvalues
            .iter()
            .filter(|e| **e * stiffest < mu / **e)
            .count()
    }
}

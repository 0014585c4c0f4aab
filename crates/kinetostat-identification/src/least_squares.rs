//! Weighted linear least squares by postures: estimate, covariance, and what each posture says against the others.
//!
//! Rows are divided by the standard deviation of their reading, so that a residual of one is a standard deviation. Rows of one
//! posture stand together: they share its errors (repeatability, drift, what the model does not have), and the textbook covariance,
//! which takes them for independent, is too small by up to three times. The covariance by postures
//!
//! ```text
//! P (sum_g u_g u_g^T) P m / (m - 1)     u_g = A_g^T r_g, P = (A^T A)^-1, m postures
//! ```
//!
//! is right for both (Liang and Zeger 1986). Leaving a posture out and predicting it needs no second fit:
//! `e_g = (I - A_g P A_g^T)^-1 r_g`.

use kinetostat::linalg::SingularValues;
use kinetostat::number::larger;
use nalgebra::{DMatrix, DVector};

use crate::cone::{ConstrainedRows, Constraint, NotSolved, UNSEEN};

/// Readings of one posture: linear in the unknowns, each row divided by the standard deviation of its reading.
#[derive(Clone, Debug)]
pub struct PostureRows {
    /// Derivatives of the readings by the unknowns, one row for each reading.
    pub rows: DMatrix<f64>,
    /// The readings.
    pub values: DVector<f64>,
}

/// Unknowns from rows.
#[derive(Clone, Debug)]
pub struct LinearFit {
    /// Estimate, in the unknowns' own units.
    pub estimate: DVector<f64>,
    /// `(A^T A)^-1` on the combinations that the rows see: the covariance if the stated standard deviations are right and
    /// all readings are independent.
    pub normal_inverse: DMatrix<f64>,
    /// The same with numbers at their bound held there: what tells how a posture is predicted from others.
    pub held_inverse: DMatrix<f64>,
    /// Number of combinations of unknowns that the rows see.
    pub rank: usize,
    /// Readings less what the estimate says of them, posture by posture, in standard deviations.
    pub residuals: Vec<DVector<f64>>,
    /// Weights of the rows, 1 without outliers.
    pub weights: Vec<DVector<f64>>,
    /// Unknowns at zero, their bound, and first unknowns of matrices with a load that does not deflect them.
    pub at_bound: Vec<usize>,
}

/// Scatter about the fit, in stated deviations, above which the stated ones are not believed.
pub const SCATTER: f64 = 1.5;

/// How far a row may be from the fit before it counts less, in standard deviations (Huber 1964): 95 % efficient where there is no
/// outlier.
pub const HUBER: f64 = 1.345;

/// Rows reduced to as many as there are unknowns, with the same normal equations: `A = Q R`, `R x = Q^T y`.
pub(crate) fn reduced(
    postures: &[PostureRows],
    weights: &[DVector<f64>],
) -> (DMatrix<f64>, DVector<f64>) {
    let unknowns = postures.first().map_or(0, |p| p.rows.ncols());
    // Blocks of rows are folded in one after the other: the memory does not grow with the readings.
    let most = 256.max(2 * unknowns);
    let mut stack = DMatrix::zeros(0, unknowns + 1);
    for (posture, weight) in postures.iter().zip(weights) {
        let own = DMatrix::from_fn(posture.rows.nrows(), unknowns + 1, |i, j| {
            let root = weight[i].sqrt();
            root * match j < unknowns {
                true => posture.rows[(i, j)],
                false => posture.values[i],
            }
        });
        let at = stack.nrows();
        stack = stack.insert_rows(at, own.nrows(), 0.0);
        stack.rows_mut(at, own.nrows()).copy_from(&own);
        if stack.nrows() > most {
            stack = stack.qr().r();
        }
    }
    if stack.nrows() > unknowns + 1 {
        stack = stack.qr().r();
    }
    let right = stack.column(unknowns).into_owned();
    (stack.remove_column(unknowns), right)
}

/// Where an estimate starts and what it must meet.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a> {
    /// What combinations that the rows do not see keep.
    pub from: &'a DVector<f64>,
    /// Sizes in which the distance from it is measured.
    pub sizes: &'a DVector<f64>,
    /// Compliances that are not negative, matrices that are positive semi-definite.
    pub constraints: &'a [Constraint],
}

/// The estimate nearest to `from` in units of `sizes` among those that fit best: combinations that the rows do not see stay as they
/// are there. `robust` weighs rows that are far from the fit less (Huber), until the estimate does not change.
///
/// # Errors
/// As [`ConstrainedRows::solve`], which is asked where the estimate does not meet the constraints.
pub fn fit(
    postures: &[PostureRows],
    problem: &Start<'_>,
    robust: bool,
) -> Result<LinearFit, NotSolved> {
    let sizes = problem.sizes;
    let mut weights: Vec<_> = postures
        .iter()
        .map(|p| DVector::repeat(p.values.len(), 1.0))
        .collect();
    let mut found = weighted(postures, &weights, problem)?;
    // Weights contract by a constant factor; a hundred turns are a tenth of those needed for the last digit at worst.
    for _ in 0..if robust { 1000 } else { 0 } {
        let far = HUBER * scatter(&found.residuals);
        for (weight, residual) in weights.iter_mut().zip(&found.residuals) {
            for (w, r) in weight.iter_mut().zip(residual.iter()) {
                *w = (far / r.abs()).min(1.0);
            }
        }
        let next = weighted(postures, &weights, problem)?;
        let change = (&next.estimate - &found.estimate)
            .component_div(sizes)
            .amax();
        found = next;
        if change <= 1e-12 * found.estimate.component_div(sizes).amax() {
            break;
        }
    }
    Ok(found)
}

/// Scatter of most residuals in stated standard deviations: by their median, which outliers do not change; 1 unless it is clearly more.
fn scatter(residuals: &[DVector<f64>]) -> f64 {
    let mut sizes: Vec<f64> = residuals
        .iter()
        .flat_map(|r| r.iter().map(|x| x.abs()))
        .collect();
    sizes.sort_by(f64::total_cmp);
    // The median of the normal distribution's sizes.
    let median = sizes
        .get(sizes.len() / 2)
        .map_or(1.0, |m| m / 0.674_489_750_196);
    match median > SCATTER {
        true => median,
        false => 1.0,
    }
}

fn weighted(
    postures: &[PostureRows],
    weights: &[DVector<f64>],
    problem: &Start<'_>,
) -> Result<LinearFit, NotSolved> {
    let Start {
        from,
        sizes,
        constraints,
    } = *problem;
    let (triangle, right) = reduced(postures, weights);
    let left = &right - &triangle * from;
    let unknowns = sizes.len();
    let scaled = DMatrix::from_fn(triangle.nrows(), unknowns, |i, j| {
        triangle[(i, j)] * sizes[j]
    });
    let (inverse, rank) = pseudo_inverse(&scaled);
    let mut held = None;
    let mut estimate = from + (&inverse * left).component_mul(sizes);
    let mut at_bound = Vec::new();
    if !constraints.iter().all(|c| c.holds(&estimate)) {
        let problem = ConstrainedRows {
            matrix: &triangle,
            values: &right,
            constraints,
            reference: from,
            sizes,
        };
        if let Some(found) = with_zeros(&problem, &scaled, &estimate) {
            held = Some(found.inverse);
            (estimate, at_bound) = (found.estimate, found.zeros);
        } else {
            let solved = problem.solve()?;
            estimate = solved.estimate;
            let each = constraints.iter().zip(&solved.at_bound);
            let zeros = each.filter(|(_, count)| **count > 0).map(|(c, _)| c);
            at_bound = zeros.clone().map(|c| c.columns()[0]).collect();
            let single = zeros.filter_map(|c| match c {
                Constraint::NonNegative(column) => Some(*column),
                Constraint::PositiveSemidefinite(_) => None,
            });
            held = Some(without(&scaled, &single.collect::<Vec<_>>()));
        }
    }
    let normal = |inverse: &DMatrix<f64>| {
        let scaled = inverse * inverse.transpose();
        DMatrix::from_fn(unknowns, unknowns, |i, j| {
            scaled[(i, j)] * sizes[i] * sizes[j]
        })
    };
    let normal_inverse = normal(&inverse);
    Ok(LinearFit {
        held_inverse: held.map_or_else(|| normal_inverse.clone(), |own| normal(&own)),
        normal_inverse,
        rank,
        residuals: postures
            .iter()
            .map(|p| &p.values - &p.rows * &estimate)
            .collect(),
        weights: weights.to_vec(),
        at_bound,
        estimate,
    })
}

/// An optimum with some unknowns at zero, and the pseudo-inverse of the scaled rows without these.
struct WithZeros {
    estimate: DVector<f64>,
    inverse: DMatrix<f64>,
    zeros: Vec<usize>,
}

/// Exchanges of zeros at most; a few are usual.
const MOST_EXCHANGES: usize = 30;

/// The optimum where every constraint is that of a single compliance, to the last digit: all that are negative are held at zero and all
/// that are pulled from there are let go, until none is either (primal-dual active sets; Hintermueller, Ito and Kunisch 2002). None where
/// that goes round in a circle, and for matrices. `free` is the optimum without constraints, from which the exchanges start.
fn with_zeros(
    problem: &ConstrainedRows<'_>,
    scaled: &DMatrix<f64>,
    free: &DVector<f64>,
) -> Option<WithZeros> {
    let single = problem.constraints.iter().map(|c| match c {
        Constraint::NonNegative(column) => Some(*column),
        Constraint::PositiveSemidefinite(_) => None,
    });
    let single: Vec<usize> = single.collect::<Option<_>>()?;
    let mut zeros: Vec<usize> = single.iter().filter(|k| free[**k] < 0.0).copied().collect();
    for _ in 0..MOST_EXCHANGES {
        let inverse = without(scaled, &zeros);
        let mut start = problem.reference.clone();
        zeros.iter().for_each(|k| start[*k] = 0.0);
        let left = problem.values - problem.matrix * &start;
        let estimate = start + (&inverse * left).component_mul(problem.sizes);
        let residual = problem.matrix * &estimate - problem.values;
        let is_zero = |k: &&usize| match zeros.contains(k) {
            true => problem.matrix.column(**k).dot(&residual) >= 0.0,
            false => estimate[**k] < 0.0,
        };
        let next: Vec<usize> = single.iter().filter(is_zero).copied().collect();
        if next == zeros {
            return Some(WithZeros {
                estimate,
                inverse,
                zeros,
            });
        }
        zeros = next;
    }
    None
}

/// Pseudo-inverse of a matrix without some of its columns.
fn without(matrix: &DMatrix<f64>, columns: &[usize]) -> DMatrix<f64> {
    let mut rest = matrix.clone();
    columns.iter().for_each(|k| rest.column_mut(*k).fill(0.0));
    pseudo_inverse(&rest).0
}

/// Pseudo-inverse and rank of a matrix whose columns are scaled.
fn pseudo_inverse(matrix: &DMatrix<f64>) -> (DMatrix<f64>, usize) {
    let (rows, columns) = matrix.shape();
    // Columns of very different length (a stiff and a soft spring) are no sign of an unseen one.
    let lengths: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
    let longest = lengths.iter().copied().fold(0.0, larger);
    let unit = |j: usize| match lengths[j] > 1e-12 * longest {
        true => 1.0 / lengths[j],
        false => 0.0,
    };
    let balanced = DMatrix::from_fn(rows, columns, |i, j| matrix[(i, j)] * unit(j));
    let values = SingularValues::of(&balanced);
    let mut inverse = values.pseudo_inverse(UNSEEN);
    for (j, mut row) in inverse.row_iter_mut().enumerate() {
        row *= unit(j);
    }
    (inverse, values.rank(UNSEEN))
}

impl LinearFit {
    /// Sum of the squares of the residuals, each with its weight.
    #[must_use]
    pub fn chi_squared(&self) -> f64 {
        let each = self.residuals.iter().zip(&self.weights);
        each.map(|(r, w)| r.component_mul(r).dot(w)).sum()
    }

    /// Rows less the combinations of unknowns that they see.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        let rows: usize = self.residuals.iter().map(|r| r.len()).sum();
        rows.saturating_sub(self.rank)
    }

    /// Estimate of the factor by which the stated standard deviations are too small: `sqrt(chi^2 / (N - p))`. 1 where nothing is
    /// left to tell.
    #[must_use]
    pub fn sigma_factor(&self) -> f64 {
        match self.degrees_of_freedom() {
            0 => 1.0,
            left => (self.chi_squared() / left as f64).sqrt(),
        }
    }

    /// Standard deviations of the unknowns for the stated ones of the readings, all independent.
    #[must_use]
    pub fn deviations(&self) -> DVector<f64> {
        self.normal_inverse.diagonal().map(|v| v.max(0.0).sqrt())
    }

    /// Covariance of the unknowns that holds whatever readings of one posture have in common; rows of a prior are as sure as they say.
    /// None for fewer than two postures.
    #[must_use]
    pub fn covariance_by_postures(
        &self,
        postures: &[PostureRows],
        prior: Option<&PostureRows>,
    ) -> Option<DMatrix<f64>> {
        let count = postures.len();
        if count < 2 {
            return None;
        }
        let unknowns = self.estimate.len();
        let mut middle = DMatrix::zeros(unknowns, unknowns);
        for ((posture, residual), weight) in postures.iter().zip(&self.residuals).zip(&self.weights)
        {
            let pull = posture.rows.tr_mul(&residual.component_mul(weight));
            middle.ger(1.0, &pull, &pull, 1.0);
        }
        middle *= count as f64 / (count - 1) as f64;
        if let Some(prior) = prior {
            middle += prior.rows.tr_mul(&prior.rows);
        }
        Some(&self.normal_inverse * middle * &self.normal_inverse)
    }

    /// Residuals of every posture against the fit to all others, in standard deviations; none where the others do not determine
    /// what the posture would show.
    #[must_use]
    pub fn left_out(&self, postures: &[PostureRows]) -> Vec<Option<DVector<f64>>> {
        let each = postures.iter().zip(&self.residuals).zip(&self.weights);
        each.map(|((posture, residual), weights)| {
            let n = residual.len();
            let root = weights.map(f64::sqrt);
            let rows = DMatrix::from_fn(n, posture.rows.ncols(), |i, j| {
                root[i] * posture.rows[(i, j)]
            });
            let rest = DMatrix::identity(n, n) - &rows * &self.held_inverse * rows.transpose();
            let least = rest.symmetric_eigenvalues().min();
            let weighted = rest
                .lu()
                .solve(&residual.component_mul(&root))
                .filter(|_| least > 1e-8)?;
            Some(weighted.component_div(&root))
        })
        .collect()
    }
}

//! Linear least squares that says what it cannot determine.

use nalgebra::{ColPivQR, DMatrix, DVector, RowDVector};

use crate::fitting::student::student_95;
use crate::number::larger;

/// Elements of the triangle's diagonal below this share of the largest are no information: any noise is larger.
const RANK: f64 = 1e-7;

/// Unknowns that fit best, and how well they are known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Solution {
    /// The unknowns.
    pub(crate) values: Vec<f64>,
    /// Variances and covariances of the unknowns, `N x N`; `None` where no residual is left to judge by.
    pub(crate) covariance: Option<DMatrix<f64>>,
    /// Residuals beyond the unknowns.
    pub(crate) freedom: usize,
}

impl Solution {
    /// Half width of the 95 % confidence interval (Student's t) of a sum of the unknowns with these factors.
    pub(crate) fn half_width_95(&self, factors: &[f64]) -> Option<f64> {
        let t = student_95(self.freedom)?;
        Some(t * self.standard_error(factors)?)
    }

    /// Standard error of the same.
    pub(crate) fn standard_error(&self, factors: &[f64]) -> Option<f64> {
        let covariance = self.covariance.as_ref()?;
        let factors = DVector::from_column_slice(factors);
        let variance = factors.dot(&(covariance * &factors));
        // A variance of nothing may come out below zero by rounding.
        Some(larger(0.0, variance).sqrt())
    }
}

/// Solves `rows x unknowns = seen`, all rows of one accuracy. Unknowns with the same number in `units` have the same unit.
///
/// # Errors
/// The unknowns, by index, that the rows do not determine.
pub(crate) fn solve<const N: usize>(
    rows: &[[f64; N]],
    seen: &[f64],
    units: [usize; N],
) -> Result<Solution, Vec<usize>> {
    // Rows of zeros change nothing, and make room for all columns of the triangle.
    let count = rows.len().max(N);
    let cell = |i: usize, j: usize| rows.get(i).map_or(0.0, |row| row[j]);
    let mut design = DMatrix::from_fn(count, N, cell);
    let seen = DVector::from_fn(count, |i, _| seen.get(i).copied().unwrap_or(0.0));
    // Columns differ by their units: with the longest of each unit at length 1, directions can be compared. Each at
    // length 1 would make information of rounding, such as the sine of half a turn.
    let own: Vec<f64> = design.column_iter().map(|column| column.norm()).collect();
    let alike = |j: usize| (0..N).filter(move |k| units[*k] == units[j]);
    let lengths: Vec<f64> = (0..N)
        .map(|j| alike(j).map(|k| own[k]).fold(0.0, larger))
        .map(|length| if length > 0.0 { length } else { 1.0 })
        .collect();
    for (j, length) in lengths.iter().enumerate() {
        design.column_mut(j).unscale_mut(*length);
    }
    // Householder's reflections with the longest column first; nalgebra's singular values are wrong where several are
    // equal, as those of a slot are.
    let factors = ColPivQR::new(design.clone());
    let (left, upper) = (factors.q(), factors.r());
    let mut order = RowDVector::from_fn(N, |_, j| j);
    factors.p().permute_columns(&mut order);
    let missing = undetermined(&upper, &order);
    if !missing.is_empty() {
        return Err(missing);
    }
    let Some(inverse) = upper.solve_upper_triangular(&DMatrix::identity(N, N)) else {
        return Err((0..N).collect());
    };
    let solve = |seen: &DVector<f64>| {
        let ordered = &inverse * left.tr_mul(seen);
        let mut unknowns = DVector::zeros(N);
        for (k, j) in order.iter().enumerate() {
            unknowns[*j] = ordered[k];
        }
        unknowns
    };
    let mut scaled = solve(&seen);
    // A second round takes the rounding of the first out.
    scaled += solve(&(&seen - &design * &scaled));
    let residuals = &seen - &design * &scaled;
    let freedom = rows.len().saturating_sub(N);
    let covariance = (freedom > 0).then(|| {
        let variance = residuals.norm_squared() / freedom as f64;
        let mut covariance = DMatrix::zeros(N, N);
        for (a, j) in order.iter().enumerate() {
            for (b, k) in order.iter().enumerate() {
                let shared = inverse.row(a).dot(&inverse.row(b));
                covariance[(*j, *k)] = variance * shared / (lengths[*j] * lengths[*k]);
            }
        }
        covariance
    });
    Ok(Solution {
        values: (0..N).map(|j| scaled[j] / lengths[j]).collect(),
        covariance,
        freedom,
    })
}

/// Unknowns with a share in a direction of which the triangle `upper`, its columns in this order, tells nothing.
fn undetermined(upper: &DMatrix<f64>, order: &RowDVector<usize>) -> Vec<usize> {
    let count = order.len();
    let most = upper[(0, 0)].abs();
    // Diagonal elements only fall.
    let told = (0..count)
        .take_while(|k| upper[(*k, *k)].abs() > RANK * most)
        .count();
    let known = upper.view((0, 0), (told, told)).into_owned();
    let rest = upper.view((0, told), (told, count - told)).into_owned();
    let mut missing: Vec<usize> = order.iter().skip(told).copied().collect();
    match known.solve_upper_triangular(&rest) {
        Some(shares) => {
            let mixed = |k: &usize| shares.row(*k).iter().any(|share| share.abs() > 1e-6);
            missing.extend((0..told).filter(mixed).map(|k| order[k]));
        }
        None => missing = (0..count).collect(),
    }
    missing.sort_unstable();
    missing
}

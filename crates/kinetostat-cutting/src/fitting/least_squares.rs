//! Linear least squares that says what it cannot determine.

use nalgebra::{ColPivQR, DMatrix, DVector, RowDVector};

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

/// `t` with 95 % of the distribution between `-t` and `t`, for 1 to 30 degrees of freedom.
const TABLE: [f64; 30] = [
    12.706_205, 4.302_653, 3.182_446, 2.776_445, 2.570_582, 2.446_912, 2.364_624, 2.306_004,
    2.262_157, 2.228_139, 2.200_985, 2.178_813, 2.160_369, 2.144_787, 2.131_450, 2.119_905,
    2.109_816, 2.100_922, 2.093_024, 2.085_963, 2.079_614, 2.073_873, 2.068_658, 2.063_899,
    2.059_539, 2.055_529, 2.051_831, 2.048_407, 2.045_230, 2.042_272,
];

/// Quantile of the normal distribution.
const NORMAL: f64 = 1.959_963_985;

/// `t` with 95 % of Student's distribution between `-t` and `t`; `None` without a degree of freedom.
///
/// A table, and beyond it the expansion about the normal distribution (Abramowitz and Stegun 26.7.5), good there to 1e-6.
fn student_95(freedom: usize) -> Option<f64> {
    let index = freedom.checked_sub(1)?;
    if let Some(t) = TABLE.get(index) {
        return Some(*t);
    }
    let (z, n) = (NORMAL, freedom as f64);
    let first = (z.powi(3) + z) / 4.0;
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
    Some(z + first / n + second / (n * n) + third / n.powi(3))
}

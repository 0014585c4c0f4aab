//! Linear least squares that says what it cannot determine.

use nalgebra::{DMatrix, DVector, SVD};

use crate::number::larger;

/// Singular values below this share of the largest are no information: any noise is larger.
const RANK: f64 = 1e-7;

/// Unknowns that fit best, and how well they are known.
pub(crate) struct Solution {
    /// The unknowns.
    pub(crate) values: Vec<f64>,
    /// Standard error of each; `None` where no residual is left to judge by.
    pub(crate) standard_errors: Option<Vec<f64>>,
    /// Residuals beyond the unknowns.
    pub(crate) freedom: usize,
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
    // Rows of zeros change nothing, and give directions without information a place among the singular ones.
    let count = rows.len().max(N);
    let cell = |i: usize, j: usize| rows.get(i).map_or(0.0, |row| row[j]);
    let mut design = DMatrix::from_fn(count, N, cell);
    let seen = DVector::from_fn(count, |i, _| seen.get(i).copied().unwrap_or(0.0));
    // Columns differ by their units: with the longest of each unit at length 1, singular values can be compared. Each at
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
    let singular = SVD::new(design.clone(), true, true);
    let (Some(left), Some(right)) = (&singular.u, &singular.v_t) else {
        return Err((0..N).collect());
    };
    let most = singular.singular_values.iter().copied().fold(0.0, larger);
    let told = |k: usize| singular.singular_values[k] > RANK * most;
    // An unknown with a share in a direction without information is not determined.
    let unknown = |j: &usize| (0..N).any(|k| !told(k) && right[(k, *j)].abs() > 1e-6);
    let missing: Vec<usize> = (0..N).filter(unknown).collect();
    if !missing.is_empty() {
        return Err(missing);
    }
    let solve = |seen: &DVector<f64>| {
        let along = left.tr_mul(seen).component_div(&singular.singular_values);
        right.tr_mul(&along)
    };
    let mut scaled = solve(&seen);
    // A second round takes the rounding of the first out.
    scaled += solve(&(&seen - &design * &scaled));
    let residuals = &seen - &design * &scaled;
    let freedom = rows.len().saturating_sub(N);
    let standard_errors = (freedom > 0).then(|| {
        let variance = residuals.norm_squared() / freedom as f64;
        let spread = |j: usize| {
            let shares = (0..N).map(|k| right[(k, j)] / singular.singular_values[k]);
            shares.map(|share| share * share).sum::<f64>()
        };
        (0..N)
            .map(|j| (variance * spread(j)).sqrt() / lengths[j])
            .collect()
    });
    Ok(Solution {
        values: (0..N).map(|j| scaled[j] / lengths[j]).collect(),
        standard_errors,
        freedom,
    })
}

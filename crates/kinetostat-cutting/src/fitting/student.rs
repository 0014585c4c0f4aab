//! Student's t.

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
pub(crate) fn student_95(freedom: usize) -> Option<f64> {
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

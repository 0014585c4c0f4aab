//! Coefficients of the linear law that fit mean forces best.

use crate::error::{CutError, CutErrorKind, Result};
use crate::fitting::cut::MeasuredCut;
use crate::fitting::least_squares::{Solution, solve};
use crate::fitting::series::{MeanForce, Series};
use crate::law::Linear;
use crate::number::{larger, smaller};

/// Coefficients in the order of a fit, with their units.
const NAMES: [(&str, &str); 6] = [
    ("K_tc", "N/mm2"),
    ("K_rc", "N/mm2"),
    ("K_ac", "N/mm2"),
    ("K_te", "N/mm"),
    ("K_re", "N/mm"),
    ("K_ae", "N/mm"),
];
/// Indices of the coefficients that act in the plane, in the order of [`crate::fitting::cut::MeasuredCut::plane_rows`].
const PLANE: [usize; 4] = [0, 1, 3, 4];
/// Indices of the coefficients that act along the axis.
const AXIAL: [usize; 2] = [2, 5];

/// A coefficient and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Coefficient {
    /// `K_tc`, `K_rc`, `K_ac`, `K_te`, `K_re` or `K_ae`.
    pub symbol: &'static str,
    /// N/mm2 for the part that grows with the chip, N/mm for that of the edge.
    pub unit: &'static str,
    /// Value of the coefficient.
    pub value: f64,
    /// Standard error; `None` where there are no more forces than coefficients.
    pub standard_error: Option<f64>,
    /// Half width of the 95 % confidence interval (Student's t); `None` likewise.
    pub half_width_95: Option<f64>,
}

/// Result of a fit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CoefficientFit {
    /// `K_tc`, `K_rc`, `K_ac` and `K_te`, `K_re`, `K_ae`.
    pub coefficients: [Coefficient; 6],
    /// Measured less fitted force, N, for each series and row: along x, y and z; `None` where it was not measured.
    pub residuals_n: Vec<Vec<[Option<f64>; 3]>>,
    /// Share of the variance about the mean that the fit explains, along x, y and z over all series; `None` where the
    /// measured force does not vary.
    pub r_squared: [Option<f64>; 3],
    /// Mean thickness of chip at the smallest feed, mm: the law is not measured below it.
    pub least_mean_chip_mm: f64,
    /// Largest thickness of chip that occurred, mm: the law is not measured beyond it.
    pub largest_chip_mm: f64,
    /// Solutions for tangential and radial coefficients, and for axial ones.
    plane: Solution,
    axial: Solution,
}

impl CoefficientFit {
    /// The law with these coefficients.
    ///
    /// # Errors
    /// Coefficients that no material has: with few or noisy forces, a tangential edge force below zero.
    pub fn law(&self) -> Result<Linear> {
        let value = |i: usize| self.coefficients[i].value;
        Linear::new(
            [value(0), value(1), value(2)],
            [value(3), value(4), value(5)],
        )
    }

    /// Half width of the 95 % confidence interval of the mean force that the fit gives along x, y and z, N; `None` where there
    /// are no more forces than coefficients. Feed per tooth in mm.
    ///
    /// It says how well the line through the forces is known; single means lie further from it.
    ///
    /// ```
    /// use kinetostat_cutting::{
    ///     Engagement, MeasuredCut, Series, Shape, Side, Tool, fit_coefficients,
    /// };
    ///
    /// let tool = Tool::new(Shape::Flat, 20.0, 4)?;
    /// let slot = Engagement::straight(10.0, 20.0, 2.0, Side::Left)?; // mm
    /// let cut = MeasuredCut::new(&tool, &slot)?;
    /// let text = "feed_mm_per_tooth;fx_n;fy_n;fz_n\n0.05;-95;150;19\n0.1;-112;231;34\n0.2;-146;390;62\n";
    /// let fit = fit_coefficients(&[Series::read("slot.csv", text, cut)?])?;
    /// let within = fit.force_half_width_95(&cut, 0.1)[1].unwrap_or(f64::NAN);
    /// // Wider where nothing was measured.
    /// assert!(fit.force_half_width_95(&cut, 0.4)[1].is_some_and(|beyond| beyond > 2.0 * within));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn force_half_width_95(
        &self,
        cut: &MeasuredCut,
        feed_mm_per_tooth: f64,
    ) -> [Option<f64>; 3] {
        let [x, y] = cut.plane_rows(feed_mm_per_tooth);
        let z = cut.axial_row(feed_mm_per_tooth);
        let plane = |row: [f64; 4]| self.plane.half_width_95(&row);
        [plane(x), plane(y), self.axial.half_width_95(&z)]
    }
}

/// Fits the coefficients of the linear law to mean forces, from a slot, from partial immersion or from several of them together.
///
/// Forces along x and y determine the tangential and radial coefficients together, those along z the axial ones. Within
/// each of these two groups, all forces are taken as equally accurate, and their errors as independent.
///
/// ```
/// use kinetostat_cutting::{
///     Engagement, MeasuredCut, Series, Shape, Side, Tool, fit_coefficients,
/// };
///
/// let tool = Tool::new(Shape::Flat, 20.0, 4)?;
/// let slot = Engagement::straight(10.0, 20.0, 2.0, Side::Left)?; // mm
/// let text = "\
/// feed_mm_per_tooth,fx_n,fy_n,fz_n
/// 0.05,-95.2,149.7,-19.3
/// 0.10,-112.3,230.6,-33.6
/// 0.15,-128.6,309.5,-48.1
/// 0.20,-145.9,389.7,-62.1
/// ";
/// let series = Series::read("slot.csv", text, MeasuredCut::new(&tool, &slot)?)?;
/// let fit = fit_coefficients(&[series])?;
/// let [tangential, ..] = fit.coefficients;
/// assert!((tangential.value - 800.0).abs() < 10.0); // N/mm2
/// assert!(tangential.half_width_95.is_some_and(|width| width < 20.0));
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
///
/// # Errors
/// Coefficients that the forces do not determine, by their names.
pub fn fit_coefficients(series: &[Series]) -> Result<CoefficientFit> {
    let (mut plane, mut in_plane) = (Vec::new(), Vec::new());
    let (mut axial, mut along) = (Vec::new(), Vec::new());
    for (cut, row) in series
        .iter()
        .flat_map(|s| s.rows.iter().map(|row| (s.cut, row)))
    {
        for (design, force) in cut
            .plane_rows(row.feed_mm_per_tooth)
            .into_iter()
            .zip(row.force_n)
        {
            if let Some(force) = force {
                plane.push(design);
                in_plane.push(force);
            }
        }
        if let Some(force) = row.force_n[2] {
            axial.push(cut.axial_row(row.feed_mm_per_tooth));
            along.push(force);
        }
    }
    let (plane, axial) = match (
        solve(&plane, &in_plane, [0, 0, 1, 1]),
        solve(&axial, &along, [0, 1]),
    ) {
        (Ok(plane), Ok(axial)) => (plane, axial),
        (plane, axial) => {
            let missing = |found: Option<Vec<usize>>, of: &[usize]| {
                let indices = found.unwrap_or_default();
                indices.into_iter().map(|i| of[i]).collect::<Vec<_>>()
            };
            return Err(undetermined(
                &missing(plane.err(), &PLANE),
                &missing(axial.err(), &AXIAL),
            ));
        }
    };
    let mut coefficients = NAMES.map(|(symbol, unit)| Coefficient {
        symbol,
        unit,
        value: f64::NAN,
        standard_error: None,
        half_width_95: None,
    });
    for (solution, places) in [(&plane, &PLANE[..]), (&axial, &AXIAL[..])] {
        for (i, place) in places.iter().enumerate() {
            let coefficient = &mut coefficients[*place];
            coefficient.value = solution.values[i];
            let mut alone = vec![0.0; places.len()];
            alone[i] = 1.0;
            coefficient.standard_error = solution.standard_error(&alone);
            coefficient.half_width_95 = solution.half_width_95(&alone);
        }
    }
    let values = coefficients.map(|coefficient| coefficient.value);
    let law = Linear {
        cutting_n_per_mm2: [values[0], values[1], values[2]],
        edge_n_per_mm: [values[3], values[4], values[5]],
    };
    let residuals_n: Vec<Vec<[Option<f64>; 3]>> = series
        .iter()
        .map(|series| residuals(series, &law))
        .collect();
    Ok(CoefficientFit {
        coefficients,
        r_squared: [0, 1, 2].map(|axis| r_squared(series, &residuals_n, axis)),
        residuals_n,
        least_mean_chip_mm: cuts(series)
            .map(|(cut, feed)| cut.mean_chip_mm(feed))
            .fold(f64::INFINITY, smaller),
        largest_chip_mm: cuts(series)
            .map(|(cut, feed)| cut.largest_chip_mm(feed))
            .fold(0.0, larger),
        plane,
        axial,
    })
}

/// The cuts and feeds of all rows.
fn cuts(series: &[Series]) -> impl Iterator<Item = (&MeasuredCut, f64)> {
    series.iter().flat_map(|s| {
        let rows = s.rows.iter();
        rows.map(move |row| (&s.cut, row.feed_mm_per_tooth))
    })
}

fn residuals(series: &Series, law: &Linear) -> Vec<[Option<f64>; 3]> {
    let of_row = |row: &MeanForce| {
        let fitted = series.cut.mean_force_n(law, row.feed_mm_per_tooth);
        [0, 1, 2].map(|axis| row.force_n[axis].map(|force| force - fitted[axis]))
    };
    series.rows.iter().map(of_row).collect()
}

fn r_squared(series: &[Series], residuals: &[Vec<[Option<f64>; 3]>], axis: usize) -> Option<f64> {
    let measured: Vec<f64> = series
        .iter()
        .flat_map(|series| &series.rows)
        .filter_map(|row| row.force_n[axis])
        .collect();
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    let all: f64 = measured.iter().map(|force| (force - mean).powi(2)).sum();
    let left: f64 = residuals
        .iter()
        .flatten()
        .filter_map(|row| row[axis])
        .map(|residual| residual * residual)
        .sum();
    (all > 0.0).then(|| 1.0 - left / all)
}

fn undetermined(plane: &[usize], axial: &[usize]) -> CutError {
    let symbols: Vec<&str> = plane.iter().chain(axial).map(|i| NAMES[*i].0).collect();
    let expected = match (plane.is_empty(), axial.is_empty()) {
        (false, true) => "mean forces along x and y (fx_n, fy_n) at two different feeds at least",
        (true, false) => "mean forces along z (fz_n) at two different feeds at least",
        _ => "mean forces along x, y and z (fx_n, fy_n, fz_n) at two different feeds at least",
    };
    CutError::new(
        CutErrorKind::Measurement,
        symbols.join(", "),
        "not determined by these forces",
        expected,
    )
}

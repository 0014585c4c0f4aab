//! Smoothing along the path with a Gaussian kernel.
//!
//! The smoothed deviation at a length `s` is the mean (Nadaraya 1964, Watson 1964)
//!
//! ```text
//! e(s) = sum_i K(s - s_i) w_i e_i / (k0 + sum_i K(s - s_i) w_i),   K(u) = exp(-u^2 / (2 h^2))
//! ```
//!
//! over the points of the same stretch without a corner, with the smoothing length `h`. It lets through the share
//! `exp(-2 pi^2 h^2 / l^2)` of a wave of length `l`: half at `5.34 h`, nine tenths at `13.7 h`. The constant `k0` is `K(3 h)`
//! times the mean weight: where there are points it changes less than a hundredth, and farther than about `3 h` from all of
//! them the mean fades to nothing instead of carrying the last one on.
//!
//! Around a stretch that comes back to its beginning the kernel is the sum of its images, one turn of the length `L` apart. It stays
//! positive definite: its Fourier series has the coefficients of the Gaussian's transform, all positive (Poisson's sum).
//!
//! The scatter of a point is averaged over `n = (sum K w)^2 / sum (K w)^2` points, its standard deviation falls to
//! `sigma / sqrt(n)`; with points every `a` along a straight course `n = 2 sqrt(pi) h / a`.

use nalgebra::Vector3;

use crate::alignment::AlignedPoint;

/// Reach of the kernel in smoothing lengths, beyond which a point counts nothing: `exp(-18)`.
const REACH: f64 = 6.0;

/// `K(3 h)`.
const FADING: f64 = 0.011_108_996_538_242_306;

/// Around a stretch that is far shorter than the smoothing length everything is the mean of all.
const MOST_TURNS: f64 = 64.0;

/// A Gaussian kernel along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Standard deviation, mm.
    pub length_mm: f64,
}

/// A smoothed deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Smoothed {
    /// The mean, mm.
    pub deviation_mm: Vector3<f64>,
    /// Weight that it rests on, `k0` included.
    pub support: f64,
    /// Number of points that a scatter is averaged over; 0 where there are none.
    pub effective_points: f64,
}

impl Kernel {
    /// Weight of a point at this distance along the path.
    fn value(&self, apart_mm: f64) -> f64 {
        let parts = apart_mm / self.length_mm;
        (-0.5 * parts * parts).exp()
    }

    /// Smoothed deviations at lengths of a pass, from points of it in the order along it.
    ///
    /// ```
    /// # use kinetostat_mirror::{AlignedPoint, Kernel};
    /// # use nalgebra::Vector3;
    /// let at = |i: usize| AlignedPoint {
    ///     row: i + 1, along_mm: i as f64, piece: 0, pass: 0, tangent: Vector3::x(),
    ///     deviation_mm: Vector3::new(0.0, 0.02, 0.0), weight: 1.0,
    /// };
    /// let points: Vec<_> = (0..100).map(at).collect();
    /// let smoothed = Kernel { length_mm: 5.0 }.smoothed(&points, &[50.0]);
    /// assert!((smoothed[0].deviation_mm.y - 0.02).abs() < 2e-5);
    /// let n = 2.0 * std::f64::consts::PI.sqrt() * 5.0;
    /// assert!((smoothed[0].effective_points / n - 1.0).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn smoothed(&self, points: &[AlignedPoint], along_mm: &[f64]) -> Vec<Smoothed> {
        let total: f64 = points.iter().map(|point| point.weight).sum();
        let constant = FADING * total / points.len().max(1) as f64;
        let reach = REACH * self.length_mm;
        along_mm
            .iter()
            .map(|at| {
                let first = points.partition_point(|point| point.along_mm < at - reach);
                let end = points.partition_point(|point| point.along_mm <= at + reach);
                let (mut sum, mut weight, mut squares) = (Vector3::zeros(), 0.0, 0.0);
                for point in &points[first..end.max(first)] {
                    let share = self.value(point.along_mm - at) * point.weight;
                    sum += point.deviation_mm * share;
                    weight += share;
                    squares += share * share;
                }
                match squares > 0.0 {
                    true => Smoothed {
                        deviation_mm: sum / (weight + constant),
                        support: weight + constant,
                        effective_points: weight * weight / squares,
                    },
                    false => Smoothed::default(),
                }
            })
            .collect()
    }

    /// Smoothed deviations around a stretch that begins and ends at the same place, at the lengths `from` and `to`.
    ///
    /// ```
    /// # use kinetostat_mirror::{AlignedPoint, Kernel};
    /// # use nalgebra::Vector3;
    /// let at = |i: usize| AlignedPoint {
    ///     row: i + 1, along_mm: i as f64, piece: 0, pass: 0, tangent: Vector3::x(),
    ///     deviation_mm: Vector3::new(0.0, 1e-3 * i as f64, 0.0), weight: 1.0,
    /// };
    /// let points: Vec<_> = (0..100).map(at).collect();
    /// let kernel = Kernel { length_mm: 5.0 };
    /// let ends = kernel.smoothed_around(&points, &[0.0, 100.0], [0.0, 100.0]);
    /// assert!((ends[0].deviation_mm - ends[1].deviation_mm).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn smoothed_around(
        &self,
        points: &[AlignedPoint],
        along_mm: &[f64],
        [from, to]: [f64; 2],
    ) -> Vec<Smoothed> {
        let (turn, reach) = (to - from, REACH * self.length_mm);
        let turns = (reach / turn).ceil().min(MOST_TURNS) as i32;
        let images = (-turns..=turns).flat_map(|k| {
            let shift = f64::from(k) * turn;
            points.iter().map(move |point| AlignedPoint {
                along_mm: point.along_mm + shift,
                ..*point
            })
        });
        let near = |point: &AlignedPoint| (from - reach..=to + reach).contains(&point.along_mm);
        let images: Vec<AlignedPoint> = images.filter(near).collect();
        self.smoothed(&images, along_mm)
    }
}

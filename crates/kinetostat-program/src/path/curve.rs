//! The curve of one move: a straight line, or an arc that may rise along its axis.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use serde::Serialize;

/// A move shorter than this has no length and no direction: what is left of two equal places after the
/// arithmetic of increments and inches, in mm.
pub(crate) const NO_LENGTH_MM: f64 = 1e-7;

/// A circular arc or helix in the part frame; lengths in mm, angles in radians.
///
/// The point at angle `a` is `centre + radius (cos a first + sin a second) + rise`, with
/// `first`, `second`, `axis` right-handed. Angle, radius and rise all grow evenly with the share, so
/// an arc whose radii differ within the tolerance still meets both its ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Arc {
    /// Centre at the height of the start, in mm.
    pub centre: Vector3<f64>,
    /// Unit vector of angle zero.
    pub first: Vector3<f64>,
    /// Unit vector of angle 90 degrees.
    pub second: Vector3<f64>,
    /// Unit vector of the axis, `first` cross `second`.
    pub axis: Vector3<f64>,
    /// Angle of the start, from `first` about `axis`.
    pub start_angle: f64,
    /// Angle from start to end, positive about `axis` (G3), negative for G2.
    pub sweep: f64,
    /// Radius at the start, in mm.
    pub start_radius: f64,
    /// Radius at the end, in mm.
    pub end_radius: f64,
    /// Motion along the axis from start to end, in mm.
    pub rise: f64,
}

/// Sine of the angle at a point between the two others below which the three lie on a line.
const STRAIGHT: f64 = 1e-7;

impl Arc {
    /// The arc from `start` through `via` to `end`, in mm, of one radius and without a rise; its sweep is positive about its own
    /// axis. `None` where the three lie on a line, or two of them at one place.
    ///
    /// ```
    /// use kinetostat_program::Arc;
    /// use nalgebra::Vector3;
    ///
    /// let [start, via, end] = [[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]].map(|[x, y]| Vector3::new(x, y, 2.0));
    /// let half = Arc::through(&start, &via, &end).unwrap();
    /// assert!((half.sweep - std::f64::consts::PI).abs() < 1e-12 && (half.point(0.5) - via).norm() < 1e-12);
    /// assert!(Arc::through(&start, &Vector3::new(0.0, 0.0, 2.0), &end).is_none());
    /// ```
    #[must_use]
    pub fn through(start: &Vector3<f64>, via: &Vector3<f64>, end: &Vector3<f64>) -> Option<Self> {
        let (a, b) = (via - start, end - start);
        let normal = a.cross(&b);
        let size = a.norm() * b.norm();
        if size == 0.0 || (end - via).norm() == 0.0 || normal.norm() <= STRAIGHT * size {
            return None;
        }
        // The centre has the same distance from all three.
        let to_centre = (b * a.norm_squared() - a * b.norm_squared()).cross(&normal)
            * (0.5 / normal.norm_squared());
        let centre = start + to_centre;
        let axis = normal.normalize();
        let first = (start - centre).normalize();
        let second = axis.cross(&first);
        let angle = |point: &Vector3<f64>| {
            let from_centre = point - centre;
            let angle = from_centre.dot(&second).atan2(from_centre.dot(&first));
            angle.rem_euclid(std::f64::consts::TAU)
        };
        // About this axis the way from start over via to end is the positive one.
        Some(Self {
            centre,
            first,
            second,
            axis,
            start_angle: 0.0,
            sweep: angle(end),
            start_radius: (start - centre).norm(),
            end_radius: (end - centre).norm(),
            rise: 0.0,
        })
    }

    /// Angle of a place about the axis from the start, in rad, the one nearest to what is expected.
    pub(crate) fn angle_to(&self, place: &Vector3<f64>, expected: f64) -> f64 {
        let out = place - self.centre;
        let angle = out.dot(&self.second).atan2(out.dot(&self.first)) - self.start_angle;
        angle + TAU * ((expected - angle) / TAU).round()
    }

    fn radius(&self, share: f64) -> f64 {
        self.start_radius + (self.end_radius - self.start_radius) * share
    }

    /// Point at a share of the sweep, in mm.
    pub fn point(&self, share: f64) -> Vector3<f64> {
        let (sine, cosine) = (self.start_angle + self.sweep * share).sin_cos();
        self.centre
            + (self.first * cosine + self.second * sine) * self.radius(share)
            + self.axis * (self.rise * share)
    }

    /// The part of it between two shares.
    ///
    /// ```
    /// use kinetostat_program::Arc;
    /// use nalgebra::Vector3;
    ///
    /// let [start, via, end] = [[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]].map(|[x, y]| Vector3::new(x, y, 2.0));
    /// let half = Arc::through(&start, &via, &end).unwrap();
    /// let last = half.between([0.5, 1.0]);
    /// assert!((last.point(0.0) - via).norm() < 1e-12 && (last.point(0.5) - half.point(0.75)).norm() < 1e-12);
    /// ```
    #[must_use]
    pub fn between(&self, [from, to]: [f64; 2]) -> Self {
        Self {
            centre: self.centre + self.axis * (self.rise * from),
            start_angle: self.start_angle + self.sweep * from,
            sweep: self.sweep * (to - from),
            start_radius: self.radius(from),
            end_radius: self.radius(to),
            rise: self.rise * (to - from),
            ..*self
        }
    }

    /// Derivative of the point by the share, in mm.
    fn derivative(&self, share: f64) -> Vector3<f64> {
        let (sine, cosine) = (self.start_angle + self.sweep * share).sin_cos();
        (self.second * cosine - self.first * sine) * (self.radius(share) * self.sweep)
            + (self.first * cosine + self.second * sine) * (self.end_radius - self.start_radius)
            + self.axis * self.rise
    }

    /// Length between two shares, in mm.
    fn length_between(&self, from: f64, to: f64) -> f64 {
        let radius = self.radius(0.5 * (from + to));
        let round = radius * self.sweep;
        let outward = self.end_radius - self.start_radius;
        (round * round + self.rise * self.rise + outward * outward).sqrt() * (to - from)
    }

    /// Into how many equal pieces the arc must be divided so that no chord leaves it by more than
    /// `tolerance_mm`.
    pub fn chords_within(&self, tolerance_mm: f64) -> usize {
        let radius = self.start_radius.max(self.end_radius);
        // A chord over the angle a leaves its arc by r (1 - cos(a/2)). At most a third of a turn a
        // piece keeps tiny arcs recognisable as such.
        let angle = if tolerance_mm >= radius {
            TAU / 3.0
        } else {
            (2.0 * (1.0 - tolerance_mm / radius).acos()).min(TAU / 3.0)
        };
        let pieces = (self.sweep.abs() / angle).ceil();
        if pieces.is_finite() {
            (pieces as usize).max(1)
        } else {
            1
        }
    }
}

/// The curve of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    /// Straight from start to end.
    Line,
    /// Along an arc or helix.
    Arc(Arc),
}

impl Curve {
    pub(crate) fn point(
        &self,
        start: &Vector3<f64>,
        end: &Vector3<f64>,
        share: f64,
    ) -> Vector3<f64> {
        if share <= 0.0 {
            return *start;
        }
        if share >= 1.0 {
            return *end;
        }
        match self {
            Curve::Line => start + (end - start) * share,
            Curve::Arc(arc) => arc.point(share),
        }
    }

    pub(crate) fn tangent(
        &self,
        start: &Vector3<f64>,
        end: &Vector3<f64>,
        share: f64,
    ) -> Option<Vector3<f64>> {
        let direction = match self {
            Curve::Line => end - start,
            Curve::Arc(arc) => arc.derivative(share.clamp(0.0, 1.0)),
        };
        direction.try_normalize(NO_LENGTH_MM)
    }

    pub(crate) fn length_between(
        &self,
        start: &Vector3<f64>,
        end: &Vector3<f64>,
        from: f64,
        to: f64,
    ) -> f64 {
        match self {
            Curve::Line => (end - start).norm() * (to - from),
            Curve::Arc(arc) => arc.length_between(from, to),
        }
    }
}

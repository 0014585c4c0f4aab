//! The curve of one move: a straight line, or an arc that may rise along its axis.

use std::f64::consts::TAU;

use nalgebra::Vector3;

/// A move shorter than this has no length and no direction: what is left of two equal places after the
/// arithmetic of increments and inches, in mm.
pub(crate) const NO_LENGTH_MM: f64 = 1e-7;

/// A circular arc or helix in the part frame; lengths in mm, angles in radians.
///
/// The point at angle `a` is `centre + radius (cos a first + sin a second) + rise`, with
/// `first`, `second`, `axis` right-handed. Angle, radius and rise all grow evenly with the share, so
/// an arc whose radii differ within the tolerance still meets both its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
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

impl Arc {
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

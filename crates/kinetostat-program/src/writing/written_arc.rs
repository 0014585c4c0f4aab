//! An arc of the written program, as a controller reads it.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::path::curve::Arc;

/// Share of a sweep at which the tool is when a part of the path is done, see [`WrittenArc::slip`].
pub(crate) fn slipped(slip: &[f64; 2], part: f64) -> f64 {
    part + part * (1.0 - part) * (slip[0] + slip[1] * (1.0 - 2.0 * part))
}

/// An arc of the written program about an axis of the part, with the ends of its [`Piece`](crate::Piece).
///
/// ```
/// use kinetostat_program::*;
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600\nM2\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// // The part is made 0.2 % larger: a quarter of a circle of 10.02 mm.
/// let larger = |request: &Request| Ok(request.position_mm * 2e-3);
/// let mut writing = WriteOptions::default();
/// writing.header = None;
/// let written = write_corrected(&program, &path, &larger, &writing, &Unwatched)?;
/// let piece = &written.pieces.iter().find(|piece| piece.arc.is_some()).unwrap();
/// let arc = piece.arc.unwrap();
/// let curve = arc.between(&piece.commanded_from, &piece.commanded_to);
/// assert_eq!((arc.axes(), curve.start_radius, arc.turned(1.0)), ([0, 1, 2], 10.02, 1.0));
/// assert!((piece.commanded(&path.moves[1], 0.5).norm() - 10.02).abs() < 1e-4);
/// assert!((piece.length_mm(&path.moves[1]) - 15.739).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WrittenArc {
    /// Axis about which it turns: 2 in the plane of X and Y (G17), 1 in that of Z and X (G18), 0 in that of Y and Z (G19).
    pub normal: usize,
    /// Centre in the plane, part frame, in mm, along the first two of [`WrittenArc::axes`].
    pub centre_mm: [f64; 2],
    /// Angle from its start to its end, in rad, positive counter-clockwise (G3).
    pub sweep_rad: f64,
    /// The corrected place at a part `u` of the piece's stretch of the path belongs to the share
    /// `u + u (1 - u) (slip[0] + slip[1] (1 - 2 u))` of the sweep: where the correction varies along the path, equal ways on the
    /// path are not quite equal ways of the tool.
    pub slip: [f64; 2],
}

impl WrittenArc {
    /// Axes of the plane and of its normal, right-handed (0 X, 1 Y, 2 Z).
    #[must_use]
    pub fn axes(&self) -> [usize; 3] {
        [
            (self.normal + 1) % 3,
            (self.normal + 2) % 3,
            self.normal % 3,
        ]
    }

    /// Share of the sweep at which the tool is when a part of the piece's stretch of the path is done.
    #[must_use]
    pub fn turned(&self, part: f64) -> f64 {
        slipped(&self.slip, part)
    }

    /// Curve between two ends; radius and height change linearly with the angle.
    #[must_use]
    pub fn between(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Arc {
        let unit = |axis: usize| Vector3::ith(axis, 1.0);
        let [first, second, normal] = self.axes();
        let out = |point: &Vector3<f64>| {
            [
                point[first] - self.centre_mm[0],
                point[second] - self.centre_mm[1],
            ]
        };
        let (start, end) = (out(from), out(to));
        Arc {
            centre: unit(first) * self.centre_mm[0]
                + unit(second) * self.centre_mm[1]
                + unit(normal) * from[normal],
            first: unit(first),
            second: unit(second),
            axis: unit(normal),
            start_angle: start[1].atan2(start[0]),
            sweep: self.sweep_rad,
            start_radius: start[0].hypot(start[1]),
            end_radius: end[0].hypot(end[1]),
            rise: to[normal] - from[normal],
        }
    }
}

//! What shifted, scaled and turned coordinates make of a place, in mm of the part frame.

use nalgebra::Vector3;

use crate::expanding::radius::geometry::{Axes, Point, Sense, in_plane};

/// Two scales that differ by less keep a circle a circle.
const SAME: f64 = 1e-12;

/// First the shift, then the scale about its centre, then the turn about its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Map {
    pub shift: Vector3<f64>,
    /// Centre and factors, negative ones mirror.
    pub scale: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Axes of the plane, centre, angle in rad.
    pub turn: Option<(Axes, Point, f64)>,
}

impl Default for Map {
    fn default() -> Self {
        Self {
            shift: Vector3::zeros(),
            scale: None,
            turn: None,
        }
    }
}

impl Map {
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// Whether places keep their differences.
    pub fn only_shifts(&self) -> bool {
        self.scale.is_none() && self.turn.is_none()
    }

    /// Where a programmed place is.
    pub fn place(&self, programmed: Vector3<f64>) -> Vector3<f64> {
        let mut at = programmed + self.shift;
        if let Some((centre, factors)) = self.scale {
            at = centre + factors.component_mul(&(at - centre));
        }
        if let Some((axes, centre, angle)) = self.turn {
            let turned = centre + turned(in_plane(&at, axes) - centre, angle);
            (at[axes[0]], at[axes[1]]) = (turned.x, turned.y);
        }
        at
    }

    /// Which programmed place is there.
    pub fn programmed(&self, place: Vector3<f64>) -> Vector3<f64> {
        let mut at = place;
        if let Some((axes, centre, angle)) = self.turn {
            let turned = centre + turned(in_plane(&at, axes) - centre, -angle);
            (at[axes[0]], at[axes[1]]) = (turned.x, turned.y);
        }
        if let Some((centre, factors)) = self.scale {
            at = centre + (at - centre).component_div(&factors);
        }
        at - self.shift
    }

    /// The sense of an arc in a plane; none where it is no circle any more.
    pub fn sense(&self, sense: Sense, axes: Axes) -> Option<Sense> {
        let Some((_, factors)) = self.scale else {
            return Some(sense);
        };
        let [a, b] = [factors[axes[0]], factors[axes[1]]];
        let same = (a.abs() - b.abs()).abs() < SAME;
        same.then_some(match a * b > 0.0 {
            true => sense,
            false => sense.other(),
        })
    }
}

fn turned(from: Point, angle: f64) -> Point {
    // Quarter turns to the last digit.
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    let (sine, cosine) = match (quarters.round() - quarters).abs() < 1e-14 {
        true => [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]
            [(quarters.round() as i64).rem_euclid(4) as usize],
        false => angle.sin_cos(),
    };
    Point::new(
        cosine * from.x - sine * from.y,
        sine * from.x + cosine * from.y,
    )
}

//! Transformation of shifted, scaled and rotated coordinates to places in mm of the part frame.

use nalgebra::Vector3;

use crate::expanding::coordinates::switch::Ending;
use crate::expanding::radius::geometry::{Axes, Point, Sense, in_plane};
use crate::expanding::translate::wrong::Wrong;

/// Largest difference of two scales that keep a circle a circle.
const SAME: f64 = 1e-12;

/// First the shift, then the scale about its centre, then the turn about its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Map {
    pub shift: Vector3<f64>,
    /// Centre and factors, negative ones mirror.
    pub scale: Option<(Vector3<f64>, Vector3<f64>)>,
    /// True if G51.1 has made the scale, false if G51.
    pub is_mirror: bool,
    /// Axes of the plane, centre, angle in rad.
    pub turn: Option<(Axes, Point, f64)>,
}

impl Default for Map {
    fn default() -> Self {
        Self {
            shift: Vector3::zeros(),
            scale: None,
            is_mirror: false,
            turn: None,
        }
    }
}

impl Map {
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// True if differences of places are unchanged.
    pub fn only_shifts(&self) -> bool {
        self.scale.is_none() && self.turn.is_none()
    }

    /// Takes away what G50 or G50.1 ends.
    pub fn take_away(&mut self, ending: Option<Ending>) -> Result<(), Wrong> {
        let (Some(ending), Some((about, factors))) = (ending, &mut self.scale) else {
            return Ok(());
        };
        match (ending, self.is_mirror) {
            (Ending::Scale, false) => self.scale = None,
            (Ending::Mirrors(axes), true) => {
                for axis in (0..3).filter(|axis| axes[*axis]) {
                    (about[axis], factors[axis]) = (0.0, 1.0);
                }
                if factors.iter().all(|factor| *factor == 1.0) {
                    (self.scale, self.is_mirror) = (None, false);
                }
            }
            (Ending::Scale, true) => {
                return Err((
                    "G50 ends the scale of G51, and the mirrors of G51.1 are in force".to_owned(),
                    "write G50.1 where the mirrors end",
                ));
            }
            (Ending::Mirrors(_), false) => {
                return Err((
                    "G50.1 ends the mirrors of G51.1, and the scale of G51 is in force".to_owned(),
                    "write G50 where the scale ends",
                ));
            }
        }
        Ok(())
    }

    /// True if one axis of the plane is mirrored, which swaps left and right of a path.
    pub fn turns_over(&self, axes: Axes) -> bool {
        let sign = |(_, factors): &(_, Vector3<f64>)| factors[axes[0]] * factors[axes[1]] < 0.0;
        self.scale.as_ref().is_some_and(sign)
    }

    /// Place in the part frame of a programmed place.
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

    /// Inverse of `place`.
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

    /// The sense of an arc in a plane; `None` if it is no circle any more.
    pub fn sense(&self, sense: Sense, axes: Axes) -> Option<Sense> {
        let Some((_, factors)) = self.scale else {
            return Some(sense);
        };
        let [a, b] = [factors[axes[0]], factors[axes[1]]];
        let same = (a.abs() - b.abs()).abs() < SAME;
        same.then_some(match self.turns_over(axes) {
            true => sense.other(),
            false => sense,
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

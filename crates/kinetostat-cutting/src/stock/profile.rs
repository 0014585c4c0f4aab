//! The envelope of a tool as the stock needs it, quick and defined everywhere, and normals and curvature of walls.

use crate::tool::{Shape, Tool};

/// Height over radius and radius over height of an envelope: a flat end, then a corner (part of a circle, or a cone), then a
/// cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile {
    /// Radius of the flat end.
    pub end: f64,
    /// Radius of the corner; 0 where there is none.
    pub corner: f64,
    /// Height over radius of the cone of a face mill.
    pub cone: Option<f64>,
    /// Radius of the cylinder.
    pub outer: f64,
}

/// The cone of a face mill is taken up to this multiple of its radius at the tip: inserts are shorter.
const CONE: f64 = 2.0;

impl Profile {
    pub fn new(tool: &Tool) -> Self {
        let cone = match tool.shape() {
            Shape::Face { lead_angle } if lead_angle < 1.57 => Some(lead_angle.tan()),
            _ => None,
        };
        Self {
            end: tool.end_radius_mm(),
            corner: tool.corner_radius_mm(),
            cone,
            outer: if cone.is_some() {
                CONE * tool.radius_mm()
            } else {
                tool.radius_mm()
            },
        }
    }

    /// A cylinder with a flat end: no corner, no cone.
    pub fn is_flat(&self) -> bool {
        self.corner == 0.0 && self.cone.is_none()
    }

    /// Height where the cylinder begins.
    pub fn shoulder(&self) -> f64 {
        match self.cone {
            Some(slope) => (self.outer - self.end) * slope,
            None => self.corner,
        }
    }

    /// Height of the envelope at a radius up to `outer`.
    #[inline]
    pub fn height(&self, radius: f64) -> f64 {
        let beyond = radius - self.end;
        if beyond <= 0.0 {
            return 0.0;
        }
        match self.cone {
            Some(slope) => beyond.min(self.outer - self.end) * slope,
            None => {
                let rest = self.corner * self.corner - beyond * beyond;
                self.corner - if rest > 0.0 { rest.sqrt() } else { 0.0 }
            }
        }
    }

    /// Slope of the envelope at a radius.
    #[inline]
    pub fn slope(&self, radius: f64) -> f64 {
        let beyond = radius - self.end;
        match self.cone {
            _ if beyond <= 0.0 => 0.0,
            Some(slope) => slope,
            None => {
                let rest = self.corner * self.corner - beyond * beyond;
                if rest > 0.0 {
                    beyond / rest.sqrt()
                } else {
                    1e12
                }
            }
        }
    }

    /// Radius of the envelope at a height: none below the tip, infinite above the shoulder.
    #[inline]
    pub fn radius(&self, height: f64) -> f64 {
        if height <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let rounding = 1e-4 * self.corner;
        match self.cone {
            Some(_) if height > self.shoulder() * (1.0 + 1e-4) => f64::INFINITY,
            Some(slope) => self.end + height / slope,
            None if height > self.corner + rounding => f64::INFINITY,
            None => {
                let rest = self.corner - height;
                self.end + (self.corner * self.corner - rest * rest).sqrt()
            }
        }
    }

    /// Radius up to which the tool reaches into material of this height above the tip.
    pub fn reach(&self, height: f64) -> f64 {
        match self.cone {
            Some(slope) => (self.end + height.max(0.0) / slope).min(self.outer),
            None if height > 0.0 && height < self.corner => self.radius(height),
            None => self.outer,
        }
    }

    /// Radius beyond which the envelope is steeper than 45 degrees.
    pub fn steep_from(&self) -> f64 {
        match self.cone {
            Some(slope) if slope <= 1.0 => f64::INFINITY,
            Some(_) => self.end,
            None => self.end + self.corner * std::f64::consts::FRAC_1_SQRT_2,
        }
    }
}

/// Normal of a wall, seen from above, out of the air into the material; and its type of curvature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Normal([i16; 2]);

/// Curvature of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bend {
    /// Left by a tool that moved along it.
    Straight,
    /// Left by a tool that stood, or turned, there.
    Round,
}

/// Numbers of a normal per unit.
const NORMAL: f64 = i16::MAX as f64;

impl Normal {
    /// Encodes a unit vector; a vector that is not finite becomes zero.
    pub fn new(vector: [f64; 2], bend: Bend) -> Self {
        // A cast holds at the greatest number, and makes 0 of what is no number.
        let [x, y] = vector.map(|part| (part * NORMAL).round() as i16);
        // The last bit of x is how the wall bends.
        Self([
            match bend {
                Bend::Straight => x & !1,
                Bend::Round => x | 1,
            },
            y,
        ])
    }

    pub fn vector(self) -> [f64; 2] {
        self.0.map(|part| f64::from(part) / NORMAL)
    }

    pub fn bend(self) -> Bend {
        match self.0[0] & 1 == 0 {
            true => Bend::Straight,
            false => Bend::Round,
        }
    }
}

/// Normal of the outline of a blank, inwards: the gradient of its distance.
pub(crate) fn outline_normal(
    at: &impl Fn(f64, f64) -> (f64, f64),
    [x, y]: [f64; 2],
    step: f64,
) -> Normal {
    let along_x = at(x + step, y).1 - at(x - step, y).1;
    let along_y = at(x, y + step).1 - at(x, y - step).1;
    let length = along_x.hypot(along_y);
    Normal::new([along_x / length, along_y / length], Bend::Straight)
}

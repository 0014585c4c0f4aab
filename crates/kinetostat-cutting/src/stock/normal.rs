//! Normals and curvature of walls: four bytes at a point of the grid.

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

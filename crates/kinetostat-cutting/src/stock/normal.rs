//! Where walls look, and how they bend: four bytes at a point of the grid.

/// Where a wall looks, seen from above: out of the air, into the material; and how it bends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Normal([i16; 2]);

/// How a wall bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bend {
    /// It was left by a tool that went along it.
    Straight,
    /// It was left by a tool that stood, or turned, there.
    Round,
}

/// Numbers of a normal per unit.
const NORMAL: f64 = i16::MAX as f64;

impl Normal {
    /// Of a vector of length one; none (of length zero) of what is not finite.
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

/// Where the outline of a blank looks, into it: the gradient of its distance.
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

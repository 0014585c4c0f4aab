//! Polar words: `@` is a radius, `^` an angle in degrees, about the origin of the program's coordinates.

use crate::expanding::translate::block::Polar;

impl Polar {
    /// The place in X and Y that the words mean, for a tool at a place.
    pub fn place(&self, at: [f64; 2], incremental: bool) -> Result<[f64; 2], &'static str> {
        let [x, y] = at;
        let (radius, angle) = (x.hypot(y), y.atan2(x));
        let is_origin = x == 0.0 && y == 0.0;
        let of = |radius: f64, angle: f64| [radius * angle.cos(), radius * angle.sin()];
        let turn = self.angle_deg.map(f64::to_radians);
        match (incremental, self.radius, turn) {
            (false, Some(radius), Some(angle)) => Ok(of(radius, angle)),
            (false, Some(_), None) if is_origin => {
                Err("a radius (@) without an angle (^) where the tool is at the origin")
            }
            (false, Some(radius), None) => Ok(of(radius, angle)),
            (false, None, Some(angle)) => Ok(of(radius, angle)),
            (true, ..) if is_origin => {
                Err("incremental polar words (G91) where the tool is at the origin")
            }
            (true, more, turn) => {
                // First the radius, then the angle.
                Ok(of(
                    radius + more.unwrap_or(0.0),
                    angle + turn.unwrap_or(0.0),
                ))
            }
            (false, None, None) => Ok(at),
        }
    }
}

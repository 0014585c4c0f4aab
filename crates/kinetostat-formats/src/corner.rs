//! The rounding or the chamfer between two straight lines in a plane, and the rounding between a line and an arc.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;

/// Transition in place of a corner, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cut {
    /// An arc of this radius, tangential to both lines.
    Rounded(f64),
    /// A line that takes so much of each side.
    Sides(f64),
    /// A line of this length.
    Length(f64),
}

/// Resulting corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// End of the first line and start of the second one, mm.
    pub ends: [Vector2<f64>; 2],
    /// 1 where the path turns to the left, -1 to the right.
    pub sense: f64,
}

/// Ways that turn by less than this, or turn back as nearly, have no corner, rad.
const LEAST_TURN: f64 = 1e-6;

/// Tolerated excess of a side or a rounding over the length of its line, mm: rounding of digits.
const ROUNDING_MM: f64 = 1e-6;

/// The sentence of a corner that is refused.
pub(crate) fn not_followed(why: &str) -> String {
    format!("the corner is not followed by what is known here: {why}")
}

impl Corner {
    /// Between lines from one place over the corner to another.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn cut([from, at, to]: [Vector2<f64>; 3], cut: Cut) -> Result<Self, String> {
        let size = match cut {
            Cut::Rounded(size) | Cut::Sides(size) | Cut::Length(size) => size,
        };
        if !(size > 0.0 && size.is_finite()) {
            return Err("its size is not above zero".to_owned());
        }
        let (back, on) = (from - at, to - at);
        let (Some(u), Some(v)) = (back.try_normalize(1e-9), on.try_normalize(1e-9)) else {
            return Err("one of the lines at the corner has no length in the plane".to_owned());
        };
        let inner = u.perp(&v).abs().atan2(u.dot(&v));
        let turn = PI - inner;
        if turn < LEAST_TURN || inner < LEAST_TURN {
            return Err("the lines at the corner go straight on, or back on themselves".to_owned());
        }
        let side = match cut {
            Cut::Rounded(radius) => radius / (0.5 * inner).tan(),
            Cut::Sides(side) => side,
            Cut::Length(length) => 0.5 * length / (0.5 * inner).sin(),
        };
        for line in [back.norm(), on.norm()] {
            if side > line + ROUNDING_MM {
                return Err(format!(
                    "it takes {side:.4} mm of a line at the corner that is {line:.4} mm long"
                ));
            }
        }
        Ok(Self {
            ends: [at + u * side, at + v * side],
            // From `from` to the corner and on.
            sense: match u.perp(&v) < 0.0 {
                true => 1.0,
                false => -1.0,
            },
        })
    }
}

/// An arc beside a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Beside {
    pub centre: Vector2<f64>,
    /// Angle of the arc, anticlockwise, rad.
    pub angle: f64,
}

/// A way beside a corner, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leg {
    pub from: Vector2<f64>,
    pub to: Vector2<f64>,
    /// Arc; `None` for a straight line.
    pub arc: Option<Beside>,
}

fn left(direction: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-direction.y, direction.x)
}

impl Leg {
    fn sense(&self) -> f64 {
        self.arc.map_or(0.0, |arc| arc.angle.signum())
    }

    /// Direction at its end, or at its start.
    fn direction(&self, at: Vector2<f64>) -> Option<Vector2<f64>> {
        match self.arc {
            None => (self.to - self.from).try_normalize(1e-9),
            Some(arc) => Some(left((at - arc.centre).try_normalize(1e-9)?) * self.sense()),
        }
    }

    /// The place of it that is nearest to another one, and how far that is along it, mm.
    fn nearest(&self, to: Vector2<f64>) -> Option<(Vector2<f64>, f64)> {
        match self.arc {
            None => {
                let along = self.direction(self.to)?;
                let share = along.dot(&(to - self.from));
                Some((self.from + along * share, share))
            }
            Some(arc) => {
                let start = self.from - arc.centre;
                let out = (to - arc.centre).try_normalize(1e-9)? * start.norm();
                let turned =
                    (self.sense() * start.perp(&out).atan2(start.dot(&out))).rem_euclid(TAU);
                // A hair before its start.
                let turned = match turned * start.norm() > TAU * start.norm() - ROUNDING_MM {
                    true => turned - TAU,
                    false => turned,
                };
                Some((arc.centre + out, turned * start.norm()))
            }
        }
    }

    /// Length, mm.
    fn length(&self) -> f64 {
        match self.arc {
            None => (self.to - self.from).norm(),
            Some(arc) => arc.angle.abs() * (self.from - arc.centre).norm(),
        }
    }
}

/// The rounding of a corner between a straight line and an arc, one way or the other.
///
/// # Errors
/// Why there is none.
pub(crate) fn rounding(legs: [Leg; 2], radius: f64) -> Result<Corner, String> {
    if !(radius > 0.0 && radius.is_finite()) {
        return Err("its size is not above zero".to_owned());
    }
    let at = legs[0].to;
    let no_length = || "one of the ways at the corner has no length in the plane".to_owned();
    let [before, behind] = legs.map(|leg| leg.direction(at));
    let (before, behind) = before.zip(behind).ok_or_else(no_length)?;
    let turn = before.perp(&behind).atan2(before.dot(&behind));
    if turn.abs() < LEAST_TURN || turn.abs() > PI - LEAST_TURN {
        return Err("the ways at the corner go straight on, or back on themselves".to_owned());
    }
    let sense = turn.signum();
    let (line, arc) = match legs.map(|leg| leg.arc) {
        [None, Some(arc)] => ((before, legs[1]), arc),
        [Some(arc), None] => ((behind, legs[0]), arc),
        _ => return Err("it is not between a straight line and an arc".to_owned()),
    };
    let (direction, curved) = line;
    // The centre of the rounding is at the distance of the radius from the line, on the inner side, and from the circle.
    let size = (at - arc.centre).norm();
    let from_centre = match curved.sense() == sense {
        true => size - radius,
        false => size + radius,
    };
    let beside = at + left(direction) * (sense * radius);
    let out = beside - arc.centre;
    let across = out.perp(&direction);
    let half_squared = from_centre * from_centre - across * across;
    if from_centre <= 0.0 || half_squared < 0.0 {
        return Err("its radius is too large for the arc at the corner".to_owned());
    }
    let foot = arc.centre + left(direction) * -across;
    let half = half_squared.sqrt();
    let mut found: Option<(f64, Corner)> = None;
    for centre in [foot + direction * half, foot - direction * half] {
        let [first, second] = legs.map(|leg| leg.nearest(centre));
        let (Some((first, to_first)), Some((second, to_second))) = (first, second) else {
            continue;
        };
        let on_first = (-ROUNDING_MM..=legs[0].length()).contains(&to_first);
        let on_second = (0.0..=legs[1].length() + ROUNDING_MM).contains(&to_second);
        let away = (centre - at).norm();
        if on_first && on_second && found.is_none_or(|(least, _)| away < least) {
            let ends = [first, second];
            found = Some((away, Corner { ends, sense }));
        }
    }
    let corner = found.map(|(_, corner)| corner);
    corner.ok_or_else(|| "it takes more of a way at the corner than there is".to_owned())
}

impl Leg {
    /// Rest of the leg from a point on it.
    pub(crate) fn rest_from(&self, place: Vector2<f64>) -> Self {
        let arc = self
            .arc
            .zip(self.nearest(place))
            .map(|(arc, (_, turned))| Beside {
                angle: arc.angle - self.sense() * turned / (self.from - arc.centre).norm(),
                ..arc
            });
        Self {
            from: place,
            to: self.to,
            arc,
        }
    }
}

//! Planes, and circles in them: about a pole, by a radius, tangential.

use std::f64::consts::TAU;

use kinetostat_program::{NearlyClosed, angle_about};
use nalgebra::{Rotation2, Vector2, Vector3};

/// An arc in the programmed axes, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arc {
    pub centre: Vector2<f64>,
    /// Anticlockwise seen from above, rad.
    pub angle: f64,
}

/// Farthest that radii of start and end differ, mm: a little more than the control's usual 0.016.
const RADIUS_MM: f64 = 0.02;
/// Radii and chords smaller than this are none.
const SAME_MM: f64 = 1e-4;

/// Remedy of a circle that is geometrically impossible.
pub(crate) const AGAIN: &str = "let the CAM system write the circle again";

impl Arc {
    /// The direction in which it ends.
    pub(crate) fn last_direction(&self, end: &Vector2<f64>) -> Option<Vector2<f64>> {
        let arm = (end - self.centre).try_normalize(1e-9)?;
        Some(Vector2::new(-arm.y, arm.x) * self.angle.signum())
    }
}

/// Angle of an arc about a centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Turned {
    /// Angle, rad.
    By(f64),
    /// To its end, in the sense 1 anticlockwise, -1 clockwise; words of so fine a last digit state that, mm.
    ToEnd { sense: f64, digit_mm: f64 },
}

/// Arc about a centre from a place to another. A full turn if both are the same.
///
/// # Errors
/// Where they lie on no circle about the centre, or it is not sure whether that is a whole turn; what to do.
pub(crate) fn about(
    centre: Vector2<f64>,
    from: &Vector2<f64>,
    to: &Vector2<f64>,
    turned: Turned,
) -> Result<Arc, (String, &'static str)> {
    let (a, b) = (from - centre, to - centre);
    let (first, last) = (a.norm(), b.norm());
    let fits = (first - last).abs() <= RADIUS_MM && first > SAME_MM;
    if !fits {
        return Err((
            format!("the circle has radius {first:.4} mm at its start and {last:.4} mm at its end"),
            AGAIN,
        ));
    }
    let angle = match turned {
        Turned::By(angle) => angle,
        Turned::ToEnd { sense, digit_mm } => {
            let angle = angle_about(a.into(), b.into(), sense, digit_mm)
                .map_err(|nearly| (nearly.to_string(), NearlyClosed::REMEDY))?;
            sense * angle
        }
    };
    Ok(Arc { centre, angle })
}

/// Arc by a radius, negative for more than half a turn.
///
/// # Errors
/// No circle of this radius passes through both points.
pub(crate) fn by_radius(
    from: &Vector2<f64>,
    to: &Vector2<f64>,
    radius_mm: f64,
    sense: f64,
) -> Result<Arc, String> {
    let chord = to - from;
    let (length, radius) = (chord.norm(), radius_mm.abs());
    if !(length > SAME_MM && radius > SAME_MM && 0.5 * length <= radius + RADIUS_MM) {
        return Err(format!(
            "no circle of radius {radius:.4} mm goes through two places {length:.4} mm apart"
        ));
    }
    let height = (radius * radius - 0.25 * length * length).max(0.0).sqrt();
    let left = Vector2::new(-chord.y, chord.x) / length;
    // The centre of a short arc to the left is on the left.
    let side = sense * radius_mm.signum();
    let centre = from + 0.5 * chord + left * (side * height);
    let short = 2.0 * (0.5 * length / radius).min(1.0).asin();
    let turned = match radius_mm > 0.0 {
        true => short,
        false => TAU - short,
    };
    Ok(Arc {
        centre,
        angle: sense * turned,
    })
}

/// Tangential to a direction; none where that is a straight line.
///
/// # Errors
/// Where the way would turn back on itself.
pub(crate) fn tangential(
    from: &Vector2<f64>,
    to: &Vector2<f64>,
    direction: &Vector2<f64>,
) -> Result<Option<Arc>, String> {
    let chord = to - from;
    let left = Vector2::new(-direction.y, direction.x);
    let (across, along) = (left.dot(&chord), direction.dot(&chord));
    if chord.norm() < SAME_MM {
        return Err("the arc ends where it begins".to_owned());
    }
    if across.abs() < 1e-7 * chord.norm() {
        return match along > 0.0 {
            true => Ok(None),
            false => Err("the arc would turn back on itself".to_owned()),
        };
    }
    let radius = chord.norm_squared() / (2.0 * across);
    Ok(Some(Arc {
        centre: from + left * radius,
        angle: 2.0 * across.atan2(along),
    }))
}

/// A place by its radius and its angle from a pole, degrees from X.
pub(crate) fn polar(pole: &Vector2<f64>, radius_mm: f64, degrees: f64) -> Vector2<f64> {
    pole + Rotation2::new(degrees.to_radians()) * Vector2::new(radius_mm, 0.0)
}

/// A plane by the number of the axis across it: Y and Z, Z and X, or X and Y. Angles count from the first of its axes to the second, and
/// DR+ turns so, too: HEIDENHAIN, TNC 640, user's manual, Klartext programming, "Polar coordinates: zero point, pole and angle
/// reference axis", table of planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Plane(pub usize);

/// Plane across the tool axis Z.
pub(crate) const XY: Plane = Plane(2);

impl Default for Plane {
    fn default() -> Self {
        XY
    }
}

impl Plane {
    /// The numbers of its axes.
    pub(crate) fn axes(self) -> [usize; 2] {
        [(self.0 + 1) % 3, (self.0 + 2) % 3]
    }

    /// A place in it.
    pub(crate) fn flat(self, place: &Vector3<f64>) -> Vector2<f64> {
        let [u, v] = self.axes();
        Vector2::new(place[u], place[v])
    }

    /// Projects a position whose third coordinate may be unknown.
    pub(crate) fn known(self, place: [Option<f64>; 3]) -> Option<Vector2<f64>> {
        let [u, v] = self.axes();
        Some(Vector2::new(place[u]?, place[v]?))
    }

    /// A place of its two coordinates and that across.
    pub(crate) fn place(self, flat: Vector2<f64>, across: f64) -> Vector3<f64> {
        let [u, v] = self.axes();
        let mut place = Vector3::zeros();
        (place[u], place[v], place[self.0]) = (flat.x, flat.y, across);
        place
    }

    /// The direction across.
    pub(crate) fn across(self) -> Vector3<f64> {
        self.place(Vector2::zeros(), 1.0)
    }
}

//! Arcs in the plane: by their centre, their radius, or their opening angle.

use std::f64::consts::TAU;

use kinetostat_program::{NearlyClosed, angle_about};
use nalgebra::Vector3;

/// Words of an arc in a block, in the frame's axes, mm and degrees.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Stated {
    /// Centre along each axis, from the start or, where so said, of the frame.
    pub centre: [Option<(f64, FromStart)>; 3],
    /// CR.
    pub radius: Option<f64>,
    /// AR.
    pub opening: Option<f64>,
    /// Last digit of its words, mm.
    pub digit_mm: f64,
}

/// From where a centre counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FromStart {
    Yes,
    No,
}

/// An arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arc {
    pub centre: Vector3<f64>,
    pub end: Vector3<f64>,
    /// Right-handed about the axis across the plane.
    pub angle_rad: f64,
}

/// Farthest that radii at start and end differ, mm (machine data 21000).
const RADIUS_TOLERANCE_MM: f64 = 0.01;
/// Tolerance of the end point relative to the radius (machine data 21010).
const RADIUS_SHARE: f64 = 1e-3;
/// Radii, steps and chords smaller than this are none.
const SAME_MM: f64 = 1e-6;

/// Reason and remedy of an arc that cannot be computed.
pub(crate) type Reason = (String, &'static str);

/// A reason against which the CAM system alone helps.
pub(crate) fn again(reason: impl Into<String>) -> Reason {
    (reason.into(), "let the CAM system write it again")
}

/// The arc from a place to another; `sense` is 1 for G3 and -1 for G2.
///
/// # Errors
/// Why there is none, and what to do.
pub(crate) fn arc(
    start: Vector3<f64>,
    end: Vector3<f64>,
    has_end: bool,
    normal: usize,
    sense: f64,
    stated: &Stated,
) -> Result<Arc, Reason> {
    let (u, v) = ((normal + 1) % 3, (normal + 2) % 3);
    let flat = |place: &Vector3<f64>| [place[u], place[v]];
    let across = stated.centre[normal].is_some_and(|(by, from)| {
        by.abs() > SAME_MM && from == FromStart::Yes || from == FromStart::No
    });
    if across {
        return Err(again(
            "its centre is stated across the plane of G17, G18 or G19",
        ));
    }
    let centred = stated.centre[u].is_some() || stated.centre[v].is_some();
    let count = usize::from(centred) + usize::from(stated.radius.is_some());
    if count > 1 {
        return Err(again("both a centre and a radius are stated"));
    }
    let ([a0, a1], [b0, b1]) = (flat(&start), flat(&end));
    let chord = (b0 - a0).hypot(b1 - a1);
    let mut end = end;
    let (centre, angle) = if centred {
        let along = |axis: usize| match stated.centre[axis] {
            Some((by, FromStart::Yes)) => start[axis] + by,
            Some((at, FromStart::No)) => at,
            None => start[axis],
        };
        let centre = [along(u), along(v)];
        let from = [a0 - centre[0], a1 - centre[1]];
        let angle = match (stated.opening, has_end) {
            (Some(opening), false) => {
                let angle = opening.to_radians();
                let (sin, cos) = (sense * angle).sin_cos();
                end[u] = centre[0] + cos * from[0] - sin * from[1];
                end[v] = centre[1] + sin * from[0] + cos * from[1];
                angle
            }
            (Some(_), true) => {
                return Err(again("a centre, an end and an opening angle are stated"));
            }
            (None, _) => {
                let to = [b0 - centre[0], b1 - centre[1]];
                let (first, last) = (from[0].hypot(from[1]), to[0].hypot(to[1]));
                let allowed = RADIUS_TOLERANCE_MM.max(RADIUS_SHARE * first);
                if first < SAME_MM || (first - last).abs() > allowed {
                    return Err(again(format!(
                        "the circle has radius {first:.4} at its start and {last:.4} at its end"
                    )));
                }
                angle_about(from, to, sense, stated.digit_mm)
                    .map_err(|nearly| (nearly.to_string(), NearlyClosed::REMEDY))?
            }
        };
        (centre, angle)
    } else {
        if chord < SAME_MM {
            return Err(again("its end is its start, and no centre is stated"));
        }
        let angle = opened(chord, stated).map_err(again)?;
        // Left of the way where the arc turns to the left by less than half a turn.
        let aside = sense * 0.5 / (0.5 * angle).tan();
        let centre = [
            0.5 * (a0 + b0) - aside * (b1 - a1),
            0.5 * (a1 + b1) + aside * (b0 - a0),
        ];
        (centre, angle)
    };
    let mut place = start;
    place[u] = centre[0];
    place[v] = centre[1];
    Ok(Arc {
        centre: place,
        end,
        angle_rad: sense * angle,
    })
}

/// The angle of an arc over a chord by its radius or opening angle, rad.
fn opened(chord: f64, stated: &Stated) -> Result<f64, String> {
    match (stated.radius, stated.opening) {
        (Some(radius), None) if radius.abs() < SAME_MM => Err("its radius is zero".to_owned()),
        (Some(radius), None) => {
            let half = 0.5 * chord / radius.abs();
            if half > 1.0 + RADIUS_TOLERANCE_MM / radius.abs() || half.is_nan() {
                return Err(format!(
                    "its ends are {chord:.4} mm apart, which a radius of {} does not reach",
                    radius.abs()
                ));
            }
            let small = 2.0 * half.min(1.0).asin();
            Ok(match radius < 0.0 {
                true => TAU - small,
                false => small,
            })
        }
        (None, Some(opening)) if opening > 0.0 && opening < 360.0 => Ok(opening.to_radians()),
        (None, Some(_)) => Err("its opening angle is not between 0 and 360 degrees".to_owned()),
        (Some(_), Some(_)) => Err("both a radius and an opening angle are stated".to_owned()),
        (None, None) => Err("neither centre nor radius is stated".to_owned()),
    }
}

//! The way of the tool's centre along a contour with RL or RR.
//!
//! The corners are those of the G-code expansion's cutter radius compensation: arcs outside, the meeting of both ways inside. The
//! way to the contour is the control's own: straight to the place square to the contour's first block, and the same at its end
//! (HEIDENHAIN, TNC 640, user's manual, Klartext programming, "Tool radius compensation: contour starts and ends").

use std::fmt::Write as _;

use kinetostat_program::{Curve, Dialect, ExpandOptions, NoSubprograms, expand};
use nalgebra::{Rotation2, Vector2, Vector3};

use crate::heidenhain::arcs::Plane;
use crate::heidenhain::reading::walker::Way;
use crate::heidenhain::state::Aside;
use crate::model::motion::{Motion, MotionKind};

/// A piece of the way, in the programmed axes, mm.
pub(super) struct Piece {
    pub from: Vector3<f64>,
    pub to: Vector3<f64>,
    /// Centre in the plane, and angle, rad.
    pub arc: Option<(Vector2<f64>, f64)>,
}

/// Error in a contour: the index of its block, the reason, the remedy.
pub(super) type Why = (usize, String, String);

/// Ways shorter than this have no direction, mm.
const LEAST_MM: f64 = 1e-6;

/// A motion of the contour in its plane.
struct Leg {
    from: Vector3<f64>,
    to: Vector3<f64>,
    arc: Option<(Vector2<f64>, f64)>,
}

impl Leg {
    fn of(motion: &Motion, way: &Way, plane: Plane) -> Option<Self> {
        let known = |place: [Option<f64>; 3]| Some(Vector3::new(place[0]?, place[1]?, place[2]?));
        let (from, to) = (known(way.start)?, known(way.end)?);
        motion.target.pose()?;
        let arc = match &motion.kind {
            MotionKind::Arc {
                centre_mm,
                angle_rad,
                ..
            } => {
                let centre = plane.flat(&way.datum.programmed(centre_mm));
                Some((centre, angle_rad.abs() * way.turns))
            }
            _ => None,
        };
        Some(Self { from, to, arc })
    }

    /// The direction in which it begins in the plane.
    fn begins(&self, plane: Plane) -> Option<Vector2<f64>> {
        let (from, to) = (plane.flat(&self.from), plane.flat(&self.to));
        let way = match self.arc {
            Some((centre, angle)) => {
                Rotation2::new(0.5 * std::f64::consts::PI * angle.signum()) * (from - centre)
            }
            None => to - from,
        };
        way.try_normalize(LEAST_MM)
    }
}

/// The pieces of each motion of a contour; the first is the way to it.
pub(super) fn centre_line(
    motions: &[Motion],
    ways: &[Way],
    aside: Aside,
    radius_mm: f64,
    plane: Plane,
) -> Result<Vec<Vec<Piece>>, Why> {
    let mut legs = Vec::with_capacity(ways.len());
    for (index, (motion, way)) in motions.iter().zip(ways).enumerate() {
        let why = match Leg::of(motion, way, plane) {
            Some(leg)
                if leg
                    .arc
                    .is_some_and(|(_, angle)| angle.abs() > std::f64::consts::TAU + 1e-9) =>
            {
                "the arc is more than a turn"
            }
            Some(_) if way.plane != plane => "the block is in another plane",
            Some(_) if way.axes.is_some() || way.normals[1].is_some() => {
                "the tool or a rotary axis turns"
            }
            Some(leg) => {
                legs.push(leg);
                continue;
            }
            None => "where the block begins or ends is not known",
        };
        return Err((index, why.to_owned(), AGAIN.to_owned()));
    }
    let first = legs.iter().skip(1).find_map(|leg| leg.begins(plane));
    let (Some(ahead), None) = (first, legs[0].arc) else {
        let why = "no straight block leads to a contour in the plane";
        return Err((
            0,
            why.to_owned(),
            "begin with a line to the contour, and state R0 behind it".to_owned(),
        ));
    };
    let entry = plane.flat(&legs[0].to) - plane.flat(&legs[0].from);
    if entry.norm() < LEAST_MM {
        let why = "the compensation begins without a way in the plane";
        return Err((
            0,
            why.to_owned(),
            "state RL or RR in the line to the contour, and go to the depth before".to_owned(),
        ));
    }
    let text = as_gcode(&legs, ahead, aside, radius_mm, plane);
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::LinuxCnc;
    let flat = expand(text, &options, &NoSubprograms).map_err(|fault| {
        let index = fault
            .line
            .saturating_sub(HEAD_LINES + 1)
            .min(legs.len() - 1);
        (index, fault.reason, fault.remedy)
    })?;
    let mut pieces: Vec<Vec<Piece>> = legs.iter().map(|_| Vec::new()).collect();
    // The way to the contour begins where the tool is.
    let mut from = legs[0].from;
    for step in &flat.path.moves {
        let line = flat
            .origins
            .get(step.line.saturating_sub(1))
            .map_or(0, |origin| origin.line);
        let Some(own) = line
            .checked_sub(HEAD_LINES + 1)
            .and_then(|at| pieces.get_mut(at))
        else {
            continue;
        };
        let place = |place: &Vector3<f64>| plane.place(place.xy(), place.z);
        let to = place(&step.end);
        let arc = match &step.curve {
            Curve::Line => None,
            Curve::Arc(arc) => Some((arc.centre.xy(), arc.sweep * arc.axis.z.signum())),
        };
        own.push(Piece { from, to, arc });
        from = to;
    }
    match pieces.iter().position(Vec::is_empty) {
        Some(index) => Err((
            index,
            "no way of the tool's centre is left of the block".to_owned(),
            AGAIN.to_owned(),
        )),
        None => Ok(pieces),
    }
}

/// Remedy of a contour that is not followed.
pub(super) const AGAIN: &str = "let the CAM system write the way of the tool's centre with R0";

/// Lines of G-code before the contour.
const HEAD_LINES: usize = 3;

/// The contour in G-code, a motion a line. The line to it begins along the contour's first block, so that it ends square to that.
fn as_gcode(
    legs: &[Leg],
    ahead: Vector2<f64>,
    aside: Aside,
    radius_mm: f64,
    plane: Plane,
) -> String {
    let first = plane.flat(&legs[0].to) - ahead * (2.0 * radius_mm + 1.0);
    let height = |place: &Vector3<f64>| place[plane.0];
    let side = match aside {
        Aside::Left => "G41.1",
        Aside::Right => "G42.1",
    };
    let mut text = format!(
        "G21 G90 G17 G94 F100\nG0 X{:.9} Y{:.9} Z{:.9}\n{side} D{:.9}\n",
        first.x,
        first.y,
        height(&legs[0].to),
        2.0 * radius_mm
    );
    for leg in legs {
        let (from, to) = (plane.flat(&leg.from), plane.flat(&leg.to));
        let code = match leg.arc {
            None => "G1",
            Some((_, angle)) if angle > 0.0 => "G3",
            Some(_) => "G2",
        };
        let _ = write!(
            text,
            "{code} X{:.9} Y{:.9} Z{:.9}",
            to.x,
            to.y,
            height(&leg.to)
        );
        if let Some((centre, _)) = leg.arc {
            let arm = centre - from;
            let _ = write!(text, " I{:.9} J{:.9}", arm.x, arm.y);
        }
        text.push('\n');
    }
    let last = legs.last().map_or(0.0, |leg| height(&leg.to));
    let _ = write!(text, "G40\nG0 Z{:.9}\nM2\n", last + 1.0);
    text
}

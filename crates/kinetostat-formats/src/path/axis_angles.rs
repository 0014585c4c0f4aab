//! How the rotary axes of a machine turn where a program states the direction of the tool's axis alone.
//!
//! Where the axes stand at the end of a motion follows from the direction, and from where they stood before. How they get there is the
//! controller's law: SINUMERIK takes the tool's axis on a great circle (ORIVECT, the basic setting of G group 51; a machine whose MD21104
//! leaves it to ORIWKS does the same) or turns the axes evenly (ORIAXES); the postprocessors to which APT goes divide a motion until
//! the tool's axis stays in the plane of both directions; Heidenhain with M128 turns the axes evenly (PATHCTRL AXIS).

use kinetostat_program::{GreatCircle, OffCircle, RotaryAxes, Unreached};
use nalgebra::Vector3;

use crate::model::motion::Motion;
use crate::model::program::{Language, RobotProgram};
use crate::path::axis_turns::{OVER, axis_of};
use crate::path::fault::PathError;

/// What the rotary axes do in one motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxesOfMotion {
    pub start_deg: Vec<f64>,
    pub end_deg: Vec<f64>,
    /// None where they turn evenly.
    pub great_circle: Option<GreatCircle>,
}

/// Whether the tool's axis goes on a great circle in a motion.
pub(crate) fn on_great_circle(program: &RobotProgram, index: usize) -> bool {
    match program.language {
        Language::Heidenhain => false,
        _ => !program.even_axes.contains(&index),
    }
}

/// What the rotary axes do in every motion; they stay where a motion states no axis.
///
/// Of the angles that point the tool along the axis, those nearest to the ones before, within the limits of the axes; at first, to zero.
pub(crate) fn axes_of_motions(
    program: &RobotProgram,
    rotary: &RotaryAxes,
    is_rapid: impl Fn(&Motion) -> bool,
) -> Result<Vec<AxesOfMotion>, Vec<PathError>> {
    let mut faults = Vec::new();
    let mut last = vec![0.0; rotary.axes.len()];
    let mut stated = false;
    let mut all = Vec::with_capacity(program.motions.len());
    for (index, motion) in program.motions.iter().enumerate() {
        let mut own = AxesOfMotion {
            start_deg: last.clone(),
            end_deg: last.clone(),
            great_circle: None,
        };
        if let Some(axis) = axis_of(program, motion) {
            let follows = stated && motion.follows.is_some();
            match of_motion(
                rotary,
                (&last, &axis),
                follows && on_great_circle(program, index),
            ) {
                Ok(found) => own = found,
                // In air the axes may go over to other angles.
                Err(reason) => match rotary.angles_towards(&axis, &last) {
                    Ok(angles) if is_rapid(motion) => own.end_deg = angles,
                    _ => {
                        faults.push(fault(program, motion, (rotary, &axis), reason));
                        own.end_deg = nearest_of(rotary, &axis, &last);
                    }
                },
            }
            stated = true;
        }
        last.clone_from(&own.end_deg);
        all.push(own);
    }
    match faults.is_empty() {
        true => Ok(all),
        false => Err(faults),
    }
}

fn of_motion(
    rotary: &RotaryAxes,
    (last, axis): (&[f64], &Vector3<f64>),
    on_circle: bool,
) -> Result<AxesOfMotion, OffCircle> {
    if on_circle {
        let circle = GreatCircle::new(rotary, last, axis)?;
        return Ok(AxesOfMotion {
            start_deg: circle.start_deg().to_vec(),
            end_deg: circle.end_deg().to_vec(),
            great_circle: Some(circle),
        });
    }
    match rotary.angles_towards(axis, last) {
        Ok(end_deg) => Ok(AxesOfMotion {
            start_deg: last.to_vec(),
            end_deg,
            great_circle: None,
        }),
        Err(reason) => Err(OffCircle::Unreached(*axis, reason)),
    }
}

/// Angles to go on with behind a fault: what follows is not wrong for that.
fn nearest_of(rotary: &RotaryAxes, axis: &Vector3<f64>, last: &[f64]) -> Vec<f64> {
    match rotary.angles_towards(axis, last) {
        Ok(angles) | Err(Unreached::Limits(angles)) => angles,
        Err(Unreached::Direction) => last.to_vec(),
    }
}

fn fault(
    program: &RobotProgram,
    motion: &Motion,
    (rotary, end): (&RotaryAxes, &Vector3<f64>),
    reason: OffCircle,
) -> PathError {
    let along = |axis: &Vector3<f64>| format!("({:.4}, {:.4}, {:.4})", axis.x, axis.y, axis.z);
    let (reason, remedy) = match reason {
        OffCircle::Opposite => (OVER.0.to_owned(), "let the CAM system write a pose between"),
        OffCircle::Unreached(axis, Unreached::Direction) => (
            format!(
                "the rotary axes of the machine do not point the tool along {}",
                along(&axis)
            ),
            "check directions and words of the axes in the model ([[rotary_axis]]), and which axes the part has",
        ),
        OffCircle::Unreached(axis, Unreached::Limits(angles)) => {
            let outside = rotary.words_of_limits(&angles);
            match (axis - end).norm() > SAME {
                false => (
                    format!("to point the tool along {}, {outside}", along(&axis)),
                    "let the CAM system tilt the tool less, or the other way round behind a rapid; or state other limits of the axis, if it has them (limits_deg of [[rotary_axis]], or of its joint)",
                ),
                true => (
                    format!(
                        "on the way to the direction {} {outside}; with other angles the tool would leave its way",
                        along(end)
                    ),
                    "let the CAM system retract before it and turn the axes over in a rapid; or state other limits of the axis, if it has them (limits_deg of [[rotary_axis]], or of its joint)",
                ),
            }
        }
    };
    PathError {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason,
        remedy: remedy.to_owned(),
    }
}

/// Directions nearer than this are one.
const SAME: f64 = 1e-9;

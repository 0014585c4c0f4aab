//! Motion of the rotary axes of a machine whose program states their angles, or the tool axis alone.
//!
//! Where the axes stand at the end of a motion follows from the direction, and from where they stood before. How they get there is the
//! controller's law: SINUMERIK takes the tool's axis on a great circle (ORIVECT, the basic setting of G group 51; a machine whose MD21104
//! leaves it to ORIWKS does the same) or turns the axes evenly (ORIAXES); the postprocessors to which APT goes divide a motion until
//! the tool's axis stays in the plane of both directions; Heidenhain with M128 turns the axes evenly (PATHCTRL AXIS). Angles end where
//! they are stated, and on the way the same laws hold.

use kinetostat_program::{GreatCircle, OffCircle, RotaryAxes, StatedBy, Unreached};
use nalgebra::Vector3;

use crate::model::motion::Motion;
use crate::model::program::{AxesStated, RobotProgram};
use crate::path::axis_turns::{OVER, axis_of};
use crate::path::{PathError, fault_at};

/// Motion of the rotary axes in one motion of the program.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxesOfMotion {
    pub start_deg: Vec<f64>,
    pub end_deg: Vec<f64>,
    /// Great circle of the tool axis; `None` if the rotary axes turn evenly.
    pub great_circle: Option<GreatCircle>,
    /// Source of the axis positions in the program.
    pub stated: StatedBy,
}

/// True if the tool axis moves on a great circle in a motion.
pub(crate) fn on_great_circle(program: &RobotProgram, index: usize) -> bool {
    program.language.goes_on_great_circles() && !program.rotary.even.contains(&index)
}

/// Positions of the rotary axes in every motion; they stay if a motion states no axis. They are unknown where a program that states angles omits
/// them.
///
/// Among the angles that point the tool along the axis, those nearest to the previous ones within the axis limits apply; at first,
/// those nearest to zero.
pub(crate) fn axes_of_motions(
    program: &RobotProgram,
    rotary: &RotaryAxes,
    is_rapid: impl Fn(&Motion) -> bool,
) -> Result<Vec<Option<AxesOfMotion>>, Vec<PathError>> {
    let mut faults = Vec::new();
    let mut last = vec![0.0; rotary.axes.len()];
    let mut stated = false;
    let has_angles = program.rotary.has_angles();
    let mut all = Vec::with_capacity(program.motions.len());
    for (index, motion) in program.motions.iter().enumerate() {
        match program.rotary.motions.get(&index).filter(|_| has_angles) {
            Some(AxesStated::Open) => {
                all.push(None);
                continue;
            }
            Some(AxesStated::Angles { start, end }) => {
                let on_circle = on_great_circle(program, index) && motion.follows.is_some();
                let (own, why_not) = by_angles(rotary, [start, end], on_circle);
                // In air the axes may go over to other angles.
                if let Some((reason, remedy)) = why_not.filter(|_| !is_rapid(motion)) {
                    faults.push(fault_at(program, motion, reason, remedy));
                }
                stated = true;
                last.clone_from(&own.end_deg);
                all.push(Some(own));
                continue;
            }
            None => {}
        }
        let mut own = AxesOfMotion {
            start_deg: last.clone(),
            end_deg: last.clone(),
            great_circle: None,
            stated: StatedBy::Direction,
        };
        if let Some(axis) = axis_of(program, motion) {
            let follows = stated && motion.follows.is_some();
            match of_motion(
                rotary,
                &last,
                &axis,
                follows && on_great_circle(program, index),
            ) {
                Ok(found) => own = found,
                // In air the axes may go over to other angles.
                Err(reason) => match rotary.angles_towards(&axis, &last) {
                    Ok(angles) if is_rapid(motion) => own.end_deg = angles,
                    _ => {
                        faults.push(fault(program, motion, rotary, &axis, reason));
                        own.end_deg = nearest_of(rotary, &axis, &last);
                    }
                },
            }
            stated = true;
        }
        last.clone_from(&own.end_deg);
        all.push(Some(own));
    }
    match faults.is_empty() {
        true => Ok(all),
        false => Err(faults),
    }
}

fn of_motion(
    rotary: &RotaryAxes,
    last: &[f64],
    axis: &Vector3<f64>,
    on_circle: bool,
) -> Result<AxesOfMotion, OffCircle> {
    if on_circle {
        let circle = GreatCircle::new(rotary, last, axis)?;
        return Ok(AxesOfMotion {
            start_deg: circle.start_deg().to_vec(),
            end_deg: circle.end_deg().to_vec(),
            great_circle: Some(circle),
            stated: StatedBy::Direction,
        });
    }
    match rotary.angles_towards(axis, last) {
        Ok(end_deg) => Ok(AxesOfMotion {
            start_deg: last.to_vec(),
            end_deg,
            great_circle: None,
            stated: StatedBy::Direction,
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
    rotary: &RotaryAxes,
    end: &Vector3<f64>,
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
    fault_at(program, motion, reason, remedy)
}

/// Interpolation of the axes between stated angles, and the reason why it is not the required great circle.
fn by_angles(
    rotary: &RotaryAxes,
    [start, end]: [&Vec<f64>; 2],
    on_circle: bool,
) -> (AxesOfMotion, Option<(String, &'static str)>) {
    let mut own = AxesOfMotion {
        start_deg: start.clone(),
        end_deg: end.clone(),
        great_circle: None,
        stated: StatedBy::Angles,
    };
    let tool_axis = rotary.tool_at_zero.inverse() * Vector3::z();
    let [from, to] = [start, end].map(|angles| rotary.tool_direction_at(angles, &tool_axis));
    if !on_circle || (from - to).norm() < SAME {
        return (own, None);
    }
    const EVENLY: &str = "write ORIAXES where the machine turns each axis evenly, or let the CAM system write a block between";
    let why = match GreatCircle::new(rotary, start, &to) {
        Ok(circle) => {
            let both = circle.end_deg().iter().zip(end);
            if both.into_iter().all(|(a, b)| (a - b).abs() < SAME_DEG) {
                own.start_deg = circle.start_deg().to_vec();
                own.great_circle = Some(circle);
                return (own, None);
            }
            format!(
                "the tool's axis goes on the great circle (ORIVECT, the basic setting), and so the axes come to {}, not to {}",
                words_of_angles(rotary, circle.end_deg()),
                words_of_angles(rotary, end)
            )
        }
        Err(OffCircle::Opposite) => OVER.0.to_owned(),
        Err(OffCircle::Unreached(_, Unreached::Limits(angles))) => format!(
            "the tool's axis goes on the great circle (ORIVECT, the basic setting), and on it {}",
            rotary.words_of_limits(&angles)
        ),
        Err(OffCircle::Unreached(_, Unreached::Direction)) => {
            "the axes of the machine do not follow the great circle on which the tool's axis goes (ORIVECT, the basic setting)".to_owned()
        }
    };
    (own, Some((why, EVENLY)))
}

fn words_of_angles(rotary: &RotaryAxes, angles: &[f64]) -> String {
    let each = rotary.axes.iter().zip(angles);
    let words: Vec<String> = each
        .map(|(axis, angle)| format!("{}{angle:.3}", axis.letter))
        .collect();
    words.join(" ")
}

/// Angles that differ by less are one, deg: what the arithmetic of directions leaves.
const SAME_DEG: f64 = 1e-4;

/// Directions nearer than this are one.
const SAME: f64 = 1e-9;

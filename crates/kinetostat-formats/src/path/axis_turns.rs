//! Orientation of a tool whose program states the direction of its axis alone.
//!
//! APT (`GOTO/x,y,z,i,j,k`), SINUMERIK (`A3 B3 C3`), Heidenhain (`TX TY TZ`) and lists of poses with `i, j, k` say where the axis
//! points, and not how the tool is turned about it. For a round tool that does not matter in the cut; for the arm that holds it
//! it does: another turn is another posture. So a rule says it, for every pose of the program, from the numbers of the text alone:
//! what was written is read again by the same rule.

use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::path::PathError;

/// Rule for the rotation of the tool about its axis, for programs that state the axis alone.
///
/// Between two poses the tool's axis goes on the great circle, evenly with the way, as with `ORIVECT` of SINUMERIK; and the tool turns
/// evenly about it.
///
/// ```
/// use kinetostat_formats::*;
/// use nalgebra::Vector3;
///
/// let text = "UNITS/MM\nGOTO/0,0,0,0,0,1\nGOTO/100,0,0,0.6,0,0.8\nGOTO/200,0,0,0,0.6,0.8\n";
/// let program = read_apt(vec![SourceFile::new("a.apt", text)], &ReadOptions::default()).unwrap();
/// let mut options = PathOptions::default();
/// options.turn_about_axis = TurnAboutAxis::Towards { of_tool: Vector3::x(), in_part: Vector3::x() };
/// let robot = path_of(&program, &options).unwrap();
/// // The tool's axis is that of the text, ...
/// let last = &robot.path.moves[2];
/// assert!((robot.path.tool_direction(2, 1.0) - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-12);
/// // ... and its x lies as near as possible to x of the part: it is x, at right angles to the axis.
/// let x = last.orientation(1.0).unwrap() * Vector3::x();
/// assert!((x - Vector3::x()).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum TurnAboutAxis {
    /// Minimal rotation: from pose to pose the tool turns by the least rotation that brings its axis over. It begins as the least
    /// rotation from z of the work object leaves it, where its x (y if its axis is x) lies along x of the work object; so it does again
    /// behind a rapid to the opposite axis.
    #[default]
    Least,
    /// Alignment: at every pose a direction of the tool lies as near as possible to one of the work object.
    Towards {
        /// Direction in axes of the tool's frame, not along the tool axis.
        of_tool: Vector3<f64>,
        /// Direction in axes of the work object; the tool axis never points along it.
        in_part: Vector3<f64>,
    },
}

/// Axes nearer to z of the part than this are z: the program is one of positions.
pub(crate) const ALONG_Z: f64 = 1e-9;

/// Directions that lie nearer than this to the axis say no turn about it (1.1 degrees).
const ALONG_AXIS: f64 = 0.02;

/// Axes that are as opposite as this have no shortest way from one to the other.
const OPPOSITE: f64 = 1e-6;

/// True if the pose of a motion states the direction of the tool axis, but not the rotation about it.
pub(crate) fn is_by_axis(program: &RobotProgram, motion: &Motion) -> bool {
    let by_language = !program.language.states_turn();
    let by_text = matches!(&motion.site.target, TargetSite::Literal(text) if text.convention == OrientationText::Axis);
    motion.target.pose().is_some() && (by_language || by_text)
}

/// The axis at the end of a motion, in axes of its work object; none where the motion states more, or nothing.
pub(crate) fn axis_of(program: &RobotProgram, motion: &Motion) -> Option<Vector3<f64>> {
    let pose = motion
        .target
        .pose()
        .filter(|_| is_by_axis(program, motion))?;
    Some(pose.orientation * Vector3::z())
}

/// The first motion whose tool leans from z of its work object, where the axis alone is stated.
pub(crate) fn first_leaning(program: &RobotProgram) -> Option<&Motion> {
    let leans = |axis: Vector3<f64>| (axis - Vector3::z()).norm() > ALONG_Z;
    let mut motions = program.motions.iter();
    motions.find(|motion| axis_of(program, motion).is_some_and(leans))
}

/// The first motion whose tool leans from z of the robot's base, where the axis alone is stated, or nothing: z of its work object then.
///
/// In axes of the base the tool does not lie along z for that: the path of a program with several work objects is in these axes.
pub(crate) fn first_leaning_in_base(program: &RobotProgram) -> Option<&Motion> {
    let leans = |motion: &&Motion| {
        let axis = axis_of(program, motion).zip(motion.work_object.known());
        axis.is_some_and(|(axis, frame)| (frame * axis - Vector3::z()).norm() > ALONG_Z)
    };
    program.motions.iter().find(leans)
}

/// The orientation that takes the tool's axis to a direction, and a direction of the tool as near as possible to another one; none
/// where one of these lies along its axis.
fn standing(
    tool_axis: Vector3<f64>,
    of_tool: Vector3<f64>,
    axis: Vector3<f64>,
    in_part: Vector3<f64>,
) -> Option<UnitQuaternion<f64>> {
    let frame = |axis: Vector3<f64>, beside: Vector3<f64>| {
        let axis = axis.try_normalize(f64::MIN_POSITIVE)?;
        let beside = beside.try_normalize(f64::MIN_POSITIVE)?;
        let across = beside - axis * axis.dot(&beside);
        let across = across.try_normalize(ALONG_AXIS)?;
        Some(Matrix3::from_columns(&[axis, across, axis.cross(&across)]))
    };
    let matrix = frame(axis, in_part)? * frame(tool_axis, of_tool)?.transpose();
    let rotation = Rotation3::from_matrix_unchecked(matrix);
    Some(UnitQuaternion::from_rotation_matrix(&rotation))
}

/// Initial orientation with the tool axis along z of the part.
pub(crate) fn at_z(tool_axis: Vector3<f64>) -> UnitQuaternion<f64> {
    let towards_x = |of_tool| standing(tool_axis, of_tool, Vector3::z(), Vector3::x());
    let made = towards_x(Vector3::x()).or_else(|| towards_x(Vector3::y()));
    made.unwrap_or_default()
}

/// Initial orientation with the tool axis as at the first pose.
fn begun(tool_axis: Vector3<f64>, axis: Vector3<f64>) -> UnitQuaternion<f64> {
    let half = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    least(&Vector3::z(), &axis).unwrap_or(half) * at_z(tool_axis)
}

/// The least rotation that brings a direction to another one; none where they are opposite.
fn least(from: &Vector3<f64>, to: &Vector3<f64>) -> Option<UnitQuaternion<f64>> {
    match (from + to).norm() < OPPOSITE {
        true => None,
        false => UnitQuaternion::rotation_between(from, to),
    }
}

/// The orientation at the end of every motion in axes of the path, none of a motion that does not state the axis alone.
///
/// `to_path` turns the axes of a motion's work object into those of the path.
pub(crate) fn axis_turns(
    program: &RobotProgram,
    rule: TurnAboutAxis,
    tool_axis: Vector3<f64>,
    to_path: impl Fn(&Motion) -> Isometry3<f64>,
    is_rapid: impl Fn(&Motion) -> bool,
) -> Result<Vec<Option<UnitQuaternion<f64>>>, Vec<PathError>> {
    let mut faults = Vec::new();
    let mut last: Option<UnitQuaternion<f64>> = None;
    let mut turns = Vec::with_capacity(program.motions.len());
    for motion in &program.motions {
        let Some(axis) = axis_of(program, motion) else {
            turns.push(None);
            continue;
        };
        let frame = to_path(motion).rotation;
        let made = match (rule, last) {
            (TurnAboutAxis::Towards { of_tool, in_part }, _) => {
                let made = standing(tool_axis, of_tool, axis, in_part);
                made.map(|made| frame * made).ok_or(ALONG)
            }
            (TurnAboutAxis::Least, Some(before)) => {
                match least(&(before * tool_axis), &(frame * axis)) {
                    Some(turn) => Ok(turn * before),
                    // The rule starts again in air.
                    None if is_rapid(motion) => Ok(frame * begun(tool_axis, axis)),
                    None => Err(OVER),
                }
            }
            (TurnAboutAxis::Least, None) => Ok(frame * begun(tool_axis, axis)),
        };
        match made {
            Ok(made) => last = Some(made),
            Err((reason, remedy)) => {
                faults.push(PathError {
                    file: program.files[motion.file].name().to_owned(),
                    line: motion.line,
                    reason: reason.to_owned(),
                    remedy: remedy.to_owned(),
                });
                // Later poses are checked independently of this fault.
                last = Some(frame * begun(tool_axis, axis));
            }
        }
        turns.push(last);
    }
    match faults.is_empty() {
        true => Ok(turns),
        false => Err(faults),
    }
}

pub(crate) const OVER: (&str, &str) = (
    "the tool's axis turns to its opposite here, and over which side it goes is not stated",
    "let the CAM system write a pose between, or state how the tool turns about its axis (`turn_about_axis`)",
);

const ALONG: (&str, &str) = (
    "the tool's axis points along the direction that the tool is turned towards, so that this says no turn about it",
    "state another direction (`turn_about_axis`)",
);

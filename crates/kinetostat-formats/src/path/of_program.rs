//! From the motions of a program to a path.

use kinetostat_program::{
    CoordinateWords, Curve, Feed, FeedMode, Knowledge, Move, MoveKind, Path, ToolTurn, Warning,
};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};

use crate::model::frame::FrameUse;
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::orientation::OrientationText;
use crate::model::program::{Language, RobotProgram};
use crate::model::site::{PoseText, TargetSite};
use crate::model::target::Target;
use crate::path::circle::{about, through};
use crate::path::fault::PathError;
use crate::path::options::PathOptions;
use crate::path::tools::{changes, same_frame, tools_of};

/// So many places say whether a program is small, ...
const SEVERAL: usize = 8;

/// ... as one of 3 m in metres is where its lengths are taken for millimetres.
const METRES_AS_MM: f64 = 3.0;

/// The path of a robot's program, and in which axes it is.
///
/// Motions with poses are moves; those to joint values are moves of which nothing is known, and so is the start of what
/// follows them. Joint motions to poses count as rapids, linear and circular ones as feeds.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RobotPath {
    /// Moves in the order in which they run. Their lines are those of the file that holds the motions.
    pub path: Path,
    /// Motion of every move, an index of [`RobotProgram::motions`].
    pub motions: Vec<usize>,
    /// Work object of the program, in whose axes the path is; `None` where the program uses several, and the path is in the
    /// axes of the robot's base.
    pub work_object: Option<FrameUse>,
    /// The tools that poses are of, in the order in which they are first used; of several, [`Path::tool_changes`] names them by
    /// [`crate::tool_number`].
    pub tools: Vec<FrameUse>,
    /// The file with the motions, an index of [`RobotProgram::files`].
    pub file: usize,
}

/// The path of a program.
///
/// ```
/// use kinetostat_formats::*;
///
/// let text = "MODULE M\nPROC main()\n\
///     MoveJ [[0,0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0;\n\
///     MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
///     MoveC [[5,5,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\
///     [[10,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\n\
///     ENDPROC\nENDMODULE\n";
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
/// let robot = path_of(&program, &PathOptions::default()).unwrap();
/// assert_eq!(robot.path.moves.len(), 3);
/// assert!((robot.path.moves[2].length_mm() - 5.0 * std::f64::consts::PI).abs() < 1e-9);
/// assert_eq!(robot.path.moves[1].feed.unwrap().value, 1200.0); // mm/min
/// ```
///
/// # Errors
/// All motions that cannot stand in one path: of several tools, of work objects that are not known, in several files.
pub fn path_of(program: &RobotProgram, options: &PathOptions) -> Result<RobotPath, Vec<PathError>> {
    let poses: Vec<&Motion> = (program.motions.iter())
        .filter(|motion| motion.target.pose().is_some())
        .collect();
    let mut faults = Vec::new();
    let file = program.motions.first().map_or(0, |motion| motion.file);
    let fault = |motion: &Motion, reason: String, remedy: &str| PathError {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason,
        remedy: remedy.to_owned(),
    };
    if let Some(other) = program.motions.iter().find(|motion| motion.file != file) {
        faults.push(fault(
            other,
            format!(
                "motions stand in this file and in {}",
                program.files[file].name()
            ),
            "give the files with motions one by one",
        ));
    }
    let tools = tools_of(&poses);
    let in_order = poses.windows(2).all(|pair| pair[0].line <= pair[1].line);
    if let (Some(other), false) = (tools.get(1), in_order) {
        let first = poses.iter().find(|motion| motion.tool.name == other.name);
        faults.extend(first.map(|motion| {
            fault(
                motion,
                format!("the tool `{}` is another one, in a program whose routines do not run in the order of their lines", other.name),
                "write one program for each tool, or the routines in their order",
            )
        }));
    }
    let one = differs(&poses, |motion| &motion.work_object).is_none();
    let work_object = poses.first().map(|motion| motion.work_object.clone());
    if !one {
        for motion in poses.iter().filter(|m| m.work_object.known().is_none()) {
            faults.push(fault(
                motion,
                format!(
                    "the work object `{}` is not known, and the program has another one",
                    motion.work_object.name
                ),
                "state where it is (`frames`)",
            ));
        }
    }
    if let Some(tilted) = poses.iter().find(|motion| leans(motion)) {
        faults.push(fault(
            tilted,
            "the tool's axis is not z of the part here".to_owned(),
            "programs of five axes that state the axis alone are not corrected yet: give those of three axes, or write the program in the language of the robot",
        ));
    }
    faults.extend(poses.iter().filter_map(|motion| {
        let speed = motion
            .speed
            .mm_per_s
            .filter(|speed| !(*speed > 0.0 && speed.is_finite()))?;
        Some(fault(
            motion,
            format!("its speed is {speed} mm/s"),
            "write a speed above zero",
        ))
    }));
    faults.extend(program.motions.windows(2).filter_map(|pair| {
        let [from, to] = [&pair[0], &pair[1]].map(|motion| motion.target.pose());
        let way = to?.position_mm - from?.position_mm;
        let closed = matches!(pair[1].kind, MotionKind::Circular { .. }) && way.norm() < 1e-6;
        closed.then(|| {
            fault(
                &pair[1],
                "a circle through a place that ends where it begins is no circle".to_owned(),
                "write a full turn as two circular motions",
            )
        })
    }));
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut made = Maker {
        program,
        options,
        in_base: !one,
    }
    .path();
    if tools.len() > 1 {
        made.tool_changes = changes(&poses, &tools);
    }
    Ok(RobotPath {
        motions: (0..program.motions.len()).collect(),
        path: made,
        work_object: work_object.filter(|_| one),
        tools,
        file,
    })
}

/// The first motion with another frame than the first one.
fn differs<'m>(poses: &[&'m Motion], frame: fn(&Motion) -> &FrameUse) -> Option<&'m Motion> {
    let first = frame(poses.first()?);
    let other = |motion: &&&Motion| !same_frame(frame(motion), first);
    poses.iter().find(other).copied()
}

struct Maker<'a> {
    program: &'a RobotProgram,
    options: &'a PathOptions,
    /// Poses in the axes of the robot's base.
    in_base: bool,
}

impl Maker<'_> {
    /// From the axes of a motion's work object to those of the path.
    fn frame(&self, motion: &Motion) -> Isometry3<f64> {
        match (self.in_base, motion.work_object.known()) {
            (true, Some(frame)) => *frame,
            _ => Isometry3::identity(),
        }
    }

    fn pose(&self, motion: &Motion, target: &Target) -> Option<Isometry3<f64>> {
        Some(self.frame(motion) * target.pose()?.isometry())
    }

    fn path(&self) -> Path {
        let mut moves: Vec<Move> = Vec::with_capacity(self.program.motions.len());
        let mut warnings = Vec::new();
        let mut last: Option<Isometry3<f64>> = None;
        for (index, motion) in self.program.motions.iter().enumerate() {
            let before = index.checked_sub(1).map(|i| &self.program.motions[i]);
            // Behind a change of tools the new tip is somewhere else.
            let follows = motion.follows.is_some()
                && motion.follows == index.checked_sub(1)
                && before.is_some_and(|before| same_frame(&before.tool, &motion.tool));
            let start = last.filter(|_| follows);
            let made = self.made(motion, start, last.unwrap_or_default());
            if motion.runs == Runs::Elsewhere {
                warnings.push(Warning {
                    line: motion.line,
                    text: "nothing in these files calls the routine of this motion: it is corrected as if it ran by itself"
                        .to_owned(),
                });
            }
            last = self.pose(motion, &motion.target);
            moves.push(made);
        }
        warnings.dedup_by(|b, a| a.text == b.text);
        let begins =
            |motion: &&Move| motion.known == Knowledge::End && motion.kind == MoveKind::Feed;
        if let Some(first) = moves.iter().find(begins) {
            warnings.push(Warning {
                line: first.line,
                text: format!(
                    "where {} begins is not known, here first: behind another tool, behind joint values, in a branch or in what runs more than once. Only the end is corrected, and of a force that turns with the feed only the part along the tool",
                    match moves.iter().filter(begins).count() {
                        1 => "1 motion at feed".to_owned(),
                        n => format!("{n} motions at feed"),
                    }
                ),
            });
        }
        let slow = |motion: &&Motion| {
            motion.kind != MotionKind::Joint
                && motion.target.pose().is_some()
                && motion.speed.mm_per_s.is_none()
        };
        let unknown = self.program.motions.iter().find(slow);
        if let (Some(motion), Some(_)) = (unknown, self.options.rapid_from_mm_per_s) {
            warnings.push(Warning {
                line: motion.line,
                text: format!(
                    "the speed `{}` is not known, here first: such motions are taken to cut",
                    motion.speed.text
                ),
            });
        }
        if let Some(line) = self.tiny() {
            warnings.push(Warning {
                line,
                text: "all places of the program lie within 3 mm of each other: are its lengths in metres? They are taken for millimetres".to_owned(),
            });
        }
        if self.in_base {
            warnings.push(Warning {
                line: 1,
                text: "the program uses several work objects: its places in results, heights of the load and tables of corrections are in axes of the robot's base".to_owned(),
            });
        }
        for finding in &self.program.findings {
            warnings.push(Warning {
                line: finding.line,
                text: finding.message.clone(),
            });
        }
        let mut path = Path::of_moves(moves, self.options.tool_axis);
        path.warnings = warnings;
        path
    }

    /// Line of the first of many places that lie as near to each other as those of a program in metres.
    fn tiny(&self) -> Option<usize> {
        let places = self.program.motions.iter().filter_map(|motion| {
            let pose = self.pose(motion, &motion.target)?;
            Some((motion.line, pose.translation.vector))
        });
        let (mut count, mut first) = (0, None);
        let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
        for (line, place) in places {
            count += 1;
            first.get_or_insert(line);
            (low, high) = (low.inf(&place), high.sup(&place));
        }
        let spread = (high - low).amax();
        first.filter(|_| count >= SEVERAL && spread > 0.0 && spread < METRES_AS_MM)
    }

    fn made(&self, motion: &Motion, start: Option<Isometry3<f64>>, before: Isometry3<f64>) -> Move {
        let end = self.pose(motion, &motion.target);
        let from = start.unwrap_or(before);
        let to = end.unwrap_or(before);
        let [a, b] = [from, to].map(|pose| pose.translation.vector);
        let mut known = match (end, start) {
            (None, _) => Knowledge::Nothing,
            (Some(_), None) => Knowledge::End,
            (Some(_), Some(_)) => Knowledge::Whole,
        };
        let curve = match &motion.kind {
            MotionKind::Circular { via } if known == Knowledge::Whole => {
                match self.pose(motion, via) {
                    Some(via) => {
                        through(&a, &via.translation.vector, &b).map_or(Curve::Line, Curve::Arc)
                    }
                    None => {
                        known = Knowledge::End;
                        Curve::Line
                    }
                }
            }
            MotionKind::Arc {
                centre_mm,
                axis,
                angle_rad,
            } if known == Knowledge::Whole => {
                let frame = self.frame(motion);
                let centre = (frame * Point3::from(*centre_mm)).coords;
                about(&a, &b, &centre, &(frame.rotation * axis), *angle_rad)
                    .map_or(Curve::Line, Curve::Arc)
            }
            _ => Curve::Line,
        };
        // From where it comes is not known: it has no direction, and turns by nothing.
        let (a, from) = match known {
            Knowledge::Whole => (a, from),
            _ => (b, to),
        };
        let fast = |limit: f64| {
            let fastest = motion.speed.text.eq_ignore_ascii_case("vmax");
            fastest || motion.speed.mm_per_s.is_some_and(|speed| speed >= limit)
        };
        // APT says it beside the motion, a machine's control in it.
        let said = match self.program.language {
            Language::Apt => motion.speed.text.to_ascii_uppercase().starts_with("RAPID"),
            Language::Siemens => motion.speed.text == "G0",
            Language::Heidenhain => motion.speed.text == "FMAX",
            _ => false,
        };
        let rapid = motion.kind == MotionKind::Joint
            || motion.target.pose().is_none()
            || said
            || self.options.rapid_from_mm_per_s.is_some_and(fast);
        Move {
            line: motion.line,
            kind: match rapid {
                true => MoveKind::Rapid,
                false => MoveKind::Feed,
            },
            curve,
            start: a,
            end: b,
            tool_turn: states_orientation(motion).then(|| {
                let start = nearest(from.rotation, &to.rotation);
                Box::new(ToolTurn::shortest(start, to.rotation))
            }),
            extra: Vec::new(),
            feed: motion.speed.mm_per_s.map(|speed| Feed {
                mode: FeedMode::PerMinute,
                value: 60.0 * speed,
            }),
            known,
            words: CoordinateWords {
                mm_per_unit: 1.0,
                incremental: false,
                absolute_centre: false,
                work_offset_mm: Vector3::zeros(),
                to_machine: [false; 3],
            },
        }
    }
}

/// Whether only the tool's axis is stated, and it is another one than z.
fn leans(motion: &Motion) -> bool {
    let by_axis = matches!(&motion.site.target, TargetSite::Literal(text) if text.convention == OrientationText::Axis);
    let axis = motion
        .target
        .pose()
        .map(|pose| pose.orientation * Vector3::z());
    by_axis && axis.is_some_and(|axis| (axis - Vector3::z()).norm() > 1e-9)
}

/// Whether the text of a target says how the tool stands.
fn states_orientation(motion: &Motion) -> bool {
    let unstated = |text: &PoseText| {
        matches!(
            text.convention,
            OrientationText::Unstated | OrientationText::Axis
        )
    };
    match &motion.site.target {
        TargetSite::Literal(text) => !unstated(text),
        _ => true,
    }
}

/// Of the two quaternions of one rotation, the one on the side of another.
fn nearest(rotation: UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    match rotation.coords.dot(&to.coords) < 0.0 {
        true => UnitQuaternion::new_unchecked(-rotation.into_inner()),
        false => rotation,
    }
}

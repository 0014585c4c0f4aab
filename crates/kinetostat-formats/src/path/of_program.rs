//! From the motions of a program to a path.

use std::sync;

use kinetostat_program::{
    Arc, CoordinateWords, Curve, Feed, FeedMode, Knowledge, Move, MoveKind, Path, RotaryAxes,
    RotaryTurn, ToolTurn, Warning,
};
use nalgebra::{Isometry3, Point3, Unit, UnitQuaternion, Vector3};

use crate::apt::spindle::spindle_changes;
use crate::model::frame::FrameUse;
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::orientation::OrientationText;
use crate::model::program::{Language, RobotProgram};
use crate::model::site::{PoseText, TargetSite};
use crate::model::stated_axes::AxesStated;
use crate::model::target::Target;
use crate::path::axis_angles::{AxesOfMotion, axes_of_motions};
use crate::path::axis_turns::{axis_turns, first_leaning, is_by_axis};
use crate::path::circle::about;
use crate::path::far_places::too_far;
use crate::path::fault::PathError;
use crate::path::options::PathOptions;
use crate::path::path_warnings::{by_rule, turns_alone, warnings_of};
use crate::path::tools::{changes, same_frame, tools_of};
use crate::text::source::SourceFile;

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
    /// The program states the direction of the tool's axis alone, and it is not z throughout: about it the tool is turned by
    /// [`PathOptions::turn_about_axis`].
    pub axis_alone: bool,
    /// Rotary axes of the machine turn the tool: about it they may stand otherwise where the tool lies along one of them.
    pub(crate) by_axes: bool,
}

impl RobotPath {
    /// How far the tool is turned from one orientation to another, as far as the text of the program says it, rad.
    pub(crate) fn turned(&self, to: &UnitQuaternion<f64>, from: &UnitQuaternion<f64>) -> f64 {
        let axis = self.path.tool_axis;
        match self.axis_alone || self.by_axes {
            true => (to * axis).angle(&(from * axis)),
            false => to.angle_to(from),
        }
    }
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
    faults.extend(program.motions.iter().filter_map(|motion| {
        let (reason, remedy) = too_far(motion)?;
        Some(fault(motion, reason, remedy))
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
        let place = |fault: &PathError| {
            let files = &mut program.files.iter();
            let file = files.position(|file| file.name() == fault.file);
            (file, fault.line)
        };
        faults.sort_by_key(place);
        return Err(faults);
    }
    let mut maker = Maker {
        program,
        options,
        in_base: !one,
        turns: None,
        rotary: None,
        tool_axis: options.tool_axis,
    };
    let leaning = first_leaning(program);
    let angled = first_with_angles(program);
    let letters = options.rotary.iter().flat_map(|rotary| &rotary.axes);
    let same = letters
        .map(|axis| axis.letter)
        .eq(program.rotary.letters.iter().copied());
    if let (Some(motion), false) = (angled, same) {
        return Err(vec![fault(
            motion,
            "angles of rotary axes say how the tool stands, and these axes are not those of the machine".to_owned(),
            "state the axes of the machine, in the order in which their words were read (`rotary`, `rotary_axes`)",
        )]);
    }
    if leaning.is_some() || angled.is_some() {
        let rule = (options.turn_about_axis, options.tool_axis);
        match &options.rotary {
            Some(rotary) => {
                if let (false, Some(motion)) = (one, leaning.or(angled)) {
                    return Err(vec![fault(
                        motion,
                        "rotary axes of the machine turn the tool, and the program has several work objects".to_owned(),
                        "write one program for each work object",
                    )]);
                }
                let is_rapid = |motion: &Motion| maker.is_rapid(motion);
                let angles = axes_of_motions(program, rotary, is_rapid)?;
                maker.rotary = Some((sync::Arc::clone(rotary), angles));
                maker.tool_axis = rotary.tool_at_zero.inverse() * Vector3::z();
            }
            None => {
                let is_rapid = |motion: &Motion| maker.is_rapid(motion);
                let frame = |motion: &Motion| maker.frame(motion);
                maker.turns = Some(axis_turns(program, rule, frame, is_rapid)?);
            }
        }
    }
    let mut made = maker.path();
    made.warnings.extend(
        leaning
            .iter()
            .flat_map(|motion| by_rule(program, motion, options)),
    );
    let findings = made.rotary_findings();
    made.warnings.extend(findings);
    made.warnings.extend(turns_alone(&made.moves));
    if let (Language::Apt, Some(file)) = (program.language, program.files.get(file)) {
        made.spindle_changes = spindle_changes(file);
    }
    if tools.len() > 1 {
        made.tool_changes = changes(&poses, &tools);
    }
    Ok(RobotPath {
        axis_alone: leaning.is_some(),
        by_axes: angled.is_some(),
        motions: (0..program.motions.len()).collect(),
        path: made,
        work_object: work_object.filter(|_| one),
        tools,
        file,
    })
}

/// The first motion at which angles of rotary axes say how the tool stands.
fn first_with_angles(program: &RobotProgram) -> Option<&Motion> {
    let mut stated = program.rotary.motions.iter();
    let first = stated.find(|(_, stated)| matches!(stated, AxesStated::Angles { .. }));
    program.motions.get(*first?.0)
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
    /// How the tool stands at the end of every motion, in axes of the path, where the program states its axis alone and that leans.
    turns: Option<Vec<Option<UnitQuaternion<f64>>>>,
    /// What the rotary axes of the machine do, instead.
    rotary: Option<(sync::Arc<RotaryAxes>, Vec<Option<AxesOfMotion>>)>,
    /// From the tip to the holder, in axes of the tool.
    tool_axis: Vector3<f64>,
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

    /// Where a motion ends, and how the tool stands there.
    fn end(&self, index: usize) -> Option<Isometry3<f64>> {
        let motion = &self.program.motions[index];
        let mut end = self.pose(motion, &motion.target)?;
        if let Some(turn) = self.turns.as_ref().and_then(|turns| turns[index]) {
            end.rotation = turn;
        }
        Some(end)
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
            let made = self.made(index, start, last.unwrap_or_default());
            if motion.runs == Runs::Elsewhere {
                warnings.push(Warning {
                    line: motion.line,
                    text: "nothing in these files calls the routine of this motion: it is corrected as if it ran by itself"
                        .to_owned(),
                });
            }
            last = self.end(index);
            moves.push(made);
        }
        warnings.dedup_by(|b, a| a.text == b.text);
        let poses = |index: usize| self.end(index).map(|pose| pose.translation.vector);
        warnings.extend(warnings_of(
            (self.program, self.options),
            &moves,
            self.in_base,
            poses,
        ));
        let mut path = Path::of_moves(moves, self.tool_axis);
        path.warnings = warnings;
        path
    }

    /// Whether a motion positions the tool in air.
    fn is_rapid(&self, motion: &Motion) -> bool {
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
        motion.kind == MotionKind::Joint
            || motion.target.pose().is_none()
            || said
            || self.options.rapid_from_mm_per_s.is_some_and(fast)
    }

    /// Whether the text of a target, or the rule for the turn about its axis, says how the tool stands.
    fn states_orientation(&self, motion: &Motion) -> bool {
        // Languages of machines state at most the axis.
        let by_axis = matches!(
            self.program.language,
            Language::Apt | Language::Siemens | Language::Heidenhain
        );
        if by_axis || self.turns.is_some() {
            return self.turns.is_some();
        }
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

    fn made(&self, index: usize, start: Option<Isometry3<f64>>, before: Isometry3<f64>) -> Move {
        let motion = &self.program.motions[index];
        let end = self.end(index);
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
                    Some(via) => Arc::through(&a, &via.translation.vector, &b)
                        .map_or(Curve::Line, Curve::Arc),
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
        Move {
            line: motion.line,
            kind: match self.is_rapid(motion) {
                true => MoveKind::Rapid,
                false => MoveKind::Feed,
            },
            curve,
            start: a,
            end: b,
            tool_turn: match &self.rotary {
                Some((axes, motions)) => motions[index].as_ref().map(|own| {
                    let whole = known == Knowledge::Whole;
                    Box::new(ToolTurn::rotary(RotaryTurn {
                        axes: sync::Arc::clone(axes),
                        origin_deg: vec![0.0; own.end_deg.len()],
                        start_deg: match whole {
                            true => own.start_deg.clone(),
                            false => own.end_deg.clone(),
                        },
                        end_deg: own.end_deg.clone(),
                        great_circle: own.great_circle.clone().filter(|_| whole),
                        stated: own.stated,
                    }))
                }),
                None => self.states_orientation(motion).then(|| {
                    let start = nearest(from.rotation, &to.rotation);
                    let axis = Unit::new_normalize(self.tool_axis);
                    let by_axis = self.turns.is_some() && is_by_axis(self.program, motion);
                    Box::new(match self.swivels(motion) {
                        true => ToolTurn::swivelled(start, to.rotation, Vector3::x_axis()),
                        false if by_axis => ToolTurn::swivelled(start, to.rotation, axis),
                        false => ToolTurn::shortest(start, to.rotation),
                    })
                }),
            },
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

impl Maker<'_> {
    /// Whether the x of the tool swivels in a plane while the tool turns about it: KUKA's LIN and CIRC with `#VAR` do, and turn with
    /// `$VEL.ORI1` and `$VEL.ORI2`. Of motions of a spline nothing is published: they count as turns about one axis.
    fn swivels(&self, motion: &Motion) -> bool {
        let file = self.program.files.get(motion.file).map(SourceFile::bytes);
        let word = file.and_then(|bytes| bytes.get(motion.site.keyword.clone()));
        let is = |name: &str| word.is_some_and(|word| word.eq_ignore_ascii_case(name.as_bytes()));
        self.program.language == Language::Krl && (is("LIN") || is("CIRC"))
    }
}

/// Of the two quaternions of one rotation, the one on the side of another.
fn nearest(rotation: UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    match rotation.coords.dot(&to.coords) < 0.0 {
        true => UnitQuaternion::new_unchecked(-rotation.into_inner()),
        false => rotation,
    }
}

//! Motions of a program in the axes of its path: the options, and the move of each motion with its curve and the turn of the tool.

use std::sync;

use kinetostat_program::{
    Arc, CoordinateWords, Curve, Feed, FeedMode, Knowledge, Move, MoveKind, RotaryAxes, RotaryTurn,
    ToolTurn,
};
use nalgebra::{Isometry3, Point3, Unit, UnitQuaternion, Vector3};

use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::{PoseText, TargetSite};
use crate::model::target::Target;
use crate::path::axis_angles::{AxesOfMotion, axes_of_motions};
use crate::path::axis_turns::{TurnAboutAxis, axis_turns, is_by_axis};
use crate::path::{PathError, fault_at};
use crate::text::source::SourceFile;

/// The motions of a program, and what their moves need beside them.
pub(super) struct Maker<'a> {
    pub program: &'a RobotProgram,
    pub options: &'a PathOptions,
    /// Poses in the axes of the robot's base.
    pub in_base: bool,
    /// Orientation at the end of every motion, in axes of the path, if the program states a leaning tool axis alone.
    pub turns: Option<Vec<Option<UnitQuaternion<f64>>>>,
    /// Alternative to `turns`: motion of the machine's rotary axes.
    pub rotary: Option<(sync::Arc<RotaryAxes>, Vec<Option<AxesOfMotion>>)>,
    /// Direction from the tip to the holder, in axes of the tool.
    pub tool_axis: Vector3<f64>,
}

impl<'a> Maker<'a> {
    /// Maker for a program with one work object, or in the axes of the robot's base; `leaning` is the first motion whose tool leans, if the program
    /// states the tool axis alone, or angles of rotary axes.
    pub(super) fn of(
        program: &'a RobotProgram,
        options: &'a PathOptions,
        in_base: bool,
        leaning: Option<&Motion>,
    ) -> Result<Self, Vec<PathError>> {
        let mut maker = Self {
            program,
            options,
            in_base,
            turns: None,
            rotary: None,
            tool_axis: options.tool_axis,
        };
        let Some(leaning) = leaning else {
            return Ok(maker);
        };
        let is_rapid = |motion: &Motion| maker.is_rapid(motion);
        match &options.rotary {
            Some(_) if in_base => {
                let reason = "rotary axes of the machine turn the tool, and the program has several work objects";
                let remedy = "write one program for each work object";
                return Err(vec![fault_at(program, leaning, reason.to_owned(), remedy)]);
            }
            Some(rotary) => {
                let angles = axes_of_motions(program, rotary, is_rapid)?;
                maker.rotary = Some((sync::Arc::clone(rotary), angles));
                maker.tool_axis = rotary.tool_at_zero.inverse() * Vector3::z();
            }
            None => {
                let frame = |motion: &Motion| maker.frame_in_path(motion);
                maker.turns = Some(axis_turns(
                    program,
                    options.turn_about_axis,
                    options.tool_axis,
                    frame,
                    is_rapid,
                )?);
            }
        }
        Ok(maker)
    }

    /// Transformation from the axes of a motion's work object to those of the path.
    pub(super) fn frame_in_path(&self, motion: &Motion) -> Isometry3<f64> {
        match (self.in_base, motion.work_object.known()) {
            (true, Some(frame)) => *frame,
            _ => Isometry3::identity(),
        }
    }

    pub(super) fn pose_in_path(&self, motion: &Motion, target: &Target) -> Option<Isometry3<f64>> {
        Some(self.frame_in_path(motion) * target.pose()?.isometry())
    }

    /// Pose at the end of a motion; `None` if the end or the path to it is unknown.
    pub(super) fn end_in_path(&self, index: usize) -> Option<Isometry3<f64>> {
        let motion = &self.program.motions[index];
        if !motion.has_known_way() {
            return None;
        }
        let mut end = self.pose_in_path(motion, &motion.target)?;
        if let Some(turn) = self.turns.as_ref().and_then(|turns| turns[index]) {
            end.rotation = turn;
        }
        Some(end)
    }

    /// True if a motion positions the tool in air.
    pub(super) fn is_rapid(&self, motion: &Motion) -> bool {
        let fast = |limit: f64| {
            let fastest = motion.speed.text.eq_ignore_ascii_case("vmax");
            fastest || motion.speed.mm_per_s.is_some_and(|speed| speed >= limit)
        };
        // APT says it beside the motion, a machine's control in it.
        let said = self.program.language.is_rapid(&motion.speed.text);
        motion.kind == MotionKind::Joint
            || !motion.has_known_way()
            || said
            || self.options.rapid_from_mm_per_s.is_some_and(fast)
    }
}

/// Options with which the path of a robot's program is made.
///
/// ```
/// let mut options = kinetostat_formats::PathOptions::default();
/// // All linear motions cut, whatever their speed, with a tool whose z points from the holder to the tip.
/// assert_eq!(options.rapid_from_mm_per_s, None);
/// assert_eq!(options.tool_axis, -nalgebra::Vector3::z());
/// options.rapid_from_mm_per_s = Some(200.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathOptions {
    /// Linear and circular motions at this speed or a higher one position the tool in air, mm/s; `None`: all of them cut.
    pub rapid_from_mm_per_s: Option<f64>,
    /// Unit vector from the tool's tip to its holder, in axes of the tool's frame: -z where the frame's z points out of the
    /// spindle, as is usual at ABB and FANUC; -x at KUKA.
    pub tool_axis: Vector3<f64>,
    /// Rule for the rotation of the tool about its axis, if the program states the axis alone.
    pub turn_about_axis: TurnAboutAxis,
    /// Rotary axes of the machine, in axes of the program's work object: where a program states their angles
    /// ([`crate::ReadOptions::rotary_axes`]) they stand there, and where it states the tool's axis alone they point the tool along it,
    /// within their limits. Between two poses they lead it on the great circle (APT, and SINUMERIK with ORIVECT, its
    /// basic setting), or turn evenly with the way (SINUMERIK with ORIAXES, Heidenhain). They say how the tool is turned about its axis, too.
    pub rotary: Option<sync::Arc<RotaryAxes>>,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self {
            rapid_from_mm_per_s: None,
            tool_axis: -Vector3::z(),
            turn_about_axis: TurnAboutAxis::Least,
            rotary: None,
        }
    }
}

impl Maker<'_> {
    /// The move of a motion from a start, or from what is before it where the start is not known.
    pub(super) fn made(
        &self,
        index: usize,
        start: Option<Isometry3<f64>>,
        before: Isometry3<f64>,
    ) -> Move {
        let motion = &self.program.motions[index];
        let end = self.end_in_path(index);
        let from = start.unwrap_or(before);
        let to = end.unwrap_or(before);
        let [a, b] = [from, to].map(|pose| pose.translation.vector);
        let mut known = match (end, start) {
            (None, _) => Knowledge::Nothing,
            (Some(_), None) => Knowledge::End,
            (Some(_), Some(_)) => Knowledge::Whole,
        };
        let mut curve = Curve::Line;
        if known == Knowledge::Whole {
            match self.curve_between(motion, &a, &b) {
                Some(found) => curve = found,
                None => known = Knowledge::End,
            }
        }
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
            tool_turn: self.turn_of_tool(index, known, from, to),
            extra: Vec::new(),
            feed: motion.speed.mm_per_s.map(|speed| Feed {
                mode: FeedMode::PerMinute,
                value: 60.0 * speed,
            }),
            known,
            words: CoordinateWords {
                mm_per_unit: 1.0,
                ..CoordinateWords::default()
            },
        }
    }

    /// The way of a motion from place to place; none where the place on its circle is not known.
    fn curve_between(&self, motion: &Motion, a: &Vector3<f64>, b: &Vector3<f64>) -> Option<Curve> {
        let arc = match &motion.kind {
            MotionKind::Circular { via } => {
                let via = self.pose_in_path(motion, via)?;
                Arc::through(a, &via.translation.vector, b)
            }
            MotionKind::Arc {
                centre_mm,
                axis,
                angle_rad,
            } => {
                let frame = self.frame_in_path(motion);
                let centre = (frame * Point3::from(*centre_mm)).coords;
                about(a, b, &centre, &(frame.rotation * axis), *angle_rad)
            }
            MotionKind::Joint | MotionKind::Linear => None,
        };
        Some(arc.map_or(Curve::Line, Curve::Arc))
    }

    /// Rotation of the tool in a motion; `None` if its orientation is unknown.
    fn turn_of_tool(
        &self,
        index: usize,
        known: Knowledge,
        from: Isometry3<f64>,
        to: Isometry3<f64>,
    ) -> Option<Box<ToolTurn>> {
        let motion = &self.program.motions[index];
        match &self.rotary {
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
        }
    }

    /// True if the text of a target, or the rule for the turn about its axis, defines the orientation.
    fn states_orientation(&self, motion: &Motion) -> bool {
        // Languages of machines state at most the axis.
        let by_axis = !self.program.language.states_turn();
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

    /// True where the x of the tool swivels in a plane while the tool turns about it.
    fn swivels(&self, motion: &Motion) -> bool {
        let file = self.program.files.get(motion.file).map(SourceFile::bytes);
        let word = file.and_then(|bytes| bytes.get(motion.site.keyword.clone()));
        word.is_some_and(|word| self.program.language.swivels(word))
    }
}

/// Selects the sign of a quaternion so that it lies in the hemisphere of another.
fn nearest(rotation: UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    match rotation.coords.dot(&to.coords) < 0.0 {
        true => UnitQuaternion::new_unchecked(-rotation.into_inner()),
        false => rotation,
    }
}

/// The arc from `start` to `end` about a centre and an axis by an angle in rad, right-handed; the rise is even.
fn about(
    start: &Vector3<f64>,
    end: &Vector3<f64>,
    centre: &Vector3<f64>,
    axis: &Vector3<f64>,
    angle_rad: f64,
) -> Option<Arc> {
    let across = |place: &Vector3<f64>| {
        let arm = place - centre;
        arm - axis * arm.dot(axis)
    };
    let (arm, last) = (across(start), across(end));
    let first = arm.try_normalize(1e-9)?;
    Some(Arc {
        centre: start - arm,
        first,
        second: axis.cross(&first),
        axis: *axis,
        start_angle: 0.0,
        sweep: angle_rad,
        start_radius: arm.norm(),
        end_radius: last.norm(),
        rise: (end - start).dot(axis),
    })
}

//! The move of a motion: its curve, and how the tool turns in it.

use std::sync;

use kinetostat_program::{
    Arc, CoordinateWords, Curve, Feed, FeedMode, Knowledge, Move, MoveKind, RotaryTurn, ToolTurn,
};
use nalgebra::{Isometry3, Point3, Unit, UnitQuaternion, Vector3};

use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::site::{PoseText, TargetSite};
use crate::path::axis_turns::is_by_axis;
use crate::path::maker::Maker;
use crate::text::source::SourceFile;

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

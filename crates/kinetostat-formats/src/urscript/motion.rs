//! Motions: their ends, with the frames in which they are stated, their speeds and their blends.

use std::ops::Range;

use nalgebra::Isometry3;

use crate::interpreter::calls::argument;
use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::{self, Reason};
use crate::model::frame::{Frame, FrameUse};
use crate::model::motion::{Motion, MotionKind, Speed, Zone};
use crate::model::program::ACCELERATION;
use crate::model::site::{MotionSite, SpeedSite, TargetSite};
use crate::model::target::Target;
use crate::urscript::grammar::FORM;
use crate::urscript::table::{MotionRow, motion_row};

/// A run of a URScript program.
pub(super) type Run<'r, 'p> = run::Run<'r, 'p, UrScript>;

/// Modal state.
pub(crate) struct UrScript {
    pub tool: FrameUse,
    /// Tools that the program has in numbers.
    pub tools: Vec<Frame>,
}

/// Expressions of the end of a motion.
pub(super) struct End<'e> {
    /// `pose_trans(frame, pose)`: a feature of the pendant, or a frame of the program.
    pub frame: Option<&'e Expression>,
    pub pose: &'e Expression,
    /// `get_inverse_kin(pose, near)`: the joints of a pose next to others.
    pub others: Vec<&'e Expression>,
}

impl<'e> End<'e> {
    pub(super) fn of(expression: &'e Expression) -> Self {
        let mut end = Self {
            frame: None,
            pose: expression,
            others: Vec::new(),
        };
        // A call with further arguments states the pose of another tool.
        if let Some(given) = expression.given_to("GET_INVERSE_KIN", &["X", "QNEAR"])
            && let [pose, others @ ..] = given.as_slice()
        {
            (end.pose, end.others) = (pose, others.to_vec());
        }
        let given = end.pose.given_to("POSE_TRANS", &["P_FROM", "P_FROM_TO"]);
        if let Some([frame, pose]) = given.as_deref() {
            (end.frame, end.pose) = (Some(*frame), pose);
        }
        end
    }
}

impl Run<'_, '_> {
    /// The motion of a statement, or why it is refused.
    pub(super) fn motion_of(
        &mut self,
        tokens: &Range<usize>,
        arguments: &[Argument],
    ) -> Result<Motion, Reason> {
        let file = self.file();
        let no_motion = || ("it is no motion".to_owned(), FORM.remedy);
        let row = motion_row(file.word(tokens.start)).ok_or_else(no_motion)?;
        let given = |name: &str| argument(row.parameters, arguments, name);
        for value in ["A", "V", "T", "R"].into_iter().filter_map(given) {
            let found = self.value(value);
            if found.unknown_reason().is_none() && found.as_number().is_none() {
                let reason = format!("`{}` is no number", file.text(&value.tokens));
                return Err((
                    reason,
                    "write acceleration, speed, time and radius as numbers",
                ));
            }
        }
        let values = arguments.iter().filter_map(|own| own.value.as_ref());
        if let Some(odd) = values.into_iter().find(|own| own.node == Node::Unreadable) {
            let reason = format!("`{}` is no expression", file.text(&odd.tokens));
            return Err((reason, FORM.remedy));
        }
        let last = row.parameters[row.ends - 1];
        let is_missing = || (format!("{} needs {last}", row.name), FORM.remedy);
        let end = given(last).ok_or_else(is_missing)?;
        let (target, target_site, work_object) = self.end(row, end)?;
        let keyword = file.span(&(tokens.start..tokens.start + 1));
        let mut site = MotionSite::of(keyword, file.span(&End::of(end).pose.tokens), target_site);
        let kind = match (row.name, row.ends) {
            ("movej", _) => MotionKind::Joint,
            (_, 1) => MotionKind::Linear,
            _ => {
                let first = given(row.parameters[0]).ok_or_else(is_missing)?;
                let (via, via_site, frame) = self.end(row, first)?;
                let mode = given("MODE").map_or(Some(0.0), |mode| self.value(mode).as_number());
                if mode != Some(0.0) {
                    let reason = "on the circle the tool turns with the path (mode=1), or its mode is not known";
                    let remedy =
                        "write mode=0 with the orientation that the tool is to have at the end";
                    return Err((reason.to_owned(), remedy));
                }
                if frame != work_object {
                    let reason = "the place on the circle and its end are in two frames";
                    return Err((reason.to_owned(), "write both in one frame"));
                }
                let whole = file.span(&first.tokens).start..file.span(&end.tokens).start;
                site.via = Some((whole, via_site));
                MotionKind::Circular { via }
            }
        };
        let time = given("T").map(|time| self.value(time).as_number());
        let is_timed = time.is_some_and(|time| time != Some(0.0));
        site.indivisible = is_timed.then_some("its time is stated, not its speed");
        site.zone = given("R").map(|blend| file.span(&blend.tokens));
        let frames = [self.own.tool.clone(), work_object];
        let mut motion = self.made_motion(tokens, kind, target, site, frames);
        (motion.speed, motion.site.speed) = self.speed(row, given("V"), is_timed, tokens);
        let blend = given("R").map_or(Some(0.0), |blend| self.value(blend).as_number());
        motion.zone = match blend {
            Some(0.0) => Zone::Exact,
            blend => blend.map_or(Zone::Unstated, |radius| Zone::Radius(1e3 * radius)),
        };
        // The manual's defaults, in m/s2 and rad/s2.
        let usual = if row.name == "movej" { 1.4 } else { 1.2 };
        let stated = given("A").map(|own| self.value(own).as_number());
        let acceleration = match stated.unwrap_or(Some(usual)) {
            Some(number) => number.to_string(),
            None => given("A").map_or_else(String::new, |own| file.text(&own.tokens)),
        };
        self.say_beside(tokens, format!("{ACCELERATION} {acceleration}"));
        if let (true, Some(time), MotionKind::Linear) = (is_timed, time.flatten(), &motion.kind) {
            motion.speed.mm_per_s = self.way_mm(&motion).map(|way| way / time);
        }
        Ok(motion)
    }

    /// The speed, and where it stands or may stand; a time takes its place.
    fn speed(
        &mut self,
        row: &MotionRow,
        stated: Option<&Expression>,
        is_timed: bool,
        tokens: &Range<usize>,
    ) -> (Speed, Option<SpeedSite>) {
        // The manual's default; joints turn by another unit.
        let value = stated.map_or(Some(0.25), |stated| self.value(stated).as_number());
        let is_said = row.name != "movej" && !is_timed;
        let mm_per_s = value.map(|value| 1e3 * value).filter(|_| is_said);
        let file = self.file();
        let close = file.span(tokens).end - 1;
        let (span, text, before) = match stated {
            Some(stated) => (file.span(&stated.tokens), file.text(&stated.tokens), ""),
            None => (close..close, String::new(), ", v="),
        };
        let site = mm_per_s.map(|_| SpeedSite {
            span,
            before: before.to_owned(),
            after: String::new(),
            unit_mm_per_s: 1e3,
        });
        (Speed { mm_per_s, text }, site)
    }

    /// An end, where its numbers stand, and in which frame they are.
    fn end(
        &mut self,
        row: &MotionRow,
        expression: &Expression,
    ) -> Result<(Target, TargetSite, FrameUse), Reason> {
        let End { frame, pose, .. } = End::of(expression);
        let frame = match frame {
            Some(frame) => self.frame_use(&FORM, frame),
            None => FrameUse {
                name: "base".to_owned(),
                frame: Frame::Known(Isometry3::identity()),
            },
        };
        let value = self.value(pose);
        let in_joints = "its end is stated in joints, and which pose they give is not known";
        let remedy = "write the end as a pose, or go there by movej, which takes joint values";
        let (target, site) = match (value.as_numbers::<6>(), row.name) {
            (Some(joints), "movej") => {
                let values_deg = joints.map(f64::to_degrees).to_vec();
                (Target::Joints { values_deg }, TargetSite::Fixed(in_joints))
            }
            (Some(_), _) => return Err((in_joints.to_owned(), remedy)),
            (None, _) => self.pose_end(&FORM, pose, &value)?,
        };
        Ok((target, site, frame))
    }

    /// `set_tcp(pose)`: a tool that the statement has in numbers has no name.
    pub(super) fn set_tcp(&mut self, tcp: &Expression) {
        let mut tool = self.frame_use(&FORM, tcp);
        if !matches!(tcp.node, Node::Word(_)) {
            if let Some(stated) = self.options.frames.get("tcp") {
                tool.frame = Frame::Known(*stated);
            }
            let tools = &mut self.own.tools;
            if !tools.contains(&tool.frame) {
                tools.push(tool.frame.clone());
            }
            tool.name = match tools.iter().position(|own| *own == tool.frame) {
                None | Some(0) => "tcp".to_owned(),
                Some(at) => format!("tcp_{}", at + 1),
            };
        }
        self.own.tool = tool;
    }
}

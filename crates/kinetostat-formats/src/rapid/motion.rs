//! Conversion of a motion instruction to a motion.

use std::ops::Range;
use std::rc::Rc;

use nalgebra::Isometry3;

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::{Place, Reason, Root};
use crate::interpreter::value::{Datum, Value};
use crate::model::motion::{Frame, FrameUse, Motion, MotionKind, Runs, Speed, Zone};
use crate::model::site::{MotionSite, SpeedSite, TargetSite};
use crate::model::target::Target;
use crate::options::UnknownTargets;
use crate::rapid::lex::Arguments;
use crate::rapid::literals::{frame_of, joints_of};
use crate::rapid::state::Run;
use crate::rapid::table::{Ends, MotionRow};
use crate::rapid::targets::Found;

/// Arguments by which the path is corrected while it runs.
const CORRECTED: [&str; 3] = ["CORR", "TRACK", "SEAMNAME"];

/// An end with its text and its external axes.
type End = (Target, TargetSite, Vec<Option<f64>>);

impl Run<'_, '_> {
    /// The motion of an instruction, or why it is refused.
    pub(super) fn motion(
        &mut self,
        row: &'static MotionRow,
        tokens: &Range<usize>,
    ) -> Result<Motion, Reason> {
        let file = self.file();
        let arguments = Arguments::of(file, tokens.start + 1..tokens.end);
        let ends = match row.ends {
            Ends::Circular => 2,
            _ => 1,
        };
        let tool_at = ends + 2 + row.between;
        if arguments.ordered.len() <= tool_at {
            let reason = format!("{} needs at least {} arguments", row.name, tool_at + 1);
            return Err((reason, "write its target, speed, zone and tool"));
        }
        let is_given = |option: &&str| arguments.option(option).is_some();
        if CORRECTED.iter().any(is_given) {
            return Err((
                "the path is corrected by a sensor while the program runs".to_owned(),
                "take this motion into a program of its own",
            ));
        }
        let span = file.span(tokens);
        let end = &arguments.ordered[ends - 1];
        let (target, target_site, external) = match row.ends {
            Ends::AbsoluteJoint => self.joints(end),
            _ => self.pose(end, &span)?,
        };
        let (kind, via) = match row.ends {
            Ends::Linear => (MotionKind::Linear, None),
            Ends::Joint | Ends::AbsoluteJoint => (MotionKind::Joint, None),
            Ends::Circular => {
                let first = &arguments.ordered[0];
                let (via, site, _) = self.pose(first, &span)?;
                // With the comma and the blanks up to the end.
                let whole = file.span(&first.tokens).start..file.span(&end.tokens).start;
                (MotionKind::Circular { via }, Some((whole, site)))
            }
        };
        let (speed, speed_site, other_speeds) = self.speed(&arguments, ends);
        let zone = self.zone(&arguments, tool_at - 1);
        let tool = self.frame(Role::Tool, &arguments.ordered[tool_at])?;
        let mut work_object = match arguments.option("WOBJ").flatten() {
            Some(named) => self.frame(Role::WorkObject, named)?,
            None => FrameUse {
                name: "wobj0".to_owned(),
                frame: Frame::Known(Isometry3::identity()),
            },
        };
        if let Some(by) = self.own.displacement
            && row.ends != Ends::AbsoluteJoint
        {
            work_object.name += " displaced";
            if let Frame::Known(frame) = &mut work_object.frame {
                *frame *= by;
            }
        }
        let indivisible = match row.straight {
            None => Some("this instruction cannot be divided"),
            Some(_) if is_given(&"T") => Some("its time is stated, not its speed"),
            Some(_) if is_given(&"ID") => Some("it runs in step with another robot (\\ID)"),
            Some(_) => None,
        };
        Ok(Motion {
            file: file.index,
            line: file.source.line_of(span.start),
            kind,
            target,
            speed,
            zone,
            tool,
            work_object,
            runs: Runs::Once,
            follows: None,
            site: MotionSite {
                via,
                speed: speed_site,
                zone: Some(file.span(&arguments.ordered[tool_at - 1].tokens)),
                external,
                other_speeds,
                indivisible,
                ..MotionSite::of(
                    file.span(&(tokens.start..tokens.start + 1)),
                    file.span(&end.tokens),
                    target_site,
                )
            },
            span,
        })
    }

    /// The bytes of an expression.
    pub(super) fn text(&self, expression: &Expression) -> String {
        let file = self.file();
        String::from_utf8_lossy(file.source.part(&file.span(&expression.tokens))).into_owned()
    }

    fn pose(&mut self, end: &Expression, statement: &Range<usize>) -> Result<End, Reason> {
        match self.end(end, statement) {
            Ok(Found { pose, site }) => {
                let external = pose.external.clone();
                Ok((Target::Pose(pose), site, external))
            }
            Err((reason, _)) if self.options.unknown_targets == UnknownTargets::LeftAsWritten => {
                Ok((
                    Target::Unknown { reason },
                    TargetSite::Fixed("its end is not known from the text"),
                    Vec::new(),
                ))
            }
            Err(reason) => Err(reason),
        }
    }

    /// Joints are not corrected: where they are not known the next motion begins at an unknown place.
    fn joints(&mut self, expression: &Expression) -> End {
        let site = TargetSite::Fixed("its end is stated in joints");
        match joints_of(&self.value(expression)) {
            Some((values_deg, external)) => (Target::Joints { values_deg }, site, external),
            None => {
                let reason = "its joints are not known from the text".to_owned();
                (Target::Unknown { reason }, site, Vec::new())
            }
        }
    }

    /// The speed, where it can be written otherwise, and what else the data of the speed state.
    fn speed(
        &mut self,
        arguments: &Arguments,
        at: usize,
    ) -> (Speed, Option<SpeedSite>, Option<String>) {
        let expression = &arguments.ordered[at];
        let text = self.text(expression);
        let known = self.value(expression).as_numbers::<4>();
        let others =
            known.map(|[_, turning, linear, rotating]| format!("{turning},{linear},{rotating}"));
        if let Some(stated) = arguments.option("V").flatten() {
            let mm_per_s = self.value(stated).as_number();
            return (Speed { mm_per_s, text }, None, others);
        }
        if arguments.option("T").is_some() {
            let mm_per_s = None;
            return (Speed { mm_per_s, text }, None, others);
        }
        let span = self.file().span(&expression.tokens);
        let site = others.as_ref().map(|others| SpeedSite {
            span,
            before: "[".to_owned(),
            after: format!(",{others}]"),
            unit_mm_per_s: 1.0,
        });
        let mm_per_s = known.map(|speed| speed[0]);
        (Speed { mm_per_s, text }, site, others)
    }

    /// The zone: `[finep, pzone_tcp, ...]`, or its radius (`\Z`).
    fn zone(&mut self, arguments: &Arguments, at: usize) -> Zone {
        if let Some(radius) = arguments.option("Z").flatten() {
            return (self.value(radius).as_number()).map_or(Zone::Unstated, Zone::Radius);
        }
        let zone = self.value(&arguments.ordered[at]);
        let part = |index: usize| zone.parts().get(index);
        match (part(0).and_then(|part| part.as_truth()), part(1)) {
            (Some(true), _) => Zone::Exact,
            (Some(false), Some(radius)) => radius.as_number().map_or(Zone::Unstated, Zone::Radius),
            _ => Zone::Unstated,
        }
    }
}

/// Tool or work object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Tool,
    WorkObject,
}

impl Run<'_, '_> {
    /// The tool or work object that an expression names. Frames that the caller states stand in for those of the text.
    pub(super) fn frame(
        &mut self,
        role: Role,
        expression: &Expression,
    ) -> Result<FrameUse, Reason> {
        let mut name = self.text(expression);
        if let Node::Call(..) | Node::One(..) | Node::Two(..) | Node::Unreadable = expression.node {
            let reason = format!("`{name}` is no tool and no work object");
            return Err((reason, "write its name, or its numbers"));
        }
        if let Node::Word(word) = &expression.node {
            if let Some(frame) = self.own.stated.get(word) {
                let frame = Frame::Known(*frame);
                return Ok(FrameUse { name, frame });
            }
            // The datum that a parameter stands for.
            if let Some(Place {
                root: Root::Module(index),
                path,
            }) = self.place(expression)
                && path.is_empty()
            {
                let datum = &self.symbols.data[index];
                if let Some(frame) = self.own.stated.get(&datum.node.name) {
                    let frame = Frame::Known(*frame);
                    return Ok(FrameUse { name, frame });
                }
                if datum.node.name != *word {
                    name = self.shown(index);
                }
            }
        }
        let value = self.value(expression);
        let key = match &expression.node {
            Node::Word(word) => Some((role == Role::Tool, *word)),
            _ => None,
        };
        let list = match &value.value {
            Value::List(list) => Some(list),
            _ => None,
        };
        // Cache: a motion usually has the tool of the motion before.
        if let (Some(key), Some(list)) = (&key, list)
            && let Some((known, frame)) = self.own.frames.get(key)
            && Rc::ptr_eq(known, list)
        {
            return Ok(frame.clone());
        }
        let frame = match &value.value {
            Value::Unknown(reason) if self.has_first_value(expression) => {
                return Err((reason.to_string(), STATE_IT));
            }
            Value::Unknown(reason) => Frame::Unknown {
                reason: reason.to_string(),
            },
            _ => literal(role, &value)?,
        };
        let frame = FrameUse { name, frame };
        if let (Some(key), Some(list)) = (key, list) {
            self.own
                .frames
                .insert(key, (Rc::clone(list), frame.clone()));
        }
        Ok(frame)
    }
}

const STATE_IT: &str =
    "state the frame when reading, or write the motions with one that does not change";

/// `[robhold, tframe, tload]` or `[robhold, ufprog, ufmec, uframe, oframe]`.
fn literal(role: Role, value: &Datum) -> Result<Frame, Reason> {
    let found: Option<Isometry3<f64>> = match (role, value.parts()) {
        (Role::Tool, [hold, frame, _]) => {
            if hold.as_truth() == Some(false) {
                return Err((
                    "the tool stands still and the robot holds the work piece".to_owned(),
                    "such programs are not corrected: take them out",
                ));
            }
            hold.as_truth().and_then(|_| frame_of(frame))
        }
        (Role::WorkObject, [hold, fixed, _, user, object]) => {
            if hold.as_truth() == Some(true) {
                return Err((
                    "the robot holds the work object".to_owned(),
                    "such programs are not corrected: take them out",
                ));
            }
            if fixed.as_truth() == Some(false) {
                return Err((
                    "the work object's user frame moves with a mechanical unit".to_owned(),
                    "a moving work piece is not corrected: take these motions into a program of their own",
                ));
            }
            frame_of(user).and_then(|user| Some(user * frame_of(object)?))
        }
        _ => None,
    };
    Ok(found.map_or_else(
        || Frame::Unknown {
            reason: value.unknown_reason().map_or_else(
                || "its declaration is not the literal of a tool or work object".to_owned(),
                |reason| reason.to_string(),
            ),
        },
        Frame::Known,
    ))
}

//! Tools and work objects of motions.

use std::rc::Rc;

use nalgebra::Isometry3;

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::{Place, Reason, Root};
use crate::interpreter::value::{Datum, Value};
use crate::model::frame::{Frame, FrameUse};
use crate::rapid::literals::frame_of;
use crate::rapid::state::Run;

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

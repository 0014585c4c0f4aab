//! The ends of motions and where their numbers stand: literals, declarations, elements of arrays, offsets.

use std::ops::Range;

use crate::interpreter::ends::Around;
use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::Reason;
use crate::interpreter::value::Datum;
use crate::model::site::{OffsetAxes, PartText, PoseText, ReplacedText, TargetSite};
use crate::model::target::PoseTarget;
use crate::rapid::literals::{numbers_in, pose_of, text_of};
use crate::rapid::state::Run;
use crate::text::Name;
use crate::text::number::NumberText;

/// An end that is known.
pub(crate) struct Found {
    pub pose: PoseTarget,
    pub site: TargetSite,
}

/// A further declaration of a target that an array has as an element.
const AROUND: Around = Around {
    before: |_| "CONST robtarget ".to_owned(),
    middle: b":=",
    after: b";",
};

const WRITE_IT: &str =
    "write the motion with a literal or declared target, or leave it as written when reading";

const IN_NUMBERS: &str = "write the target in numbers: [[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],[six external axes]], with q1 to q4 of length 1 in all, cf1 to cfx whole, and 9E9 for axes that are not there";
const OFFSETS: &str = "write the offsets as numbers, or leave the motion as written when reading";
const GIVE_IT: &str = "give the module that declares it as well";

impl Run<'_, '_> {
    /// The end that an expression in a motion statement is.
    pub(super) fn end(
        &mut self,
        expression: &Expression,
        statement: &Range<usize>,
    ) -> Result<Found, Reason> {
        let value = self.value(expression);
        let shown = self.text(expression);
        let pose = pose_of(self.files, &value).map_err(|reason| match &expression.node {
            Node::List(_) => (reason, IN_NUMBERS),
            Node::Call(name, _) if name.is("OFFS") || name.is("RELTOOL") => (reason, OFFSETS),
            Node::Word(name) if self.root(name).is_none() => (reason, GIVE_IT),
            Node::Word(_) | Node::Element(..) if value.unknown_reason().is_none() => {
                match value.parts().len() {
                    4 => (format!("`{shown}`: {reason}"), WRITE_IT),
                    _ => (format!("`{shown}` is no robtarget"), WRITE_IT),
                }
            }
            _ => (reason, WRITE_IT),
        })?;
        let site = self.site(expression, &value, &pose, statement);
        Ok(Found { pose, site })
    }

    /// Text position of the numbers of an end. If the statement refers to them by other names or computes them, a new end replaces the expression.
    fn site(
        &mut self,
        expression: &Expression,
        value: &Datum,
        pose: &PoseTarget,
        statement: &Range<usize>,
    ) -> TargetSite {
        let file = self.file();
        let span = file.span(&expression.tokens);
        let is_here = |_: &PoseText| {
            let literal = value.literal;
            literal.is_some_and(|literal| literal.is_within(file.index, statement))
        };
        let found = match &expression.node {
            Node::List(_) => text_of(value).filter(is_here).map(TargetSite::Literal),
            Node::Word(_) | Node::Element(..) => {
                text_of(value).and_then(|text| self.declared(expression, text, pose, &AROUND))
            }
            Node::Call(name, arguments) if name.is("OFFS") || name.is("RELTOOL") => {
                self.offset(name, arguments, &span)
            }
            _ => None,
        };
        found.unwrap_or_else(|| {
            let part = |at: usize, expression: &Expression| PartText {
                span: file.span(&expression.tokens),
                numbers: (value.parts().get(at))
                    .and_then(|part| numbers_in(part, file.index, &span))
                    .unwrap_or_default(),
            };
            TargetSite::Replaced(Box::new(ReplacedText {
                pose: pose.clone(),
                parts: match &expression.node {
                    Node::List(parts) => match parts.as_slice() {
                        [place, turn, ..] => Some([part(0, place), part(1, turn)]),
                        _ => None,
                    },
                    _ => None,
                },
                span: span.clone(),
            }))
        })
    }

    /// `Offs` and `RelTool` of a target that is written in numbers: their lengths are written otherwise.
    fn offset(
        &mut self,
        name: &Name,
        arguments: &[Argument],
        call: &Range<usize>,
    ) -> Option<TargetSite> {
        let file = self.file();
        let axes = match name.is("OFFS") {
            true => OffsetAxes::WorkObject,
            false => OffsetAxes::Tool,
        };
        let ordered: Vec<&Expression> = (arguments.iter())
            .filter(|argument| argument.option.is_none())
            .filter_map(|argument| argument.value.as_ref())
            .collect();
        let [base, lengths @ ..] = ordered.as_slice() else {
            return None;
        };
        let base = self.value(base);
        let literal = text_of(&base)?;
        let mut number = |length: &&Expression| {
            let value = self.value(length).as_number()?;
            let span = file.span(&length.tokens);
            Some(NumberText { span, value })
        };
        let numbers: Option<Vec<NumberText>> = lengths.iter().map(&mut number).collect();
        Some(TargetSite::Offset {
            call: call.clone(),
            arguments: Box::new(numbers?.try_into().ok()?),
            axes,
            base: Box::new(pose_of(self.files, &base).ok()?),
            literal: Box::new(literal),
        })
    }
}

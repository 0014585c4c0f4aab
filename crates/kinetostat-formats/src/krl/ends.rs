//! The ends of motions: positions in braces, declarations, elements of arrays, sums with a position in braces.

use std::ops::Range;

use nalgebra::{Isometry3, Translation3, Vector3};

use crate::interpreter::ends::Around;
use crate::interpreter::expression::{Expression, Node, Operator};
use crate::interpreter::run::Reason;
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::Sight;
use crate::interpreter::value::Datum;
use crate::krl::expression::expression_of;
use crate::krl::position::{Position, isometry, position_of};
use crate::krl::state::Run;
use crate::krl::table::Ends;
use crate::model::orientation::OrientationText;
use crate::model::site::{OffsetAxes, PartialText, PoseText, ReplacedText, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::text::number::NumberText;

const WRITE_IT: &str =
    "write the motion with a literal or a target of the .dat, or leave it as written when reading";
const GIVE_IT: &str = "give the .dat file that declares it as well (or $config.dat)";
const STATE_IT: &str = "give the .dat file that states it as well";

/// Reason of an end whose numbers are computed, and not all of them.
pub(crate) const ONLY_SOME: &str = "statements before it give it only some of X, Y, Z, A, B and C";

/// A further declaration beside one that shares its statement, or beside an element of an array.
const AROUND: Around = Around {
    before: |node| {
        let global = match node.sight {
            Sight::Everywhere => "GLOBAL ",
            Sight::Module => "",
        };
        let type_name = String::from_utf8_lossy(node.type_name.letters());
        format!("DECL {global}{type_name} ")
    },
    middle: b"=",
    after: b"",
};

/// End of a motion, as far as its own text states it.
#[derive(Debug, Clone)]
pub(super) struct End {
    pub target: Target,
    pub site: TargetSite,
    /// Stated members of X, Y, Z, A, B, C of a partial position; the others keep their previous values.
    pub open: Option<[Option<f64>; 6]>,
    pub external: Vec<Option<f64>>,
    /// B as it is stated.
    pub b: Option<f64>,
}

/// The places of the ends of a motion, by tokens, with what is added to them (`:{...}`).
pub(crate) fn ends_of(
    file: &TokenFile<'_>,
    tokens: &Range<usize>,
    ends: Ends,
) -> Vec<Range<usize>> {
    let count = match ends {
        Ends::Circular => 2,
        Ends::Joint | Ends::Linear | Ends::Step | Ends::JointStep => 1,
    };
    let mut found = Vec::with_capacity(count);
    let mut start = tokens.start + 1;
    for _ in 0..count {
        let mut at = start;
        let mut open = 0_usize;
        while at < tokens.end {
            match file.tokens[at].kind {
                Kind::Symbol(b'{' | b'[' | b'(') => open += 1,
                Kind::Symbol(b'}' | b']' | b')') => open = open.saturating_sub(1),
                Kind::Symbol(b',') if open == 0 => break,
                // Reference axes of a step: #BASE, #TOOL.
                Kind::Symbol(b'#') if open == 0 && at > start => break,
                // A word behind a whole value begins what is behind the end: C_DIS, WITH.
                Kind::Word
                    if open == 0
                        && at > start
                        && !file.is(at - 1, b':')
                        && !file.is(at - 1, b'.') =>
                {
                    break;
                }
                _ => {}
            }
            at += 1;
        }
        found.push(start..at);
        start = at + usize::from(file.is(at, b','));
    }
    found
}

impl Run<'_, '_> {
    /// The end that tokens of a motion are.
    pub(super) fn end(&mut self, tokens: &Range<usize>) -> Result<End, Reason> {
        if tokens.is_empty() {
            return Err(("the motion has no end".to_owned(), "write its target"));
        }
        let expression = expression_of(self.file(), tokens.clone());
        if let Node::Two(Operator::Behind, operands) = &expression.node {
            let [before, added] = &**operands;
            return self.sum(before, added, tokens);
        }
        if expression.node == Node::Unreadable {
            let reason = match self.file().is(tokens.start, b'{') {
                true => "it is no position in braces",
                false => "where it goes is computed while the program runs",
            };
            return Err((reason.to_owned(), WRITE_IT));
        }
        let value = self.value(&expression);
        let position = position_of(self.files, &value)
            .map_err(|reason| self.no_position(&expression, &value, reason))?;
        if let Some(values_deg) = joints_of(&position)? {
            return Ok(End {
                target: Target::Joints { values_deg },
                site: TargetSite::Fixed("it states the axes"),
                open: None,
                external: position.external_values(),
                b: None,
            });
        }
        let (pose, open) = position.pose();
        let site = self.site(&expression, &position, &pose);
        Ok(End {
            target: Target::Pose(pose),
            site,
            open,
            external: position.external_values(),
            b: position.coordinates()[4],
        })
    }

    /// Reason why the value of an end is no position.
    fn no_position(&self, expression: &Expression, value: &Datum, reason: String) -> Reason {
        let shown = self.file().text(&expression.tokens);
        match &expression.node {
            Node::Members(members) if members.is_empty() => {
                ("it states no place".to_owned(), "write X, Y, Z, A, B and C")
            }
            Node::Members(_) => (reason, WRITE_IT),
            Node::Word(name) if self.root(name).is_none() && !shown.starts_with('$') => {
                (reason, GIVE_IT)
            }
            Node::Word(_) | Node::Element(..) if value.members().is_empty() => {
                match value.unknown_reason() {
                    Some(reason) => (reason.to_string(), WRITE_IT),
                    None => (format!("`{shown}` has no value in these files"), STATE_IT),
                }
            }
            _ => (format!("`{shown}`: {reason}"), WRITE_IT),
        }
    }

    /// Text position of the numbers of an end.
    fn site(
        &mut self,
        expression: &Expression,
        position: &Position,
        pose: &PoseTarget,
    ) -> TargetSite {
        let span = self.file().span(&expression.tokens);
        if let Some(text) = position.text() {
            if matches!(expression.node, Node::Members(_)) {
                // Angles that are left out are those of before: known, though no number of them stands here.
                return TargetSite::Literal(PoseText {
                    unit_mm: 1.0,
                    convention: OrientationText::Abc,
                    ..text
                });
            }
            if let Some(declared) = self.declared(expression, text, pose, &AROUND) {
                return declared;
            }
        }
        if position.coordinates().iter().all(Option::is_some) {
            return TargetSite::Replaced(Box::new(ReplacedText {
                span,
                pose: pose.clone(),
                parts: None,
            }));
        }
        match (position.whole.clone(), position.texts()) {
            (Some((file, whole)), Some(numbers)) => TargetSite::Partial(Box::new(PartialText {
                file,
                whole,
                place: span,
                numbers,
            })),
            _ => TargetSite::Fixed(ONLY_SOME),
        }
    }

    /// `end:{X 0,Y 4,Z 0,A 0,B 0,C 0}`: in the axes of the end.
    fn sum(
        &mut self,
        before: &Expression,
        added: &Expression,
        tokens: &Range<usize>,
    ) -> Result<End, Reason> {
        let file = self.file();
        if matches!(before.node, Node::Two(Operator::Behind, _)) {
            return Err((
                "a sum of more than two positions is not followed".to_owned(),
                "write the motion with a target of its own",
            ));
        }
        let base = self.end(&before.tokens)?;
        let begin = file.span(&before.tokens).start;
        self.targets.is_no_end(file.index, begin);
        let (Target::Pose(base_pose), None) = (&base.target, &base.open) else {
            return Err((
                "what is added to has not all of X, Y, Z, A, B, C".to_owned(),
                "write them",
            ));
        };
        let value = self.value(added);
        let added = position_of(self.files, &value).map_err(|reason| (reason, WRITE_IT))?;
        if (added.external.iter().flatten()).any(|axis| axis.value != 0.0) {
            return Err((
                "what is added moves an external axis".to_owned(),
                "write the motion with a target of its own",
            ));
        }
        let by = isometry(added.coordinates().map(Option::unwrap_or_default))
            .unwrap_or_else(Isometry3::identity);
        let place = Translation3::from(base_pose.position_mm);
        let end = Isometry3::from_parts(place, base_pose.orientation) * by;
        let literal = match &base.site {
            TargetSite::Literal(text) => Some(text.clone()),
            TargetSite::Declared { declaration, .. } => {
                let declaration = self.targets.declarations.get(*declaration);
                declaration.map(|declaration| declaration.text.clone())
            }
            _ => None,
        };
        let pose = PoseTarget {
            position_mm: end.translation.vector,
            orientation: end.rotation,
            ..base_pose.clone()
        };
        let here = |numbers: [Option<NumberText>; 6]| match numbers {
            [Some(x), Some(y), Some(z), ..] => Some([x, y, z]),
            _ => None,
        };
        let is_here = added.whole.as_ref().is_some_and(|(of, whole)| {
            let span = file.span(tokens);
            *of == file.index && span.start <= whole.start && whole.end <= span.end
        });
        let site = match (added.texts().filter(|_| is_here).and_then(here), literal) {
            (Some(arguments), Some(literal)) => TargetSite::Offset {
                call: file.span(tokens),
                arguments: Box::new(arguments),
                axes: OffsetAxes::Tool,
                base: Box::new(base_pose.clone()),
                literal: Box::new(literal),
            },
            _ => TargetSite::Replaced(Box::new(ReplacedText {
                span: file.span(tokens),
                pose: pose.clone(),
                parts: None,
            })),
        };
        Ok(End {
            target: Target::Pose(pose),
            site,
            open: None,
            external: base.external,
            b: None,
        })
    }
}

/// Axes and none of X to C; none for a pose.
fn joints_of(position: &Position) -> Result<Option<Vec<f64>>, Reason> {
    let stated = position.axes.iter().flatten().count();
    let placed = position.numbers.iter().flatten().count();
    match (stated, placed) {
        (0, 0) => Err(("it states no place".to_owned(), "write X, Y, Z, A, B and C")),
        (0, _) => Ok(None),
        (6, 0) => Ok(Some(position.axes.iter().flatten().copied().collect())),
        (_, 0) => Err((
            "it states only some axes: the others are those of before".to_owned(),
            "write A1 to A6",
        )),
        _ => Err((
            "it mixes axes with places".to_owned(),
            "write A1 to A6, or X, Y, Z, A, B and C",
        )),
    }
}

/// The remedy for a step that is not followed.
pub(crate) const WRITE_END: &str = "write the end with LIN, or PTP, and all its numbers";

/// A step from where the tool is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Step {
    /// Step along the axes of the base, or of the tool, mm.
    Along {
        step_mm: Vector3<f64>,
        in_tool: bool,
    },
    /// Step of the joints, degrees.
    Joints([f64; 6]),
}

impl Step {
    /// The target behind it; none where what it goes on from does not say it.
    pub(crate) fn from(self, before: &Target) -> Option<Target> {
        match (self, before) {
            (Self::Along { step_mm, in_tool }, Target::Pose(before)) => {
                let mut pose = before.clone();
                // The arm configuration at the end of a step is not stated.
                pose.configuration = Configuration::default();
                pose.position_mm += match in_tool {
                    true => before.orientation * step_mm,
                    false => step_mm,
                };
                Some(Target::Pose(pose))
            }
            (Self::Joints(by), Target::Joints { values_deg }) if values_deg.len() == by.len() => {
                let values = values_deg.iter().zip(by).map(|(value, by)| value + by);
                Some(Target::Joints {
                    values_deg: values.collect(),
                })
            }
            _ => None,
        }
    }
}

/// The step that a position is (`{X 10,Z -5}`), which turns nothing; that of joints (`is_joint`) may be `{A1 10}`.
pub(crate) fn step_of(position: &Position, is_joint: bool, in_tool: bool) -> Result<Step, Reason> {
    let values = position.coordinates().map(Option::unwrap_or_default);
    let turns = values[3..].iter().any(|angle| *angle != 0.0);
    let external = position.external.iter().flatten();
    let moves_external = external.into_iter().any(|step| step.value != 0.0);
    let has_axes = position.axes.iter().any(Option::is_some);
    let is_of_axes = is_joint && position.numbers.iter().all(Option::is_none);
    match turns || moves_external || (has_axes && !is_of_axes) {
        true => Err((
            "it goes on from where the tool is, and turns it or moves axes".to_owned(),
            WRITE_END,
        )),
        false if has_axes => Ok(Step::Joints(position.axes.map(Option::unwrap_or_default))),
        false => Ok(Step::Along {
            step_mm: Vector3::new(values[0], values[1], values[2]),
            in_tool,
        }),
    }
}

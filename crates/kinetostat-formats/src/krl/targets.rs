//! The ends of motions: positions in braces, declarations, elements of arrays, sums with a position in braces.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Translation3};

use crate::krl::aggregate::{Position, position_of};
use crate::krl::assigned_frames::{Given, GivenEnd};
use crate::krl::frames::isometry;
use crate::krl::symbols::Datum;
use crate::krl::values::{Reason, Values, WRITE_IT};
use crate::model::orientation::OrientationText;
use crate::model::site::{
    Declaration, DeclarationCopy, OffsetAxes, PartialText, PoseText, TargetSite,
};
use crate::model::target::{PoseTarget, Target};
use crate::text::number::NumberText;

/// Where a motion ends, as far as its own text says it.
#[derive(Debug, Clone)]
pub(crate) struct End {
    pub target: Target,
    pub site: TargetSite,
    /// What it states of X, Y, Z, A, B, C where that is not all: the rest is that of before.
    pub open: Option<[Option<f64>; 6]>,
    pub external: Vec<Option<f64>>,
}

/// The targets of a program.
#[derive(Default)]
pub(crate) struct Targets {
    pub declarations: Vec<Declaration>,
    /// By file and place of the declared value.
    known: BTreeMap<(usize, usize), usize>,
}

/// What a position states where that is not all, and where the statement has it.
fn partial(position: Position, file: usize, place: Range<usize>) -> TargetSite {
    TargetSite::Partial(Box::new(PartialText {
        file,
        whole: position.whole,
        place,
        numbers: position.numbers,
    }))
}

/// A position without the members that it leaves open.
fn pose_of(position: &Position) -> (PoseTarget, Option<[Option<f64>; 6]>) {
    let values = position.values();
    let whole = values.iter().all(Option::is_some);
    let numbers = values.map(Option::unwrap_or_default);
    let frame = isometry(numbers).unwrap_or_else(Isometry3::identity);
    let pose = PoseTarget {
        position_mm: frame.translation.vector,
        orientation: frame.rotation,
        configuration: position.configuration.clone(),
        external: position.external_values(),
    };
    (pose, (!whole).then_some(values))
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

impl Targets {
    /// The end that tokens of a motion in a routine are.
    pub(crate) fn find(
        &mut self,
        values: &Values<'_>,
        (routine, given): (usize, &Given),
        tokens: &Range<usize>,
    ) -> Result<End, Reason> {
        let file = values.file(routine);
        if tokens.is_empty() {
            return Err(("the motion has no end".to_owned(), "write its target"));
        }
        if let Some(colon) = file.find(tokens.clone(), b':') {
            return self.sum(values, (routine, given), tokens, colon);
        }
        if file.is(tokens.start, b'{') {
            let position =
                position_of(file, tokens).map_err(|reason| (reason.to_owned(), WRITE_IT))?;
            if let Some(values_deg) = joints_of(&position)? {
                return Ok(joints(values_deg, &position));
            }
            let (pose, open) = pose_of(&position);
            let external = position.external_values();
            let site = match position.text(file.index) {
                // Angles that are left out are those of before: known, though no number of them stands here.
                Some(text) => TargetSite::Literal(PoseText {
                    convention: OrientationText::Abc,
                    ..text
                }),
                None => partial(position, file.index, file.span(tokens)),
            };
            return Ok(End {
                target: Target::Pose(pose),
                site,
                open,
                external,
            });
        }
        if let Some(given) = values.assigned_end(routine, tokens, given) {
            return assigned(&file.text(tokens), given);
        }
        let (datum, stated) = values.datum(routine, tokens)?;
        let home = &values.files[datum.file];
        let position = position_of(home, &stated.value)
            .map_err(|reason| (format!("`{}`: {reason}", file.text(tokens)), WRITE_IT))?;
        if let Some(values_deg) = joints_of(&position)? {
            return Ok(joints(values_deg, &position));
        }
        let (pose, open) = pose_of(&position);
        let Some(text) = position.text(datum.file) else {
            return Ok(End {
                target: Target::Pose(pose),
                external: position.external_values(),
                site: partial(position, datum.file, file.span(tokens)),
                open,
            });
        };
        let key = (datum.file, text.whole.start);
        let declaration = match self.known.get(&key) {
            Some(known) => *known,
            None => {
                let whole = text.whole.clone();
                let name = home.span(&(stated.name_at..stated.name_at + 1));
                self.declarations.push(Declaration {
                    statement: home.span(&stated.statement),
                    name,
                    text,
                    pose: pose.clone(),
                    keeps_value: stated.keeps_value,
                    copy: match stated.alone && home.span(&stated.statement).end == whole.end {
                        true => DeclarationCopy::Statement,
                        false => around(datum),
                    },
                });
                self.known.insert(key, self.declarations.len() - 1);
                self.declarations.len() - 1
            }
        };
        let site = TargetSite::Declared {
            declaration,
            name: file.span(tokens),
        };
        Ok(End {
            target: Target::Pose(pose),
            site,
            open,
            external: position.external_values(),
        })
    }

    /// `end:{X 0,Y 4,Z 0,A 0,B 0,C 0}`: in the axes of the end.
    fn sum(
        &mut self,
        values: &Values<'_>,
        (routine, given): (usize, &Given),
        tokens: &Range<usize>,
        colon: usize,
    ) -> Result<End, Reason> {
        let file = values.file(routine);
        if file.find(colon + 1..tokens.end, b':').is_some() {
            return Err((
                "a sum of more than two positions is not followed".to_owned(),
                "write the motion with a target of its own",
            ));
        }
        let base = self.find(values, (routine, given), &(tokens.start..colon))?;
        let (Target::Pose(base_pose), None) = (&base.target, &base.open) else {
            return Err((
                "what is added to has not all of X, Y, Z, A, B, C".to_owned(),
                "write them",
            ));
        };
        if !file.is(colon + 1, b'{') {
            return Err((
                "what is added is no position in braces".to_owned(),
                "write the sum with numbers: `XP1:{X 0,Y 0,Z 10,A 0,B 0,C 0}`",
            ));
        }
        let added = position_of(file, &(colon + 1..tokens.end))
            .map_err(|reason| (reason.to_owned(), WRITE_IT))?;
        if added
            .external
            .iter()
            .flatten()
            .any(|axis| axis.value != 0.0)
        {
            return Err((
                "what is added moves an external axis".to_owned(),
                "write the motion with a target of its own",
            ));
        }
        let by = isometry(added.values().map(Option::unwrap_or_default))
            .unwrap_or_else(Isometry3::identity);
        let end = Isometry3::from_parts(
            Translation3::from(base_pose.position_mm),
            base_pose.orientation,
        ) * by;
        let literal = match &base.site {
            TargetSite::Literal(text) => Some(text.clone()),
            TargetSite::Declared { declaration, .. } => {
                Some(self.declarations[*declaration].text.clone())
            }
            TargetSite::Offset { .. }
            | TargetSite::Replaced(_)
            | TargetSite::Partial(_)
            | TargetSite::Joints(_)
            | TargetSite::Fixed(_) => None,
        };
        let site = match (numbers(&added), literal) {
            (Some(arguments), Some(literal)) => TargetSite::Offset {
                call: file.span(tokens),
                arguments: Box::new(arguments),
                axes: OffsetAxes::Tool,
                base: Box::new(base_pose.clone()),
                literal: Box::new(literal),
            },
            _ => TargetSite::Fixed("what is added states only some of X, Y and Z"),
        };
        let pose = PoseTarget {
            position_mm: end.translation.vector,
            orientation: end.rotation,
            ..base_pose.clone()
        };
        Ok(End {
            target: Target::Pose(pose),
            site,
            open: None,
            external: base.external,
        })
    }
}

/// The end that statements before gave to a name, in numbers.
fn assigned(name: &str, given: &GivenEnd) -> Result<End, Reason> {
    let GivenEnd { line, position, .. } = given;
    if let Some(values_deg) = joints_of(position)? {
        return Ok(joints(values_deg, position));
    }
    let (pose, open) = pose_of(position);
    if open.is_some() {
        return Err((
            format!("`{name}` gets only some of X, Y, Z, A, B and C in line {line}"),
            "write all of them there",
        ));
    }
    Ok(End {
        target: Target::Pose(pose),
        site: TargetSite::Fixed("a statement before it assigns its end"),
        open: None,
        external: position.external_values(),
    })
}

fn joints(values_deg: Vec<f64>, position: &Position) -> End {
    End {
        target: Target::Joints { values_deg },
        site: TargetSite::Fixed("it states the axes"),
        open: None,
        external: position.external_values(),
    }
}

fn numbers(position: &Position) -> Option<[NumberText; 3]> {
    match &position.numbers {
        [Some(x), Some(y), Some(z), ..] => Some([x.clone(), y.clone(), z.clone()]),
        _ => None,
    }
}

/// A further declaration beside one that shares its statement, or beside an element of an array.
fn around(datum: &Datum) -> DeclarationCopy {
    let global = match datum.is_global {
        true => "GLOBAL ",
        false => "",
    };
    let type_name = String::from_utf8_lossy(datum.type_name.letters()).into_owned();
    DeclarationCopy::Around {
        before: format!("DECL {global}{type_name} ").into_bytes(),
        middle: b"=".to_vec(),
        after: Vec::new(),
    }
}

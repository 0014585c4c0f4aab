//! The ends of motions: literals, declarations, elements of arrays, offsets.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::model::site::{Declaration, DeclarationCopy, OffsetAxes, PoseText, TargetSite};
use crate::model::target::PoseTarget;
use crate::rapid::expression::{Argument, Expression, Value};
use crate::rapid::frames::{Reason, Values};
use crate::rapid::literals::target_of;
use crate::rapid::symbols::Meaning;
use crate::rapid::tree::Change;
use crate::text::finding::Finding;
use crate::text::name::Name;
use crate::text::number::NumberText;

/// Deepest nesting of offsets of offsets.
const DEEPEST: usize = 8;

/// An end that is known.
pub(crate) struct Found {
    pub pose: PoseTarget,
    pub site: TargetSite,
}

/// The targets of a program.
#[derive(Default)]
pub(crate) struct Targets {
    pub declarations: Vec<Declaration>,
    pub findings: Vec<Finding>,
    /// By datum and element.
    known: BTreeMap<(usize, Vec<usize>), usize>,
    arrays: BTreeMap<usize, Option<Expression>>,
}

const WRITE_IT: &str =
    "write the motion with a literal or declared target, or leave it as written when reading";
const IN_NUMBERS: &str = "write the target in numbers: [[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],[six external axes]], with q1 to q4 of length 1 in all, cf1 to cfx whole, and 9E9 for axes that are not there";
const IS_COMPUTED: &str = "where it goes is computed while the program runs";

impl Targets {
    /// The end that an expression in a routine is.
    pub(crate) fn find(
        &mut self,
        values: &Values<'_>,
        routine: usize,
        expression: &Expression,
    ) -> Result<Found, Reason> {
        self.find_nested(values, routine, expression, 0)
    }

    /// The end that constants are, where the expression itself has no number that could be written otherwise.
    fn of_constants(values: &Values<'_>, routine: usize, expression: &Expression) -> Option<Found> {
        let file = &values.files[values.symbols.routines[routine].file];
        let numbers = values.in_numbers(routine, expression)?;
        let (_, mut pose) = target_of(file, &numbers).ok()?;
        let parts = pose.configuration.numbers.iter().map(f64::to_string);
        pose.configuration.text = format!("[{}]", parts.collect::<Vec<String>>().join(","));
        Some(Found {
            pose,
            site: TargetSite::Fixed("its numbers are those of constants"),
        })
    }

    fn find_nested(
        &mut self,
        values: &Values<'_>,
        routine: usize,
        expression: &Expression,
        depth: usize,
    ) -> Result<Found, Reason> {
        let file = &values.files[values.symbols.routines[routine].file];
        match &expression.value {
            Value::List(_) => {
                let (text, pose) = match target_of(file, expression) {
                    Ok(literal) => literal,
                    Err(reason) => {
                        let found = Self::of_constants(values, routine, expression);
                        return found.ok_or_else(|| (reason.to_owned(), IN_NUMBERS));
                    }
                };
                Ok(Found {
                    pose,
                    site: TargetSite::Literal(text),
                })
            }
            Value::Word(name) => {
                let span = file.span(&expression.tokens);
                let found = self.declared(values, routine, name, &[], span);
                found.or_else(|fault| Self::of_constants(values, routine, expression).ok_or(fault))
            }
            Value::Element(name, indices) => {
                let index = |part: &Expression| {
                    let value = values.number(routine, part)?;
                    ((1.0..1e9).contains(&value) && value.fract() == 0.0).then_some(value as usize)
                };
                let indices: Option<Vec<usize>> = indices.iter().map(index).collect();
                let indices = indices.ok_or_else(|| (IS_COMPUTED.to_owned(), WRITE_IT))?;
                self.declared(
                    values,
                    routine,
                    name,
                    &indices,
                    file.span(&expression.tokens),
                )
            }
            Value::Call(name, arguments)
                if depth < DEEPEST && (name.is("OFFS") || name.is("RELTOOL")) =>
            {
                let axes = match name.is("OFFS") {
                    true => OffsetAxes::WorkObject,
                    false => OffsetAxes::Tool,
                };
                let call = file.span(&expression.tokens);
                self.offset(values, routine, axes, arguments, call, depth)
            }
            _ => Err((IS_COMPUTED.to_owned(), WRITE_IT)),
        }
    }

    fn declared(
        &mut self,
        values: &Values<'_>,
        routine: usize,
        name: &Name,
        indices: &[usize],
        span: Range<usize>,
    ) -> Result<Found, Reason> {
        let own = &values.files[values.symbols.routines[routine].file];
        let shown = String::from_utf8_lossy(own.source.part(&span));
        let shown = shown.split('{').next().unwrap_or_default().trim_end();
        let index = match values.symbols.meaning(routine, name) {
            Some(Meaning::Datum(index)) => index,
            Some(Meaning::Parameter) => {
                let reason = format!(
                    "`{shown}` is an argument of the routine: it differs from call to call"
                );
                return Err((
                    reason,
                    "write the motion where the routine is called, with its target",
                ));
            }
            None => {
                let reason = format!("no `{shown}` is declared in these files");
                return Err((reason, "give the module that declares it as well"));
            }
        };
        let datum = &values.symbols.data[index];
        if !datum.node.type_name.is("ROBTARGET") {
            return Err((format!("`{shown}` is no robtarget"), WRITE_IT));
        }
        if let (Some((file, line)), false) = (datum.assigned, values.symbols.is_fixed(index)) {
            let reason = values.changed(shown, own.index, file, line);
            return Err((reason, WRITE_IT));
        }
        let key = (index, indices.to_vec());
        if !self.known.contains_key(&key) {
            let declaration = self.declare(values, index, indices, shown)?;
            self.known.insert(key.clone(), self.declarations.len());
            self.declarations.push(declaration);
        }
        let declaration = self.known[&key];
        Ok(Found {
            pose: self.declarations[declaration].pose.clone(),
            site: TargetSite::Declared {
                declaration,
                name: span,
            },
        })
    }

    fn declare(
        &mut self,
        values: &Values<'_>,
        index: usize,
        indices: &[usize],
        shown: &str,
    ) -> Result<Declaration, Reason> {
        let no_value = || (format!("`{shown}` is declared without a value"), WRITE_IT);
        let datum = &values.symbols.data[index];
        let file = &values.files[datum.file];
        let whole;
        let element = match indices.is_empty() {
            true => {
                whole = values.initial(index).ok_or_else(no_value)?;
                &whole
            }
            false => {
                let array = self
                    .arrays
                    .entry(index)
                    .or_insert_with(|| values.initial(index));
                let array = array.as_ref().ok_or_else(no_value)?;
                let found = indices
                    .iter()
                    .try_fold(array, |list, at| match &list.value {
                        Value::List(parts) => parts.get(at.checked_sub(1)?),
                        _ => None,
                    });
                found.ok_or_else(|| (format!("`{shown}` has no such element"), "mend the index"))?
            }
        };
        let (text, pose) = target_of(file, element)
            .map_err(|reason| (format!("`{shown}`: {reason}"), WRITE_IT))?;
        let name = file.span(&(datum.node.name_at..datum.node.name_at + 1));
        if datum.node.change == Change::Persistent && indices.is_empty() {
            self.findings.push(Finding {
                file: datum.file,
                line: file.source.line_of(name.start),
                message: format!(
                    "`{shown}` is PERS: the controller may hold another value than this file; load the written one"
                ),
            });
        }
        let copy = match indices.is_empty() {
            true => DeclarationCopy::Statement,
            false => DeclarationCopy::Around {
                before: b"CONST robtarget ".to_vec(),
                middle: b":=".to_vec(),
                after: b";".to_vec(),
            },
        };
        Ok(Declaration {
            statement: file.span(&datum.node.tokens),
            name,
            text,
            pose,
            keeps_value: datum.keeps_value,
            copy,
        })
    }

    fn offset(
        &mut self,
        values: &Values<'_>,
        routine: usize,
        axes: OffsetAxes,
        arguments: &[Argument],
        call: Range<usize>,
        depth: usize,
    ) -> Result<Found, Reason> {
        let file = &values.files[values.symbols.routines[routine].file];
        let computed = || {
            (
                IS_COMPUTED.to_owned(),
                "write the offsets as numbers, or leave the motion as written when reading",
            )
        };
        let ordered: Vec<&Expression> = (arguments.iter())
            .filter(|argument| argument.option.is_none())
            .filter_map(|argument| argument.value.as_ref())
            .collect();
        let [base, x, y, z] = ordered.as_slice() else {
            return Err((
                "an offset has a target and three lengths".to_owned(),
                "mend its arguments",
            ));
        };
        let base = self.find_nested(values, routine, base, depth + 1)?;
        let number = |part: &Expression| {
            let value = values.number(routine, part)?;
            Some(NumberText {
                span: file.span(&part.tokens),
                value,
            })
        };
        let arguments_text = [
            number(x).ok_or_else(computed)?,
            number(y).ok_or_else(computed)?,
            number(z).ok_or_else(computed)?,
        ];
        let turn = turn(values, routine, arguments).ok_or_else(computed)?;
        let by = Vector3::from([0, 1, 2].map(|axis: usize| arguments_text[axis].value));
        let mut pose = base.pose.clone();
        match axes {
            OffsetAxes::WorkObject => pose.position_mm += by,
            OffsetAxes::Tool => {
                pose.position_mm += pose.orientation * by;
                pose.orientation *= turn;
            }
        }
        let Some(literal) = self.literal_of(&base.site) else {
            let site = TargetSite::Fixed("its numbers are those of constants");
            return Ok(Found { pose, site });
        };
        let site = TargetSite::Offset {
            call,
            arguments: Box::new(arguments_text),
            axes,
            base: Box::new(base.pose),
            literal: Box::new(literal),
        };
        Ok(Found { pose, site })
    }

    /// The literal that says the configuration of an end.
    fn literal_of(&self, site: &TargetSite) -> Option<PoseText> {
        match site {
            TargetSite::Literal(text) => Some(text.clone()),
            TargetSite::Declared { declaration, .. } => {
                Some(self.declarations[*declaration].text.clone())
            }
            TargetSite::Offset { literal, .. } => Some((**literal).clone()),
            TargetSite::Partial(_) | TargetSite::Joints(_) | TargetSite::Fixed(_) => None,
        }
    }
}

/// `\Rx`, `\Ry`, `\Rz` of RelTool: about x, then the new y, then the new z.
fn turn(
    values: &Values<'_>,
    routine: usize,
    arguments: &[Argument],
) -> Option<UnitQuaternion<f64>> {
    let angle = |capitals: &str| {
        let found = arguments
            .iter()
            .find(|argument| argument.option.is_some_and(|name| name.is(capitals)));
        match found {
            None => Some(0.0),
            Some(argument) => values
                .number(routine, argument.value.as_ref()?)
                .map(f64::to_radians),
        }
    };
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let (x, y, z) = (angle("RX")?, angle("RY")?, angle("RZ")?);
    Some(about(Vector3::x_axis(), x) * about(Vector3::y_axis(), y) * about(Vector3::z_axis(), z))
}

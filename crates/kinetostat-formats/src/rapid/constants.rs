//! Constants in the place of numbers and their lists: `[[0,0,cz],down,[0,0,0,0],noAxes]`, `CONST robtarget p2:=p1`, `OrientZYX(90,0,180)`.
//!
//! Source of `OrientZYX`: ABB, RAPID Instructions, Functions and Data types (3HAC050917): a turn about z, then about the new y, then about
//! the new x.

use nalgebra::{UnitQuaternion, Vector3};

use crate::rapid::expression::{Argument, Expression, Value, expression_of};
use crate::rapid::symbols::{Meaning, Scope, Symbols};
use crate::rapid::tree::Change;
use crate::rapid::tree::TokenFile;
use crate::text::name::Name;

/// Deepest nesting of lists and of constants that others are.
const DEEPEST: usize = 12;

/// Most numbers of an expression: constants in constants grow.
const MOST: usize = 64;

/// What the data of a program are declared with.
#[derive(Clone, Copy)]
pub(crate) struct Constants<'v, 'p> {
    pub(crate) symbols: &'v Symbols<'p>,
    pub(crate) files: &'p [TokenFile<'p>],
}

impl Constants<'_, '_> {
    /// The first value of a datum, in its file.
    pub(crate) fn declared(&self, index: usize) -> Option<Expression> {
        let datum = &self.symbols.data[index];
        let tokens = datum.node.initial.clone()?;
        Some(expression_of(&self.files[datum.file], tokens))
    }

    /// An expression of a routine in numbers alone; none where the run of the program says one of them.
    pub(crate) fn numbers_in(&self, routine: usize, expression: &Expression) -> Option<Expression> {
        let mut left = MOST;
        self.numbers_of(Scope::Routine(routine), expression, DEEPEST, &mut left)
    }

    fn numbers_of(
        &self,
        scope: Scope,
        expression: &Expression,
        depth: usize,
        left: &mut usize,
    ) -> Option<Expression> {
        let depth = depth.checked_sub(1)?;
        *left = left.checked_sub(1)?;
        let value = match &expression.value {
            Value::Number(_) => expression.value.clone(),
            Value::List(parts) => {
                let parts = parts.iter();
                let parts: Option<Vec<Expression>> = parts
                    .map(|part| self.numbers_of(scope, part, depth, left))
                    .collect();
                Value::List(parts?)
            }
            Value::Word(name) => {
                let (scope, initial) = self.constant(scope, name)?;
                self.numbers_of(scope, &initial, depth, left)?.value
            }
            Value::Call(name, arguments) if name.is("ORIENTZYX") => {
                let angle = |argument: &Argument| {
                    let found = self.numbers_of(scope, argument.value.as_ref()?, depth, left)?;
                    match found.value {
                        Value::Number(degrees) if argument.option.is_none() => {
                            Some(degrees.to_radians())
                        }
                        _ => None,
                    }
                };
                let angles: Option<Vec<f64>> = arguments.iter().map(angle).collect();
                let [z, y, x] = angles?.try_into().ok()?;
                let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
                let turn = about(Vector3::z_axis(), z)
                    * about(Vector3::y_axis(), y)
                    * about(Vector3::x_axis(), x);
                let number = |value: f64| Expression {
                    value: Value::Number(value),
                    tokens: expression.tokens.clone(),
                };
                Value::List([turn.w, turn.i, turn.j, turn.k].map(number).to_vec())
            }
            _ => return None,
        };
        Some(Expression {
            value,
            tokens: expression.tokens.clone(),
        })
    }

    /// The one value of a name, and where the names in it mean what they do.
    fn constant(&self, scope: Scope, name: &Name) -> Option<(Scope, Expression)> {
        let Meaning::Datum(index) = self.symbols.meaning_in(scope, name)? else {
            return None;
        };
        let datum = &self.symbols.data[index];
        // A controller may hold another value of a PERS than the file.
        let is_one = self.symbols.is_fixed(index) && datum.node.change != Change::Persistent;
        Some((datum.scope, is_one.then(|| self.declared(index))??))
    }
}

//! The parts of VAL3 that a run asks for.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::operation::{function, two};
use crate::interpreter::reading::Grammar;
use crate::interpreter::run::{Dialect, MotionParts};
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::{Choice, Counting, DatumNode, Flow, Leave, Statement};
use crate::interpreter::value::{Datum, Step, Value};
use crate::table::Treatment;
use crate::text::Name;
use crate::val3::expression::{self, PARTS};
use crate::val3::frames::{Run, Val3, numbers_of, own_trsf, single, trsf_of};
use crate::val3::instructions::{CHANGE_THEIRS, is_motion, is_one_of, row};

impl Dialect for Val3 {
    const OWN_COUNTER: bool = false;
    const DECLARES_BY_USE: bool = false;
    const GRAMMAR: &'static Grammar = &expression::GRAMMAR;
    const JOINS_FILES: bool = false;
    const NO_MAIN: [&'static str; 2] = [
        "there is no program in these files: which one is to be run is not known",
        "give the .pgx file of the program that cuts",
    ];

    fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
        expression::expression_of(file, tokens)
    }

    fn component(of: &Datum, name: &Name) -> Option<Step> {
        let place = |names: [&str; 6]| names.iter().position(|own| name.is(own));
        match of.parts().len() {
            6 => PARTS.into_iter().find_map(place).map(Step::Index),
            _ => Some(Step::Member(*name)),
        }
    }

    fn predefined(name: &Name) -> Option<Datum> {
        let lower = String::from_utf8_lossy(name.letters()).to_ascii_lowercase();
        let text = |text: &str| Datum::of(Value::Text(text.into()));
        match name.letters() {
            b"WORLD" | b"FLANGE" => {
                let members = [
                    ("TRSF", Datum::numbers([0.0; 6])),
                    ("FATHERID", text(&lower)),
                ];
                let members = members
                    .into_iter()
                    .filter_map(|(own, value)| Some((Name::of(own.as_bytes())?, value)));
                Some(Datum::of(Value::Members(
                    members.collect::<Vec<_>>().into(),
                )))
            }
            b"OFF" | b"JOINT" | b"CARTESIAN" => Some(text(&lower)),
            _ => None,
        }
    }

    /// Local data begin with zeros; points, frames and tools have no frame before they get a value.
    fn of_type(node: &DatumNode) -> Option<Datum> {
        match node.type_name.letters() {
            b"NUM" => Some(Datum::number(0.0)),
            b"BOOL" => Some(Datum::truth(false)),
            b"STRING" => Some(Datum::of(Value::Text("".into()))),
            b"TRSF" => Some(Datum::numbers([0.0; 6])),
            _ => None,
        }
    }

    /// Data of the application keep what a run gives them until it is loaded again.
    fn decides_places(node: &DatumNode) -> bool {
        let letters = node.type_name.letters();
        letters.starts_with(b"POINT")
            || letters.starts_with(b"JOINT")
            || ["TRSF", "FRAME", "TOOL"]
                .iter()
                .any(|kind| node.type_name.is(kind))
    }

    /// A name without an index means the first element.
    fn converted(type_name: &Name, value: Datum) -> Datum {
        let is_number = ["NUM", "BOOL", "STRING"]
            .iter()
            .any(|kind| type_name.is(kind));
        match (is_number, value.parts().first()) {
            (true, Some(first)) => first.clone(),
            _ => single(&value).clone(),
        }
    }

    /// The product of two transformations.
    fn operation(_: &Run<'_, '_>, operator: Operator, left: &Datum, right: &Datum) -> Datum {
        let trsf = |of: &Datum| of.as_numbers::<6>().and_then(trsf_of);
        match (operator, trsf(left), trsf(right)) {
            (Operator::Times, Some(left), Some(right)) => {
                Datum::numbers(numbers_of(&(left * right), [0.0; 3]))
            }
            _ => two(operator, left, right),
        }
    }

    fn function(
        run: &mut Run<'_, '_>,
        name: &Name,
        arguments: &[Argument],
        _: &Expression,
    ) -> Option<Datum> {
        let values: Vec<Datum> = (arguments.iter().filter_map(|of| of.value.as_ref()))
            .map(|value| single(&run.value(value)).clone())
            .collect();
        if let Some(reason) = values.iter().find_map(Datum::unknown_reason) {
            return Some(Datum::unknown(reason.clone()));
        }
        match (name.letters(), values.as_slice()) {
            (b"APPRO", [point, by]) => Some(run.moved(point, None, by)),
            (b"COMPOSE", [point, frame, by]) => Some(run.moved(point, Some(frame), by)),
            (letters, [number]) => {
                let of_one = function(std::str::from_utf8(letters).ok()?)?;
                Some(of_one(number.as_number()?))
                    .filter(|value| value.is_finite())
                    .map(Datum::number)
            }
            _ => None,
        }
    }

    fn leaves_arguments(function: &Name) -> bool {
        !Self::changes_arguments(function) || is_one_of(function, &["appro", "compose"])
    }

    fn changes_arguments(instruction: &Name) -> bool {
        let is_known = row(instruction).is_some();
        !is_known || is_one_of(instruction, &CHANGE_THEIRS)
    }

    fn is_motion(word: &Name) -> bool {
        is_motion(word)
    }

    fn instruction(run: &mut Run<'_, '_>, tokens: &Range<usize>, _: Choice) -> Flow {
        run.instruction(tokens)
    }

    fn leave(_: &TokenFile<'_>, _: &Range<usize>) -> Leave {
        Leave::Returns(None)
    }

    /// `i=a to b step c`.
    fn counting(file: &TokenFile<'_>, header: &Range<usize>) -> Option<Counting> {
        let find = |word: &str| header.clone().find(|at| file.is_word(*at, word));
        let mut assigns = header
            .clone()
            .filter(|at| file.tokens[*at].kind == Kind::Assign);
        let (assign, to, step) = (assigns.next()?, find("TO")?, find("STEP"));
        (assign < to).then(|| Counting {
            variable: header.start..assign,
            from: assign + 1..to,
            to: to + 1..step.unwrap_or(header.end),
            step: step.map(|at| at + 1..header.end),
        })
    }

    fn acts(_: &Run<'_, '_>, file: &TokenFile<'_>, tokens: &Range<usize>) -> bool {
        let Some(name) = file.name(tokens.start) else {
            return true;
        };
        let acts = ["resetMotion", "taskCreate", "taskCreateSync"];
        let is_refused =
            row(&name).is_some_and(|row| matches!(row.treatment, Treatment::Refused { .. }));
        is_motion(&name) || is_refused || is_one_of(&name, &acts)
    }

    /// Programs that run beside as tasks.
    fn interrupting(run: &Run<'_, '_>) -> Vec<usize> {
        let mut found = Vec::new();
        for (index, home) in run.symbols.routines.iter().enumerate() {
            let file = &run.files[home.file];
            for statement in &home.routine.body {
                statement.each(&mut |statement: &Statement| {
                    if let Statement::Call { tokens } = statement
                        && file
                            .text(&(tokens.start..tokens.start + 1))
                            .to_ascii_uppercase()
                            .starts_with("TASKCREATE")
                    {
                        let names = tokens
                            .clone()
                            .filter(|at| file.is(at + 1, b'('))
                            .filter_map(|at| file.name(at));
                        found.extend(names.filter_map(|name| run.symbols.routine(index, &name)));
                    }
                });
            }
        }
        found
    }

    fn begin(run: &mut Run<'_, '_>) {
        run.own.is_moving = false;
    }

    fn motion_parts(file: &TokenFile<'_>, tokens: &Range<usize>) -> MotionParts {
        let arguments = Self::arguments_of(file, tokens.start + 1..tokens.end);
        // A point has no text of its own: what names it stays.
        let others = arguments
            .into_iter()
            .filter_map(|argument| argument.value)
            .collect();
        MotionParts {
            ends: Vec::new(),
            others,
        }
    }

    fn printed(datum: &Datum) -> Option<String> {
        Some(match &datum.value {
            Value::Number(value) => value.to_string(),
            Value::Truth(value) => value.to_string(),
            Value::Text(text) => format!("\"{text}\""),
            Value::List(parts) => {
                let numbers = parts.iter().map(|part| Some(part.as_number()?.to_string()));
                format!(
                    "{{{}}}",
                    numbers.collect::<Option<Vec<String>>>()?.join(",")
                )
            }
            Value::Members(_) | Value::Unknown(_) => return None,
        })
    }
}

impl Run<'_, '_> {
    /// A point moved in its own axes (`appro`), or in those of a frame (`compose`).
    ///
    /// Source: Staubli, VAL3 Reference Manual, `appro` and `compose`: the point keeps its frame and its configuration.
    fn moved(&mut self, point: &Datum, frame: Option<&Datum>, by: &Datum) -> Datum {
        let found = own_trsf(point).and_then(|own| {
            let by = by
                .as_numbers::<6>()
                .and_then(trsf_of)
                .ok_or("what it is moved by is no transformation of six numbers")?;
            let Some(frame) = frame else {
                return Ok(own * by);
            };
            let axes = self.frame_of(point);
            let axes = axes
                .known()
                .ok_or("the frame of the point is not known")?
                .inverse()
                * self.placed(frame, 0)?;
            Ok(axes * by * axes.inverse() * own)
        });
        match (found, Name::of(b"TRSF")) {
            (Ok(trsf), Some(name)) => {
                let mut moved = point.clone();
                let near = point
                    .member("TRSF")
                    .and_then(Datum::as_numbers::<6>)
                    .map_or([0.0; 3], |[.., a, b, c]| [a, b, c]);
                moved.put(
                    &[Step::Member(name)],
                    Datum::numbers(numbers_of(&trsf, near)),
                );
                moved
            }
            (Err(reason), _) => Datum::unknown(reason),
            (Ok(_), None) => Datum::unknown("it is no point"),
        }
    }
}

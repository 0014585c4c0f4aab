//! The parts of KRL that a run asks for.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node, Operator};
use crate::interpreter::operation::two;
use crate::interpreter::reading::Grammar;
use crate::interpreter::run::{Dialect, MotionParts};
use crate::interpreter::symbols::Scope;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Choice, Counting, DatumNode, Flow, Leave, Statement};
use crate::interpreter::value::{Datum, Step, Value};
use crate::krl::ends::ends_of;
use crate::krl::expression;
use crate::krl::lex::assignment;
use crate::krl::position::{datum_of, position_of};
use crate::krl::settings::is_in_force;
use crate::krl::state::{InForce, Krl, Role, Run};
use crate::krl::table::{motion_row, only_reads, row};
use crate::table::Treatment;
use crate::text::Name;

/// Limit of the elements of an undeclared array.
const MOST_UNDECLARED: usize = 128;

/// Types of positions: they decide where the tool goes.
const POSITIONS: [&str; 7] = ["FRAME", "POS", "E3POS", "E6POS", "AXIS", "E3AXIS", "E6AXIS"];

impl Dialect for Krl {
    const OWN_COUNTER: bool = false;
    const DECLARES_BY_USE: bool = true;

    const GRAMMAR: &'static Grammar = &expression::GRAMMAR;

    fn component(_: &Datum, name: &Name) -> Option<Step> {
        Some(Step::Member(*name))
    }

    fn predefined(name: &Name) -> Option<Datum> {
        let is_origin = name.is("$NULLFRAME") || name.is("$WORLD");
        is_origin.then(|| datum_of(&nalgebra::Isometry3::identity()))
    }

    fn of_type(node: &DatumNode) -> Option<Datum> {
        let is_number = ["INT", "REAL", "BOOL", "CHAR"]
            .iter()
            .any(|own| node.type_name.is(own));
        (!is_number).then(|| Datum::of(Value::Members(Default::default())))
    }

    /// A data list keeps what a run gives it.
    fn kept(run: &Run<'_, '_>, index: usize) -> Option<String> {
        let datum = &run.symbols.data[index];
        let is_changed = || run.own.assigned.contains_key(&datum.node.name);
        let is_kept = matches!(datum.scope, Scope::Module(_)) && is_changed();
        is_kept.then(|| {
            format!(
                "`{}` keeps its value from run to run: the controller may hold another than this file, load the written one",
                run.shown(index)
            )
        })
    }

    fn decides_places(node: &DatumNode) -> bool {
        POSITIONS.iter().any(|name| node.type_name.is(name))
    }

    fn function(
        run: &mut Run<'_, '_>,
        name: &Name,
        _arguments: &[Argument],
        whole: &Expression,
    ) -> Option<Datum> {
        run.note_outside(name, &whole.tokens);
        None
    }

    fn leaves_arguments(function: &Name) -> bool {
        only_reads(function)
    }

    fn changes_arguments(instruction: &Name) -> bool {
        motion_row(instruction).is_none() && !only_reads(instruction)
    }

    fn is_motion(word: &Name) -> bool {
        motion_row(word).is_some()
    }

    /// Source: KUKA System Software 8.x, data types: a REAL is rounded where an INT takes it.
    fn converted(type_name: &Name, value: Datum) -> Datum {
        match value.as_number() {
            Some(number) if type_name.is("INT") && number.fract() != 0.0 => {
                Datum::number(number.round())
            }
            _ => value,
        }
    }

    /// Two INT have an INT as their quotient.
    fn divides_whole(run: &Run<'_, '_>, operands: &[Expression; 2]) -> bool {
        operands.iter().all(|operand| is_whole(run, operand))
    }

    fn changes_by_itself(name: &Name) -> bool {
        const RUNNING: [&str; 8] = [
            "$TIMER",
            "$TIMER_FLAG",
            "$CYCFLAG",
            "$IN",
            "$ANIN",
            "$POS_ACT",
            "$AXIS_ACT",
            "$ROB_TIMER",
        ];
        RUNNING.iter().any(|own| name.is(own))
    }

    fn operation(run: &Run<'_, '_>, operator: Operator, left: &Datum, right: &Datum) -> Datum {
        if operator != Operator::Behind {
            return two(operator, left, right);
        }
        let frame = |of: &Datum| {
            let position = position_of(run.files, of)?;
            position
                .frame()
                .ok_or_else(|| "its numbers are not all stated".to_owned())
        };
        match (frame(left), frame(right)) {
            (Ok(left), Ok(right)) => datum_of(&(left * right)),
            (Err(reason), _) | (_, Err(reason)) => Datum::unknown(reason),
        }
    }

    fn assigned(run: &mut Run<'_, '_>, tokens: &Range<usize>, assign: usize) {
        let file = run.file();
        if let Some(name) = file.name(tokens.start)
            && run.root(&name).is_none()
        {
            // An undeclared variable becomes known at its first assignment.
            let unknown = || Datum::of(Value::Members(Default::default()));
            let value = match file.is(tokens.start + 1, b'[') {
                true => Datum::list((0..MOST_UNDECLARED).map(|_| unknown()).collect()),
                false => unknown(),
            };
            run.undeclared.insert(name, value);
        }
        if let Some(role) = file.name(tokens.start).as_ref().and_then(Role::of_array) {
            run.gives_frame(role, tokens, assign);
        }
        if let Err(reason) = run.set(tokens, assign) {
            run.fault(tokens, reason);
        }
    }

    fn instruction(run: &mut Run<'_, '_>, tokens: &Range<usize>, _: Choice) -> Flow {
        run.instruction(tokens)
    }

    fn leave(file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave {
        if file.is_word(tokens.start, "EXIT") {
            return Leave::Breaks;
        }
        match file.name(tokens.start + 1) {
            Some(label) if file.is_word(tokens.start, "GOTO") => Leave::Jump(label),
            _ => {
                let value = tokens.start + 1..tokens.end;
                Leave::Returns((!value.is_empty()).then_some(value))
            }
        }
    }

    /// `i=a TO b STEP c`.
    fn counting(file: &TokenFile<'_>, header: &Range<usize>) -> Option<Counting> {
        let find = |word: &str| header.clone().find(|at| file.is_word(*at, word));
        let (equals, to, step) = (file.find(header.clone(), b'=')?, find("TO")?, find("STEP"));
        (equals < to).then(|| Counting {
            variable: header.start..equals,
            from: equals + 1..to,
            to: to + 1..step.unwrap_or(header.end),
            step: step.map(|at| at + 1..header.end),
        })
    }

    fn acts(run: &Run<'_, '_>, file: &TokenFile<'_>, tokens: &Range<usize>) -> bool {
        let Some(name) = file.name(tokens.start) else {
            return true;
        };
        if motion_row(&name).is_some() || is_in_force(&name) || name.is("BAS") {
            return true;
        }
        let is_refused = |name: &Name| {
            let row = row(name);
            row.is_some_and(|row| matches!(row.treatment, Treatment::Refused { .. }))
        };
        let is_spline = name.is("SPLINE") || name.is("ENDSPLINE");
        let is_assignment = b"=.[".iter().any(|byte| file.is(tokens.start + 1, *byte));
        let is_known = is_assignment || file.is(tokens.start + 1, b'(') || row(&name).is_some();
        let mut called = tokens.clone().filter(|at| file.is(*at + 1, b'('));
        let calls_refused = called.any(|at| {
            let name = file.name(at);
            name.is_some_and(|name| is_refused(&name) && run_routine(run, &name).is_none())
        });
        is_spline || !is_known || is_refused(&name) || calls_refused
    }

    fn interrupting(run: &Run<'_, '_>) -> Vec<usize> {
        let mut found = Vec::new();
        for (index, home) in run.symbols.routines.iter().enumerate() {
            let file = &run.files[home.file];
            let mut see = |statement: &Statement| {
                let Statement::Call { tokens } = statement else {
                    return;
                };
                let is_interrupt = ["INTERRUPT", "TRIGGER", "GLOBAL"]
                    .iter()
                    .any(|word| file.is_word(tokens.start, word));
                if is_interrupt {
                    let called = tokens.clone().filter(|at| file.is(*at + 1, b'('));
                    let names = called.filter_map(|at| file.name(at));
                    found.extend(names.filter_map(|name| run.symbols.routine(index, &name)));
                }
            };
            for statement in &home.routine.body {
                statement.each(&mut see);
            }
        }
        found
    }

    fn begin(run: &mut Run<'_, '_>) {
        run.own.force = InForce::default();
        run.own.spline = None;
        run.own.along_next = None;
        run.own.initial.clear();
        run.own.used.clear();
    }

    const JOINS_FILES: bool = false;

    const NO_MAIN: [&'static str; 2] = [
        "there is no DEF in these files: which routine is to be run is not known",
        "give the .src file of the routine that cuts",
    ];

    fn motion_parts(file: &TokenFile<'_>, tokens: &Range<usize>) -> MotionParts {
        let read = |tokens: Range<usize>| expression::expression_of(file, tokens);
        let row = file.name(tokens.start).as_ref().and_then(motion_row);
        let ends = row.map_or_else(Vec::new, |row| ends_of(file, tokens, row.ends));
        let with = tokens.clone().find(|at| file.is_word(*at, "WITH"));
        let list = with.map(|at| at + 1..tokens.end);
        let items = list.iter().flat_map(|list| file.split(list));
        let values = items.filter_map(|item| {
            let equals = assignment(file, &item)?;
            Some(read(equals + 1..item.end))
        });
        MotionParts {
            others: values.collect(),
            ends: ends.into_iter().map(read).collect(),
        }
    }

    fn printed(datum: &Datum) -> Option<String> {
        Some(match &datum.value {
            Value::Number(value) => value.to_string(),
            Value::Truth(value) => if *value { "TRUE" } else { "FALSE" }.to_owned(),
            Value::Text(text) if text.starts_with('#') => text.to_string(),
            Value::Text(text) => format!("\"{text}\""),
            Value::Members(members) => {
                let members = members.iter().map(|(name, value)| {
                    let letters = String::from_utf8_lossy(name.letters());
                    let text = match value.as_number() {
                        // Below a picometre nothing is meant.
                        Some(number) if number.abs() < 1e7 => (1e9 * number).round() / 1e9,
                        _ => return Some(format!("{letters} {}", Self::printed(value)?)),
                    };
                    Some(format!("{letters} {}", text + 0.0))
                });
                let members: Option<Vec<String>> = members.collect();
                format!("{{{}}}", members?.join(","))
            }
            Value::List(_) | Value::Unknown(_) => return None,
        })
    }
}

/// True for an expression of the type INT.
fn is_whole(run: &Run<'_, '_>, expression: &Expression) -> bool {
    match &expression.node {
        Node::Number(_) => {
            let text = run.file().text(&expression.tokens);
            !text.contains(['.', 'e', 'E'])
        }
        Node::Word(name) => {
            let root = run.root(name);
            let type_name = root.and_then(|root| run.type_of(root));
            type_name.is_some_and(|type_name| type_name.is("INT"))
        }
        Node::Element(of, _) | Node::One(_, of) => is_whole(run, of),
        Node::Two(_, operands) => operands.iter().all(|operand| is_whole(run, operand)),
        _ => false,
    }
}

fn run_routine(run: &Run<'_, '_>, name: &Name) -> Option<usize> {
    match run.scope {
        Scope::Routine(from) => run.symbols.routine(from, name),
        Scope::Module(_) => None,
    }
}

impl Run<'_, '_> {
    /// Compares a frame that the program gives an element of an array with the one that the caller states.
    fn gives_frame(&mut self, role: Role, tokens: &Range<usize>, assign: usize) {
        let file = self.file();
        let to = expression::expression_of(file, tokens.start..assign);
        let Node::Element(_, indices) = &to.node else {
            return;
        };
        let [index] = indices.as_slice() else { return };
        if let Some(number) = self.value(index).as_number() {
            let value = self.value(&expression::expression_of(file, assign + 1..tokens.end));
            self.compare_with_stated(role, number as u32, &value);
        }
    }
}

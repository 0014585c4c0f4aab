//! The parts of RAPID that a run asks for.
//!
//! Data that every RAPID controller has: speeds, zones, the flange as a tool, the world as a work object.
//!
//! Source: ABB, RAPID Instructions, Functions and Data types, pages of `speeddata`, `zonedata`, `tooldata`, `wobjdata`.

use std::f64::consts::PI;
use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression};
use crate::interpreter::reading::Grammar;
use crate::interpreter::run::{Dialect, MotionParts};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{Change, Choice, Counting, DatumNode, Flow, Leave};
use crate::interpreter::value::{Datum, Step, Value, printed as by_grammar};
use crate::options::ExternalAxes;
use crate::rapid::functions::{CHANGE_THEIRS, computed, is_computed, leaves_arguments};
use crate::rapid::lex;
use crate::rapid::lex::Arguments;
use crate::rapid::literals::{component, list_of_frame};
use crate::rapid::state::{Modes, Rapid, Run, mode_of};
use crate::rapid::table::{EXTERNAL, Ends, motion_row, row};
use crate::table::Treatment;
use crate::text::Name;

impl Dialect for Rapid {
    const OWN_COUNTER: bool = true;
    const DECLARES_BY_USE: bool = false;

    const GRAMMAR: &'static Grammar = &lex::GRAMMAR;

    fn arguments_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Vec<Argument> {
        lex::arguments_of(file, tokens)
    }

    fn component(of: &Datum, name: &Name) -> Option<Step> {
        let letters = std::str::from_utf8(name.letters()).ok()?;
        component(letters, of.parts().len()).map(Step::Index)
    }

    fn predefined(name: &Name) -> Option<Datum> {
        predefined(name)
    }

    fn of_type(node: &DatumNode) -> Option<Datum> {
        let is_variable = node.change == Change::Variable;
        is_variable.then(|| of_type(&node.type_name)).flatten()
    }

    /// Values that decide where the tool goes, or which way the program takes. Frames, loads and speeds that controllers keep are stated
    /// again as they are set up.
    fn kept(run: &Run<'_, '_>, index: usize) -> Option<String> {
        const KINDS: [&str; 7] = ["NUM", "DNUM", "BOOL", "POS", "ORIENT", "POSE", "ROBTARGET"];
        let node = run.symbols.data[index].node;
        let decides = || KINDS.iter().any(|kind| node.type_name.is(kind));
        (node.change == Change::Persistent && decides()).then(|| {
            format!(
                "`{}` is PERS: the controller may hold another value than this file; load the written one",
                run.shown(index)
            )
        })
    }

    fn decides_places(node: &DatumNode) -> bool {
        const KINDS: [&str; 5] = ["ROBTARGET", "JOINTTARGET", "POS", "POSE", "ORIENT"];
        node.change == Change::Persistent && KINDS.iter().any(|kind| node.type_name.is(kind))
    }

    fn function(
        run: &mut Run<'_, '_>,
        name: &Name,
        arguments: &[Argument],
        whole: &Expression,
    ) -> Option<Datum> {
        if let Some(stated) = run.stated_signal(name, arguments) {
            return Some(stated);
        }
        if name.is("CROBT")
            && let Some(here) = run.current_target(arguments)
        {
            let key = run.key_of_call(whole);
            run.results.insert(key, here.clone());
            return Some(here);
        }
        let given = run.given(arguments);
        computed(name, &given)
    }

    fn leaves_arguments(function: &Name) -> bool {
        leaves_arguments(function)
    }

    fn changes_arguments(instruction: &Name) -> bool {
        row(instruction).is_none_or(|row| CHANGE_THEIRS.contains(&row.name))
    }

    fn is_motion(word: &Name) -> bool {
        motion_row(word).is_some()
    }

    fn instruction(run: &mut Run<'_, '_>, tokens: &Range<usize>, choice: Choice) -> Flow {
        run.instruction(tokens, choice)
    }

    fn leave(file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave {
        if file.is_word(tokens.start, "RETURN") {
            let value = tokens.start + 1..tokens.end.saturating_sub(1);
            return Leave::Returns((!value.is_empty()).then_some(value));
        }
        match Name::of(file.word(tokens.start + 1)) {
            Some(label) if file.is_word(tokens.start, "GOTO") => Leave::Jump(label),
            _ => Leave::Ends,
        }
    }

    /// `i FROM a TO b STEP c`.
    fn counting(file: &TokenFile<'_>, header: &Range<usize>) -> Option<Counting> {
        let find = |word: &str| header.clone().find(|at| file.is_word(*at, word));
        let (to, step) = (find("TO")?, find("STEP"));
        file.is_word(header.start + 1, "FROM").then(|| Counting {
            variable: header.start..header.start + 1,
            from: header.start + 2..to,
            to: to + 1..step.unwrap_or(header.end),
            step: step.map(|at| at + 1..header.end),
        })
    }

    fn acts(run: &Run<'_, '_>, file: &TokenFile<'_>, tokens: &Range<usize>) -> bool {
        let Some(name) = Name::of(file.word(tokens.start)) else {
            return true;
        };
        if motion_row(&name).is_some() || mode_of(file, tokens).is_some() {
            return true;
        }
        match row(&name).map(|row| row.treatment) {
            Some(EXTERNAL) => run.options.external_axes != ExternalAxes::Carried,
            Some(Treatment::Refused { .. }) => true,
            Some(_) => ["EXITCYCLE", "PDISPSET", "PDISPOFF"]
                .iter()
                .any(|word| name.is(word)),
            None => is_computed(file, tokens),
        }
    }

    fn begin(run: &mut Run<'_, '_>) {
        run.own.modes = Modes::BASIC;
        run.own.displacement = None;
    }

    const JOINS_FILES: bool = true;

    const NO_MAIN: [&'static str; 2] = [
        "there is no PROC main in these files: which routine is to be run is not known",
        "name the one that cuts main",
    ];

    fn motion_parts(file: &TokenFile<'_>, tokens: &Range<usize>) -> MotionParts {
        let mut arguments = Arguments::of(file, tokens.start + 1..tokens.end);
        let name = Name::of(file.word(tokens.start));
        let is_circle = name
            .as_ref()
            .and_then(motion_row)
            .is_some_and(|row| row.ends == Ends::Circular);
        let ends = (1 + usize::from(is_circle)).min(arguments.ordered.len());
        let options = std::mem::take(&mut arguments.options).into_iter();
        let mut others = arguments.ordered.split_off(ends);
        others.extend(options.filter_map(|(_, value)| value));
        MotionParts {
            ends: arguments.ordered,
            others,
        }
    }

    fn printed(datum: &Datum) -> Option<String> {
        printed(datum)
    }
}

/// A value as RAPID writes it; none where a part of it is not known.
fn printed(datum: &Datum) -> Option<String> {
    Some(match &datum.value {
        Value::Number(value) if value.abs() >= 8e9 => "9E9".to_owned(),
        Value::List(parts) => {
            let parts: Option<Vec<String>> = parts.iter().map(printed).collect();
            format!("[{}]", parts?.join(","))
        }
        _ => return by_grammar(&lex::GRAMMAR, datum),
    })
}

/// The value of a type without one: numbers are 0, truths FALSE, texts empty, and aggregates of those.
///
/// Source: ABB, Technical reference manual - RAPID kernel, Data declarations.
fn of_type(type_name: &Name) -> Option<Datum> {
    let zeros = |count: usize| Datum::numbers(std::iter::repeat_n(0.0, count));
    Some(match type_name.letters() {
        b"NUM" | b"DNUM" | b"INTNUM" | b"ERRNUM" => Datum::number(0.0),
        b"BOOL" => Datum::truth(false),
        b"STRING" => Datum::of(Value::Text("".into())),
        b"POS" => zeros(3),
        b"ORIENT" | b"CONFDATA" | b"SPEEDDATA" => zeros(4),
        b"EXTJOINT" | b"ROBJOINT" => zeros(6),
        b"POSE" => Datum::list(vec![zeros(3), zeros(4)]),
        b"JOINTTARGET" => Datum::list(vec![zeros(6), zeros(6)]),
        b"ROBTARGET" => Datum::list(vec![zeros(3), zeros(4), zeros(4), zeros(6)]),
        _ => return None,
    })
}

/// The value of a name that no module declares.
fn predefined(name: &Name) -> Option<Datum> {
    let identity = || list_of_frame(&nalgebra::Isometry3::identity());
    let empty_load = || {
        let zero = || Datum::number(0.0);
        let centre = Datum::numbers([0.0; 3]);
        let axes = Datum::numbers([1.0, 0.0, 0.0, 0.0]);
        Datum::list(vec![zero(), centre, axes, zero(), zero(), zero()])
    };
    if name.is("TOOL0") {
        let hold = Datum::truth(true);
        return Some(Datum::list(vec![hold, identity(), empty_load()]));
    }
    if name.is("WOBJ0") {
        let [hold, fixed] = [false, true].map(Datum::truth);
        let unit = Datum::of(Value::Text("".into()));
        return Some(Datum::list(vec![hold, fixed, unit, identity(), identity()]));
    }
    match name.letters() {
        b"PI" => return Some(Datum::number(PI)),
        b"LOAD0" => return Some(empty_load()),
        b"FINE" => return Some(zone(true, 0.0)),
        _ => {}
    }
    speed(name).or_else(|| zone_by_number(name))
}

/// `v100` and its kin: 500 degrees/s, 5000 mm/s, 1000 degrees/s with each.
fn speed(name: &Name) -> Option<Datum> {
    const SPEEDS: [u32; 25] = [
        5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000,
        2500, 3000, 4000, 5000, 6000, 7000,
    ];
    let number = number_behind(name, b"V").filter(|number| SPEEDS.contains(number))?;
    Some(Datum::numbers([f64::from(number), 500.0, 5000.0, 1000.0]))
}

/// `z10` and its kin.
fn zone_by_number(name: &Name) -> Option<Datum> {
    const ZONES: [u32; 14] = [0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200];
    let number = number_behind(name, b"Z").filter(|number| ZONES.contains(number))?;
    let radius = match number {
        0 => 0.3,
        _ => f64::from(number),
    };
    Some(zone(false, radius))
}

fn zone(is_stop: bool, radius: f64) -> Datum {
    let turning = match radius {
        5.0.. => (1.5 * radius).round(),
        _ => radius,
    };
    let numbers = [
        radius,
        turning,
        turning,
        0.1 * turning,
        turning,
        0.1 * turning,
    ];
    let numbers = numbers.into_iter().map(Datum::number);
    Datum::list(
        std::iter::once(Datum::truth(is_stop))
            .chain(numbers)
            .collect(),
    )
}

fn number_behind(name: &Name, letter: &[u8]) -> Option<u32> {
    let digits = std::str::from_utf8(name.letters().strip_prefix(letter)?).ok()?;
    digits.parse().ok()
}

//! Instructions by their tables: motions, and what is carried.

use std::ops::Range;

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::symbols::Scope;
use crate::interpreter::token::Kind;
use crate::interpreter::tree::{Choice, Flow};
use crate::interpreter::value::Datum;
use crate::options::ExternalAxes;
use crate::rapid::functions::{CHANGE_THEIRS, is_computed};
use crate::rapid::lex::{Arguments, arguments_of, expression_of};
use crate::rapid::literals::frame_of;
use crate::rapid::state::{Run, mode_of};
use crate::rapid::table::{EXTERNAL, MotionRow, motion_row, row};
use crate::table::Treatment;
use crate::text::Name;

/// Statements that leave the path as it is, and change what deflection depends on.
const EFFECTS: [(&str, &str); 4] = [
    ("VelSet", "changes the speeds behind it"),
    ("SpeedRefresh", "changes the speeds behind it"),
    (
        "GripLoad",
        "changes the load that the controller reckons with",
    ),
    (
        "MechUnitLoad",
        "changes the load that the controller reckons with",
    ),
];

impl Run<'_, '_> {
    /// An instruction, or the call of a procedure.
    pub(super) fn instruction(&mut self, tokens: &Range<usize>, choice: Choice) -> Flow {
        let file = self.file();
        let name = Name::of(file.word(tokens.start));
        if let Some(row) = name.as_ref().and_then(motion_row) {
            self.motion_by(row, tokens, choice);
            self.log_motion(tokens);
            return Flow::Next;
        }
        if let (Some(name), Scope::Routine(from)) = (&name, self.scope)
            && let Some(called) = self.symbols.routine(from, name)
        {
            let arguments = arguments_of(file, tokens.start + 1..tokens.end);
            return match self.call_with(called, &arguments, tokens) {
                Flow::Ends => Flow::Ends,
                _ => Flow::Next,
            };
        }
        self.log_instruction(tokens);
        self.carried(name, tokens)
    }

    /// The arguments of an instruction; functions of these files in them run.
    fn arguments(&mut self, tokens: &Range<usize>) -> Arguments {
        let file = self.file();
        let arguments = Arguments::of(file, tokens.start + 1..tokens.end);
        let has_function = |expression: &&Expression| matches!(expression.node, Node::Call(..));
        let options = arguments
            .options
            .iter()
            .filter_map(|(_, value)| value.as_ref());
        for expression in arguments.ordered.iter().chain(options).filter(has_function) {
            self.value(expression);
        }
        arguments
    }

    /// A motion instruction.
    pub(super) fn motion_by(
        &mut self,
        row: &'static MotionRow,
        tokens: &Range<usize>,
        choice: Choice,
    ) {
        if !self.begins_motion(tokens) {
            return;
        }
        match self.motion(row, tokens) {
            Ok(mut motion) => {
                if choice == Choice::Compact && motion.site.indivisible.is_none() {
                    motion.site.indivisible =
                        Some("it stands behind IF without THEN, where one statement can stand");
                }
                motion.site.turns_otherwise = self.own.modes.otherwise(&motion);
                self.push_motion(motion);
            }
            Err(reason) => {
                self.fault(tokens, reason);
                self.here = None;
            }
        }
    }

    /// An instruction that is no motion, or what is in none of the files.
    pub(super) fn carried(&mut self, name: Option<Name>, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let Some(row) = name.as_ref().and_then(row) else {
            self.call_outside(tokens);
            return Flow::Next;
        };
        match row.treatment {
            // The arm stands still, and the user says that nothing else matters.
            EXTERNAL if self.options.external_axes == ExternalAxes::Carried => {
                self.moves_external_axes();
                return Flow::Next;
            }
            Treatment::Refused { reason, remedy } => {
                self.fault(tokens, (reason.to_owned(), remedy));
                self.here = None;
                return Flow::Next;
            }
            _ => {}
        }
        let arguments = self.arguments(tokens);
        if mode_of(file, tokens).is_some() {
            self.own.modes = self.own.modes.after(file, tokens);
        }
        let is = |word: &&str| word.eq_ignore_ascii_case(row.name);
        if CHANGE_THEIRS.iter().any(is) {
            self.change(row.name, &arguments.ordered);
        }
        // Waiting sets flags and what it waits for; a box asks a person.
        if row.name.starts_with("Wait") || row.name == "UIMsgBox" {
            self.lose_waited(tokens);
        }
        if let Some((word, effect)) = EFFECTS.iter().find(|(word, _)| is(word)) {
            self.find(
                tokens,
                format!("{word} {effect}: it is carried, and not followed"),
            );
        }
        match row.name {
            "ExitCycle" => return Flow::Ends,
            "EOffsOff" => self.moves_external_axes(),
            "PDispOff" => self.own.displacement = None,
            "PDispSet" => self.displace(tokens, &arguments.ordered),
            _ => {}
        }
        Flow::Next
    }

    /// Where the external axes are from here on does not follow from the last motion.
    fn moves_external_axes(&mut self) {
        if let Some(index) = self.here {
            self.motions[index].site.external_moved_behind = true;
        }
    }

    /// `PDispSet frame`: the places of all motions behind it are in this frame of the work object.
    ///
    /// Source: ABB, RAPID Instructions, Functions and Data types, PDispSet: the displacement is in the axes of the work object.
    fn displace(&mut self, tokens: &Range<usize>, arguments: &[Expression]) {
        let value = arguments.first().map(|frame| self.value(frame));
        let Some(frame) = value.as_ref().and_then(frame_of) else {
            let why = value.as_ref().and_then(Datum::unknown_reason);
            let why = why.map_or_else(String::new, |why| format!(": {why}"));
            let reason = format!("the displacement of all motions behind it is not known{why}");
            self.fault(
                tokens,
                (reason, "write it as a pose: [[x,y,z],[q1,q2,q3,q4]]"),
            );
            return;
        };
        self.own.displacement = Some(frame);
    }

    /// Names in the arguments of an instruction that may change them.
    fn lose_waited(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let is_word =
            |at: &usize| file.tokens[*at].kind == Kind::Word && file.word(*at - 1) != b"\\";
        let words: Vec<usize> = (tokens.start + 1..tokens.end).filter(is_word).collect();
        for at in words {
            let name = expression_of(file, at..at + 1);
            let reason = self.changed(&name);
            self.lose(&name, &reason);
        }
    }

    /// `Incr n`, `Decr n`, `Clear n`, `Add n, 3`.
    fn change(&mut self, word: &str, arguments: &[Expression]) {
        let [to, rest @ ..] = arguments else { return };
        let before = self.value(to).as_number();
        let by = rest
            .first()
            .map_or(Some(1.0), |by| self.value(by).as_number());
        let number = match (word, before, by) {
            ("Clear", ..) => Some(0.0),
            ("Decr", Some(before), _) => Some(before - 1.0),
            ("Incr" | "Add", Some(before), Some(by)) => Some(before + by),
            _ => None,
        };
        match (number, self.place(to)) {
            (Some(number), Some(place)) => self.put(&place, Datum::number(number)),
            _ => {
                let reason = self.changed(to);
                self.lose(to, &reason);
            }
        }
    }

    /// A call of what is in none of the files: it is taken not to move the tool, but for one of which the run computes which it is.
    fn call_outside(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        // `%name% a, b;`
        let mut marks = tokens.clone().filter(|at| file.word(*at) == b"%");
        let name_end = marks.nth(1).unwrap_or(tokens.start);
        let arguments = arguments_of(file, name_end + 1..tokens.end);
        for value in arguments
            .iter()
            .filter_map(|argument| argument.value.as_ref())
        {
            if let Node::Call(..) = value.node {
                self.value(value);
            }
        }
        self.lose_arguments(&arguments);
        let is_computed = is_computed(file, tokens);
        if is_computed {
            self.here = None;
        }
        let called = crate::error::excerpt(file.word(tokens.start));
        self.note_outside_call((!is_computed).then_some(called), tokens);
    }
}

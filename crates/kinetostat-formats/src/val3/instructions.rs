//! Instructions and their table: motions, calls, and what is carried.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::Dialect;
use crate::interpreter::symbols::Scope;
use crate::interpreter::token::Kind;
use crate::interpreter::tree::Flow;
use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, row_of, rows, sorted};
use crate::text::Name;
use crate::val3::expression::expression_of;
use crate::val3::frames::{Run, Val3};

impl Run<'_, '_> {
    /// An instruction, or the call of a program.
    pub(super) fn instruction(&mut self, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let Some(name) = file.name(tokens.start) else {
            let reason = "the name is longer than 32 letters".to_owned();
            self.fault(tokens, (reason, "shorten it"));
            return Flow::Next;
        };
        if is_motion(&name) {
            self.lose_number(tokens);
            if self.begins_motion(tokens) {
                match self.motion(tokens) {
                    Ok(motion) => self.push_motion(motion),
                    Err(reason) => {
                        self.fault(tokens, reason);
                        self.here = None;
                    }
                }
                self.own.is_moving = true;
                self.log_motion(tokens);
            }
            return Flow::Next;
        }
        if name.is("CALL") {
            let inner = tokens.start + 1..tokens.end;
            return match self.routine(inner.start) {
                Some(called) => {
                    let arguments = Val3::arguments_of(file, inner.start + 1..inner.end);
                    match self.call_with(called, &arguments, tokens) {
                        Flow::Ends => Flow::Ends,
                        _ => Flow::Next,
                    }
                }
                None => self.call_outside(&inner, tokens),
            };
        }
        self.log_instruction(tokens);
        self.carried(&name, tokens)
    }

    /// The program of the files that a token names.
    fn routine(&self, at: usize) -> Option<usize> {
        match self.scope {
            Scope::Routine(from) => self.symbols.routine(from, &self.file().name(at)?),
            Scope::Module(_) => None,
        }
    }

    /// `n=movel(...)`: the number of the motion is known to the controller alone.
    fn lose_number(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let assign = tokens.start.saturating_sub(1);
        let is_assign = file
            .tokens
            .get(assign)
            .is_some_and(|token| token.kind == Kind::Assign);
        if is_assign {
            let line = file.line_of(assign);
            let is_here = |at: &usize| file.line_of(*at) == line;
            let first = (0..assign)
                .rev()
                .take_while(is_here)
                .last()
                .unwrap_or(assign);
            let place: Expression = expression_of(file, first..assign);
            let reason = self.changed(&place);
            self.lose(&place, &reason);
        }
    }

    fn carried(&mut self, name: &Name, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let Some(row) = row(name) else {
            return self.call_outside(tokens, tokens);
        };
        if let Treatment::Refused { reason, remedy } = row.treatment {
            self.fault(tokens, (reason.to_owned(), remedy));
            self.here = None;
        }
        match row.name {
            "waitEndMove" => self.own.is_moving = false,
            "resetMotion" if self.own.is_moving => {
                let reason = "it drops the motions that have not ended".to_owned();
                self.fault(
                    tokens,
                    (reason, "wait for their ends before it: waitEndMove()"),
                );
                self.here = None;
            }
            "setMonitorSpeed" => {
                self.find(
                    tokens,
                    "setMonitorSpeed changes all speeds: it is carried, and not followed"
                        .to_owned(),
                );
            }
            "taskCreate" | "taskCreateSync" => self.begin_task(tokens),
            _ => {}
        }
        if is_one_of(name, &CHANGE_THEIRS) {
            self.lose_arguments(&Val3::arguments_of(file, tokens.start + 1..tokens.end));
        }
        Flow::Next
    }

    /// A program that runs beside: it may not move the tool.
    fn begin_task(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let names = tokens.clone().filter(|at| file.is(at + 1, b'('));
        for at in names {
            match self.routine(at) {
                Some(called) if self.routine_acts(called) => {
                    let reason = "its program moves the tool while others run".to_owned();
                    self.fault(
                        tokens,
                        (
                            reason,
                            "give the .pgx file of that program without this one",
                        ),
                    );
                }
                Some(_) => {}
                None => {
                    self.call_outside(&(at..tokens.end), tokens);
                }
            }
        }
    }

    /// A call of what is in none of the files: it is taken not to move the tool.
    fn call_outside(&mut self, call: &Range<usize>, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let arguments = Val3::arguments_of(file, call.start + 1..call.end);
        for Argument { value, .. } in &arguments {
            if let Some(value) = value
                .as_ref()
                .filter(|value| matches!(value.node, Node::Call(..)))
            {
                self.value(value);
            }
        }
        self.lose_arguments(&arguments);
        self.note_outside_call(Some(file.text(&(call.start..call.start + 1))), tokens);
        Flow::Next
    }
}

const MANUAL: &str = "Staubli, VAL3 Reference Manual";

/// The words of motions.
pub(super) const MOTIONS: [&str; 3] = ["movec", "movej", "movel"];

/// Instructions that change what they are given.
pub(super) const CHANGE_THEIRS: [&str; 7] = [
    "clearBuffer",
    "get",
    "getKey",
    "insert",
    "sioGet",
    "toNum",
    "fromBinary",
];

const MOVED_FRAME: Treatment = Refused {
    reason: "it moves or changes the frame of points while the program runs",
    remedy: "state the frame in the data of the application, or take this statement into a program of its own",
};
const OWN_WAY: Treatment = Refused {
    reason: "its motion is not followed, or it changes the path while it runs",
    remedy: "write it as movel, movec or movej, or take it into a program of its own",
};

/// The row of a statement by its name.
pub(super) fn row(name: &Name) -> Option<&'static StatementRow> {
    row_of(&SORTED, name)
}

/// True for the word of a motion.
pub(super) fn is_motion(name: &Name) -> bool {
    is_one_of(name, &MOTIONS)
}

/// True for a name of a list, whatever its case.
pub(super) fn is_one_of(name: &Name, all: &[&str]) -> bool {
    (all.iter()).any(|own| own.as_bytes().eq_ignore_ascii_case(name.letters()))
}

/// Treatment of each statement of VAL3, in alphabetical order. Library programs and functions that are neither in a file nor listed are carried with
/// a finding.
pub const VAL3_STATEMENTS: &[StatementRow] = &SORTED;

static SORTED: [StatementRow; count(GROUPS)] = sorted(rows::<{ count(GROUPS) }>(GROUPS));

#[rustfmt::skip]
const GROUPS: &[Alike] = &[
    alike(Understood, MANUAL, &[
        "=", "begin", "end", "if", "elseIf", "else", "endIf", "while", "endWhile", "for", "endFor", "do", "until", "switch",
        "case", "default", "break", "endSwitch", "return", "call", "taskCreate", "taskCreateSync", "movec", "movej", "movel", "appro", "compose",
        "resetMotion", "waitEndMove",
    ]),
    alike(Carried, MANUAL, &[
        "aioSet", "aioLink", "cls", "clearBuffer", "close", "delay", "dioLink", "dioSet", "disablePower", "enablePower", "get",
        "getKey", "gotoxy", "insert", "ioBusStatus", "isEmpty", "isSettled", "logMsg", "open", "popUpMsg", "put", "putln",
        "restartMove", "setMonitorSpeed", "setMutex", "setPayload", "sioGet", "sioLink", "sioSet", "stopMove", "taskKill",
        "taskResume", "taskSuspend", "title", "toNum", "fromBinary", "toBinary", "userPage", "wait", "watch",
    ]),
    alike(MOVED_FRAME, MANUAL, &["link", "setFrame", "setTool", "setWorld", "delete", "resize"]),
    alike(OWN_WAY, MANUAL, &[
        "alter", "alterBegin", "alterEnd", "alterMovec", "alterMovej", "alterMovel", "alterStopTime", "movecf", "movejf", "movelf",
        "autoConnectMove", "libLoad", "libDelete", "stepMove", "trackConv", "compliantMovel", "movejc", "movelc", "movejs",
        "movejfollow", "movels", "rawMovej", "synchroMove",
    ]),
];

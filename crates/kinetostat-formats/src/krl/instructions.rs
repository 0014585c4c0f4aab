//! Statements that are no assignments: motions and the spline blocks in which they may stand, calls, and what the table says of all others.

use std::ops::Range;

use crate::error::excerpt;
use crate::interpreter::run::{Place, Root};
use crate::interpreter::symbols::Scope;
use crate::interpreter::tree::Flow;
use crate::krl::ends::ends_of;
use crate::krl::expression::{arguments_of, expression_of};
use crate::krl::lex::{assignment, contradiction, folds_of, text_of};
use crate::krl::settings::is_in_force;
use crate::krl::state::Run;
use crate::krl::table::{Ends, MotionRow, OPERATORS, motion_row, row};
use crate::model::motion::Zone;
use crate::table::Treatment;
use crate::text::Name;
use crate::text::source::Finding;

impl Run<'_, '_> {
    /// Runs a statement that is no assignment.
    pub(super) fn instruction(&mut self, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        let Some(name) = file.name(tokens.start) else {
            self.unknown_statement(tokens);
            return Flow::Next;
        };
        if let Some(row) = motion_row(&name) {
            self.moves(row, tokens);
            self.log_motion(tokens);
            return Flow::Next;
        }
        if name.is("SPLINE") || name.is("ENDSPLINE") {
            self.log_motion(tokens);
            self.spline_word(tokens, name.is("SPLINE"));
            return Flow::Next;
        }
        if name.letters().starts_with(b"EXT") && row(&name).is_some() {
            return Flow::Next;
        }
        let calls_own = match self.scope {
            Scope::Routine(from) => self.symbols.routine(from, &name).is_some(),
            Scope::Module(_) => false,
        };
        match file.is(tokens.start + 1, b'(') {
            true if calls_own => {}
            true => self.log_instruction(tokens),
            false => self.log_words(tokens),
        }
        self.note_what_acts_along(&name, tokens);
        if name.is("INTERRUPT") || name.is("TRIGGER") || name.is("GLOBAL") {
            self.interrupt(tokens);
            return Flow::Next;
        }
        if name.is("BAS") {
            if let Err(reason) = self.bas(tokens) {
                self.fault(tokens, reason);
            }
            return Flow::Next;
        }
        if file.is(tokens.start + 1, b'(') {
            return self.call_statement(&name, tokens);
        }
        self.run_calls(tokens);
        match row(&name).map(|row| row.treatment) {
            // The instruction is refused once; the statements after it are read as if it did not exist.
            Some(Treatment::Refused { reason, remedy }) => {
                self.fault(tokens, (reason.to_owned(), remedy));
            }
            Some(Treatment::Carried) => {}
            _ => self.unknown_statement(tokens),
        }
        Flow::Next
    }

    /// `name(a,b)`.
    fn call_statement(&mut self, name: &Name, tokens: &Range<usize>) -> Flow {
        let file = self.file();
        if let Scope::Routine(from) = self.scope
            && let Some(called) = self.symbols.routine(from, name)
        {
            let close = file.find(tokens.start + 2..tokens.end, b')');
            let arguments = arguments_of(file, tokens.start + 2..close.unwrap_or(tokens.end));
            return match self.call_with(called, &arguments, tokens) {
                Flow::Ends => Flow::Ends,
                _ => Flow::Next,
            };
        }
        self.run_calls(tokens);
        Flow::Next
    }

    /// Runs what is called in tokens that are no expression as a whole.
    fn run_calls(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let mut at = tokens.start;
        while at < tokens.end {
            let name = file.name(at).filter(|_| file.is(at + 1, b'('));
            let is_call = name.is_some_and(|name| !OPERATORS.iter().any(|word| name.is(word)));
            let close = match is_call {
                true => file.find(at + 2..tokens.end, b')'),
                false => None,
            };
            match close {
                Some(close) => {
                    self.value(&expression_of(file, at..close + 1));
                    at = close + 1;
                }
                None => at += 1,
            }
        }
    }

    /// Notes a call of what is in none of the files; one that the table refuses is a fault.
    pub(super) fn note_outside(&mut self, name: &Name, tokens: &Range<usize>) {
        self.note_call(row(name), tokens);
    }

    /// `INTERRUPT DECL 3 WHEN condition DO routine()` and `TRIGGER WHEN PATH=0 DELAY=0 DO routine() PRIO=-1` call at any time. Every program
    /// has `IR_STOPM`, which stops the robot.
    fn interrupt(&mut self, tokens: &Range<usize>) {
        let file = self.file();
        let done = tokens.clone().find(|at| file.is_word(*at, "DO"));
        if let Some(done) = done
            && let Some(equals) = assignment(file, &(done + 1..tokens.end))
        {
            self.assigned_at_any_time(tokens, done + 1..equals);
        }
        for at in tokens.clone() {
            let Some(name) = file.name(at).filter(|_| file.is(at + 1, b'(')) else {
                continue;
            };
            let Scope::Routine(from) = self.scope else {
                continue;
            };
            let Some(called) = self.symbols.routine(from, &name) else {
                if !name.is("IR_STOPM") && !OPERATORS.iter().any(|word| name.is(word)) {
                    self.note_outside(&name, &(at..at + 1));
                }
                continue;
            };
            if self.routine_acts(called) {
                let shown = excerpt(file.word(at));
                let reason = format!(
                    "`{shown}` moves the tool at any time, or sets what the motions behind it go by"
                );
                self.fault(
                    tokens,
                    (reason, "take the interrupt into a program of its own"),
                );
            }
        }
    }

    /// An assignment that an interrupt or a trigger makes: what it sets is not known behind it.
    fn assigned_at_any_time(&mut self, tokens: &Range<usize>, to: Range<usize>) {
        let file = self.file();
        if file.name(to.start).is_some_and(|name| is_in_force(&name)) {
            let reason = "it sets at any time what the motions behind it go by".to_owned();
            let remedy = "take the interrupt into a program of its own";
            return self.fault(tokens, (reason, remedy));
        }
        let to = expression_of(file, to);
        let reason = self.changed(&to);
        self.lose(&to, &reason);
        if let Some(Place {
            root: Root::Module(index),
            ..
        }) = self.place(&to)
        {
            self.volatile.insert(index);
        }
    }

    /// `SPLINE WITH $VEL.CP=0.2` and `ENDSPLINE C_SPL`: what the first puts in force, the second takes back.
    fn spline_word(&mut self, tokens: &Range<usize>, begins: bool) {
        match (begins, self.own.spline.take()) {
            (true, None) => {
                self.own.spline = Some(self.own.force.clone());
                let is_with = self.file().is_word(tokens.start + 1, "WITH");
                if is_with
                    && tokens.len() > 1
                    && let Err(reason) = self.with(&(tokens.start + 2..tokens.end))
                {
                    self.fault(tokens, reason);
                }
            }
            (false, Some(before)) => self.own.force = before,
            (_, open) => {
                self.own.spline = open;
                let reason = "a spline block begins in another one, or ends without a beginning";
                self.fault(
                    tokens,
                    (
                        reason.to_owned(),
                        "write SPLINE, its segments, and ENDSPLINE",
                    ),
                );
            }
        }
    }

    /// `TRIGGER WHEN DISTANCE=1` and `WHEN PATH=-20`, and `STOP WHEN PATH`, act along the next motion or at its end: before several that
    /// take its place they would act at the end of the first.
    fn note_what_acts_along(&mut self, name: &Name, tokens: &Range<usize>) {
        let file = self.file();
        let from_start = tokens.clone().any(|at| {
            let zero =
                file.is_word(at, "DISTANCE") && file.is(at + 1, b'=') && file.word(at + 2) == b"0";
            zero || file.is_word(at, "ONSTART")
        });
        if from_start {
            return;
        }
        if name.is("TRIGGER") {
            self.own.along_next = Some("the TRIGGER before it acts along the whole of it");
        } else if name.is("STOP") && file.is_word(tokens.start + 1, "WHEN") {
            self.own.along_next = Some("the STOP WHEN before it acts along the whole of it");
        }
    }

    /// `PTP $AXIS_ACT`, `PTP $POS_ACT`: to where the arm is. It stops there, with which the way to the first point of a program begins.
    fn goes_nowhere(&mut self, row: &MotionRow, tokens: &Range<usize>) -> bool {
        let file = self.file();
        let ends = ends_of(file, tokens, row.ends);
        let (Ends::Joint | Ends::Linear, [end]) = (row.ends, ends.as_slice()) else {
            return false;
        };
        let name = file.name(end.start).filter(|_| end.len() == 1);
        let is_actual = name.is_some_and(|name| name.is("$AXIS_ACT") || name.is("$POS_ACT"));
        if is_actual {
            let shown = file.text(end);
            self.find(
                tokens,
                format!(
                    "`{shown}` is where the arm is: the motion stops there and goes nowhere, it is carried"
                ),
            );
        }
        is_actual
    }

    /// Runs a motion with what is in force.
    fn moves(&mut self, row: &'static MotionRow, tokens: &Range<usize>) {
        let in_spline = self.own.spline.is_some();
        if in_spline && !matches!(row.name, "SLIN" | "SCIRC") {
            self.fault(
                tokens,
                (
                    "it is no segment of a spline block".to_owned(),
                    "write SLIN or SCIRC, or write it behind ENDSPLINE",
                ),
            );
            self.here = None;
            return;
        }
        if !in_spline && self.goes_nowhere(row, tokens) {
            return;
        }
        if !self.begins_motion(tokens) {
            return;
        }
        match self.motion(row, tokens) {
            Ok(mut motion) => {
                let along = self.own.along_next.take();
                motion.site.indivisible = motion.site.indivisible.or(along);
                // Segments pass their ends.
                if in_spline && motion.zone == Zone::Exact {
                    motion.zone = Zone::Unstated;
                }
                self.push_motion(motion);
                self.compare_fold();
            }
            Err(reason) => {
                self.fault(tokens, reason);
                self.here = None;
            }
        }
    }

    /// Says where the text of the fold around the last motion contradicts what is in force.
    fn compare_fold(&mut self) {
        let Some(motion) = self.motions.last() else {
            return;
        };
        let file = &self.files[motion.file];
        let around = self.own.folds[motion.file].get_or_insert_with(|| folds_of(file));
        let line = file.lines.partition_point(|line| {
            let first = file.tokens.get(line.tokens.start);
            first.is_some_and(|token| token.bytes().start <= motion.span.start)
        });
        let fold = line
            .checked_sub(1)
            .and_then(|line| around.get(line).copied().flatten());
        let text = fold.map(|fold| text_of(file, fold));
        let said = text.and_then(|text| contradiction(text, &motion.tool, &motion.work_object));
        if let Some(message) = said {
            let (file, line) = (motion.file, motion.line);
            let start = motion.span.start;
            if self.noted.insert((file, start, "fold")) {
                self.findings.push(Finding {
                    file,
                    line,
                    message,
                });
            }
        }
    }

    /// Refuses what is no statement.
    fn unknown_statement(&mut self, tokens: &Range<usize>) {
        self.fault(
            tokens,
            (
                "it is no statement of KRL that is known here".to_owned(),
                "remove it, or take it into a program of its own",
            ),
        );
    }
}

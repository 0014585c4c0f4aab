//! Calls: of routines, of what is in none of the files, and of what interrupts.

use std::ops::Range;

use crate::calls::{Call, Holds};
use crate::error::excerpt;
use crate::krl::state::{State, Thing};
use crate::krl::table::{OPERATORS, row};
use crate::krl::walking::walker::{DEEPEST, Walker};
use crate::model::motion::Runs;
use crate::model::outside_call::OutsideCall;
use crate::table::Treatment;
use crate::text::name::Name;

/// What motions go by, with the names that programs have for it.
const IN_FORCE: [(Thing, &str); 7] = [
    (Thing::Base, "$BASE"),
    (Thing::Tool, "$TOOL"),
    (Thing::Speed, "$VEL"),
    (Thing::Distance, "$APO"),
    (Thing::PointData, "FDAT_ACT"),
    (Thing::LinearData, "LDAT_ACT"),
    (Thing::Orientation, "$ORI_TYPE"),
];

impl Walker<'_, '_> {
    /// Notes a call of a routine; whether it can be followed.
    pub(super) fn notes_call(
        &mut self,
        called: usize,
        tokens: &Range<usize>,
        state: State,
    ) -> bool {
        let now = self.now;
        self.summaries[called].calls.push(Call {
            from: now.routine,
            at: state,
            runs: now.runs,
        });
        if now.depth >= DEEPEST {
            let reason = "calls and blocks are nested deeper than 200".to_owned();
            self.refuse(
                tokens,
                (reason, "call what is deepest from the first routine"),
            );
            return false;
        }
        true
    }

    /// What is in force behind a call of a routine that was walked, or is.
    pub(super) fn behind_call(&mut self, called: usize, state: State) -> State {
        let summary = &mut self.summaries[called];
        match summary.leaves {
            Some(leaves) => leaves.in_call(state),
            None => {
                summary.recursive = true;
                State::UNKNOWN
            }
        }
    }

    /// A call, at a token, of what is in none of these files.
    pub(super) fn calls_outside(
        &mut self,
        (at, name): (usize, Name),
        tokens: &Range<usize>,
        state: State,
    ) -> State {
        match row(&name).map(|row| row.treatment) {
            Some(Treatment::Refused { reason, remedy }) => {
                self.refuse(tokens, (reason.to_owned(), remedy));
                state
            }
            Some(_) => state,
            None => {
                let file = self.file();
                // It is taken not to move the tool and not to change what is in force.
                self.settings.calls.push(OutsideCall {
                    file: file.index,
                    line: file.source.line_of(file.span(tokens).start),
                    name: Some(excerpt(file.word(at))),
                });
                state
            }
        }
    }

    /// Notes what an interrupt calls that none of the files holds; every program has the first of the names, which stops the robot.
    fn interrupted_by_outside(&mut self, at: usize, name: &Name) {
        let file = self.file();
        if let Some(row) = row(name) {
            if let Treatment::Refused { reason, remedy } = row.treatment {
                self.refuse(&(at..at + 1), (reason.to_owned(), remedy));
            }
            return;
        }
        if name.is("IR_STOPM") || OPERATORS.iter().any(|word| name.is(word)) {
            return;
        }
        self.settings.calls.push(OutsideCall {
            file: file.index,
            line: file.source.line_of(file.span(&(at..at + 1)).start),
            name: Some(excerpt(file.word(at))),
        });
    }

    /// What `INTERRUPT DECL 3 WHEN condition DO routine()` and `TRIGGER WHEN PATH=0 DELAY=0 DO routine() PRIO=-1` call at any time.
    pub(super) fn interrupting(&mut self, tokens: &Range<usize>) -> Vec<usize> {
        let file = self.file();
        let mut all = Vec::new();
        for at in tokens.clone() {
            let Some(name) = file.name(at).filter(|_| file.is(at + 1, b'(')) else {
                continue;
            };
            let Some(called) = self.values.symbols.routine(self.now.routine, &name) else {
                self.interrupted_by_outside(at, &name);
                continue;
            };
            let touched = self.touched.routines[called];
            let changed = IN_FORCE.iter().filter(|(thing, _)| touched.has(*thing));
            let changed: Vec<&str> = changed.map(|(_, name)| *name).collect();
            let shown = excerpt(file.word(at));
            let reason = match (touched.has(Thing::Place), changed.as_slice()) {
                (true, _) => Some(format!("`{shown}` moves the tool at any time")),
                (false, []) => None,
                (false, names) => Some(format!(
                    "`{shown}` sets {} at any time, and the motions behind it go by what it sets",
                    names.join(", ")
                )),
            };
            if let Some(reason) = reason {
                self.refuse(
                    tokens,
                    (reason, "take the interrupt into a program of its own"),
                );
            }
            self.summaries[called].calls.push(Call {
                from: self.now.routine,
                at: State::UNKNOWN,
                runs: Runs::Repeatedly,
            });
            all.push(called);
        }
        all
    }
}

//! Statements that put something in force, and those of which the table says what is done.

use std::ops::Range;

use crate::krl::role::Role;
use crate::krl::settings::Setter;
use crate::krl::state::State;
use crate::krl::table::row;
use crate::krl::usage::place_of;
use crate::krl::walking::walker::Walker;
use crate::table::Treatment;
use crate::text::name::Name;

impl Walker<'_, '_> {
    /// Assignments and BAS: whether the statement is one.
    pub(super) fn puts_in_force(
        &mut self,
        name: &Name,
        tokens: &Range<usize>,
        state: &mut State,
    ) -> bool {
        let routine = self.now.routine;
        let equals = self.file().assign(tokens);
        let mut setter = Setter {
            values: self.values,
            settings: &mut self.settings,
            routine,
        };
        let done = match equals {
            Some(equals) => setter.assign(tokens, equals, state),
            None if name.is("BAS") => setter.bas(tokens, state),
            None => return false,
        };
        if let Err(reason) = done {
            self.refuse(tokens, reason);
        }
        true
    }

    /// `TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}`, and `TC={X 0,Y 0,Z 180,A 0,B 0,C 0}` of a frame that the program declares.
    pub(super) fn gives_frame(&mut self, name: &Name, tokens: &Range<usize>) {
        let Some(equals) = self.file().assign(tokens) else {
            return;
        };
        let routine = self.now.routine;
        let first = tokens.start..tokens.start + 1;
        if let Some(datum) = self.values.own_datum(routine, &first) {
            let statement = ((routine, datum), (tokens, equals));
            let given = &self.settings.given;
            let end = match self.is_certain() {
                true => self.values.given_end(statement.0, statement.1, given),
                false => None,
            };
            self.settings.given.ends.insert(datum, end);
        }
        let Some(role) = Role::of_array(name) else {
            return;
        };
        let (place, element) = place_of(self.file(), tokens.start, equals);
        let Some(number) = element else {
            return;
        };
        let is_whole = place == (tokens.start..equals);
        let frame =
            (is_whole).then(|| (self.values).literal_frame(routine, &(equals + 1..tokens.end)));
        let is_certain = self.is_certain();
        let numbers = &mut self.settings.given.numbers;
        match (is_whole && is_certain, numbers.get(&(role, number))) {
            (true, _) => {
                numbers.insert((role, number), frame.flatten());
            }
            // Whether it ran or not, the same value stands there.
            (false, Some(before)) if frame == Some(*before) => {}
            (false, None) => {}
            (false, Some(_)) => {
                numbers.insert((role, number), None);
            }
        }
    }

    /// All other statements.
    pub(super) fn by_table(&mut self, name: &Name, tokens: &Range<usize>, state: State) -> State {
        match row(name).map(|row| row.treatment) {
            Some(Treatment::Refused { reason, remedy }) => {
                self.refuse(tokens, (reason.to_owned(), remedy));
                // What stands behind it is looked at as if it was not there: one fault is one line.
                state
            }
            Some(Treatment::Carried) => state,
            _ => {
                self.unknown_statement(tokens);
                state
            }
        }
    }

    /// Refuses what is no statement.
    pub(super) fn unknown_statement(&mut self, tokens: &Range<usize>) {
        self.refuse(
            tokens,
            (
                "it is no statement of KRL that is known here".to_owned(),
                "remove it, or take it into a program of its own",
            ),
        );
    }
}

//! What is in force, whichever way the program takes: through loops, by several calls, out of handlers and interrupts.

use std::ops::Range;

use crate::rapid::place::Place;
use crate::rapid::tree::{RoutineKind, Statement};
use crate::rapid::turning::{Modes, Moment};
use crate::rapid::walker::Walker;

/// The first pass of a loop as it begins.
pub(super) struct Pass {
    modes: Modes,
    first_motion: usize,
    begun: Moment,
    called_again: usize,
}

impl Walker<'_, '_> {
    /// A routine that no statement calls: the first one, or what an interrupt, an expression or a computed name leads to.
    pub(super) fn root(&mut self, routine: usize, is_main: bool) {
        let is_procedure =
            self.values.symbols.routines[routine].routine.kind == RoutineKind::Procedure;
        let is_computed = self.outside_calls.iter().any(|call| call.name.is_none());
        let begins = is_main || is_procedure && !is_computed;
        self.now.modes = match begins {
            true => Modes::BASIC,
            false => Modes::BASIC.met(self.anywhere),
        };
        let stated = self.modes_stated;
        self.routine(routine, 0);
        if !begins && self.modes_stated > stated {
            // It may come between any two statements.
            let anywhere = self.anywhere;
            self.modes
                .iter_mut()
                .for_each(|own| *own = own.met(anywhere));
        }
    }

    /// What runs where something went wrong in a body, of which the motions are given, and how many modes were stated before it.
    pub(super) fn handlers(&mut self, handlers: &[Statement], body: Range<usize>, stated: usize) {
        let (behind, in_body) = (self.now.modes, self.modes_stated);
        // It may have gone wrong before anything of the body was in force.
        let (entry, _) = self.modes_at_entry[self.now.routine];
        let anywhere = self.anywhere.met(entry);
        self.now.modes = behind.met(anywhere);
        self.block(handlers, Place::Unknown);
        // RETRY and TRYNEXT lead back into the body.
        if self.modes_stated > in_body {
            self.modes[body]
                .iter_mut()
                .for_each(|own| *own = own.met(anywhere));
        }
        // A handler that leaves the routine leaves in force what was where it came from.
        self.now.modes = match handlers.is_empty() || self.modes_stated == stated {
            true => behind,
            false => behind.met(anywhere),
        };
    }

    /// Behind a call, where the routine that calls handles errors: what was called may have been left anywhere in it, with what was in
    /// force there. TRYNEXT goes on behind the call, and RETRY calls again.
    ///
    /// Source: ABB, RAPID Reference Manual, Basic Characteristics, Error recovery: an error goes to the handler of the routine in which it
    /// occurred, and from one without a handler to that which called it, at the point of the call; RETRY runs the statement again in
    /// which the error occurred, TRYNEXT the one behind it, RETURN goes on behind the call of the routine.
    pub(super) fn left_by_error(&mut self, before: Modes, called: usize) {
        let routine = self.values.symbols.routines[self.now.routine].routine;
        if !routine.handlers.is_empty() && self.states_modes[called] {
            let met = self.now.modes.met(before).met(self.anywhere);
            self.now.modes = met;
            self.modes_of_another_call(called);
            self.now.modes = self.now.modes.met(met);
        }
    }

    /// A loop begins.
    pub(super) fn pass(&mut self) -> Pass {
        Pass {
            modes: self.now.modes,
            first_motion: self.motions.len(),
            begun: self.next_moment(),
            called_again: self.called_again,
        }
    }

    /// The end of a loop: what is in force there is so at its next pass, too.
    pub(super) fn next_pass(&mut self, pass: &Pass) {
        let met = pass.modes.met(self.now.modes);
        self.now.modes = met;
        if met.holds_as(pass.modes) {
            return;
        }
        let again = self.called_again > pass.called_again;
        let active = self.active.clone();
        self.meet_modes(pass.begun, met, |motion, routine| {
            motion >= pass.first_motion || again && !active.contains(&routine)
        });
        for jump in &mut self.jumps {
            jump.modes = jump.modes.met_before(pass.begun, met);
        }
        if let Some((_, left)) = &mut self.now.left {
            *left = left.met_before(pass.begun, met);
        }
    }

    /// A routine was walked with what was in force at its first call, and may change what is.
    pub(super) fn modes_of_another_call(&mut self, called: usize) {
        let (modes, begun) = self.modes_at_entry[called];
        let met = modes.met(self.now.modes);
        self.called_again += 1;
        if !met.holds_as(modes) {
            let active = self.active.clone();
            self.meet_modes(begun, met, |_, routine| {
                routine == called || !active.contains(&routine)
            });
        }
        self.now.modes = self.modes_behind[called].met_before(begun, met);
    }

    /// Of motions chosen by their number and their routine, only this is sure beside what was in force at a moment; what is stated after
    /// it is sure.
    fn meet_modes(&mut self, moment: Moment, modes: Modes, of: impl Fn(usize, usize) -> bool) {
        let all = self.modes.iter_mut().zip(&self.places).enumerate();
        for (motion, (own, (routine, _))) in all {
            if of(motion, *routine) {
                *own = own.met_before(moment, modes);
            }
        }
    }
}

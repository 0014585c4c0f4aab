//! What comes back behind a subprogram with SAVE: the G codes in force at its call, the settable zero and the programmable frame.
//!
//! Source: Siemens, SINUMERIK 840D sl / 828D, programming manual, job planning, "Save modal G functions (SAVE)", and function manual,
//! basic functions, K2 "Subprograms with SAVE attribute": behind the call the frame that was active before it is active again.

use crate::flat_run::Runs;
use crate::refused_run::Behind;
use crate::siemens::flat::runner::{Level, Runner};

impl Runner<'_> {
    /// Writes what puts back the codes and the frame of a call.
    ///
    /// What the machine alone knows is refused at the call.
    pub(super) fn restore(&mut self, level: &Level) {
        match level.modes.restored_from(&self.modes) {
            Ok(codes) if codes.is_empty() => {}
            Ok(codes) => self.write_line(codes.as_bytes()),
            Err(code) => {
                let fault = self.fault(
                    &self.span(),
                    format!("the subprogram states {code} and gives back at its end (SAVE) what was before, which the program does not state"),
                    "state the code that holds before the call",
                );
                self.refuse(fault, Behind::Same);
            }
        }
        self.modes = level.modes;
        if self.frames.is(&level.frames) {
            return;
        }
        self.frames = level.frames.clone();
        let mut now = self.modes;
        if !level
            .frames
            .statements()
            .first()
            .is_some_and(|first| first.instead)
        {
            self.write_line(b"TRANS");
        }
        for statement in level.frames.statements() {
            let codes = statement.modes.of_frame_from(&mut now);
            if !codes.is_empty() {
                self.write_line(codes.as_bytes());
            }
            self.write_line(&statement.text);
        }
        let codes = self.modes.of_frame_from(&mut now);
        if !codes.is_empty() {
            self.write_line(codes.as_bytes());
        }
    }
}

//! What comes back behind a subprogram with SAVE: the G codes in force at its call, the settable zero and the programmable frame.
//!
//! Source: Siemens, SINUMERIK 840D sl / 828D, programming manual, job planning, "Save modal G functions (SAVE)", and function manual,
//! basic functions, K2 "Subprograms with SAVE attribute": behind the call the frame that was active before it is active again.

use std::rc::Rc;

use crate::refused_run::Behind;
use crate::siemens::flat::modes::Modes;
use crate::siemens::flat::runner::{Level, Runner};

/// Words that put a frame in place of all before, or back to none.
const INSTEAD: [&[u8]; 4] = [b"TRANS", b"ROT", b"SCALE", b"MIRROR"];
/// Words that add to the frame in force.
const FURTHER: [&[u8]; 4] = [b"ATRANS", b"AROT", b"ASCALE", b"AMIRROR"];

/// Whether a word in capitals states a programmable frame.
pub(super) fn is_frame(word: &[u8]) -> bool {
    INSTEAD.contains(&word) || FURTHER.contains(&word)
}

/// A statement of a frame, with numbers in place of its expressions, and the codes that its values are read with.
#[derive(Debug, Clone, PartialEq)]
struct Statement {
    text: Vec<u8>,
    modes: Modes,
    instead: bool,
}

/// The statements that make the programmable frame in force.
#[derive(Debug, Clone, Default)]
pub(super) struct Frames(Rc<Vec<Statement>>);

impl Runner<'_> {
    /// Keeps the words of a block that states a frame, as they were written.
    pub(super) fn keep_frame(&mut self, word: &[u8], text: &[u8]) {
        let instead = INSTEAD.contains(&word);
        if instead {
            self.frames = Frames::default();
        }
        let statement = Statement {
            text: text.to_vec(),
            modes: self.modes,
            instead,
        };
        // Copied where a program that called still holds the frame of its call.
        Rc::make_mut(&mut self.frames.0).push(statement);
    }

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
                let caller = self.levels.last().map_or(0, |caller| caller.unit);
                self.faults
                    .add(self.units[caller].file, *fault, Behind::Same);
            }
        }
        self.modes = level.modes;
        let same = Rc::ptr_eq(&self.frames.0, &level.frames.0) || self.frames.0 == level.frames.0;
        if same {
            return;
        }
        self.frames = level.frames.clone();
        let mut now = self.modes;
        if !level.frames.0.first().is_some_and(|first| first.instead) {
            self.write_line(b"TRANS");
        }
        for statement in level.frames.0.iter() {
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

//! Instructions by their tables: motions, and what is carried.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::model::outside_call::OutsideCall;
use crate::options::ExternalAxes;
use crate::rapid::motion::{Instruction, follow};
use crate::rapid::place::Place;
use crate::rapid::table::{EXTERNAL, MotionRow, row};
use crate::rapid::tree::{Choice, TokenFile};
use crate::rapid::turning::mode_of;
use crate::rapid::walker::Walker;
use crate::table::Treatment;
use crate::text::finding::Finding;
use crate::text::name::Name;

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

impl Walker<'_, '_> {
    /// A motion instruction.
    pub(super) fn motion_by(
        &mut self,
        row: &'static MotionRow,
        tokens: &Range<usize>,
        (place, choice): (Place, Choice),
    ) -> Place {
        let (file, routine) = (self.file(), self.now.routine);
        let instruction = Instruction {
            row,
            routine,
            tokens,
        };
        let followed = follow(&instruction, self.values, self.targets, self.unknown);
        match followed {
            Ok(mut motion) => {
                if choice == Choice::Compact && motion.site.indivisible.is_none() {
                    motion.site.indivisible =
                        Some("it stands behind IF without THEN, where one statement can stand");
                }
                motion.runs = self.now.runs;
                self.modes.push(self.now.modes);
                self.motions.push(motion);
                self.places.push((routine, place));
                Place::Motion(self.motions.len() - 1)
            }
            Err((reason, remedy)) => {
                note(self.faults, || {
                    ProgramError::at(file.source, file.span(tokens), reason, remedy)
                });
                Place::Unknown
            }
        }
    }

    /// After an expression: a function of these files may move the tool.
    pub(super) fn behind_functions(&mut self, tokens: Range<usize>, place: Place) -> Place {
        let (file, symbols) = (self.file(), &self.values.symbols);
        let moves = |at: usize| {
            let name = Name::of(file.word(at));
            let called = name.and_then(|name| symbols.routine(self.now.routine, &name));
            called.is_some_and(|index| self.moving_functions[index])
        };
        match symbols.has_functions && tokens.into_iter().any(moves) {
            true => Place::Unknown,
            false => place,
        }
    }

    /// An instruction that is no motion, or what is in none of the files.
    pub(super) fn carried(
        &mut self,
        name: Option<Name>,
        tokens: &Range<usize>,
        place: Place,
    ) -> Place {
        let file = self.file();
        let span = file.span(tokens);
        match name.as_ref().and_then(row).map(|row| row.treatment) {
            // The arm stands still, and the user says that nothing else matters.
            Some(EXTERNAL) if self.external == ExternalAxes::Carried => {
                match place {
                    Place::Motion(index) => self.motions[index].site.external_moved_behind = true,
                    Place::Entry => self.moves_external_at_entry = true,
                    Place::Unknown => {}
                }
                place
            }
            Some(Treatment::Refused { reason, remedy }) => {
                note(self.faults, || {
                    ProgramError::at(file.source, span, reason, remedy)
                });
                Place::Unknown
            }
            Some(_) => {
                let name = String::from_utf8_lossy(file.word(tokens.start));
                if mode_of(file, tokens).is_some() {
                    let moment = self.next_moment();
                    self.now.modes = self.now.modes.after(file, tokens, moment);
                    self.modes_stated += 1;
                }
                self.has_ended |= name.eq_ignore_ascii_case("ExitCycle");
                let effects = EFFECTS
                    .iter()
                    .find(|(word, _)| word.eq_ignore_ascii_case(&name));
                if let Some((word, effect)) = effects {
                    self.findings.push(Finding {
                        file: file.index,
                        line: file.source.line_of(span.start),
                        message: format!("{word} {effect}: it is carried, and not followed"),
                    });
                }
                place
            }
            None => {
                let called = crate::error::excerpt(file.word(tokens.start));
                let is_computed = is_computed(file, tokens);
                if is_computed {
                    // It may be any routine of these files.
                    self.now.modes = self.now.modes.met(self.anywhere);
                }
                self.outside_calls.push(OutsideCall {
                    file: file.index,
                    line: file.source.line_of(span.start),
                    name: (!is_computed).then_some(called),
                    speeds_behind: Vec::new(),
                });
                Place::Unknown
            }
        }
    }
}

/// Whether the run computes which routine is called: `%"name"%`, `CallByVar`.
pub(super) fn is_computed(file: &TokenFile<'_>, tokens: &Range<usize>) -> bool {
    let word = file.word(tokens.start);
    word == b"%" || word.eq_ignore_ascii_case(b"CallByVar")
}

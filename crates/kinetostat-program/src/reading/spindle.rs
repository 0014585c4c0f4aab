//! Spindle state, block by block.
//!
//! Takes S, D beside G96, G96 and G97, M3 M4 M5 M13 M14 M19, M6 and the end of the program in the order in which LinuxCNC
//! executes them (its documentation, `docs/src/gcode/overview.adoc`, "G-code Order of Execution"; that a change of tools and
//! the end of the program stop the spindle: `m-code.adoc`, M6, M2). Gives the changes of the spindle with their lines.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::spindle::{SpeedMode, Spindle, SpindleChange, SpindleRotation};
use crate::reading::block::Block;
use crate::reading::options::Units;
use crate::text::Word;

/// Faster than any spindle (rpm) and any cut (m/min, feet/min).
const LARGEST_SPEED: f64 = 1e6;

/// Metres in a foot.
const METRES_PER_FOOT: f64 = 0.3048;

/// Spindle words of a program.
#[derive(Default)]
pub(crate) struct SpindleWords {
    now: Spindle,
    changes: Vec<SpindleChange>,
    /// Units in force after the last block.
    units: Option<Units>,
    ended: bool,
}

impl SpindleWords {
    /// Takes the words of a block; the units are those in force after it.
    pub fn note(&mut self, block: &Block<'_>, units: Option<Units>) -> Result<(), ProgramError> {
        // LinuxCNC reads an S in the units before those of its block, others in the new ones.
        let sure_units = units.filter(|after| self.units.unwrap_or(*after) == *after);
        self.units = units;
        if self.ended {
            return Ok(());
        }
        let mut next = self.now;
        if let Some(code) = block.codes.speed_mode {
            let before = next.mode;
            next.mode = match code {
                960 => SpeedMode::ConstantSurface {
                    // D0 is no speed; where D names a compensation it means none.
                    most_rpm: number(block, block.word(b'D'), "a largest speed of the spindle")?
                        .filter(|most| *most > 0.0),
                },
                _ => SpeedMode::Constant,
            };
            // An S of another mode is another quantity, which controllers keep, convert or want anew.
            if std::mem::discriminant(&before) != std::mem::discriminant(&next.mode) {
                next.speed = None;
            }
        }
        if let Some(speed) = number(block, speed_word(block), "a speed of the spindle")? {
            next.speed = match (next.mode, sure_units) {
                (SpeedMode::Constant, _) => Some(speed),
                (SpeedMode::ConstantSurface { .. }, None) => None,
                (_, Some(Units::Millimetres)) => Some(speed),
                (_, Some(Units::Inches)) => Some(speed * METRES_PER_FOOT),
            };
        }
        if changes_tool(block) {
            next.rotation = SpindleRotation::Stopped;
        }
        next.rotation = match block.codes.spindle {
            Some(30 | 130) => SpindleRotation::Clockwise,
            Some(40 | 140) => SpindleRotation::CounterClockwise,
            Some(_) => SpindleRotation::Stopped,
            None => next.rotation,
        };
        self.set(block.line_number, next);
        Ok(())
    }

    /// The program has ended: from this line on the spindle stands still, whatever follows.
    pub fn end(&mut self, line: usize) {
        self.ended = true;
        let rotation = SpindleRotation::Stopped;
        self.set(
            line,
            Spindle {
                rotation,
                ..self.now
            },
        );
    }

    pub fn now(&self) -> Spindle {
        self.now
    }

    /// The words of other blocks, from the state that these ended in.
    pub fn following(&self) -> Self {
        Self {
            now: self.now,
            changes: Vec::new(),
            units: self.units,
            ended: self.ended,
        }
    }

    pub fn finish(self) -> Vec<SpindleChange> {
        self.changes
    }

    fn set(&mut self, line: usize, spindle: Spindle) {
        if spindle == self.now {
            return;
        }
        self.now = spindle;
        // A program that ends in the block that starts the spindle has one state on that line.
        while self.changes.last().is_some_and(|last| last.line >= line) {
            self.changes.pop();
        }
        self.changes.push(SpindleChange { line, spindle });
    }
}

fn changes_tool(block: &Block<'_>) -> bool {
    let mut words = block.words.iter();
    words.any(|word| word.letter == b'M' && word.tenths() == 60)
}

/// The S word, where it is a speed: beside M19 it is an angle on some machines, in a dwell without P it is
/// the time or a number of turns.
fn speed_word<'p>(block: &Block<'p>) -> Option<&'p Word> {
    let find = |letter: u8| block.words.iter().find(|word| word.letter == letter);
    let is_time = block.codes.dwell && find(b'P').is_none();
    let is_angle = block.codes.spindle == Some(190);
    find(b'S').filter(|_| !is_time && !is_angle)
}

/// Value of a word that can be zero or more; an error that names it where it cannot be.
fn number(block: &Block<'_>, word: Option<&Word>, what: &str) -> Result<Option<f64>, ProgramError> {
    match word.map(|word| word.value) {
        Some(value) if !(0.0..=LARGEST_SPEED).contains(&value) => Err(block.refuse(
            ProgramErrorKind::Malformed,
            word,
            &format!("{value} is not {what}"),
            "write a number from 0 to 1000000; the way it turns is said by M3 and M4",
        )),
        value => Ok(value),
    }
}

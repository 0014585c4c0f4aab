//! Effects of the words of a SINUMERIK block that are no motion.
//!
//! Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Fundamentals: M0, M1, M2, M17 and M30 act behind the motion of
//! their block; `M1=3` and `S1=500` are those of spindle 1; G4 takes seconds (F) or turns of the spindle (S).

use kinetostat_program::{SpeedMode, SpindleRotation};

use crate::making::event_kind::EventKind;
use crate::making::turning::Turning;
use crate::making::words::{Said, Word, kind_of_m, word_of_m};
use crate::siemens::axes_beside::OTHER_AXES;
use crate::siemens::table::row;
use crate::siemens::values::whole;
use crate::table::Treatment;

/// Context of a block's words.
pub(crate) struct Purpose {
    pub moves: bool,
    pub dwells: bool,
    /// G25, G26: its numbers are limits.
    pub limits: bool,
    /// A word stops the spindle behind the motion.
    pub stops_late: bool,
    pub dwell_s: Option<f64>,
}

/// The spindle that words without another's number are of.
pub(crate) struct Master {
    pub turning: Turning,
    /// Spindle number; `None` if unknown.
    pub number: Option<u32>,
}

impl Master {
    /// A letter or a name with its number.
    pub(crate) fn value(
        &mut self,
        name: &str,
        text: String,
        number: Option<f64>,
        purpose: &mut Purpose,
    ) -> Option<Said> {
        let early = |kind: EventKind, word: Word| Some(Said::early(kind, word, text.clone()));
        let (letter, extension) = name.split_at_checked(1)?;
        let extension: Option<u32> = match extension {
            "" => Some(0),
            digits => digits.parse().ok(),
        };
        let is_master = extension == Some(0) || extension.is_some() && extension == self.number;
        match (letter, extension) {
            ("G", Some(0)) => return self.code(number.and_then(whole), text, purpose),
            ("M", Some(extension)) => {
                let number = number.and_then(whole);
                return Some(self.function(number, extension, is_master, text, purpose));
            }
            ("S", Some(_)) if purpose.limits => return early(EventKind::Spindle, Word::Other),
            ("S", Some(_)) if purpose.dwells => return early(EventKind::Dwell, Word::Other),
            ("S", Some(_)) => {
                let turns = number.is_none_or(|number| number > 0.0);
                if is_master {
                    self.turning.speed(number.filter(|_| turns));
                }
                return match is_master && turns {
                    true => early(EventKind::Spindle, Word::Spindle),
                    false => early(EventKind::Spindle, Word::Other),
                };
            }
            ("F", Some(0)) if purpose.dwells => {
                purpose.dwell_s = number.filter(|seconds| *seconds >= 0.0);
                return early(EventKind::Dwell, Word::Dwell);
            }
            ("T" | "D", Some(_)) => return early(EventKind::Tool, Word::Other),
            ("H", Some(_)) => return early(EventKind::Other, Word::Other),
            _ => {}
        }
        let is_axis = |first: u8| OTHER_AXES.contains(&first) || b"XYZ".contains(&first);
        let first = name.bytes().next().unwrap_or_default();
        let is_coordinate = extension.is_some() && is_axis(first);
        match is_coordinate && !purpose.limits || is_followed(name) {
            true => None,
            false => early(kind_of_name(name), Word::Other),
        }
    }

    /// A G code.
    fn code(&mut self, number: Option<u32>, text: String, purpose: &Purpose) -> Option<Said> {
        let number = number?;
        let (kind, word) = match number {
            4 if purpose.dwells => (EventKind::Dwell, Word::Dwell),
            // The places are those of the tool's centre.
            41 | 42 => (EventKind::Other, Word::Other),
            96 | 961 => {
                self.turning
                    .count(SpeedMode::ConstantSurface { most_rpm: None });
                (EventKind::Spindle, Word::Other)
            }
            97 | 971 => {
                self.turning.count(SpeedMode::Constant);
                (EventKind::Spindle, Word::Spindle)
            }
            // They take it back, too.
            93..=95 => {
                self.turning.count(SpeedMode::Constant);
                return None;
            }
            505..=599 => return None,
            _ if is_followed(&format!("G{number}")) => return None,
            _ => (EventKind::Other, Word::Other),
        };
        Some(Said::early(kind, word, text))
    }

    /// An M function, of a spindle where its address has an extension.
    fn function(
        &mut self,
        number: Option<u32>,
        extension: u32,
        is_master: bool,
        text: String,
        purpose: &mut Purpose,
    ) -> Said {
        let of_spindle = matches!(number, Some(3..=5 | 19 | 40..=45 | 70));
        let Some(number) = number.filter(|_| extension == 0 || of_spindle) else {
            return Said::early(EventKind::Other, Word::Other, text);
        };
        if of_spindle && !is_master {
            return Said::early(EventKind::Spindle, Word::Other, text);
        }
        match number {
            3 => self.turning.turn(SpindleRotation::Clockwise),
            4 => self.turning.turn(SpindleRotation::CounterClockwise),
            // The control puts it out with the motion, and waits for no standstill. Here it comes behind the motion, as in
            // G-code: a spindle that stops while the tool still cuts does harm, a little later does none.
            5 if purpose.moves => purpose.stops_late = true,
            5 | 19 | 70 => self.turning.turn(SpindleRotation::Stopped),
            _ => {}
        }
        let (kind, word) = match number {
            17 => (EventKind::End, Word::Other),
            40..=45 | 70 => (EventKind::Spindle, Word::Other),
            // The machine's builder says what it does.
            60 => (EventKind::Other, Word::Other),
            _ => (kind_of_m(number), word_of_m(number)),
        };
        match number {
            0 | 1 | 2 | 17 | 30 => late(kind, word, text),
            5 | 9 if purpose.moves => late(kind, word, text),
            _ => Said::early(kind, word, text),
        }
    }
}

pub(crate) fn late(kind: EventKind, word: Word, text: String) -> Said {
    Said {
        is_late: true,
        ..Said::early(kind, word, text)
    }
}

/// True if a word is fully represented in positions, feeds and directions.
pub(crate) fn is_followed(name: &str) -> bool {
    row(name).is_some_and(|row| row.treatment == Treatment::Understood)
}

/// Subject of a carried word.
pub(crate) fn kind_of_name(name: &str) -> EventKind {
    match name {
        "SPOS" | "SPOSA" | "SPCON" | "SPCOF" | "SETMS" | "WAITS" | "LIMS" => EventKind::Spindle,
        _ => EventKind::Other,
    }
}

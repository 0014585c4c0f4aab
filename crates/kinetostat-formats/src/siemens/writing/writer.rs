//! State of the writer at a motion, and the codes and feeds that it states.

use nalgebra::{Point3, Vector3};

use crate::model::motion::Motion;
use crate::options::WriteOptions;
use crate::siemens::state::Code;
use crate::siemens::walker::Written;
use crate::text::number::short;
use crate::text::source::{Edits, SourceFile};
use crate::turned_axis::CountShown;

/// Reason and remedy of a motion that cannot be written.
pub(crate) type Reason = (&'static str, &'static str);

/// Threshold of a change of position or direction, mm and rad.
pub(crate) const SAME: f64 = 1e-9;

/// State after the last block in which the written program differs from its source.
#[derive(Debug, Clone, Default)]
pub(crate) struct Held {
    /// Tool offset from the input, in the part's axes, mm.
    pub off: Vector3<f64>,
    /// Codes, feeds and directions that are in force instead.
    pub code: Option<Code>,
    pub feed: Option<f64>,
    pub direction: Option<Vector3<f64>>,
    /// Deviation of the rotary axes, deg.
    pub turned_deg: Vec<f64>,
    /// Axes that were stated since their last word in the program: a step behind a frame does not count from that word.
    pub stated: [bool; 3],
}

/// The writer at a motion.
pub(crate) struct Writer<'w> {
    /// Letters of the rotary axes whose words are followed, and where they stand at the start and the end of the motion, deg.
    pub letters: &'w [char],
    pub angles: Option<[&'w [f64]; 2]>,
    /// Evidence in the program for the way in which rotary axes count.
    pub shown: &'w [CountShown],
    pub file: &'w SourceFile,
    pub motion: &'w Motion,
    pub written: &'w Written,
    pub options: &'w WriteOptions,
    pub edits: &'w mut Edits,
    pub held: &'w mut Held,
}

const NO_SPEED: Reason = (
    "its speed cannot be changed: it is not known from the text",
    "state the feed by G94 and F, or keep it",
);

impl Writer<'_> {
    pub(crate) fn in_frame(&self, place: Vector3<f64>) -> Vector3<f64> {
        (self.written.frame.inverse() * Point3::from(place)).coords
    }

    /// Insertion point of missing words.
    pub(crate) fn anchor(&self) -> usize {
        let written = self.written;
        let axes = written.axes.iter().flatten().map(|word| word.word.end);
        let code = written.code_word.iter().map(|word| word.end);
        axes.max().or(code.max()).unwrap_or(written.words_at)
    }

    /// Puts words at a place where words begin or end.
    pub(crate) fn insert(&mut self, at: usize, words: &str) {
        let words = words.trim();
        if words.is_empty() {
            return;
        }
        let text = match at == self.written.words_at {
            true => format!("{words} "),
            false => format!(" {words}"),
        };
        self.edits.replace(at..at, text);
    }

    /// States a code of motion where another one would be in force.
    pub(crate) fn code(&mut self, wanted: Code) {
        let written = self.written;
        let stated = &written.code_word;
        let in_force = match stated {
            Some(_) => written.code,
            None => self.held.code.unwrap_or(written.code),
        };
        if in_force != wanted {
            match stated {
                Some(word) => {
                    let long = self.file.part(word).get(1) == Some(&b'0') && word.len() == 3;
                    let text = match long {
                        true => wanted.word().replace('G', "G0"),
                        false => wanted.word().to_owned(),
                    };
                    self.edits.replace(word.clone(), text);
                }
                None => {
                    let at = written.words_at;
                    self.edits.replace(at..at, format!("{} ", wanted.word()));
                }
            }
        }
        self.held.code = (wanted != written.code).then_some(wanted);
    }

    /// The feed that a piece needs, if it is not in force; it is then.
    pub(crate) fn feed_text(&mut self, factor: f64) -> Result<Option<String>, Reason> {
        let (Some(feed), false) = (&self.written.feed, self.written.code == Code::Rapid) else {
            return match factor == 1.0 || self.written.code == Code::Rapid {
                true => Ok(None),
                false => Err(NO_SPEED),
            };
        };
        if factor != 1.0 && self.motion.speed.mm_per_s.is_none() {
            return Err(NO_SPEED);
        }
        let wanted = feed.value * factor;
        let in_force = self.held.feed.unwrap_or(feed.value);
        if wanted == in_force {
            return Ok(None);
        }
        self.held.feed = (factor != 1.0).then_some(wanted);
        if factor == 1.0 {
            let text = feed.text.clone();
            return Ok(Some(text));
        }
        // Feeds of a turn are small.
        let decimals = if wanted < 1.0 { 6 } else { 4 };
        Ok(Some(format!("F{}", short(wanted, decimals))))
    }

    /// States the feed of the own block where another one would be in force.
    pub(crate) fn feed(&mut self, factor: f64) -> Result<(), Reason> {
        if let Some((word, _)) = &self.written.feed_word {
            self.held.feed = None;
            if let Some(text) = self.feed_text(factor)? {
                self.edits.replace(word.clone(), text);
            }
        } else if let Some(text) = self.feed_text(factor)? {
            let at = self.anchor();
            self.insert(at, &text);
        }
        Ok(())
    }
}

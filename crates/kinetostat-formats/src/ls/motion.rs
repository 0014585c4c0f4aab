//! The parts of a motion instruction.

use std::ops::Range;

use crate::interpreter::expression::Expression;
use crate::ls::expression::{expression_of, indices_of};
use crate::ls::lines::{Kind, Word, index_of, words_of};
use crate::ls::table::{Effect, Follows, MOTION_OPTIONS, OFFSET, SKIP};
use crate::model::motion::{Speed, Zone};
use crate::model::site::{OffsetAxes, SpeedSite};

/// Type of interpolation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    Joint,
    Linear,
    Circular,
}

/// Target of the motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum End {
    /// A position of the program: its number and where that stands.
    Position(u32, Range<usize>),
    /// A position whose number is computed, and where that stands.
    Computed(Expression, Range<usize>),
    /// A position register: its number, and where that stands.
    Register(Expression, Range<usize>),
}

/// A motion as it is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MotionText {
    pub way: Way,
    pub keyword: Range<usize>,
    /// Auxiliary point, with `P` and brackets.
    pub via: Option<(Range<usize>, End)>,
    pub target_span: Range<usize>,
    pub target: End,
    pub speed: Speed,
    pub speed_site: Option<SpeedSite>,
    /// A register with the speed, and how many mm/s one of it is.
    pub speed_by: Option<(Expression, f64)>,
    pub zone: Zone,
    pub zone_span: Option<Range<usize>>,
    /// Reason why the end differs from the position.
    pub displaced: Option<&'static str>,
    /// A register offsets it; none for that of the condition in force.
    pub offset: Option<(OffsetAxes, Option<Expression>)>,
    /// The label to which a signal may lead from its end.
    pub skips_to: Option<Expression>,
    pub indivisible: Option<&'static str>,
    pub turns_otherwise: Option<Reason>,
}

/// Reason and remedy of a refused motion.
pub(crate) type Reason = (&'static str, &'static str);

const FORM: Reason = (
    "a motion is J, L or C, a position, a speed, and FINE or CNT",
    "write it as the controller prints it",
);

/// Form of a speed.
enum How {
    Stated,
    /// A register holds it, and how many mm/s one of it is.
    ByRegister(Expression, f64),
    Duration,
}

struct Reader<'b> {
    bytes: &'b [u8],
    words: Vec<Word>,
    at: usize,
}

/// The motion that the text of an instruction says.
pub(crate) fn motion_of(bytes: &[u8], text: &Range<usize>) -> Result<MotionText, Reason> {
    let mut reader = Reader {
        bytes,
        words: words_of(bytes, text),
        at: 0,
    };
    let keyword = reader.letters().ok_or(FORM)?;
    let way = match &bytes[keyword.clone()] {
        b"J" => Way::Joint,
        b"L" => Way::Linear,
        b"C" => Way::Circular,
        _ => return Err(FORM),
    };
    let first = reader.end()?;
    let (via, (target_span, target)) = match way {
        Way::Circular => (Some(first), reader.end()?),
        Way::Joint | Way::Linear => (None, first),
    };
    let (speed, speed_site, how) = reader.speed().ok_or(FORM)?;
    let (zone, zone_span) = reader.zone().ok_or(FORM)?;
    let is_duration = matches!(how, How::Duration);
    let mut motion = MotionText {
        way,
        keyword,
        via,
        target_span,
        target,
        speed,
        speed_site,
        speed_by: match how {
            How::ByRegister(register, unit_mm_per_s) => Some((register, unit_mm_per_s)),
            How::Stated | How::Duration => None,
        },
        zone,
        zone_span: Some(zone_span),
        displaced: None,
        offset: None,
        skips_to: None,
        indivisible: is_duration.then_some("its speed is a time, which each piece would take"),
        turns_otherwise: None,
    };
    reader.options(&mut motion)?;
    Ok(motion)
}

/// Action that an option of a motion starts (`TB .10sec,DO[1]=ON`), up to its end.
pub(crate) fn event_of(bytes: &[u8], text: &Range<usize>) -> Option<Range<usize>> {
    let starts = |word: &Word| {
        let name = &bytes[word.span.clone()];
        (MOTION_OPTIONS.iter())
            .any(|row| row.follows == Follows::Event && row.name.as_bytes() == name)
    };
    let first = words_of(bytes, text).into_iter().find(starts)?;
    Some(first.span.start..text.end)
}

impl Reader<'_> {
    fn kind(&self) -> Option<Kind> {
        self.words.get(self.at).map(|word| word.kind)
    }

    fn text(&self) -> &[u8] {
        let word = self.words.get(self.at);
        word.map_or(&[], |word| &self.bytes[word.span.clone()])
    }

    fn takes(&mut self, kind: Kind) -> bool {
        let found = self.kind() == Some(kind);
        self.at += usize::from(found);
        found
    }

    fn next(&mut self, kind: Kind) -> Option<Range<usize>> {
        let found = self.words.get(self.at).filter(|word| word.kind == kind)?;
        self.at += 1;
        Some(found.span.clone())
    }

    fn letters(&mut self) -> Option<Range<usize>> {
        self.next(Kind::Letters)
    }

    fn end(&mut self) -> Result<(Range<usize>, End), Reason> {
        let name = self.letters().ok_or(FORM)?;
        let is_register = match &self.bytes[name.clone()] {
            b"P" => false,
            b"PR" => true,
            _ => return Err(FORM),
        };
        let bracket = self.next(Kind::Bracket).ok_or(FORM)?;
        let span = name.start..bracket.end;
        let found = index_of(self.bytes, &bracket);
        let inside = match &found {
            Some((_, digits)) => digits.clone(),
            None => bracket.start + 1..bracket.end - 1,
        };
        let end = match (is_register, found) {
            (false, Some((number, digits))) => End::Position(number, digits),
            (false, None) => End::Computed(self.index(&bracket), inside),
            (true, _) => End::Register(self.index(&bracket), inside),
        };
        Ok((span, end))
    }

    fn index(&self, bracket: &Range<usize>) -> Expression {
        let indices = indices_of(self.bytes, bracket);
        let first = indices.and_then(|indices| indices.into_iter().next());
        first.unwrap_or_else(|| expression_of(self.bytes, bracket.clone()))
    }

    /// A number, or a register; with its value where the text says it.
    fn value(&mut self) -> Option<(Option<f64>, Range<usize>)> {
        let word = self.words.get(self.at)?.clone();
        match word.kind {
            Kind::Number(value) => {
                self.at += 1;
                Some((Some(value), word.span))
            }
            Kind::Letters if matches!(self.text(), b"R" | b"AR") => {
                self.at += 1;
                let bracket = self.next(Kind::Bracket)?;
                Some((None, word.span.start..bracket.end))
            }
            _ => None,
        }
    }

    /// The speed, where another can be written, and how it is stated.
    fn speed(&mut self) -> Option<(Speed, Option<SpeedSite>, How)> {
        if self.text().eq_ignore_ascii_case(b"WELD_SPEED") {
            let span = self.letters()?;
            return Some((self.speed_text(&span, None), None, How::Stated));
        }
        let (value, from) = self.value()?;
        let unit = self.words.get(self.at)?.clone();
        self.at += 1;
        let divided = self.takes(Kind::Symbol(b'/'));
        let (per, end) = match divided {
            true => {
                let per = self.letters()?;
                (self.bytes[per.clone()].to_vec(), per.end)
            }
            false => (Vec::new(), unit.span.end),
        };
        let span = from.start..end;
        // Units: mm, and seconds.
        let [length, time] = match (&self.bytes[unit.span], per.as_slice()) {
            (b"%", b"") | (b"deg", b"sec") => {
                return Some((self.speed_text(&span, None), None, How::Stated));
            }
            (b"sec" | b"msec", b"") => {
                return Some((self.speed_text(&span, None), None, How::Duration));
            }
            (b"mm", b"sec") => [1.0, 1.0],
            (b"cm", b"min") => [10.0, 60.0],
            (b"inch", b"min") => [25.4, 60.0],
            _ => return None,
        };
        let how = match value {
            Some(_) => How::Stated,
            None => How::ByRegister(expression_of(self.bytes, from), length / time),
        };
        let site = SpeedSite {
            span: span.clone(),
            before: String::new(),
            after: "mm/sec".to_owned(),
            unit_mm_per_s: 1.0,
        };
        let mm_per_s = value.map(|value| value * length / time);
        Some((self.speed_text(&span, mm_per_s), Some(site), how))
    }

    fn speed_text(&self, span: &Range<usize>, mm_per_s: Option<f64>) -> Speed {
        Speed {
            mm_per_s,
            text: String::from_utf8_lossy(&self.bytes[span.clone()]).into_owned(),
        }
    }

    fn zone(&mut self) -> Option<(Zone, Range<usize>)> {
        let word = self.letters()?;
        match &self.bytes[word.clone()] {
            b"FINE" => Some((Zone::Exact, word)),
            name @ (b"CNT" | b"CD") => {
                let is_percent = name == b"CNT";
                let (value, span) = self.value()?;
                let zone = match (value, is_percent) {
                    (Some(value), true) => Zone::Percent(value),
                    (Some(value), false) => Zone::Radius(value),
                    (None, _) => Zone::Unstated,
                };
                Some((zone, word.start..span.end))
            }
            _ => None,
        }
    }

    fn options(&mut self, motion: &mut MotionText) -> Result<(), Reason> {
        while self.at < self.words.len() {
            let row = MOTION_OPTIONS
                .iter()
                .find(|row| row.name.as_bytes() == self.text());
            let Some(row) = row else {
                return Err((
                    "an option of the motion is not known",
                    "take the option out, or this motion into a program of its own",
                ));
            };
            self.at += 1;
            let mut register = None;
            match row.follows {
                Follows::Nothing => {
                    // COORD[LDR], CNT's own.
                    self.takes(Kind::Bracket);
                }
                Follows::Value => {
                    self.value().ok_or(FORM)?;
                    let unit = self.takes(Kind::Symbol(b'%'));
                    if !unit && self.text() == b"mm" {
                        self.at += 1;
                    }
                }
                Follows::Register => {
                    if self.takes(Kind::Symbol(b',')) {
                        self.letters().ok_or(FORM)?;
                        let bracket = self.next(Kind::Bracket).ok_or(FORM)?;
                        register = Some(self.index(&bracket));
                    }
                }
                Follows::Event => {
                    if row.effect == SKIP {
                        let bracket = self.words.iter().rfind(|word| word.kind == Kind::Bracket);
                        motion.skips_to = bracket.map(|word| self.index(&word.span));
                    }
                    self.at = self.words.len();
                    motion.indivisible = Some("what its option starts would start at each piece");
                }
            }
            match row.effect {
                Effect::None => {}
                Effect::Turned(reason) => {
                    let remedy =
                        "take the option out, or teach both positions with one orientation";
                    motion.turns_otherwise = Some((reason, remedy));
                }
                Effect::Displaced(reason) => motion.displaced = Some(reason),
                Effect::Offset(axes) => match motion.offset {
                    None => motion.offset = Some((axes, register)),
                    Some(_) => motion.displaced = Some(OFFSET),
                },
                Effect::Refused(reason, remedy) => return Err((reason, remedy)),
            }
        }
        Ok(())
    }
}

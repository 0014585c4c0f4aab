//! Words of a path block: coordinates, feed, radius compensation, miscellaneous functions.

use crate::heidenhain::datum::axis_of;
use crate::heidenhain::words::{Value, Word};

/// A coordinate: its word, its value in the unit of the program, whether it is a step from where the tool is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coordinate {
    pub word: usize,
    pub value: f64,
    pub step: bool,
}

/// The word of a rotary axis: its place, A, B or C, degrees, whether it is a step from where the axis stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RotaryWord {
    pub at: usize,
    pub letter: u8,
    pub value: f64,
    pub step: bool,
}

/// Form of the feed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum FeedWord {
    #[default]
    None,
    /// The word, and its number.
    Number(usize, f64),
    /// In rapid traverse, in this block alone.
    Max,
    /// Feed of the tool call.
    Auto,
    /// Per turn or tooth, or by time.
    Other,
}

/// A path block, taken apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PathWords {
    pub axes: [Option<Coordinate>; 3],
    /// PR, IPR.
    pub radius: Option<Coordinate>,
    /// PA, IPA.
    pub angle: Option<Coordinate>,
    /// R of CR.
    pub circle: Option<f64>,
    /// DR: 1 anticlockwise.
    pub sense: Option<f64>,
    pub feed: FeedWord,
    /// RL or RR.
    pub aside: bool,
    /// R0, RL or RR, by its word.
    pub compensation: Option<usize>,
    /// Miscellaneous functions: the word, the number.
    pub functions: Vec<(usize, u32)>,
    /// A, B, C, IA, IB, IC.
    pub rotary: Vec<RotaryWord>,
    /// TX, TY, TZ.
    pub axis: [Option<f64>; 3],
    /// Words that say where the block ends, all of them.
    pub places: Vec<usize>,
}

/// Word for which a block cannot be decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Odd {
    /// A Q parameter says its value.
    Parameter(usize),
    /// The word is unknown, or has no value.
    Unknown(usize),
    /// The word is stated twice.
    Twice(usize),
}

impl PathWords {
    /// Decodes the words after the first, which states the kind of block.
    pub(crate) fn of(words: &[Word]) -> Result<Self, Odd> {
        let mut found = Self::default();
        let is_circle = words.first().is_some_and(|word| word.is("CR"));
        // Some functions have words of their own after them.
        let mut owned = false;
        let mut at = 1;
        while at < words.len() {
            let word = &words[at];
            if word.is("M") {
                let number = word.whole().ok_or(odd(word, at))?;
                found.functions.push((at, number));
                owned = has_words(number);
            } else if !owned {
                at += found.one(words, at, is_circle)?;
            }
            at += 1;
        }
        Ok(found)
    }

    /// Takes one word; how many more it took.
    fn one(&mut self, words: &[Word], at: usize, is_circle: bool) -> Result<usize, Odd> {
        let word = &words[at];
        if let Some((axis, step)) = axis_of(word) {
            let value = word.value().ok_or(odd(word, at))?;
            let coordinate = Coordinate {
                word: at,
                value,
                step,
            };
            self.places.push(at);
            return put(&mut self.axes[axis], coordinate, at);
        }
        let letters = word.letters;
        let coordinate = |step: bool| {
            let value = word.value().ok_or(odd(word, at))?;
            Ok(Coordinate {
                word: at,
                value,
                step,
            })
        };
        match letters.letters() {
            b"PR" | b"IPR" => {
                self.places.push(at);
                return put(&mut self.radius, coordinate(letters.is("IPR"))?, at);
            }
            b"PA" | b"IPA" => {
                self.places.push(at);
                return put(&mut self.angle, coordinate(letters.is("IPA"))?, at);
            }
            b"DR" => match word.value {
                Value::Sign(sign) => {
                    self.sense = Some(sign);
                    self.places.push(at);
                }
                _ => return Err(odd(word, at)),
            },
            b"R" => match word.value() {
                Some(radius) if is_circle && self.circle.is_none() => {
                    self.circle = Some(radius);
                    self.places.push(at);
                }
                Some(0.0) => self.compensation = Some(at),
                _ => return Err(odd(word, at)),
            },
            b"RL" | b"RR" if word.value == Value::None => {
                self.aside = true;
                self.compensation = Some(at);
            }
            b"F" | b"FMAX" | b"FAUTO" | b"FU" | b"FZ" | b"FT" | b"FMAXT"
                if self.feed != FeedWord::None =>
            {
                return Err(Odd::Twice(at));
            }
            b"F" => {
                let next = words.get(at + 1);
                let follows = |name: &str| next.is_some_and(|next| next.is(name));
                match &word.value {
                    Value::Number(number) => self.feed = FeedWord::Number(at, number.value),
                    Value::None if follows("MAX") => {
                        self.feed = FeedWord::Max;
                        return Ok(1);
                    }
                    Value::None if follows("AUTO") => {
                        self.feed = FeedWord::Auto;
                        return Ok(1);
                    }
                    _ => return Err(odd(word, at)),
                }
            }
            b"FMAX" => self.feed = FeedWord::Max,
            b"FAUTO" => self.feed = FeedWord::Auto,
            b"FU" | b"FZ" | b"FT" | b"FMAXT" => self.feed = FeedWord::Other,
            b"A" | b"B" | b"C" | b"IA" | b"IB" | b"IC" => {
                let value = word.value().ok_or(odd(word, at))?;
                let letter = letters.letters().last().copied().unwrap_or_default();
                if self.rotary.iter().any(|other| other.letter == letter) {
                    return Err(Odd::Twice(at));
                }
                self.rotary.push(RotaryWord {
                    at,
                    letter,
                    value,
                    step: letters.letters().len() > 1,
                });
            }
            b"NX" | b"NY" | b"NZ" => {
                word.value().ok_or(odd(word, at))?;
            }
            // The spindle's speed.
            b"S" => {}
            b"TX" => self.axis[0] = Some(word.value().ok_or(odd(word, at))?),
            b"TY" => self.axis[1] = Some(word.value().ok_or(odd(word, at))?),
            b"TZ" => self.axis[2] = Some(word.value().ok_or(odd(word, at))?),
            _ => return Err(Odd::Unknown(at)),
        }
        Ok(0)
    }

    /// True if the block states a position.
    pub(crate) fn moves(&self) -> bool {
        !self.places.is_empty()
    }
}

/// True if the words after a function belong to it.
pub(crate) fn has_words(function: u32) -> bool {
    matches!(function, 103 | 112 | 118 | 120 | 124 | 128 | 138 | 140)
}

fn odd(word: &Word, at: usize) -> Odd {
    match word.value {
        Value::Parameter { .. } => Odd::Parameter(at),
        _ => Odd::Unknown(at),
    }
}

fn put(to: &mut Option<Coordinate>, coordinate: Coordinate, at: usize) -> Result<usize, Odd> {
    match to.replace(coordinate) {
        Some(_) => Err(Odd::Twice(at)),
        None => Ok(0),
    }
}

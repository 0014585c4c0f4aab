//! The words of a block as they are written: coordinates, feeds, which functions stand on which piece.

use crate::heidenhain::path_words::{FeedWord, PathWords, RotaryWord, has_words};
use crate::heidenhain::table::{Function, function};
use crate::heidenhain::words::Word;
use crate::text::number::{NumberText, Width, printed, short};
use crate::text::source::{Edits, SourceFile};
use crate::writing::piece::Piece;

/// Functions of a block that is divided: those at its beginning on the first piece, those at its end on the last.
pub(crate) fn write_functions(words: &[Word], part: Part, edits: &mut Edits) {
    if part == Part::Only {
        return;
    }
    // With the words of its own.
    let (mut taken, mut owned) = (false, false);
    for (at, word) in words.iter().enumerate().skip(1) {
        if word.is("M") {
            let number = word.whole().unwrap_or(0);
            owned = has_words(number);
            taken = match when(number) {
                When::Start => part != Part::First,
                _ => part != Part::Last,
            };
        } else if !owned {
            continue;
        }
        if taken {
            take_out(words, at, edits);
        }
    }
}

/// Position of a piece within its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Only,
    First,
    Middle,
    Last,
}

/// A piece and its position within its motion.
#[derive(Clone, Copy)]
pub(crate) struct PlacedPiece<'p> {
    pub piece: &'p Piece,
    pub part: Part,
    /// Share of the motion at the end of the piece, by the number of pieces.
    pub share: f64,
}

/// When a function acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum When {
    Start,
    End,
    Unknown,
}

pub(crate) fn when(number: u32) -> When {
    match function(number) {
        Function::AtStart | Function::PerTurn | Function::PerMinute => When::Start,
        Function::Unknown => When::Unknown,
        _ => When::End,
    }
}

pub(crate) fn functions_of(words: &[Word]) -> Vec<(When, u32)> {
    let numbers = words
        .iter()
        .filter(|word| word.is("M"))
        .filter_map(Word::whole);
    numbers.map(|number| (when(number), number)).collect()
}

/// Words of the end and the feed of a block.
pub(crate) struct Stated {
    pub word: [Option<usize>; 3],
    pub absolute: [bool; 3],
    /// Words that say where it ends.
    pub places: Vec<usize>,
    pub feed: FeedWord,
    /// The direction of the tool.
    pub directs: bool,
    /// Angles of rotary axes.
    pub rotary: Vec<RotaryWord>,
}

impl Stated {
    pub(crate) fn of(words: &[Word]) -> Self {
        match PathWords::of(words) {
            Ok(parsed) => Self {
                word: parsed.axes.map(|axis| axis.map(|axis| axis.word)),
                absolute: parsed.axes.map(|axis| axis.is_some_and(|axis| !axis.step)),
                places: parsed.places,
                feed: parsed.feed,
                directs: parsed.axis.iter().all(Option::is_some),
                rotary: parsed.rotary,
            },
            Err(_) => Self {
                word: [None; 3],
                absolute: [false; 3],
                places: Vec::new(),
                feed: FeedWord::None,
                directs: false,
                rotary: Vec::new(),
            },
        }
    }
}

/// Takes a word out, with the blanks before it.
pub(crate) fn take_out(words: &[Word], at: usize, edits: &mut Edits) {
    let span = with_blanks(words, at);
    // The word behind may stand against it.
    let next = words.get(at + 1).map(|next| next.span.start);
    let gap = match next == Some(span.end) {
        true => " ",
        false => "",
    };
    edits.replace(span, gap);
}

/// Insertion point of words before the functions of a block.
pub(crate) fn before_functions(words: &[Word]) -> usize {
    let first = words.iter().position(|word| word.is("M"));
    let behind = first.unwrap_or(words.len()).saturating_sub(1);
    words.get(behind).map_or(0, |word| word.span.end)
}

/// A word with the blanks before it.
pub(crate) fn with_blanks(words: &[Word], at: usize) -> std::ops::Range<usize> {
    let from = match at {
        0 => words[0].span.start,
        _ => words[at - 1].span.end,
    };
    from..words[at].span.end
}

/// The number that a written number says.
pub(crate) fn parsed(text: &[u8]) -> Option<f64> {
    let plain: Vec<u8> = text
        .iter()
        .filter(|byte| !byte.is_ascii_whitespace())
        .map(|byte| match byte {
            b',' => b'.',
            other => *other,
        })
        .collect();
    std::str::from_utf8(&plain).ok()?.parse().ok()
}

/// Another value in place of a number, with its sign and its decimal sign.
pub(crate) fn number_text(
    file: &SourceFile,
    number: &NumberText,
    value: f64,
    decimals: usize,
) -> Vec<u8> {
    let original = file.part(&number.span);
    let comma = original.contains(&b',');
    let swapped = |text: &[u8], from: u8, to: u8| -> Vec<u8> {
        let swap = |byte: &u8| match *byte == from {
            true => to,
            false => *byte,
        };
        text.iter().map(swap).collect()
    };
    match comma {
        true => {
            let pointed = swapped(original, b',', b'.');
            let text = printed(&pointed, number.value, value, decimals, Width::Free);
            swapped(&text, b'.', b',')
        }
        false => printed(original, number.value, value, decimals, Width::Free),
    }
}

/// A feed with at most three decimals, as the control takes it.
pub(crate) fn feed_text(feed: f64) -> String {
    // Feeds of a turn are small.
    let decimals = if feed < 1.0 { 6 } else { 3 };
    short(feed, decimals)
}

/// A word of an axis.
pub(crate) fn word_text(axis: usize, value: f64, decimals: usize, signs: bool) -> String {
    stands(["X", "Y", "Z"][axis], value, decimals, signs)
}

/// A word with its number.
pub(crate) fn stands(name: &str, value: f64, decimals: usize, signs: bool) -> String {
    let digits = decimals.min(12);
    let text = format!("{value:+.digits$}");
    let is_zero = !text.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    let unsigned = text.trim_start_matches(['+', '-']);
    let sign = match (text.starts_with('-') && !is_zero, signs) {
        (true, _) => "-",
        (false, true) => "+",
        (false, false) => "",
    };
    format!("{name}{sign}{unsigned}")
}

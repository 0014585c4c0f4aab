//! G0 to G3 of a piece.

use crate::path::curve::Curve;
use crate::path::moves::{Motion, Move};
use crate::text::line::Word;
use crate::writing::blocks::block_text::{AXES, BlockText, Edits, motion_word, number_span};
use crate::writing::output_state::{OutputMove, OutputState, motion_of};

/// The motion word that a piece of this move needs.
pub(crate) fn motion_of_piece(motion: &Move, step: &OutputMove) -> Motion {
    match step.arc {
        Some(_) => arc_motion(motion),
        None => motion_of(motion),
    }
}

/// The motion word of an arc: its angle grows counter-clockwise about the plane's normal.
pub(crate) fn arc_motion(motion: &Move) -> Motion {
    match &motion.curve {
        Curve::Arc(arc) if arc.sweep < 0.0 => Motion::Clockwise,
        Curve::Arc(_) => Motion::CounterClockwise,
        Curve::Line => motion_of(motion),
    }
}

/// The number of a motion word.
pub(crate) fn code_of(motion: Motion) -> &'static str {
    match motion {
        Motion::Rapid => "0",
        Motion::Clockwise => "2",
        Motion::CounterClockwise => "3",
        Motion::Feed | Motion::Off => "1",
    }
}

/// Edits the motion on the block's own line: if its piece is straight, G2 and G3 become G1, and the words of the arc go.
pub(crate) fn edit_motion_words(
    (text, motion): (&BlockText<'_>, &Move),
    state: &OutputState,
    own: Motion,
    edits: &mut Edits,
) {
    let straightened = motion.curve != Curve::Line && own == motion_of(motion);
    if let Some(word) = motion_word(text.words) {
        if straightened {
            let digits = match text.program.bytes()[word.number as usize] {
                b'0' => "01",
                _ => "1",
            };
            edits.replaced.push((number_span(word), digits.to_owned()));
        }
    } else if state.motion != Some(own) {
        let coordinate = text.words.iter().find(|word| AXES.contains(&word.letter));
        let (at, after) = match coordinate {
            Some(word) => (word.start as usize, text.separator),
            None => (text.place_for_added(), ""),
        };
        let word = format!("{}{}{after}", text.cased(b'G'), code_of(own));
        edits.replaced.push((at..at, word));
    }
    if straightened {
        let of_arc = |word: &&Word| b"IJKRP".contains(&word.letter);
        for word in text.words.iter().filter(of_arc) {
            text.remove_word(edits, word);
        }
    }
}

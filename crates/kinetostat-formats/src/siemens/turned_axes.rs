//! Rotary axes whose words are followed: A, B, C of the machine's model.

use std::ops::Range;

use crate::model::stated_axes::AxesStated;
use crate::siemens::block::{Block, How, Item};
use crate::siemens::expression::Expression;
use crate::siemens::state::{Code, Coordinate};
use crate::siemens::walker::Reader;
use crate::siemens::words::{Purpose, Words, coordinate_of};
use crate::turned_axis::{AxisTurn, TipWords, Turning};

const TIP: TipWords = TipWords {
    control: "TRAORI",
    rapid: "G0 ",
    zero: "0",
    step: |letter, by| format!("{letter}=IC({by})"),
    shorter: |letter, to| format!("{letter}=DC({to}) the shorter way"),
};

impl Reader<'_> {
    /// The word of a rotary axis.
    pub(crate) fn rotary_word(
        &mut self,
        item: &Item,
        place: usize,
        how: How,
        value: &Expression,
        words: &mut Words,
    ) {
        if words.purpose == Purpose::Limits {
            return;
        }
        if how == How::Rotary {
            self.state.standing.show_one_turn(place);
        }
        let Some(written) = self.number(&item.span, value) else {
            return;
        };
        if words.rotary.iter().any(|(other, ..)| *other == place) {
            return self.fault(&item.span, "the word stands twice in the block", "keep one");
        }
        let step = how == How::Step || how == How::Modal && self.state.steps;
        if let Some(word) = coordinate_of(item, written, 1.0, step) {
            words.rotary.push((place, word, how));
        }
    }

    /// Turns the axes as the words of a block say; whether there are such words.
    pub(crate) fn turn_axes(&mut self, words: &Words) -> bool {
        if words.frame.is_some() || matches!(words.purpose, Purpose::Dwell | Purpose::Limits) {
            return false;
        }
        let turning = Turning {
            words: &TIP,
            rapid: self.state.code == Code::Rapid,
        };
        for (place, word, how) in &words.rotary {
            if words.purpose == Purpose::Machine {
                self.state.standing.send_axis(*place);
                if self.state.oriented {
                    self.state.forget();
                }
                continue;
            }
            let to = word.written;
            let turn = match (how, word.step) {
                (How::Rotary, _) => match self.shape_of_value(word).as_str() {
                    "ACP" => AxisTurn::Upwards(to),
                    "ACN" => AxisTurn::Downwards(to),
                    _ => AxisTurn::Shorter(to),
                },
                (_, true) => AxisTurn::By(to),
                (_, false) => AxisTurn::To(to),
            };
            if let (AxisTurn::To(to), How::Modal, false) = (turn, how, turning.rapid) {
                self.note_plain_turn(*place, word, to);
            }
            if let Err((reason, remedy)) = self.state.standing.turn_axis(*place, turn, turning) {
                self.fault(&word.word, reason, &remedy);
            }
            if self.state.oriented {
                self.state.direction = None;
            }
        }
        words.has_rotary()
    }

    /// `DC`, `ACP` or `ACN` around a value.
    fn shape_of_value(&self, word: &Coordinate) -> String {
        let before = self.file.part(&(word.whole.start..word.number.start));
        let text = String::from_utf8_lossy(before).to_ascii_uppercase();
        text.trim_end_matches(|c: char| !c.is_ascii_alphabetic())
            .to_owned()
    }

    /// A block that turns axes alone, without tool centre point control.
    pub(crate) fn turn_alone(&mut self, block: &Block) {
        if self.no_place_by_axes(block) {
            self.state.forget();
        }
    }

    /// True if the positions of a block are not those of the tool tip in the part; a cut is refused there.
    pub(crate) fn no_place_by_axes(&mut self, block: &Block) -> bool {
        let tip = self.state.oriented;
        if self.state.code != Code::Rapid {
            if let Some((reason, remedy)) = self.state.standing.no_cut(tip, &TIP) {
                self.fault(&block.span.clone(), reason, &remedy);
            }
            return false;
        }
        self.state.standing.loses_place(tip)
    }

    /// Notes of the motion that follows how the axes stand, and how they get there.
    pub(crate) fn note_axes(&mut self, span: &Range<usize>) {
        let index = self.out.motions.len();
        let state = &self.state;
        if state.even_axes.unwrap_or(state.machine_orientation) {
            self.out.rotary.even.insert(index);
        }
        let Some(stated) = state.standing.of_motion(state.oriented) else {
            return;
        };
        let open = state.even_axes.is_none() && !state.machine_orientation;
        let turns = |stated: &AxesStated| matches!(stated, AxesStated::Angles { start, end } if start != end);
        if open && !state.law_remarked && state.code != Code::Rapid && turns(&stated) {
            self.state.law_remarked = true;
            self.finding(
                span,
                "how the rotary axes turn between their angles is not stated, here first: the tool's axis is taken to go on the great circle (ORIVECT, the basic setting of G group 51). Where the machine turns each axis evenly, write ORIAXES"
                    .to_owned(),
            );
        }
        self.out.rotary.motions.insert(index, stated);
    }
}

//! Rotary axes whose words are followed, and tool centre point control: M128 and FUNCTION TCPM.

use std::ops::Range;

use crate::heidenhain::path_words::{FeedWord, PathWords};
use crate::heidenhain::reading::walker::Reader;
use crate::heidenhain::tip_control::TipControl;
use crate::heidenhain::words::Word;
use crate::turned_axis::{AxisTurn, TipWords, Turning};

const TIP: TipWords = TipWords {
    control: "M128",
    rapid: "L ",
    zero: "+0 FMAX",
    step: |letter, by| format!("I{letter}{by:+}"),
    shorter: |letter, to| format!("M126 in the block, with {letter}{to:+}, for the shorter way"),
};

impl Reader<'_> {
    /// FUNCTION TCPM and FUNCTION RESET TCPM.
    pub(crate) fn tip_function(&mut self, words: &[Word]) {
        let has = |name: &str| words.iter().any(|word| word.is(name));
        if !has("TCPM") {
            return;
        }
        self.state.tip = match has("RESET") {
            true => TipControl::default(),
            false => TipControl {
                on: true,
                spatial: has("SPAT"),
                by_vector: has("VECTOR"),
            },
        };
    }

    /// Functions that act on rotary axes at the beginning of a block, or at its end.
    pub(crate) fn axis_function(&mut self, number: u32) {
        match number {
            128 => {
                self.state.tip = TipControl {
                    on: true,
                    ..TipControl::default()
                }
            }
            129 => self.state.tip = TipControl::default(),
            126 => self.state.shorter = true,
            127 => self.state.shorter = false,
            _ => {}
        }
    }

    /// Turns the axes as the words of a block say, to places of the machine with M91; whether there are words of followed axes.
    pub(crate) fn turn_axes(
        &mut self,
        words: &[Word],
        parsed: &PathWords,
        span: &Range<usize>,
        machine: bool,
    ) -> bool {
        self.state.standing.begin_block();
        let mut turns = false;
        let turning = Turning {
            words: &TIP,
            rapid: parsed.feed == FeedWord::Max,
        };
        if !parsed.rotary.is_empty() {
            self.turned_by_words(!self.options.rotary_axes.is_empty());
        }
        for word in &parsed.rotary {
            let at = &words[word.at].span;
            let Some(place) = self.state.standing.place_of_letter(word.letter) else {
                if word.value != 0.0 {
                    self.fault(
                        at,
                        format!(
                            "a rotary axis ({}) turns the part or the tool, and there is no model of it",
                            char::from(word.letter)
                        ),
                        "describe the rotary axes of the machine in the model ([[rotary_axis]]), or divide the program there",
                    );
                }
                continue;
            };
            turns = true;
            if machine {
                self.state.standing.send_axis(place);
                if self.state.tip.on {
                    self.state.lost();
                }
                continue;
            }
            let turn = match (word.step, self.state.shorter) {
                (true, _) => AxisTurn::By(word.value),
                (_, true) => AxisTurn::Shorter(word.value.rem_euclid(360.0)),
                (_, false) => AxisTurn::To(word.value),
            };
            if let Err((reason, remedy)) = self.state.standing.turn_axis(place, turn, turning) {
                self.fault(at, reason, &remedy);
            }
        }
        if turns && self.state.tip.on {
            self.state.axis = self.state.plane.across();
            self.turns_otherwise(words, parsed, span);
        }
        turns
    }

    /// Turns under tool centre point control that are not those of rotary axes, each evenly.
    fn turns_otherwise(&mut self, words: &[Word], parsed: &PathWords, span: &Range<usize>) {
        if self.state.tip.spatial {
            return self.fault(
                span,
                "A, B and C are angles in space here (AXIS SPAT), and not those of rotary axes",
                "let the CAM system write angles of the axes (AXIS POS), or LN blocks with TX, TY, TZ",
            );
        }
        if parsed.axis.iter().any(Option::is_some) {
            return self.fault(
                span,
                "angles and a direction of the tool stand in one block",
                "keep one of them",
            );
        }
        if !self.state.standing.is_turning() {
            return;
        }
        let straight = matches!(words[0].letters.letters(), b"L" | b"LN" | b"LP" | b"");
        if !straight {
            self.fault(
                span,
                "a rotary axis turns on an arc",
                "let the CAM system write L blocks there",
            );
        } else if self.state.tip.by_vector && parsed.feed != FeedWord::Max {
            self.fault(
                span,
                "the tool's axis stays in a plane here (PATHCTRL VECTOR), so that its axes do not turn evenly",
                "write PATHCTRL AXIS, or M128",
            );
        }
    }

    /// A block that turns axes alone, without tool centre point control.
    pub(crate) fn turn_alone(&mut self, span: &Range<usize>, rapid: bool) {
        if self.no_place_by_axes(span, rapid) {
            self.state.place = [None; 3];
            self.state.direction = None;
        }
    }

    /// True if the positions of a block are not those of the tool tip in the part; a cut is refused there.
    pub(crate) fn no_place_by_axes(&mut self, span: &Range<usize>, rapid: bool) -> bool {
        let tip = self.state.tip.on;
        if !rapid {
            if let Some((reason, remedy)) = self.state.standing.no_cut(tip, &TIP) {
                self.fault(span, reason, &remedy);
            }
            return false;
        }
        self.state.standing.loses_place(tip)
    }
}

//! Rotary axes whose words are followed (A, B, C of the machine's model), and axes beside X, Y and Z that may stand and not move.

use std::ops::Range;

use crate::model::program::AxesStated;
use crate::siemens::block::{Block, How, Item};
use crate::siemens::expression::Expression;
use crate::siemens::state::{Code, Coordinate};
use crate::siemens::walker::{PlainTurn, Reader};
use crate::siemens::words::{Purpose, Words, coordinate_of};
use crate::text::source::Finding;
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

// Angles of modulo axes without AC or DC, which a setting of the machine takes one way or the other.
//
// Source: Siemens, SINUMERIK 840D sl, machine data lists, MD30455 $MA_MISC_FUNCTION_MASK: with bit 2 a modulo rotary axis that is programmed
// under G90 goes to its angle as with DC; without it, as with AC.

/// Limit of the other lines that a finding names.
const MOST_NAMED: usize = 20;

impl Reader<'_> {
    /// Notes a word that turns an axis in a cut, where it matters what the machine takes it for.
    pub(crate) fn note_plain_turn(&mut self, place: usize, word: &Coordinate, to: f64) {
        let letter = self.options.rotary_axes.get(place).copied();
        let readings = self.state.standing.readings_of(place, to);
        if let (Some(letter), Some(readings)) = (letter, readings) {
            let line = self.file.line_of(word.whole.start);
            self.out.plain_turns.push(PlainTurn {
                line,
                letter,
                to,
                readings,
            });
        }
    }
}

/// Finding on the plain turns of a file, at the first of them.
pub(crate) fn finding_of(file: usize, turns: &[PlainTurn]) -> Option<Finding> {
    let (first, others) = turns.split_first()?;
    let PlainTurn { letter, to, .. } = first;
    let [on, shorter] = (first.readings).map(|angle| (angle * 1e5).round() / 1e5);
    let mut lines: Vec<usize> = others.iter().map(|turn| turn.line).collect();
    lines.retain(|line| *line != first.line);
    lines.dedup();
    let named = lines.iter().take(MOST_NAMED).map(usize::to_string);
    let named = named.collect::<Vec<_>>().join(", ");
    let further = match lines.len() {
        0 => String::new(),
        1 => format!("; so in line {named}"),
        count @ ..=MOST_NAMED => format!("; so in {count} further lines: {named}"),
        count => format!("; so in {count} further lines: {named} ..."),
    };
    Some(Finding {
        file,
        line: first.line,
        message: format!(
            "axis {letter} is sent to {to} deg by a word without AC or DC, and how far it turns is a setting of the machine: it is taken as AC here, the basic setting, and turns by {on} deg; where bit 2 of MD30455 makes it DC, it turns by {shorter} deg. Write {letter}=AC({to}) or {letter}=DC({to}){further}"
        ),
    })
}

// Axes beside X, Y and Z: they may stand, and not move; those that turn stand at zero alone.

/// Letters of axes beside X, Y and Z.
pub(crate) const OTHER_AXES: &[u8] = b"ABCUVWQE";

impl Reader<'_> {
    /// An axis beside X, Y, Z: it may stand, and not move.
    pub(crate) fn other_axis(
        &mut self,
        name: &str,
        item: &Item,
        value: f64,
        how: How,
        purpose: Purpose,
    ) {
        let steps = how == How::Step || how == How::Modal && self.state.steps;
        let code = self.state.code;
        let turns = matches!(name, "A" | "B" | "C");
        let axis = self
            .state
            .others
            .entry(name.as_bytes().to_vec())
            .or_default();
        match (purpose, axis.at) {
            (Purpose::Machine, _) => axis.elsewhere = true,
            (_, _) if steps && value == 0.0 => {}
            // From wherever it stands, beside a motion of the tool; and turned, whether by a rapid or not.
            (Purpose::Motion, None) if !steps && value != 0.0 && (turns || code != Code::Rapid) => {
                axis.at = Some(value);
                self.moves_aside(name, item);
            }
            (_, None) if !steps => {
                axis.at = Some(value);
                axis.elsewhere = false;
                if value != 0.0 {
                    self.finding(
                        &item.span,
                        format!("{name} stands at {value}: the part is taken to lie as the frame in force says then"),
                    );
                }
            }
            (_, Some(at)) if !steps && at == value => axis.elsewhere = false,
            _ => {
                // All that follows stands there.
                axis.at = (!steps).then_some(value);
                axis.elsewhere = false;
                self.moves_aside(name, item);
            }
        }
    }

    fn moves_aside(&mut self, name: &str, item: &Item) {
        self.fault(
            &item.span,
            format!("the axis {name} moves: where the tool stands on the part then, needs the kinematics of the machine"),
            "give the parts of the program between such motions one by one, or describe the axis in the model ([[rotary_axis]]), if it is one of A, B, C that turns",
        );
    }
}

//! What blocks state for those behind them: the unit, the tool, the pole.

use std::ops::Range;

use nalgebra::Vector2;

use crate::heidenhain::datum::axis_of;
use crate::heidenhain::reading::walker::{BY_PARAMETER, EXPAND, Reader};
use crate::heidenhain::state::Pole;
use crate::heidenhain::words::{Value, Word};

impl Reader<'_> {
    pub(crate) fn begin(&mut self, words: &[Word], span: &Range<usize>) {
        let unit =
            words
                .iter()
                .skip(1)
                .rev()
                .find_map(|word| match (word.is("MM"), word.is("INCH")) {
                    (true, _) => Some(1.0),
                    (_, true) => Some(25.4),
                    _ => None,
                });
        // The name may be glued to the unit's word or missing: MM is the control's own.
        self.unit_mm = unit.unwrap_or(1.0);
        if self.unit_mm != 1.0 {
            self.finding(
                span,
                "lengths are in inches, and F is taken as tenths of an inch in a minute".to_owned(),
            );
        } else if unit.is_none() {
            self.finding(span, "no unit is stated: taken as mm".to_owned());
        }
    }

    pub(crate) fn tool(&mut self, words: &[Word], span: &Range<usize>) {
        self.not_below_zero(&words[1..], &["CALL", "DEF"], "the number of the tool");
        self.not_below_zero(&words[1..], &["S"], "the speed of the spindle");
        let Some(call) = words.get(1).filter(|word| word.is("CALL")) else {
            // TOOL DEF.
            return;
        };
        if words[1..]
            .iter()
            .any(|word| matches!(word.value, Value::Parameter { .. }))
        {
            return self.fault(span, BY_PARAMETER, EXPAND);
        }
        let side = |word: &&Word| (word.is("X") || word.is("Y")) && word.value == Value::None;
        if let Some(side) = words[2..].iter().find(side) {
            return self.fault(
                &side.span.clone(),
                "the tool's axis is not Z",
                "let the CAM system write the program with the tool's axis Z",
            );
        }
        if let Some(feed) = words.iter().find(|word| word.is("F")).and_then(Word::value) {
            self.state.tool_feed = Some(feed);
            self.state.feed = Some(feed);
            self.state.feed_text = format!("F{feed}");
        }
        if let Some(speed) = words.iter().find(|word| word.is("S")).and_then(Word::value) {
            self.state.turns_per_minute = Some(speed).filter(|speed| *speed > 0.0);
        }
        // Without a number the tool stays, and may become longer all the same.
        let name = match &call.value {
            Value::Number(number) => format!("TOOL:{}", number.value),
            Value::Text(text) => {
                format!("TOOL:{}", String::from_utf8_lossy(self.file.part(text)))
            }
            _ => self.state.tool.clone(),
        };
        let longer = words[2..].iter().any(|word| word.is("DL") || word.is("DR"));
        if name != self.state.tool || longer {
            self.state.tool = name;
            self.state.lost();
        }
    }

    /// Refuses words of these names, or all, with numbers below zero.
    pub(crate) fn not_below_zero(&mut self, words: &[Word], names: &[&str], what: &str) {
        let named = |word: &&Word| names.is_empty() || names.iter().any(|name| word.is(name));
        let below = |word: &&Word| word.value().is_some_and(|value| value < 0.0);
        if let Some(word) = words.iter().filter(named).find(below) {
            let reason = format!("{what} is below zero");
            self.fault(&word.span.clone(), reason, "mend the number");
        }
    }

    pub(crate) fn pole(&mut self, words: &[Word], span: &Range<usize>) {
        let mut at = self.state.pole.map(|pole| pole.at);
        let here = self.state.in_plane();
        let mut relative = words.len() == 1;
        if relative {
            at = here;
        }
        let mut stated = [None; 2];
        for word in &words[1..] {
            let value = match (axis_of(word), &word.value) {
                (Some((axis @ 0..=1, step)), Value::Number(number)) => {
                    relative |= step;
                    let from = match step {
                        true => here.map(|here| here[axis]),
                        false => Some(0.0),
                    };
                    Some((axis, from.map(|from| from + number.value * self.unit_mm)))
                }
                (_, Value::Parameter { .. }) => {
                    self.state.pole = None;
                    return self.fault(span, BY_PARAMETER, EXPAND);
                }
                _ => None,
            };
            match value {
                Some((axis, value)) => stated[axis] = value,
                None => {
                    self.state.pole = None;
                    return self.fault(
                        span,
                        "the pole is not stated by X and Y",
                        "circles in other planes are not followed: let the CAM system write L blocks",
                    );
                }
            }
        }
        self.poles[0] += 1;
        if words.len() == 1 || stated.iter().all(Option::is_some) {
            self.poles[1] = self.poles[0];
        }
        let x = stated[0].or(at.map(|at| at.x));
        let y = stated[1].or(at.map(|at| at.y));
        self.state.radius_mm = None;
        self.pole_from = self.state.last.filter(|_| relative);
        self.state.pole = match (x, y) {
            (Some(x), Some(y)) => Some(Pole {
                at: Vector2::new(x, y),
                relative,
            }),
            _ => None,
        };
    }
}

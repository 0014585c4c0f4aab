//! Modal settings: the unit, the tool, the pole.

use std::ops::Range;

use nalgebra::Vector2;

use crate::heidenhain::arcs::Plane;
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
            return self.tool_definition(words);
        };
        if words[1..]
            .iter()
            .any(|word| matches!(word.value, Value::Parameter { .. }))
        {
            return self.fault(span, BY_PARAMETER, EXPAND);
        }
        let side =
            |word: &&Word| word.value == Value::None && matches!(axis_of(word), Some((_, false)));
        let side = words[2..].iter().find(side).and_then(axis_of);
        if let Some((axis, _)) = side.filter(|(axis, _)| *axis != self.state.plane.0) {
            self.state.plane = Plane(axis);
            self.state.axis = self.state.plane.across();
            self.state.lost();
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
        let name = self.tool_name(call);
        let longer = words[2..].iter().any(|word| word.is("DL") || word.is("DR"));
        let own = self.state.cutters_mm.get(&name);
        let own = own.map(|radius| radius + larger_by(words) * self.unit_mm);
        self.state.cutter_mm = own.filter(|radius| *radius > 0.0);
        if name != self.state.tool || longer {
            self.state.tool = name;
            self.state.lost();
        }
    }

    /// The tool that a word names; that in force where it names none.
    fn tool_name(&self, word: &Word) -> String {
        match &word.value {
            Value::Number(number) => format!("TOOL:{}", number.value),
            Value::Text(text) => {
                format!("TOOL:{}", String::from_utf8_lossy(self.file.part(text)))
            }
            _ => self.state.tool.clone(),
        }
    }

    /// TOOL DEF: the radius of a tool.
    fn tool_definition(&mut self, words: &[Word]) {
        let Some(tool) = words
            .get(1)
            .filter(|word| word.is("DEF") && word.value != Value::None)
        else {
            return;
        };
        let name = self.tool_name(tool);
        let radius = words.iter().find(|word| word.is("R")).and_then(Word::value);
        match radius.filter(|radius| *radius > 0.0) {
            Some(radius) => self.state.cutters_mm.insert(name, radius * self.unit_mm),
            None => self.state.cutters_mm.remove(&name),
        };
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
        let here = self.state.counts_from();
        let before = self.state.pole;
        let mut relative = words.len() == 1;
        let mut stated = [None; 3];
        for word in &words[1..] {
            let value = match (axis_of(word), &word.value) {
                (Some((axis, step)), Value::Number(number)) => {
                    relative |= step;
                    let from = match step {
                        true => here[axis],
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
            match value.filter(|(axis, _)| stated[*axis].is_none()) {
                Some((axis, value)) => stated[axis] = Some(value),
                None => {
                    self.state.pole = None;
                    return self.fault(
                        span,
                        "the pole is not stated by two of X, Y and Z",
                        "state the two axes of the circle: CC X+0 Y+0",
                    );
                }
            }
        }
        let count = stated.iter().flatten().count();
        // Two axes say the plane; where one is stated or none, it is the working plane.
        let plane = match stated.iter().position(Option::is_none) {
            Some(across) if count == 2 => Plane(across),
            _ => self.state.plane,
        };
        if count == 3 || stated[plane.0].is_some() {
            self.state.pole = None;
            return self.fault(
                span,
                "the pole is stated by other axes than two of a plane",
                "state the two axes of the circle: CC X+0 Y+0",
            );
        }
        self.poles[0] += 1;
        if count != 1 {
            self.poles[1] = self.poles[0];
        }
        // The word that is missing is that of before.
        let kept = before.filter(|pole| pole.plane == plane && count == 1);
        let kept = kept.map(|pole| [pole.at.x, pole.at.y]);
        let [u, v] = [0, 1].map(|at| match (stated[plane.axes()[at]], count) {
            (Some(value), _) => value,
            (None, 0) => here[plane.axes()[at]],
            (None, _) => kept.map(|kept| kept[at]),
        });
        self.state.radius_mm = None;
        self.pole_from = self.state.last.filter(|_| relative);
        self.state.pole = u.zip(v).map(|(u, v)| Pole {
            plane,
            at: Vector2::new(u, v),
            relative,
        });
    }
}

/// DR of TOOL CALL: by how much the radius is larger. Its sign is a word of its own, as that of a turn.
fn larger_by(words: &[Word]) -> f64 {
    let Some(at) = words.iter().position(|word| word.is("DR")) else {
        return 0.0;
    };
    let behind = words
        .get(at + 1)
        .filter(|word| word.letters.letters().is_empty());
    match words[at].value {
        Value::Sign(sign) => sign * behind.and_then(Word::value).unwrap_or(f64::NAN),
        _ => words[at].value().unwrap_or(f64::NAN),
    }
}

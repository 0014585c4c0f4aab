//! Modal settings: the unit, the tool, the pole, cycles that act where they are defined, and what moves the coordinates.

use std::ops::Range;

use nalgebra::Vector2;

use crate::heidenhain::arcs::{Plane, XY};
use crate::heidenhain::blocks::{Block, STRAY, STRAY_REMEDY};
use crate::heidenhain::datum::{Bend, Change, KEPT, PARAMETER, axis_of, change};
use crate::heidenhain::reading::walker::{
    BUILDERS, BY_PARAMETER, EXPAND, Reader, TILTED, TILTED_REMEDY,
};
use crate::heidenhain::state::Pole;
use crate::heidenhain::words::{Value, Word};
use crate::model::parsed::stays_as_written;

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

/// Cycles that do nothing before they are called: drilling, pockets, studs, slots, contours, threads, gears.
fn acts_where_called(cycle: u32) -> bool {
    matches!(
        cycle,
        1..=6
            | 15..=18
            | 21..=25
            | 27..=29
            | 39
            | 200..=219
            | 225
            | 230..=233
            | 240
            | 241
            | 251..=258
            | 262..=267
            | 272..=278
            | 286
            | 287
            | 291
            | 292
    )
}

impl Reader<'_> {
    pub(crate) fn cycle(&mut self, block: &Block, words: &[Word], span: &Range<usize>) {
        let Some(kind) = words.get(1) else {
            return self.fault(span, "the cycle has no number", "state it");
        };
        if kind.is("CALL") {
            let place = self.state.counts_from();
            let kept = self.state.cycle.filter(|cycle| KEPT.contains(cycle));
            return match kept {
                Some(cycle) if words.len() == 2 && self.is_over_a_hole(place) => {
                    self.kept_cycle(cycle, span);
                }
                _ => self.called(block, words, span, place),
            };
        }
        if kind.is("END") {
            return;
        }
        let number = kind.number().filter(|_| kind.is("DEF"));
        let Some(number) = number else {
            return self.fault(span, "the cycle has no number", "state it");
        };
        let text = String::from_utf8_lossy(self.file.part(&number.span)).into_owned();
        let mut parts = text.splitn(2, ['.', ',']);
        let mut part = || parts.next().and_then(|text| text.parse::<u32>().ok());
        let (cycle, part) = (part().unwrap_or(0), part().unwrap_or(0));
        if let Some(stray) = block.no_parameter(self.file.bytes()) {
            return self.fault(&stray, STRAY, STRAY_REMEDY);
        }
        if acts_where_called(cycle) {
            self.state.cycle = Some(cycle);
        }
        match (cycle, part) {
            (9, 1..) => self.not_below_zero(&words[2..], &[], "the dwell"),
            (7 | 8 | 10 | 11, _) => {
                let change = change(cycle, part, &words[2..], self.unit_mm);
                self.coordinates(change, span);
            }
            (19, 1..) => {
                let tilts = |word: &Word| match word.value {
                    Value::Parameter { .. } => true,
                    _ => word.value().unwrap_or(0.0) != 0.0,
                };
                if words[2..].iter().any(tilts) {
                    self.fault(span, TILTED, TILTED_REMEDY);
                }
            }
            (247, _) => {
                let named = words.iter().skip(2).filter_map(Word::value).next_back();
                self.state.preset = match named {
                    Some(number) => format!("PRESET:{number}"),
                    None => "PRESET".to_owned(),
                };
                self.state.lost();
            }
            // Orientation of the spindle, contours and their data, tolerance, data of a gear.
            (9 | 13 | 14 | 19 | 20 | 30 | 32 | 270 | 271 | 285, _) => {}
            _ if acts_where_called(cycle) => {}
            (12 | 26 | 220 | 221 | 224 | 235 | 238 | 239 | 400..=499 | 800 | 801, _) => self.fault(
                span,
                "the cycle moves the tool or the coordinates where it is defined",
                "take it into a program of its own",
            ),
            // HEIDENHAIN, TNC 640, user's manual, cycles, "Machine-specific cycles": 300 to 399.
            (300..=399, _) => self.remark(span, &format!("cycle {cycle}"), BUILDERS),
            _ => self.fault(
                span,
                "what the cycle does where it is defined is not known",
                "take it into a program of its own",
            ),
        }
    }

    /// True if the tool stands at a known place of the working plane, which is not tilted.
    fn is_over_a_hole(&self, place: [Option<f64>; 3]) -> bool {
        let along = self.state.plane.0;
        let tilted = matches!(self.state.datum.bend, Bend::Tilt(_));
        !tilted && (0..3).all(|axis| axis == along || place[axis].is_some())
    }

    /// A cycle whose way is the control's own: it begins over the hole and ends above it.
    fn kept_cycle(&mut self, cycle: u32, span: &Range<usize>) {
        self.state.place[self.state.plane.0] = None;
        self.state.last = None;
        let line = self.file.line_of(span.start);
        self.found.unjudged_feed_on.get_or_insert(line);
        self.finding(span, stays_as_written(&format!("cycle {cycle}")));
    }

    /// A datum shift, mirror image, rotation or scaling.
    fn coordinates(&mut self, change: Change, span: &Range<usize>) {
        let state = &mut self.state;
        match change {
            Change::Kept => {}
            Change::Shift(shifts) => {
                let now = state.datum.shift_mm;
                let target = |(axis, value, adds): (usize, f64, bool)| match adds {
                    true => (axis, now[axis] + value),
                    false => (axis, value),
                };
                let shifts: Vec<(usize, f64)> = shifts.into_iter().map(target).collect();
                let differs = shifts.iter().any(|(axis, to)| now[*axis] != *to);
                if matches!(state.datum.bend, Bend::Tilt(_)) {
                    // The axes in which it counts there are unknown: it must be stated again.
                    for (axis, to) in shifts {
                        state.tilt.shifted[axis] |= to != 0.0 || now[axis] != 0.0;
                    }
                    return;
                }
                let bent = state.datum.bend != Bend::None;
                if bent && differs {
                    return self.fault(
                        span,
                        "the datum moves while the coordinates are mirrored, turned or scaled",
                        "shift the datum before, or let the CAM system write the places as they are",
                    );
                }
                for (axis, to) in shifts {
                    state.shift(axis, to);
                    state.tilt.shifted[axis] = false;
                }
            }
            // The plane stays.
            Change::Bend(Bend::None) if matches!(state.datum.bend, Bend::Tilt(_)) => {}
            Change::Bend(Bend::Rotation(_)) if state.plane != XY => self.fault(
                span,
                "the coordinates are turned about the tool's axis, which is not Z",
                "let the CAM system write the places as they are",
            ),
            Change::Bend(bend) => {
                let other =
                    std::mem::discriminant(&bend) != std::mem::discriminant(&state.datum.bend);
                if other && bend != Bend::None && state.datum.bend != Bend::None {
                    return self.fault(
                        span,
                        "a second of mirror image, rotation and scaling acts beside the first",
                        "reset the first before, or let the CAM system write the places as they are",
                    );
                }
                state.bend(bend);
            }
            Change::Refused(PARAMETER) => self.fault(
                span,
                PARAMETER,
                "write the program flat first (--expand), or the values as numbers",
            ),
            Change::Refused(reason) => self.fault(
                span,
                reason,
                "state datum shift, mirror image (X, Y, Z), rotation (ROT) or scaling (SCL) by numbers of their own, or let the CAM system write the places as they are",
            ),
        }
    }

    pub(crate) fn trans(&mut self, words: &[Word], span: &Range<usize>) {
        let is = |at: usize, name: &str| words.get(at).is_some_and(|word| word.is(name));
        let shifts = match (is(1, "DATUM"), is(2, "AXIS"), is(2, "RESET")) {
            (true, true, _) => change(7, 1, &words[3..], self.unit_mm),
            (true, _, true) => Change::Shift((0..3).map(|axis| (axis, 0.0, false)).collect()),
            _ => Change::Refused("how it moves the coordinates is not followed"),
        };
        match shifts {
            Change::Shift(shifts) if self.state.datum.keeps_axes() => {
                for (axis, to, adds) in shifts {
                    let from = match adds {
                        true => self.state.datum.shift_mm[axis],
                        false => 0.0,
                    };
                    self.state.shift(axis, from + to);
                }
            }
            Change::Refused(reason) => {
                self.fault(span, reason, "use TRANS DATUM AXIS with numbers")
            }
            _ => self.fault(
                span,
                "the datum moves while the coordinates are turned",
                "shift it before",
            ),
        }
    }
}

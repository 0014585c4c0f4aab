//! Cycles that act where they are defined, and what moves the coordinates.

use std::ops::Range;

use crate::heidenhain::arcs::XY;
use crate::heidenhain::blocks::{Block, STRAY, STRAY_REMEDY};
use crate::heidenhain::datum::{Bend, Change, KEPT, PARAMETER, change};
use crate::heidenhain::reading::walker::{BUILDERS, Reader, TILTED, TILTED_REMEDY};
use crate::heidenhain::words::{Value, Word};
use crate::model::parsed::stays_as_written;

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

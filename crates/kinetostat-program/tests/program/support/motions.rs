//! Straight motions, and those to places of the machine.

use nalgebra::Vector3;

use super::generator::Generator;
use super::truth::Truth;
use super::{LENGTHS, MACHINE_ZERO, REFERENCES};

impl Generator<'_> {
    /// A block to places of the machine, which the text does not say.
    fn go_to_machine(&mut self, words: &[String], places: [Option<f64>; 3]) {
        let (start, before) = (self.place, self.known);
        for axis in 0..3 {
            if let Some(place) = places[axis] {
                let length = if axis == 2 { LENGTHS[self.tool] } else { 0.0 };
                self.place[axis] = MACHINE_ZERO[axis] + place - length;
                self.known[axis] = self.machine_is_known && !(axis == 2 && self.tool > 0);
            }
        }
        self.truths.push(Truth::Straight {
            start,
            end: self.place,
        });
        self.fact(before, places.map(|place| place.is_some()), true);
        self.push(words);
    }

    /// G28 and G30.
    pub(super) fn reference(&mut self, second: bool, by: [Option<f64>; 3]) {
        let mut words = vec![if second { "G30" } else { "G28" }.to_owned()];
        for axis in 0..3 {
            if let Some(place) = by[axis] {
                words.push(self.coordinate(axis, place).0);
            }
        }
        let all = by.iter().all(Option::is_none);
        let point = REFERENCES[usize::from(second)];
        let places = [0, 1, 2].map(|axis| (all || by[axis].is_some()).then_some(point[axis]));
        self.go_to_machine(&words, places);
    }

    /// G53.
    pub(super) fn machine(&mut self, to: [Option<f64>; 3]) {
        if self.incremental || to.iter().all(Option::is_none) {
            return;
        }
        let mut words = vec!["G53".to_owned()];
        self.motion_word(0, &mut words);
        let mut places = [None; 3];
        for axis in 0..3 {
            if let Some(place) = to[axis] {
                let (text, value) = self.number(place / self.scale());
                words.push(format!("{}{text}", ["X", "Y", "Z"][axis]));
                places[axis] = Some(value * self.scale());
            }
        }
        self.go_to_machine(&words, places);
    }

    /// G43 and G49.
    pub(super) fn length(&mut self, tool: usize, height: Option<f64>) {
        let mut words = vec![match tool {
            0 => "G49".to_owned(),
            tool => format!("G43 H{tool}"),
        }];
        // G49 where none is in force, and the same length once more, change nothing.
        self.known[2] &= tool == self.tool;
        self.place[2] += LENGTHS[self.tool] - LENGTHS[tool];
        self.tool = tool;
        if let Some(height) = height.filter(|_| !self.incremental) {
            let (start, before) = (self.place, self.known);
            self.motion_word(0, &mut words);
            let (word, reached) = self.coordinate(2, height);
            words.push(word);
            self.place[2] = reached;
            self.known[2] = true;
            self.truths.push(Truth::Straight {
                start,
                end: self.place,
            });
            self.fact(before, [false, false, true], false);
        }
        self.push(&words);
    }

    /// G0 and G1.
    pub(super) fn straight(
        &mut self,
        (feed, to): (bool, [Option<f64>; 3]),
        speed: Option<f64>,
        extruded: Option<f64>,
        pause: bool,
    ) {
        if to.iter().all(Option::is_none) {
            return;
        }
        let mut words = Vec::new();
        let feed = feed && !self.is_lost();
        self.motion_word(u8::from(feed), &mut words);
        let (start, before) = (self.place, self.known);
        let mut end = start;
        for axis in 0..3 {
            if let Some(place) = to[axis] {
                let (word, reached) = self.coordinate(axis, place);
                words.push(word);
                end[axis] = reached;
                self.known[axis] |= !self.incremental;
            }
        }
        if let Some(length) = extruded.filter(|_| feed) {
            let (text, value) = self.number(if self.relative_extruder {
                length
            } else {
                self.extruder + length
            });
            // A blank, or `X1.0000E5` might be an exponent.
            words.push(format!(" E{text}"));
            self.extruder = if self.relative_extruder {
                self.extruder + value
            } else {
                value
            };
        }
        let length = (Vector3::from(end) - Vector3::from(start)).norm();
        if feed {
            self.speed_word(speed, length, &mut words);
        }
        if pause {
            words.push("M0".to_owned());
        }
        self.place = end;
        self.truths.push(Truth::Straight { start, end });
        self.fact(before, to.map(|place| place.is_some()), false);
        self.push(&words);
    }
}

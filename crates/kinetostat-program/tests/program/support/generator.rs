//! Writes operations down, and follows the machine that will run them.

use super::operations::{Op, Style};
use super::truth::{Fact, Generated, Truth};
use super::{START, WORK};

pub struct Generator<'s> {
    pub(super) style: &'s Style,
    pub(super) lines: Vec<String>,
    pub(super) truths: Vec<Truth>,
    pub(super) facts: Vec<Fact>,
    pub(super) known: [bool; 3],
    /// The options of the reader state where the places of the machine are.
    pub(super) machine_is_known: bool,
    pub(super) tool: usize,
    pub(super) place: [f64; 3],
    pub(super) here: [f64; 3],
    pub(super) work: usize,
    pub(super) incremental: bool,
    pub(super) absolute_centre: bool,
    pub(super) plane: usize,
    pub(super) inches: bool,
    pub(super) inverse_time: bool,
    pub(super) speed_known: bool,
    pub(super) relative_extruder: bool,
    pub(super) extruder: f64,
    pub(super) motion: Option<u8>,
}

pub fn generate(ops: &[Op], style: &Style, machine_is_known: bool) -> Generated {
    let mut generator = Generator {
        style,
        lines: Vec::new(),
        truths: Vec::new(),
        facts: Vec::new(),
        known: [true; 3],
        machine_is_known,
        tool: 0,
        place: START,
        here: [0.0; 3],
        work: 0,
        incremental: false,
        absolute_centre: false,
        plane: 0,
        inches: false,
        inverse_time: false,
        speed_known: false,
        relative_extruder: false,
        extruder: 0.0,
        motion: None,
    };
    if style.tape {
        generator.lines.push("%".to_owned());
        generator.lines.push("O1234 (program)".to_owned());
    }
    generator.lines.push("G21 G90 G17 (begin)".to_owned());
    generator.lines.push("M82".to_owned());
    generator.lines.push("G92 E0".to_owned());
    for op in ops {
        generator.run(op);
    }
    let mut text = if style.byte_order_mark {
        "\u{feff}".to_owned()
    } else {
        String::new()
    };
    let count = generator.lines.len();
    for (index, line) in generator.lines.iter().enumerate() {
        text.push_str(line);
        if index + 1 < count || style.final_ending {
            text.push_str(style.endings[index % style.endings.len()]);
        }
    }
    Generated {
        text,
        truths: generator.truths,
        facts: generator.facts,
    }
}

impl Generator<'_> {
    pub(super) fn scale(&self) -> f64 {
        if self.inches { 25.4 } else { 1.0 }
    }

    /// A number as printed, and what it reads as.
    pub(super) fn number(&self, value: f64) -> (String, f64) {
        let text = if self.inches {
            format!("{value:.5}")
        } else {
            format!("{value:.4}")
        };
        let value = text.parse().unwrap();
        (text, value)
    }

    pub(super) fn push(&mut self, words: &[String]) {
        let mut line = if self.style.numbered {
            format!("N{} ", self.lines.len() * 10)
        } else {
            String::new()
        };
        line.push_str(&words.join(if self.style.spaced { " " } else { "" }));
        self.lines.push(if self.style.lower_case {
            line.to_lowercase()
        } else {
            line
        });
    }

    /// The word that brings an axis to a place, and the place reached.
    pub(super) fn coordinate(&self, axis: usize, place: f64) -> (String, f64) {
        let letter = ["X", "Y", "Z"][axis];
        let offset = WORK[self.work][axis] + self.here[axis];
        if self.incremental {
            let (text, value) = self.number((place - self.place[axis]) / self.scale());
            (
                format!("{letter}{text}"),
                self.place[axis] + value * self.scale(),
            )
        } else {
            let (text, value) = self.number((place - offset) / self.scale());
            (format!("{letter}{text}"), value * self.scale() + offset)
        }
    }

    pub(super) fn motion_word(&mut self, code: u8, words: &mut Vec<String>) {
        if self.style.repeat_modal || self.motion != Some(code) {
            words.push(format!("G{code}"));
        }
        self.motion = Some(code);
    }

    pub(super) fn speed_word(&mut self, speed: Option<f64>, length: f64, words: &mut Vec<String>) {
        if self.inverse_time {
            let speed = speed.unwrap_or(500.0);
            words.push(format!("F{:.4}", (speed / length.max(0.01)).max(0.001)));
        } else if speed.is_some() || !self.speed_known {
            self.speed_known = true;
            words.push(format!("F{:.1}", speed.unwrap_or(800.0) / self.scale()));
        }
    }

    pub(super) fn fact(&mut self, before: [bool; 3], named: [bool; 3], machine: bool) {
        self.facts.push(Fact {
            known: [before, self.known],
            named,
            machine,
        });
    }
}

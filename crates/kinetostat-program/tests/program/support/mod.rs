//! A generator of programs that knows where each of them goes, and a reader of programs that shares
//! no code with the crate. Both are deliberately plain.

use crate::sampled::WrittenArc;
use nalgebra::Vector3;
use proptest::prelude::*;

/// One step of the generator.
#[derive(Debug, Clone)]
pub enum Op {
    Straight {
        feed: bool,
        to: [Option<f64>; 3],
        speed: Option<f64>,
        extruded: Option<f64>,
        pause: bool,
    },
    Arc {
        clockwise: bool,
        radius: f64,
        angle: f64,
        sweep: f64,
        rise: Option<f64>,
        by_radius: bool,
        full: bool,
        speed: Option<f64>,
    },
    Incremental(bool),
    AbsoluteCentre(bool),
    Plane(usize),
    Inches(bool),
    InverseTime(bool),
    RelativeExtruder(bool),
    Work(usize),
    Here([Option<f64>; 3]),
    ForgetHere,
    Remark(usize),
    /// G28 or G30, with the point on the way.
    Reference {
        second: bool,
        by: [Option<f64>; 3],
    },
    /// G53.
    Machine([Option<f64>; 3]),
    /// G43 with a tool's length, or G49, perhaps beside a rapid that states the height.
    Length {
        tool: usize,
        height: Option<f64>,
    },
}

/// How the program is written down.
#[derive(Debug, Clone)]
pub struct Style {
    pub spaced: bool,
    pub lower_case: bool,
    pub numbered: bool,
    pub endings: Vec<&'static str>,
    pub tape: bool,
    pub byte_order_mark: bool,
    pub final_ending: bool,
    pub repeat_modal: bool,
}

pub fn op() -> impl Strategy<Value = Op> {
    let place = || prop::option::weighted(0.6, -150.0..150.0_f64);
    let speed = || prop::option::weighted(0.3, 60.0..3000.0_f64);
    prop_oneof![
        8 => (any::<bool>(), [place(), place(), place()], speed(), prop::option::weighted(0.3, 0.1..5.0_f64), prop::bool::weighted(0.1))
            .prop_map(|(feed, to, speed, extruded, pause)| Op::Straight { feed, to, speed, extruded, pause }),
        5 => (any::<bool>(), 0.3..60.0_f64, 0.0..std::f64::consts::TAU, 0.2..6.0_f64, prop::option::of(-10.0..10.0_f64), any::<bool>(), prop::bool::weighted(0.2), speed())
            .prop_map(|(clockwise, radius, angle, sweep, rise, by_radius, full, speed)| Op::Arc { clockwise, radius, angle, sweep, rise, by_radius, full, speed }),
        1 => any::<bool>().prop_map(Op::Incremental),
        1 => any::<bool>().prop_map(Op::AbsoluteCentre),
        1 => (0..3_usize).prop_map(Op::Plane),
        1 => any::<bool>().prop_map(Op::Inches),
        1 => any::<bool>().prop_map(Op::InverseTime),
        1 => any::<bool>().prop_map(Op::RelativeExtruder),
        1 => (0..2_usize).prop_map(Op::Work),
        1 => [place(), place(), place()].prop_map(Op::Here),
        1 => Just(Op::ForgetHere),
        2 => (0..REMARKS.len()).prop_map(Op::Remark),
        1 => (any::<bool>(), [place(), place(), place()]).prop_map(|(second, by)| Op::Reference { second, by }),
        1 => [place(), place(), place()].prop_map(Op::Machine),
        1 => (0..LENGTHS.len(), place()).prop_map(|(tool, height)| Op::Length { tool, height }),
    ]
}

pub fn style() -> impl Strategy<Value = Style> {
    let ending = prop_oneof![Just("\n"), Just("\r\n")];
    (any::<[bool; 7]>(), prop::collection::vec(ending, 1..4)).prop_map(|(flags, endings)| Style {
        spaced: flags[0],
        lower_case: flags[1],
        numbered: flags[2],
        endings,
        tape: flags[3],
        byte_order_mark: flags[4] && flags[3],
        final_ending: flags[5],
        repeat_modal: flags[6],
    })
}

pub const REMARKS: &[&str] = &[
    "",
    "   ",
    "(a comment; with X5 inside)",
    "; another (X9 Y9)",
    "M862.3 P \"MK3S\"",
    "M115 U3.10.1",
    "M117 Printing X5 now!",
    "T1 M6 (tool)",
    "S1000 M3 ;spindle",
    "G4 P0.5",
    "G64 P0.01",
    "M8",
    "F777",
];

/// Origins of G54 and G55 in mm.
pub const WORK: [[f64; 3]; 2] = [[0.0, 0.0, 0.0], [12.345, -7.5, 3.25]];
pub const START: [f64; 3] = [1.0, 2.0, 3.0];
/// The machine's zero in the part frame, its two reference points in machine coordinates, and the lengths of its
/// tools, in mm: what the reader may be told or not, and the machine knows.
pub const MACHINE_ZERO: [f64; 3] = [-210.5, 133.25, 310.0];
pub const REFERENCES: [[f64; 3]; 2] = [[12.5, -3.0, 7.75], [-40.0, 25.5, -1.5]];
pub const LENGTHS: [f64; 3] = [0.0, 61.25, 87.5];

/// A motion as the generator meant it.
#[derive(Debug, Clone)]
pub enum Truth {
    Straight {
        start: [f64; 3],
        end: [f64; 3],
    },
    Arc {
        axes: [usize; 3],
        centre: [f64; 2],
        start: [f64; 3],
        end: [f64; 3],
        sweep: f64,
    },
}

impl Truth {
    pub fn point(&self, share: f64) -> Vector3<f64> {
        match self {
            Truth::Straight { start, end } => {
                Vector3::from(*start).lerp(&Vector3::from(*end), share)
            }
            Truth::Arc {
                axes,
                centre,
                start,
                end,
                sweep,
            } => {
                let (du, dv) = (start[axes[0]] - centre[0], start[axes[1]] - centre[1]);
                let angle = dv.atan2(du) + sweep * share;
                let radius = du.hypot(dv);
                let mut point = Vector3::zeros();
                point[axes[0]] = centre[0] + radius * angle.cos();
                point[axes[1]] = centre[1] + radius * angle.sin();
                point[axes[2]] = start[axes[2]] + (end[axes[2]] - start[axes[2]]) * share;
                point
            }
        }
    }
}

/// A generated program.
#[derive(Debug)]
pub struct Generated {
    pub text: String,
    pub truths: Vec<Truth>,
    pub facts: Vec<Fact>,
}

/// What the text says about a motion.
#[derive(Debug, Clone, Copy)]
pub struct Fact {
    /// Axes whose place the text says, before and after.
    pub known: [[bool; 3]; 2],
    /// Axes that the block moves.
    pub named: [bool; 3],
    /// To a place of the machine.
    pub machine: bool,
}

struct Generator<'s> {
    style: &'s Style,
    lines: Vec<String>,
    truths: Vec<Truth>,
    facts: Vec<Fact>,
    known: [bool; 3],
    /// The reader is told the places of the machine.
    machine_is_known: bool,
    tool: usize,
    place: [f64; 3],
    here: [f64; 3],
    work: usize,
    incremental: bool,
    absolute_centre: bool,
    plane: usize,
    inches: bool,
    inverse_time: bool,
    speed_known: bool,
    relative_extruder: bool,
    extruder: f64,
    motion: Option<u8>,
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
    fn scale(&self) -> f64 {
        if self.inches { 25.4 } else { 1.0 }
    }

    /// A number as printed, and what it reads as.
    fn number(&self, value: f64) -> (String, f64) {
        let text = if self.inches {
            format!("{value:.5}")
        } else {
            format!("{value:.4}")
        };
        let value = text.parse().unwrap();
        (text, value)
    }

    fn push(&mut self, words: &[String]) {
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
    fn coordinate(&self, axis: usize, place: f64) -> (String, f64) {
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

    fn motion_word(&mut self, code: u8, words: &mut Vec<String>) {
        if self.style.repeat_modal || self.motion != Some(code) {
            words.push(format!("G{code}"));
        }
        self.motion = Some(code);
    }

    fn speed_word(&mut self, speed: Option<f64>, length: f64, words: &mut Vec<String>) {
        if self.inverse_time {
            let speed = speed.unwrap_or(500.0);
            words.push(format!("F{:.4}", (speed / length.max(0.01)).max(0.001)));
        } else if speed.is_some() || !self.speed_known {
            self.speed_known = true;
            words.push(format!("F{:.1}", speed.unwrap_or(800.0) / self.scale()));
        }
    }

    fn fact(&mut self, before: [bool; 3], named: [bool; 3], machine: bool) {
        self.facts.push(Fact {
            known: [before, self.known],
            named,
            machine,
        });
    }

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

    fn run(&mut self, op: &Op) {
        let lost = self.known != [true; 3];
        match op.clone() {
            Op::Reference { second, by } => {
                let mut words = vec![if second { "G30" } else { "G28" }.to_owned()];
                for axis in 0..3 {
                    if let Some(place) = by[axis] {
                        words.push(self.coordinate(axis, place).0);
                    }
                }
                let all = by.iter().all(Option::is_none);
                let point = REFERENCES[usize::from(second)];
                let places =
                    [0, 1, 2].map(|axis| (all || by[axis].is_some()).then_some(point[axis]));
                self.go_to_machine(&words, places);
            }
            Op::Machine(to) => {
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
            Op::Length { tool, height } => {
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
            Op::Arc { .. } if lost => {
                // States all axes again.
                let to = [Some(11.0), Some(-7.0), Some(5.0)];
                self.run(&Op::Straight {
                    feed: false,
                    to,
                    speed: None,
                    extruded: None,
                    pause: false,
                });
            }
            Op::Straight {
                feed,
                to,
                speed,
                extruded,
                pause,
            } => {
                if to.iter().all(Option::is_none) {
                    return;
                }
                let mut words = Vec::new();
                let feed = feed && !lost;
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
            Op::Arc {
                clockwise,
                radius,
                angle,
                sweep,
                rise,
                by_radius,
                full,
                speed,
            } => {
                self.arc(
                    clockwise, radius, angle, sweep, rise, by_radius, full, speed,
                );
            }
            Op::Incremental(on) => {
                self.incremental = on;
                self.push(&[if on { "G91" } else { "G90" }.to_owned()]);
                // Both kinds of firmware agree again.
                let word = if self.relative_extruder { "M83" } else { "M82" };
                self.push(&[word.to_owned()]);
            }
            Op::AbsoluteCentre(on) => {
                self.absolute_centre = on;
                self.push(&[if on { "G90.1" } else { "G91.1" }.to_owned()]);
            }
            Op::Plane(plane) => {
                self.plane = plane;
                self.push(&[format!("G{}", 17 + plane)]);
            }
            Op::Inches(on) => {
                if on != self.inches {
                    self.speed_known = false;
                    self.extruder *= if on { 1.0 / 25.4 } else { 25.4 };
                }
                self.inches = on;
                self.push(&[if on { "G20" } else { "G21" }.to_owned()]);
            }
            Op::InverseTime(on) => {
                if on != self.inverse_time {
                    self.speed_known = false;
                }
                self.inverse_time = on;
                self.push(&[if on { "G93" } else { "G94" }.to_owned()]);
            }
            Op::RelativeExtruder(on) => {
                self.relative_extruder = on;
                self.push(&[if on { "M83" } else { "M82" }.to_owned()]);
            }
            Op::Work(work) => {
                self.work = work;
                self.push(&[format!("G{}", 54 + work)]);
            }
            Op::Here(mut coordinates) => {
                for axis in (0..3).filter(|axis| !self.known[*axis]) {
                    coordinates[axis] = None;
                }
                if coordinates.iter().all(Option::is_none) {
                    return;
                }
                let mut words = vec!["G92".to_owned()];
                for axis in 0..3 {
                    if let Some(coordinate) = coordinates[axis] {
                        let (text, value) = self.number(coordinate / self.scale());
                        words.push(format!("{}{text}", ["X", "Y", "Z"][axis]));
                        self.here[axis] =
                            self.place[axis] - WORK[self.work][axis] - value * self.scale();
                    }
                }
                self.push(&words);
            }
            Op::ForgetHere => {
                self.here = [0.0; 3];
                self.push(&["G92.1".to_owned()]);
            }
            Op::Remark(index) => {
                if REMARKS[index] == "F777" {
                    if self.inverse_time {
                        return;
                    }
                    self.speed_known = true;
                }
                self.lines.push(REMARKS[index].to_owned());
            }
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn arc(
        &mut self,
        clockwise: bool,
        radius: f64,
        angle: f64,
        sweep: f64,
        rise: Option<f64>,
        by_radius: bool,
        full: bool,
        speed: Option<f64>,
    ) {
        let axes = [[0, 1, 2], [2, 0, 1], [1, 2, 0]][self.plane];
        let by_radius = by_radius && !full;
        // The centre of an arc by radius is ill defined near half and whole turns.
        let sweep = if by_radius && (2.6..3.7).contains(&sweep) {
            2.0
        } else {
            sweep.min(5.6)
        };
        let start = self.place;
        let mut words = Vec::new();
        self.motion_word(if clockwise { 2 } else { 3 }, &mut words);
        let mut centre = [
            start[axes[0]] - radius * angle.cos(),
            start[axes[1]] - radius * angle.sin(),
        ];
        let mut centre_words = Vec::new();
        for index in 0..2 {
            let axis = axes[index];
            let letter = ["I", "J", "K"][axis];
            let origin = if self.absolute_centre {
                WORK[self.work][axis] + self.here[axis]
            } else {
                start[axis]
            };
            let (text, value) = self.number((centre[index] - origin) / self.scale());
            centre_words.push(format!("{letter}{text}"));
            if !by_radius {
                centre[index] = origin + value * self.scale();
            }
        }
        let signed = if clockwise { -sweep } else { sweep };
        let turned = |index: usize| {
            let (du, dv) = (start[axes[0]] - centre[0], start[axes[1]] - centre[1]);
            let (sine, cosine) = signed.sin_cos();
            centre[index]
                + if index == 0 {
                    du * cosine - dv * sine
                } else {
                    du * sine + dv * cosine
                }
        };
        let mut end = start;
        if !full {
            for index in 0..2 {
                let (word, reached) = self.coordinate(axes[index], turned(index));
                words.push(word);
                end[axes[index]] = reached;
            }
        }
        if let Some(rise) = rise {
            let (word, reached) = self.coordinate(axes[2], start[axes[2]] + rise);
            words.push(word);
            end[axes[2]] = reached;
        }
        if by_radius {
            let (text, _) = self.number(radius / self.scale());
            let sign = if sweep > std::f64::consts::PI {
                "-"
            } else {
                ""
            };
            words.push(format!("R{sign}{text}"));
        } else {
            words.extend(centre_words);
        }
        let sweep = match (full, clockwise) {
            (true, true) => -std::f64::consts::TAU,
            (true, false) => std::f64::consts::TAU,
            (false, _) => signed,
        };
        self.speed_word(speed, radius * sweep.abs(), &mut words);
        self.place = end;
        self.fact([true; 3], [true; 3], false);
        self.truths.push(Truth::Arc {
            axes,
            centre,
            start,
            end,
            sweep,
        });
        self.push(&words);
    }
}

/// A motion as the plain reader sees it.
#[derive(Debug)]
pub struct Reached {
    pub place: Vector3<f64>,
    pub speed: Option<f64>,
    pub line: usize,
    pub arc: Option<WrittenArc>,
}

/// The centre from which both ends are a radius away, on the side that the sign and the way round say: seen along the chord,
/// a centre to the left is that of a short way counter-clockwise.
fn centre_by_radius(
    [from, to]: [Vector3<f64>; 2],
    plane: [usize; 3],
    clockwise: bool,
    radius: f64,
) -> [f64; 2] {
    let [first, second, _] = plane;
    let along = [to[first] - from[first], to[second] - from[second]];
    let chord = along[0].hypot(along[1]);
    let away = (radius * radius - 0.25 * chord * chord).max(0.0).sqrt();
    let to_left = (radius > 0.0) != clockwise;
    let left = [-along[1] / chord, along[0] / chord];
    let sign = if to_left { away } else { -away };
    [
        0.5 * (from[first] + to[first]) + sign * left[0],
        0.5 * (from[second] + to[second]) + sign * left[1],
    ]
}

/// Runs the text on the machine, with none of the crate's code: where its motions end.
pub fn read_plainly(text: &str) -> Vec<Reached> {
    let mut reached = Vec::new();
    let mut place = Vector3::from(START);
    let (mut here, mut work) = (Vector3::zeros(), Vector3::from(WORK[0]));
    let (mut scale, mut incremental, mut speed) = (1.0, false, None);
    let mut tool = 0_usize;
    let (mut mode, mut plane, mut absolute_centre) = (0, [0, 1, 2], false);
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let mut bare = String::new();
        let mut inside = false;
        for character in line.to_uppercase().chars() {
            match character {
                ';' if !inside => break,
                '(' => inside = true,
                ')' => inside = false,
                ' ' | '\t' | '/' => {}
                _ if inside => {}
                _ => bare.push(character),
            }
        }
        if ["M862", "M115", "M117", "%", "O"]
            .iter()
            .any(|start| bare.starts_with(start))
        {
            continue;
        }
        let mut words: Vec<(char, f64)> = Vec::new();
        let mut rest = bare.as_str();
        while let Some(letter) = rest.chars().next() {
            let end = rest[1..]
                .find(|c: char| c.is_ascii_alphabetic())
                .map_or(rest.len(), |end| end + 1);
            words.push((
                letter,
                rest[1..end].parse().unwrap_or_else(|_| panic!("{line:?}")),
            ));
            rest = &rest[end..];
        }
        let get = |letter: char| {
            words
                .iter()
                .find(|(found, _)| *found == letter)
                .map(|(_, value)| *value)
        };
        let mut is_here = false;
        // Reference point of G28 and G30; zero of G53.
        let mut machine: Option<([f64; 3], bool)> = None;
        for (letter, value) in &words {
            match (letter, value.to_string().as_str()) {
                ('G', "20") => scale = 25.4,
                ('G', "21") => scale = 1.0,
                ('G', "0") => mode = 0,
                ('G', "1") => mode = 1,
                ('G', "2") => mode = 2,
                ('G', "3") => mode = 3,
                ('G', "17") => plane = [0, 1, 2],
                ('G', "18") => plane = [2, 0, 1],
                ('G', "19") => plane = [1, 2, 0],
                ('G', "90.1") => absolute_centre = true,
                ('G', "91.1") => absolute_centre = false,
                ('G', "90") => incremental = false,
                ('G', "91") => incremental = true,
                ('G', "54") => work = Vector3::from(WORK[0]),
                ('G', "55") => work = Vector3::from(WORK[1]),
                ('G', "28") => machine = Some((REFERENCES[0], false)),
                ('G', "30") => machine = Some((REFERENCES[1], false)),
                ('G', "53") => machine = Some(([0.0; 3], true)),
                ('G', "43" | "49") => {
                    let next = get('H').unwrap_or(0.0) as usize;
                    place.z += LENGTHS[tool] - LENGTHS[next];
                    tool = next;
                }
                ('G', "92") => is_here = true,
                ('G', "92.1") => here = Vector3::zeros(),
                _ => {}
            }
        }
        let coordinates = ['X', 'Y', 'Z'].map(get);
        if is_here {
            for axis in 0..3 {
                if let Some(value) = coordinates[axis] {
                    here[axis] = place[axis] - work[axis] - value * scale;
                }
            }
            continue;
        }
        if let Some(value) = get('F') {
            speed = Some(value);
        }
        if let Some((point, counts)) = machine {
            let all = !counts && coordinates.iter().all(Option::is_none);
            for axis in (0..3).filter(|axis| all || coordinates[*axis].is_some()) {
                let word = coordinates[axis].filter(|_| counts).unwrap_or(0.0);
                let length = if axis == 2 { LENGTHS[tool] } else { 0.0 };
                place[axis] = MACHINE_ZERO[axis] + point[axis] + word * scale - length;
            }
            reached.push(Reached {
                place,
                speed,
                line: index + 1,
                arc: None,
            });
            continue;
        }
        // A piece so short that rounding leaves nothing to move may still have its share of E.
        if coordinates.iter().all(Option::is_none) && get('E').is_none() {
            continue;
        }
        let from = place;
        for axis in 0..3 {
            if let Some(value) = coordinates[axis] {
                let origin = if incremental {
                    place[axis]
                } else {
                    work[axis] + here[axis]
                };
                place[axis] = origin + value * scale;
            }
        }
        reached.push(Reached {
            place,
            speed,
            line: index + 1,
            arc: (mode > 1).then(|| {
                let origin = match absolute_centre {
                    true => work + here,
                    false => from,
                };
                let words = ['I', 'J', 'K'].map(get);
                let [first, second, _] = plane;
                let given = |axis: usize| origin[axis] + words[axis].unwrap_or(0.0) * scale;
                let centre = match get('R') {
                    None => [given(first), given(second)],
                    Some(radius) => {
                        centre_by_radius([from, place], plane, mode == 2, radius * scale)
                    }
                };
                WrittenArc {
                    axes: plane,
                    centre,
                    clockwise: mode == 2,
                }
            }),
        });
    }
    reached
}

//! What programs are generated from.

use super::LENGTHS;
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

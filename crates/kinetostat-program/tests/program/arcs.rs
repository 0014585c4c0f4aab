//! Arcs in every form: three planes, centre and radius, both kinds of centre words, parts of circles,
//! whole circles and helices, absolute and incremental, millimetres and inches.

// Helpers of tests, which clippy does not count as tests.
use std::f64::consts::{PI, TAU};

use kinetostat_program::*;
use nalgebra::Vector3;

const START: [f64; 3] = [10.0, -20.0, 5.0];

pub struct Case {
    plane: usize,
    clockwise: bool,
    pub sweep: f64,
    rise: f64,
    pub by_radius: bool,
    absolute_centre: bool,
    incremental: bool,
    pub inches: bool,
}

impl Case {
    fn axes(&self) -> [usize; 3] {
        [[0, 1, 2], [2, 0, 1], [1, 2, 0]][self.plane]
    }

    /// Place at a share, from the circle itself: radius 8 mm, start at 30 degrees.
    pub fn place(&self, share: f64) -> Vector3<f64> {
        let [u, v, w] = self.axes();
        let start = PI / 6.0;
        let angle = start
            + if self.clockwise {
                -self.sweep
            } else {
                self.sweep
            } * share;
        let mut place = Vector3::from(START);
        place[u] += 8.0 * (angle.cos() - start.cos());
        place[v] += 8.0 * (angle.sin() - start.sin());
        place[w] += self.rise * share;
        place
    }

    pub fn text(&self) -> String {
        let unit = if self.inches { 25.4 } else { 1.0 };
        let [u, v, w] = self.axes();
        let number = |value: f64| format!("{:.6}", value / unit);
        let end = self.place(1.0);
        let full = self.sweep == TAU;
        let mut words = String::new();
        for axis in [u, v, w] {
            if full && axis != w || axis == w && self.rise == 0.0 {
                continue;
            }
            let from = if self.incremental { START[axis] } else { 0.0 };
            words += &format!(" {}{}", ["X", "Y", "Z"][axis], number(end[axis] - from));
        }
        if self.by_radius {
            words += &format!(
                " R{}{}",
                if self.sweep > PI { "-" } else { "" },
                number(8.0)
            );
        } else {
            for (axis, offset) in [(u, 8.0 * (PI / 6.0).cos()), (v, 8.0 * (PI / 6.0).sin())] {
                let from = if self.absolute_centre {
                    START[axis]
                } else {
                    0.0
                };
                words += &format!(" {}{}", ["I", "J", "K"][axis], number(from - offset));
            }
        }
        format!(
            "{} {} {}\nG90 G0 X{} Y{} Z{}\n{}\n{}{words} F{} (arc)\nM2\n",
            if self.inches { "G20" } else { "G21" },
            ["G17", "G18", "G19"][self.plane],
            if self.absolute_centre {
                "G90.1"
            } else {
                "G91.1"
            },
            number(START[0]),
            number(START[1]),
            number(START[2]),
            if self.incremental { "G91" } else { "G90" },
            if self.clockwise { "G02" } else { "g3" },
            number(600.0),
        )
    }
}

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for number in 0..3 * 64 {
        let flag = |bit: usize| (number / 3) & (1 << bit) != 0;
        for sweep in [0.4, 2.0, 4.5, TAU] {
            if flag(1) && (sweep == TAU || flag(2)) {
                // A whole circle by its radius has no centre, and R has no centre words.
                continue;
            }
            cases.push(Case {
                plane: number % 3,
                clockwise: flag(0),
                by_radius: flag(1),
                absolute_centre: flag(2),
                incremental: flag(3),
                inches: flag(4),
                rise: if flag(5) { -3.5 } else { 0.0 },
                sweep,
            });
        }
    }
    cases
}

#[test]
fn every_form_of_arc_is_read_as_its_circle_and_written_as_chords_of_it() {
    let cases = cases();
    assert!(cases.len() > 400);
    for case in &cases {
        let text = case.text();
        let program = Program::read(text.as_bytes()).unwrap();
        let reading = ReadOptions::default();
        let path = interpret(&program, &reading).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let motion = &path.moves[1];
        for step in 0..=16 {
            let share = f64::from(step) / 16.0;
            let distance = (motion.point(share) - case.place(share)).norm();
            assert!(distance < 1e-4, "{distance} mm at {share}\n{text}");
        }
        let length = (64.0 * case.sweep * case.sweep + case.rise * case.rise).sqrt();
        assert!((motion.length_mm() - length).abs() < 3e-4, "{text}");

        let field = |request: &Request| Ok(request.position_mm * 2e-3);
        let writing = {
            let mut writing = WriteOptions::default();
            writing.header = None;
            writing.arcs = Arcs::Lines;
            writing
        };
        let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
        verify_written(&program, &path, &written, &reading, &writing).unwrap_or_else(|error| {
            panic!(
                "{error}\n{text}\n{}",
                String::from_utf8_lossy(&written.bytes)
            )
        });
        let output = String::from_utf8(written.bytes).unwrap();
        let first = output.lines().nth(3).unwrap();
        assert!(
            first.starts_with(if case.clockwise { "G01 " } else { "g1 " }),
            "{first}"
        );
        for line in output.lines().skip(3) {
            let words = line.split('(').next().unwrap();
            assert!(!words.contains(['I', 'J', 'K', 'R', 'P']), "{line}");
        }
        // The middle of each chord is within the tolerance of the corrected circle.
        for piece in written.pieces.iter().filter(|piece| piece.move_index == 1) {
            let middle = 0.5 * (piece.share_from + piece.share_to);
            let wanted = case.place(middle) * 1.002;
            let chord = 0.5 * (piece.commanded_from + piece.commanded_to);
            assert!(
                (chord - wanted).norm() < 0.0004 + 0.0005 + 2.5e-4,
                "{}",
                (chord - wanted).norm()
            );
        }
    }
}

#[test]
fn the_direction_of_motion_is_the_derivative_of_the_point() {
    for case in cases() {
        let program = Program::read(case.text()).unwrap();
        let path = interpret(&program, &ReadOptions::default()).unwrap();
        let motion = &path.moves[1];
        for share in [0.01, 0.4, 0.99] {
            let step = motion.point(share + 1e-6) - motion.point(share - 1e-6);
            assert!((motion.tangent(share).unwrap() - step.normalize()).norm() < 1e-4);
        }
    }
}

#[test]
fn a_spiral_within_the_arc_tolerance_meets_both_its_ends() {
    let text = "G21\nG0 X0 Y0 Z0\nG2 X10.004 Y0 I5 J0 F100\n";
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &ReadOptions::default()).unwrap();
    let motion = &path.moves[1];
    assert_eq!(motion.point(0.0), Vector3::zeros());
    assert_eq!(motion.point(1.0), Vector3::new(10.004, 0.0, 0.0));
    assert!((motion.point(1.0 - 1e-9) - motion.end).norm() < 1e-6);
    assert!((motion.point(0.5) - Vector3::new(5.0, 5.002, 0.0)).norm() < 1e-9);
}

#[test]
fn a_radius_just_too_small_for_its_chord_is_half_a_circle() {
    let program = Program::read("G21\nG0 X0 Y0 Z0\nG3 X10 Y0 R4.998 F100\n").unwrap();
    let path = interpret(&program, &ReadOptions::default()).unwrap();
    assert!((path.moves[1].point(0.5) - Vector3::new(5.0, -5.0, 0.0)).norm() < 1e-9);
}

#[test]
fn modal_arc_blocks_are_converted_too_and_the_mode_after_them_is_right() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG2\nX10 Y0 I5 F300\nX20 Y0 I5\n(pause)\nG1 X30\nX40\n";
    let program = Program::read(text).unwrap();
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).unwrap();
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing.arcs = Arcs::Lines;
        writing.chord_tolerance_mm = 1.0;
        writing
    };
    // An arc that nothing is to be corrected on stays an arc.
    let shifted = |_: &Request| Ok(Vector3::new(0.1, 0.0, 0.0));
    let written = write_corrected(&program, &path, &shifted, &writing, &Unwatched).unwrap();
    verify_written(&program, &path, &written, &reading, &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    let lines: Vec<&str> = output.lines().collect();
    // The lone G2 is carried, so the first converted block must say G1; the second need not.
    assert_eq!(lines[2], "G2");
    assert!(lines[3].starts_with("G1 X"), "{output}");
    assert_eq!(output.matches("G1").count(), 2, "{output}");
    let (_, after) = output.split_once("(pause)\n").expect("the pause");
    assert!(after.starts_with("G1 X30.1"), "{output}");
    assert!(after.ends_with("\nX40.1000\n"), "{output}");
}

#[test]
fn nearly_full_circles_and_short_arcs_are_what_they_say() {
    let sweep = |block: &str| {
        let text = format!("G21 G90 G17\nG0 X20 Y0 Z0\n{block} F600\nM2\n");
        let program = Program::read(text.as_str()).unwrap();
        let path = interpret(&program, &ReadOptions::default()).unwrap();
        match path.moves[1].curve {
            Curve::Arc(arc) => arc.sweep,
            Curve::Line => panic!("{block} is no arc"),
        }
    };
    for (block, wanted) in [
        ("G3 X20.000 Y0.0000 I-20 J0", TAU),
        // A hair is missing to the full circle.
        ("G3 X20 Y-0.002 I-20", TAU - 1e-4),
        ("G2 X20 Y0.002 I-20", 1e-4 - TAU),
        // Short arcs: many last digits long, or not longer than the circle is wide, or by the sign of a radius.
        ("G3 X20 Y0.004 I-20", 2e-4),
        ("G3 X20.0000 Y0.0005 I-20", 2.5e-5),
        ("G3 X20 Y0.001002 I-20", 5.01e-5),
        ("G3 X19.998 Y0.002 I-0.002 J0", 0.5 * PI),
        ("G3 X20 Y0.001 R20", 5e-5),
        ("G3 X20 Y0.001 R-20", TAU - 5e-5),
    ] {
        let found = sweep(block);
        assert!((found - wanted).abs() < 1e-8, "{block}: {found}");
    }
}

/// LinuxCNC and grbl turn by the angle between the ends, where that is above 1e-6 rad.
#[test]
fn arcs_no_longer_than_their_words_are_rounded_are_short_arcs_and_it_is_said() {
    for (begin, block, wanted) in [
        (
            "G17 G0 X24.3929 Y104.2273",
            "G3 X24.3928 Y104.2273 I0.1128 J-0.4871",
            1.948e-4,
        ),
        (
            "G17 G0 X24.3928 Y104.2273",
            "G2 X24.3929 Y104.2273 I0.1129 J-0.4871",
            -1.948e-4,
        ),
        ("G17 G0 X20 Y0", "G3 X20 Y0.0001 I-20", 5e-6),
        ("G17 G0 X20 Y0", "G2 X20.001 Y-0.002 I-20", -1e-4),
        ("G17 G0 X20 Y0", "G3 X20 Y0.001 Z-2 I-20", 5e-5),
        ("G18 G0 X20 Z0", "G2 X20 Z0.001 I-20", -5e-5),
        ("G19 G0 Y20 Z0", "G3 Y20 Z0.001 J-20", 5e-5),
    ] {
        let text = format!("G21 G90 F600\nG0 X0 Y0 Z0\n{begin}\n{block}\nM2\n");
        let program = Program::read(text.as_str()).unwrap();
        let path = interpret(&program, &ReadOptions::default()).unwrap();
        let Curve::Arc(arc) = path.moves[2].curve else {
            panic!("{block} is no arc");
        };
        assert!(
            (arc.sweep - wanted).abs() < 0.02 * wanted.abs(),
            "{block}: {}",
            arc.sweep
        );
        let mut said = path
            .warnings
            .iter()
            .filter(|w| w.text.contains("short arc between them"));
        assert_eq!(said.next().map(|w| w.line), Some(4), "{block}");
        // Bent by a correction, it is no full circle either: the ends are two points, or the piece is straight.
        for arcs in [Arcs::Lines, Arcs::Fit] {
            let field = |request: &Request| Ok(request.position_mm * 2e-3);
            let mut writing = WriteOptions::default();
            writing.arcs = arcs;
            let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
            let reading = ReadOptions::default();
            let verified = verify_written(&program, &path, &written, &reading, &writing);
            let output = String::from_utf8_lossy(&written.bytes).into_owned();
            verified.unwrap_or_else(|error| panic!("{error}\n{output}"));
            let again = interpret(&Program::read(output.as_str()).unwrap(), &reading).unwrap();
            let cuts = again.moves.iter().filter(|one| one.kind == MoveKind::Feed);
            let length: f64 = cuts.map(Move::length_mm).sum();
            assert!(length < 2.5, "{output}");
        }
    }
}

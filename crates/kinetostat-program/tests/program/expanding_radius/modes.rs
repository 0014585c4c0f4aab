//! Modes and words around a contour: increments, inches, offsets, tools, and the order of everything that is no motion.

use kinetostat_program::{ExpandOptions, NoSubprograms, ReadOptions, Units, expand};
use nalgebra::Vector3;

use super::{flat, made, same, try_flat};

const CONTOUR: &str = "G21 G90 G17 F100\nG0 X10 Y-20 Z5\nG41.1 D4\nG1 X10 Y0\nY30\nG3 X0 Y40 I-10 J0\nG1 X-20\nG40\nG0 Z20\nM2\n";

/// The same contour in other words.
const OTHER_WORDS: [&str; 4] = [
    // Increments.
    "G21 G90 G17 F100\nG0 X10 Y-20 Z5\nG41.1 D4\nG91 G1 Y20\nY30\nG3 X-10 Y10 I-10\nG1 X-20\nG40\nG0 Z15\nM2\n",
    // Places of centres.
    "G21 G90 G90.1 G17 F100\nG0 X10 Y-20 Z5\nG41.1 D4\nG1 X10 Y0\nY30\nG3 X0 Y40 I0 J30\nG1 X-20\nG40\nG0 Z20\nM2\n",
    // Inches.
    "G20 G90 G17 F4\nG0 X0.393700787401575 Y-0.787401574803150 Z0.196850393700787\nG41.1 D0.157480314960630\nG1 Y0\nY1.181102362204724\nG3 X0 Y1.574803149606299 I-0.393700787401575 J0\nG1 X-0.787401574803150\nG40\nG0 Z0.787401574803150\nM2\n",
    // Another zero, and a radius instead of a centre.
    "G21 G90 G17 F100\nG0 X10 Y-20 Z5\nG92 X110 Y180\nG41.1 D4\nG1 X110 Y200\nY230\nG3 X100 Y240 R10\nG1 X80\nG40\nG0 Z20\nM2\n",
];

#[test]
fn the_same_contour_in_other_words_has_the_same_way() {
    let first = made(&flat(CONTOUR));
    assert_eq!(first.len(), 6);
    for text in OTHER_WORDS {
        let other = made(&flat(text));
        assert_eq!(first.len(), other.len(), "{text}");
        for (a, b) in first.iter().zip(&other) {
            assert!(
                (0..3).all(|axis| same(a.end[axis], b.end[axis])),
                "{text}\n{a:?} {b:?}"
            );
            let close = match (a.arc, b.arc) {
                (None, None) => true,
                (Some((c, s)), Some((d, t))) => same(c[0], d[0]) && same(c[1], d[1]) && same(s, t),
                _ => false,
            };
            assert!(close, "{text}\n{a:?} {b:?}");
        }
    }
}

#[test]
fn work_offsets_shift_the_part_and_not_the_words() {
    let mut options = ExpandOptions::default();
    options.reading = ReadOptions::default();
    options.reading.work_offsets_mm[1] = Some(Vector3::new(100.0, 200.0, 300.0));
    let text = CONTOUR.replace("G17", "G17 G55");
    let shifted = expand(text.as_str(), &options, &NoSubprograms).unwrap();
    let plain = flat(&text);
    assert_eq!(shifted.program.bytes(), plain.program.bytes());
    for (a, b) in shifted.path.moves.iter().zip(&plain.path.moves) {
        let apart = a.end - b.end - Vector3::new(100.0, 200.0, 300.0);
        assert!(apart.norm() < 1e-9, "{a:?} {b:?}");
    }
}

#[test]
fn units_may_change_in_a_contour() {
    let text = CONTOUR.replace("G1 X-20\n", "G20\nF4\nG1 X-0.787401574803150\n");
    let (first, other) = (made(&flat(CONTOUR)), made(&flat(&text)));
    for (a, b) in first.iter().zip(&other).take(5) {
        assert!(
            (0..3).all(|axis| same(a.end[axis], b.end[axis])),
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn words_keep_their_order_and_their_lines() {
    let text = "G21 G90\nG0 X0 Y-20 Z5\nG41.1 D4 (left)\nN10 G1 X0 Y0 F200 (in)\nM8\nY20\n(up)\nF300\nG1 Z6\nM3 S1000 X-20\nM0\nN20 Y40\nG40 (off)\nG0 X9 Y9\nM2\n";
    let flat = flat(text);
    let lines = String::from_utf8(flat.program.bytes().to_vec()).unwrap();
    assert_eq!(
        lines,
        "G21 G90\nG0 X0 Y-20 Z5\n(left)\nN10 G1 X-2 Y0 F200 (in)\nM8\nG1 Y18\n(up)\nF300\nG1 Z6\nM3 S1000\nG1 X-20\n\
         M0\nN20 G2 X-22 Y20 I0 J2\nG1 Y40\n(off)\nG0 X9 Y9\nM2\n"
    );
    let origins: Vec<usize> = flat.origins.iter().map(|origin| origin.line).collect();
    assert_eq!(
        origins,
        [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 10, 11, 12, 12, 13, 14, 15]
    );
}

#[test]
fn tools_are_found_by_their_numbers() {
    let text = |switch: &str| {
        format!("G21 G90 F100\n{switch}\nG0 X0 Y-20 Z0\nG41\nG1 X0 Y0\nY10\nG40\nM2\n")
    };
    let x = |text: &str| made(&flat(text))[1].end[0];
    assert!(same(x(&text("T3 M6")), -3.0));
    // A tool that is only made ready is not in the spindle.
    assert!(same(x(&text("T3 M6\nT4")), -3.0));
    assert!(same(x(&text("T3 M6").replace("G41", "G41 D5")), -5.0));
    assert!(same(x(&text("T3 M6").replace("G41", "G42 D5")), 5.0));
    assert!(same(x(&text("T3 M6").replace("G41", "G42 D0")), 3.0));
    assert!(same(x(&text("M61 Q2")), -2.0));
    assert!(same(x(&text("").replace("G41", "G41.1 D2.5")), -1.25));
    assert!(same(x(&text("").replace("G41", "G41.1 D-0.5")), 0.25));
    let without = text("").replace("G41", "G41.1 D0");
    let flat = flat(&without);
    assert!(same(made(&flat)[1].end[0], 0.0), "{:?}", made(&flat));
}

#[test]
fn behind_a_change_of_tools_the_tool_is_where_it_is() {
    let text = "G21 G90 F100\nT1 M6\nG0 X0 Y-20 Z0\nG41\nG1 X0 Y0\nY10\nG40\nT2 M6\nG91 G0 X5\nG90 G0 X0 Y0\nM2\n";
    let all = made(&flat(text));
    assert!(
        same(all[3].end[0], 4.0) && same(all[3].end[1], 10.0),
        "{all:?}"
    );
    let error = try_flat(&text.replace("G91 G0 X5", "G2 X5 Y10 I3 J0")).unwrap_err();
    assert_eq!(error.line, 9, "{error}");
}

#[test]
fn the_machine_s_default_units_hold_as_well() {
    let mut options = ExpandOptions::default();
    options.reading.units = Some(Units::Inches);
    let text = "G90 G17 F10\nG0 X0 Y-2 Z0\nG41.1 D0.5\nG1 X0 Y0\nM2\n";
    let flat = expand(text, &options, &NoSubprograms).unwrap();
    assert!(same(flat.path.moves[1].end.x, -0.25 * 25.4));
}

#[test]
fn in_the_plane_zx_the_same_contour_turns_up_in_other_letters() {
    let xy = "G21 G90 G17 F200\nG0 X0 Y-20 Z5\nG41.1 D6\nG1 X0 Y0\nY40\nG2 X30 Y40 I15 J0\nG1 X30 Y10\nG1 Z3\nX50\nG40\nG0 Z5\nM2\n";
    let zx: String = xy
        .replace("G17", "G18")
        .chars()
        .map(|letter| match letter {
            'X' => 'Z',
            'Y' => 'X',
            'Z' => 'Y',
            'I' => 'K',
            'J' => 'I',
            other => other,
        })
        .collect();
    let ends = |text: &str| -> Vec<[f64; 3]> {
        let made = expand(text, &ExpandOptions::default(), &NoSubprograms);
        let made = made.unwrap_or_else(|error| panic!("{error}"));
        made.path
            .moves
            .iter()
            .map(|m| [m.end.x, m.end.y, m.end.z])
            .collect()
    };
    let (one, other) = (ends(xy), ends(&zx));
    assert_eq!(one.len(), other.len());
    assert!(one.len() == 8, "{one:?}");
    for (a, b) in one.iter().zip(&other) {
        // (x, y, z) of the first is (z, x, y) of the second.
        let turned = [b[2], b[0], b[1]];
        for axis in 0..3 {
            assert!((a[axis] - turned[axis]).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}

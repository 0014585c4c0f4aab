//! Rounded and broken corners written flat, against a construction of their own: the centre of a rounding is where two parallels
//! of the lines meet, its ends are the feet of that centre on the lines.

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::{Matrix2, Vector2, Vector3};

use crate::chance::Chance;

fn path(language: Language, text: &str) -> (String, RobotPath) {
    let options = ReadOptions::default();
    let files = vec![SourceFile::new("a.h", text)];
    let flat =
        expand(language, files, &options).unwrap_or_else(|errors| panic!("{text}: {errors:?}"));
    let flat = flat.unwrap();
    let lines = flat
        .file
        .bytes()
        .iter()
        .filter(|byte| **byte == b'\n')
        .count();
    assert!(flat.changed && flat.origins.len() >= lines, "{text}");
    let output = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
    let program = read(language, vec![flat.file], &options)
        .unwrap_or_else(|errors| panic!("{output}: {errors:?}"));
    let path = path_of(&program, &PathOptions::default()).unwrap();
    (output, path)
}

/// Where the lines through two pairs of places meet, each moved to the side of the other by a distance.
fn centre_of([a, b, c]: [Vector2<f64>; 3], radius: f64) -> Vector2<f64> {
    let side = |from: Vector2<f64>, to: Vector2<f64>, towards: Vector2<f64>| {
        let along = (to - from).normalize();
        let across = Vector2::new(-along.y, along.x);
        let across = across * across.dot(&(towards - from)).signum();
        (across, across.dot(&from) + radius)
    };
    let (first, one) = side(a, b, c);
    let (second, other) = side(b, c, a);
    let matrix = Matrix2::from_rows(&[first.transpose(), second.transpose()]);
    matrix.try_inverse().unwrap() * Vector2::new(one, other)
}

fn foot(of: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> Vector2<f64> {
    let along = (to - from).normalize();
    from + along * along.dot(&(of - from))
}

fn program(language: Language, [a, b, c]: [Vector2<f64>; 3], word: (&str, f64)) -> String {
    let [a, b, c] = [a, b, c].map(|at| (format!("{:.4}", at.x), format!("{:.4}", at.y)));
    let (name, size) = word;
    let r = if name == "RND" { "R" } else { "" };
    match language {
        Language::Heidenhain => format!(
            "0 BEGIN PGM A MM\n1 L X{} Y{} Z-1 R0 FMAX M3\n2 L X{} Y{} F500\n3 {name} {r}{size:.3} F200\n4 L X{} Y{} M9\n5 END PGM A MM\n",
            a.0, a.1, b.0, b.1, c.0, c.1
        ),
        _ => format!(
            "G17 G90 G0 X{} Y{} Z-1 F500\nN20 G1 X{} Y{} {name}={size:.3}\nX{} Y{} M9\nM30\n",
            a.0, a.1, b.0, b.1, c.0, c.1
        ),
    }
}

#[test]
fn random_corners_are_those_of_a_construction_of_their_own() {
    for (language, name, digit) in [
        (Language::Heidenhain, "RND", 1e-4),
        (Language::Heidenhain, "CHF", 1e-4),
        (Language::Siemens, "RND", 1e-6),
        (Language::Siemens, "CHF", 1e-6),
        (Language::Siemens, "CHR", 1e-6),
    ] {
        let mut chance = Chance::new(7);
        let (mut worst, mut count) = (Worst::new(), 0);
        for _ in 0..150 {
            let mut place = || {
                let at = Vector2::new(chance.within(50.0), chance.within(50.0));
                at.map(|value: f64| (value * 1e4).round() / 1e4)
            };
            let [a, b, c] = [place(), place(), place()];
            let (back, on) = (a - b, c - b);
            let inner = back.angle(&on);
            let shorter = if back.norm() < on.norm() {
                back.norm()
            } else {
                on.norm()
            };
            if !(0.2..3.0).contains(&inner) || shorter < 2.0 {
                continue;
            }
            // Heidenhain's chamfer says how much it takes of each side, SINUMERIK's CHF how long it is itself.
            let own = name;
            let name = match (language, name) {
                (Language::Heidenhain, "CHF") => "CHR",
                _ => name,
            };
            // Half of the shorter line is taken.
            let size = match name {
                "RND" => 0.5 * shorter * (0.5 * inner).tan(),
                "CHF" => shorter * (0.5 * inner).sin(),
                _ => 0.5 * shorter,
            };
            let size = (size * 1e3).floor() / 1e3;
            let (output, path) = path(language, &program(language, [a, b, c], (own, size)));
            let moves = &path.path.moves;
            assert_eq!(moves.len(), 4, "{output}");
            let [line, corner, last] = [&moves[1], &moves[2], &moves[3]];
            let [first, second] = match name {
                "RND" => {
                    let centre = centre_of([a, b, c], size);
                    for k in 0..=10 {
                        let at = corner.point(f64::from(k) / 10.0).xy();
                        // The ends are rounded, and the radius is as printed.
                        worst.add(((at - centre).norm() - size).abs() / 10.0);
                    }
                    [foot(centre, a, b), foot(centre, b, c)]
                }
                "CHR" => [b + back.normalize() * size, b + on.normalize() * size],
                _ => {
                    let side = 0.5 * size / (0.5 * inner).sin();
                    [b + back.normalize() * side, b + on.normalize() * side]
                }
            };
            worst.add((line.end.xy() - first).norm());
            worst.add((corner.end.xy() - second).norm());
            worst.add((last.end.xy() - c).norm());
            assert_eq!([line, corner, last].map(|one| one.end.z), [-1.0; 3]);
            // Feeds: of the corner where it states one, and behind it that of before.
            let feeds = [line, corner, last].map(|one| one.feed.unwrap().value);
            let own = if language == Language::Heidenhain {
                200.0
            } else {
                500.0
            };
            assert_eq!(feeds.map(f64::round), [500.0, own, 500.0], "{output}");
            assert!(output.contains("M9"), "{output}");
            count += 1;
        }
        let off = worst.measured().unwrap();
        println!("{language:?} {name}: {count} corners, {off:.2e} mm off");
        assert!(count > 60 && off < digit, "{off}");
    }
}

#[test]
fn a_rectangle_with_corners_one_after_the_other_keeps_its_lines() {
    let texts = [
        (
            Language::Heidenhain,
            "0 BEGIN PGM A MM\n1 L X+0 Y+0 Z-1 FMAX\n2 L X+40 F500\n3 RND R5\n4 L IY+30 ; up\n5 RND R5\n6 L IX-40\n7 RND R5\n8 L Y+0\n\
             9 END PGM A MM\n",
        ),
        (
            Language::Siemens,
            "G0 X0 Y0 Z-1\nG1 X40 F500 RND=5\nG91 Y30 RND=5 ; up\nX-40 RND=5\nG90 Y0\nM30\n",
        ),
    ];
    for (language, text) in texts {
        let (output, path) = path(language, text);
        let ends: Vec<[f64; 2]> = path
            .path
            .moves
            .iter()
            .map(|one| one.end.xy().into())
            .collect();
        assert_eq!(
            ends,
            [
                [0.0, 0.0],
                [35.0, 0.0],
                [40.0, 5.0],
                [40.0, 25.0],
                [35.0, 30.0],
                [5.0, 30.0],
                [0.0, 25.0],
                [0.0, 0.0]
            ],
            "{output}"
        );
        let length: f64 = path.path.moves.iter().map(|one| one.length_mm()).sum();
        let wanted = 35.0 + 20.0 + 30.0 + 25.0 + 1.5 * std::f64::consts::PI * 5.0;
        assert!((length - wanted).abs() < 1e-9, "{length}");
        assert_eq!(output.matches("; up").count(), 1);
    }
}

#[test]
fn chamfers_of_heidenhain_are_lines_with_their_own_feed() {
    let text = "0 BEGIN PGM A INCH\n1 L X+0 Y+0 Z-1 R0 FMAX M3\n2 L X+2 F50\n3 CHF 0.5 F20\n4 L IY+1 M8\n5 CHF0.25\n6 L X+0\n7 END PGM A INCH\n";
    let (output, path) = path(Language::Heidenhain, text);
    assert_eq!(
        output,
        "0 BEGIN PGM A INCH\n1 L X+0 Y+0 Z-1 R0 FMAX M3\n2 L X+1.50000 Y+0.00000 F50\n3 L X+2.00000 Y+0.50000 F20\n\
         4 L X+2.00000 Y+0.75000 F50 M8\n5 L X+1.75000 Y+1.00000\n6 L X+0.00000 Y+1.00000\n7 END PGM A INCH\n"
    );
    let length: f64 = path
        .path
        .moves
        .iter()
        .skip(1)
        .map(|one| one.length_mm())
        .sum();
    let wanted = 25.4 * (1.5 + 0.5 * 2_f64.sqrt() + 0.25 + 0.25 * 2_f64.sqrt() + 1.75);
    assert!((length - wanted).abs() < 1e-6, "{length}");
}

#[test]
fn polar_lines_other_planes_and_inches_are_followed() {
    // A hexagon about a pole, as a public example has it.
    let text = "BEGIN PGM MM\nL Z-2 R0 FMAX\nCC X+50 Y+50\nLP PR+40 PA+0 FMAX\nL Z-2 F100\nLP IPA+60\nRND R15\nLP IPA+60\nRND R15\nLP IPA+60\n\
        LP IPA+60\nL Z+10 FMAX\nEND PGM MM\n";
    let (output, made) = path(Language::Heidenhain, text);
    let last = made.path.moves.iter().rev().nth(1).unwrap();
    let angle = 240.0_f64.to_radians();
    let wanted = Vector2::new(50.0 + 40.0 * angle.cos(), 50.0 + 40.0 * angle.sin());
    assert!((last.end.xy() - wanted).norm() < 1e-4, "{output}");
    assert_eq!(output.matches("CR X").count(), 2, "{output}");
    let text = "G18 G70 G0 X0 Y1 Z0\nG1 Z2 F20 RND=0.5\nX1\nM30\n";
    let (output, made) = path(Language::Siemens, text);
    assert!(output.contains("G3 Z2 X0.5 CR=0.5\n"), "{output}");
    let middle = made.path.moves[2].point(0.5) / 25.4;
    let side = 0.5 - 0.5 * 0.5_f64.sqrt();
    assert!(
        (middle - Vector3::new(side, 1.0, 2.0 - side)).norm() < 1e-9,
        "{output}"
    );
}

#[test]
fn sizes_of_corners_may_be_computed() {
    let written = |words: [&str; 3]| {
        let [round, length, side] = words;
        let text = format!(
            "R1=2 R2=0.5\nG17 G90 G0 X0 Y0 Z0\nG1 X40 F100 RND={round}\nY30 CHF={length}\nX0 CHR={side}\nY-10\nM30\n"
        );
        let files = [SourceFile::new("a.mpf", text)];
        let flat = expand_siemens(&files).unwrap();
        String::from_utf8(flat.file.bytes().to_vec()).unwrap()
    };
    let computed = written(["R1+5", "R1*R2*3", "SQRT(R1*2)+R2"]);
    assert_eq!(computed, written(["7", "3", "2.5"]));
    assert!(computed.contains("\nG3 X40 Y7 CR=7\n"), "{computed}");
}

/// A line and an arc about a pole, or the other way round, with a rounded corner between them.
fn beside_an_arc(chance: &mut Chance, arc_first: bool) -> Option<(String, [f64; 6])> {
    let digits = |value: f64| (value * 1e4).round() / 1e4;
    let [x, y] = [0, 1].map(|_| digits(chance.within(20.0)));
    let size = 5.0 + chance.within(4.0).abs();
    let [start, turn] = [chance.within(3.0), 0.9 + chance.within(2.0).abs()];
    let sense = if chance.below(2) == 0 { 1.0 } else { -1.0 };
    let on = |angle: f64| {
        [
            digits(x + size * angle.cos()),
            digits(y + size * angle.sin()),
        ]
    };
    let (begin, end) = (on(start), on(start + sense * turn));
    let outer = [
        digits(x + chance.within(30.0)),
        digits(y + chance.within(30.0)),
    ];
    let radius = digits(0.2 + chance.within(0.25).abs());
    let corner = if arc_first { end } else { begin };
    let away = Vector2::from(outer) - Vector2::from(corner);
    // The angle between the line, from outside or inside, and the circle at the corner.
    let out = Vector2::from(corner) - Vector2::new(x, y);
    let slant = (away.dot(&out) / (away.norm() * out.norm())).abs();
    if away.norm() < 8.0 || slant < 0.6 {
        return None;
    }
    let turned = if sense > 0.0 { "DR+" } else { "DR-" };
    let line = |[x, y]: [f64; 2]| format!("L X{x:+.4} Y{y:+.4}");
    let arc = |[x, y]: [f64; 2]| format!("C X{x:+.4} Y{y:+.4} {turned}");
    let blocks = match arc_first {
        false => [line(outer), line(begin), arc(end)],
        true => [line(begin), arc(end), line(outer)],
    };
    let text = format!(
        "BEGIN PGM A MM\nCC X{x:+.4} Y{y:+.4}\n{} Z-1 R0 FMAX M3\n{} F500\nRND R{radius:.4} F200\n{}\nEND PGM A MM\n",
        blocks[0], blocks[1], blocks[2]
    );
    Some((text, [x, y, size, radius, corner[0], corner[1]]))
}

#[test]
fn corners_between_a_line_and_an_arc_are_tangential_to_both() {
    for arc_first in [false, true] {
        let mut chance = Chance::new(11);
        let (mut worst, mut count) = (Worst::new(), 0);
        for _ in 0..200 {
            let Some((text, [x, y, size, radius, at_x, at_y])) =
                beside_an_arc(&mut chance, arc_first)
            else {
                continue;
            };
            let (output, path) = path(Language::Heidenhain, &text);
            let moves = &path.path.moves;
            assert_eq!(moves.len(), 4, "{output}");
            let [before, corner, behind] = [&moves[1], &moves[2], &moves[3]];
            // The rounding has its radius, and goes on from each way in the direction of that: nothing else is tangential to both.
            let length = corner.length_mm();
            let chord = (corner.end - corner.start).norm();
            worst.add((2.0 * radius * (0.5 * length / radius).sin() - chord) / 10.0);
            let step = 1e-4;
            let ends = [
                [
                    before.point(1.0 - step),
                    before.point(1.0),
                    corner.point(step),
                ],
                [
                    corner.point(1.0 - step),
                    corner.point(1.0),
                    behind.point(step),
                ],
            ];
            for [a, b, c] in ends {
                let [came, goes] = [(b - a).normalize(), (c - b).normalize()];
                assert!(came.dot(&goes) > 0.999, "{text}{output}");
                worst.add(came.cross(&goes).norm() / 300.0);
            }
            // It is the short way at the corner, and the arc is about its pole as it was.
            assert!(
                corner.turn_deg().is_finite() && length < 3.15 * radius,
                "{text}{output}"
            );
            let there = Vector2::new(at_x, at_y);
            assert!(
                (corner.start.xy() - there).norm() < 12.0 * radius,
                "{text}{output}"
            );
            let arc = if arc_first { before } else { behind };
            let line = if arc_first { behind } else { before };
            for k in 0..=10 {
                let off = (arc.point(f64::from(k) / 10.0).xy() - Vector2::new(x, y)).norm();
                worst.add((off - size) / 3.0);
            }
            assert!(line.length_mm() > 0.0);
            let feeds = [before, corner, behind].map(|one| one.feed.unwrap().value.round());
            assert_eq!(feeds, [500.0, 200.0, 500.0], "{output}");
            count += 1;
        }
        let off = worst.measured().unwrap();
        println!("arc first {arc_first}: {count} corners, {off:.2e}");
        assert!(count > 40 && off < 1e-4, "{count} {off}");
    }
}

#[test]
fn a_slot_with_arcs_between_rounded_lines_is_followed() {
    // A line into a circle from outside, round it, and out again: at 90 degrees, R1 beside R10.
    let text = "BEGIN PGM A MM\nCC X+0 Y+0\nL X-20 Y+0 Z-1 R0 FMAX M3\nL X-10 F500\nRND R1\nCP PA+0 DR+\nRND R1\nL X+20\nEND PGM A MM\n";
    let (output, path) = path(Language::Heidenhain, text);
    let moves = &path.path.moves;
    // The centre of the first rounding: 1 beside the line, 11 from the pole.
    let reach = 120_f64.sqrt();
    let share = 10.0 / 11.0;
    let wanted = [
        [-reach, 0.0],
        [-reach * share, -share],
        [reach * share, -share],
        [reach, 0.0],
        [20.0, 0.0],
    ];
    assert_eq!(moves.len(), 6, "{output}");
    for (one, wanted) in moves[1..].iter().zip(wanted) {
        let off = (one.end.xy() - Vector2::from(wanted)).norm();
        assert!(off < 1e-4, "{off} {output}");
    }
    let turned = 2.0 * (0.5 * std::f64::consts::PI - (1.0 / 11.0_f64).asin());
    assert!(
        (moves[3].length_mm() - 10.0 * turned).abs() < 1e-3,
        "{output}"
    );
}

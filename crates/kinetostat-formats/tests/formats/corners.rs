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

//! Corrected circles are circles about centres of their own again, helices by their angle where they rise.

use kinetostat_formats::*;
use kinetostat_program::{
    Arcs, Corrected, Request, Unwatched, WriteOptions as PathWriteOptions, verify_against_field,
};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::correcting::written_and_checked;

use super::program;

const GROOVE: &str = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n2 L X+25 Y+0 Z-2 R0 FMAX M3\n3 CC X+0 Y+0\n\
    4 C X-25 Y+0 DR+ F600 M8\n5 C X+25 Y+0 DR+ M9\n6 LP PR+25 PA+90\n7 L Z+10 FMAX M30\n8 END PGM A MM\n";

/// As on an arm: larger by a little, and lower on one side.
fn shift(place: &Vector3<f64>, tilt: f64) -> Vector3<f64> {
    let (sine, cosine) = place.y.atan2(place.x).sin_cos();
    Vector3::new(
        -0.01 - 0.121 * cosine + 0.067 * sine,
        -0.047 - 0.104 * cosine - 0.151 * sine,
        -0.114 + tilt * (0.03 * cosine - 0.059 * sine),
    )
}

fn corrected(text: &str, tilt: f64, writing: &PathWriteOptions) -> (String, Corrected) {
    corrected_by(text, &move |place| shift(place, tilt), writing)
}

fn corrected_by(
    text: &str,
    by: &(dyn Fn(&Vector3<f64>) -> Vector3<f64> + Sync),
    writing: &PathWriteOptions,
) -> (String, Corrected) {
    let program = program(text);
    let (options, making) = (ReadOptions::default(), PathOptions::default());
    let path = path_of(&program, &making).unwrap();
    let field = move |request: &Request| Ok(by(&request.position_mm));
    let written =
        written_and_checked((&program, &path), (&options, &making), &field, writing).unwrap();
    verify_against_field(&path.path, &written, &field, writing, &Unwatched).unwrap();
    (String::from_utf8(written.bytes.clone()).unwrap(), written)
}

/// Where the blocks of a written program go, read apart from the reader: places between the ends of its circles, and by how much the
/// radii at both ends of each circle differ.
fn followed(text: &str) -> (Vec<Vector3<f64>>, Vec<f64>) {
    let (mut at, mut centre) = (Vector3::<f64>::zeros(), Vector3::<f64>::zeros());
    let (mut places, mut radii) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace().skip(1).peekable();
        let kind = words.next().unwrap_or_default();
        let value = |name: &str| -> Option<f64> {
            let word = line
                .split_whitespace()
                .skip(2)
                .find(|word| word.starts_with(name))?;
            word[name.len()..].parse().ok()
        };
        match kind {
            "CC" => centre = Vector3::new(value("X").unwrap(), value("Y").unwrap(), 0.0),
            "C" | "CP" => {
                let arm = Vector3::new(at.x - centre.x, at.y - centre.y, 0.0);
                let sense: f64 = match line.contains("DR+") {
                    true => 1.0,
                    false => -1.0,
                };
                let first = arm.y.atan2(arm.x);
                let (angle, last) = match kind {
                    "C" => {
                        let to =
                            Vector3::new(value("X").unwrap(), value("Y").unwrap(), 0.0) - centre;
                        let angle = sense * (to.y.atan2(to.x) - first);
                        (sense * angle.rem_euclid(std::f64::consts::TAU), to.norm())
                    }
                    _ => (value("IPA").unwrap().to_radians(), arm.norm()),
                };
                assert!(angle * sense > 0.0, "{line}");
                let rise = value("IZ").unwrap_or(0.0);
                radii.push((last - arm.norm()).abs());
                let start = at.z;
                for k in 1..=40 {
                    let part = f64::from(k) / 40.0;
                    let (sine, cosine) = (first + angle * part).sin_cos();
                    let radius = arm.norm() + part * (last - arm.norm());
                    at = centre + Vector3::new(cosine, sine, 0.0) * radius;
                    at.z = start + rise * part;
                    places.push(at);
                }
            }
            "L" => {
                for (axis, name) in ["X", "Y", "Z"].iter().enumerate() {
                    at[axis] = value(name).unwrap_or(at[axis]);
                }
            }
            _ => {}
        }
    }
    (places, radii)
}

/// How far places are from the corrected circle.
fn off(places: &[Vector3<f64>], tilt: f64) -> f64 {
    let mut worst = Worst::new();
    let wanted = |angle: f64| {
        let place = Vector3::new(25.0 * angle.cos(), 25.0 * angle.sin(), -2.0);
        place + shift(&place, tilt)
    };
    for at in places {
        let mut angle = at.y.atan2(at.x);
        for _ in 0..6 {
            let along = (wanted(angle + 1e-4) - wanted(angle - 1e-4)) / 2e-4;
            angle += (at - wanted(angle)).dot(&along) / along.norm_squared();
        }
        worst.add((at - wanted(angle)).norm());
    }
    worst.of(places.len())
}

#[test]
fn a_groove_becomes_circles_with_equal_radii_and_helices() {
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    for (tilt, most, kind) in [(0.0, 12, " C X"), (1.0, 60, " CP IPA")] {
        let (output, written) = corrected(GROOVE, tilt, &writing);
        let round = written.pieces.iter().filter(|piece| piece.circle.is_some());
        let (count, lines) = (round.count(), output.matches(kind).count());
        let (places, radii) = followed(&output);
        let mut worst = Worst::new();
        for radius in &radii {
            worst.add(*radius);
        }
        println!(
            "tilt {tilt}: {count} pieces, {lines} `{kind}`, {:.3} um off, radii {:.3} um",
            1e3 * off(&places, tilt),
            1e3 * worst.of(radii.len())
        );
        assert!((2..=most).contains(&count), "{output}");
        assert!(lines > 0 && radii.len() == count, "{output}");
        assert!(off(&places, tilt) < 0.0011, "{output}");
        // As printed: not a tenth of what a control lets pass (0.016 mm), and of a circle next to nothing.
        assert!(worst.of(radii.len()) < 5e-5, "{radii:?}");
        // What acts at the start or the end of a circle stays there.
        assert_eq!(
            (output.matches("M8").count(), output.matches("M9").count()),
            (1, 1)
        );
        // Each circle, and the polar block behind them, is about its own centre, with numbers one after the other.
        for (number, line) in output.lines().enumerate() {
            assert!(line.starts_with(&format!("{number} ")), "{output}");
        }
        assert!(output.contains(" L X"), "{output}");
    }
}

#[test]
fn as_lines_there_are_many_more_blocks() {
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    let (_, round) = corrected(GROOVE, 1.0, &writing);
    writing.arcs = Arcs::Lines;
    let (output, lines) = corrected(GROOVE, 1.0, &writing);
    assert!(!output.contains(" DR+"), "{output}");
    let [round, lines] = [round, lines].map(|written| written.pieces.len());
    println!("{round} pieces with arcs, {lines} without");
    assert!(lines > 4 * round, "{lines} and {round}");
}

#[test]
fn the_pole_of_blocks_behind_is_stated_again() {
    // The second circle is in air: what is left of it counts from the pole of the program.
    let text = "0 BEGIN PGM A MM\n1 L X+25 Y+0 Z-2 FMAX\n2 CC X+0 Y+0\n3 C X+0 Y+25 DR+ F600\n4 L Z+50 FMAX\n5 L X+60 Y+25 FMAX\n\
        6 C X-25 Y+60 DR+ F600\n7 CC Y+1\n8 L X+20 Y+1 FMAX\n9 C X-20 Y+1 DR-\n10 END PGM A MM\n";
    let program = program(text);
    let mut pieces = Vec::new();
    for (motion, centre) in [(1, [0.01, 0.02]), (6, [0.0, 1.03])] {
        let mut piece = Piece::to(
            motion,
            program.motions[motion].target.pose().unwrap().position_mm,
        );
        piece.centre_mm = Some(Vector3::new(centre[0], centre[1], 0.0));
        pieces.push(piece);
    }
    let output = super::written(&program, &pieces);
    let again = super::program(&output);
    let centre = |program: &RobotProgram, motion: usize| match &program.motions[motion].kind {
        MotionKind::Arc { centre_mm, .. } => centre_mm.xy(),
        kind => panic!("{kind:?}"),
    };
    // The kept circle is about the pole of the program, which stands before it again; the last is about X of before, Y of its own.
    assert_eq!(centre(&again, 4), centre(&program, 4));
    assert!(
        output.contains("CC X+0 Y+0\n8 C X-25 Y+60 DR+ F600\n"),
        "{output}"
    );
    assert!((centre(&again, 6) - centre(&program, 6)).norm() < 0.05);
    for motion in 0..program.motions.len() {
        let [a, b] = [&program, &again].map(|one| super::place(one, motion));
        assert!(
            Vector3::from(a).metric_distance(&Vector3::from(b)) < 1e-9,
            "{motion}"
        );
    }
}

#[test]
fn centres_are_refused_where_they_say_nothing() {
    let text = "BEGIN PGM A MM\nL X+25 Y+0 Z-2 FMAX\nL X+0 F600\nEND PGM A MM\n";
    let program = program(text);
    let mut piece = Piece::to(1, Vector3::new(0.0, 0.0, -2.0));
    piece.centre_mm = Some(Vector3::zeros());
    let error = write(&program, &[piece.clone()], &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 3: a piece goes about a centre, and its motion is no arc"),
        "{error}"
    );
    let ls = "MODULE M\nPROC main()\nMoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,fine,tool0;\nENDPROC\nENDMODULE\n";
    let rapid = read_rapid(vec![SourceFile::new("m.mod", ls)], &ReadOptions::default()).unwrap();
    piece.motion = 0;
    let error = write(&rapid, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("only Heidenhain programs"),
        "{error}"
    );
}

#[test]
fn shifted_mirrored_turned_scaled_and_inch_circles_are_corrected_as_they_are_programmed() {
    // The part leans and is a little too large.
    let by = |place: &Vector3<f64>| {
        Vector3::new(
            1e-3 * place.x + 0.02,
            1e-3 * place.y,
            2e-4 * place.x - 3e-4 * place.y,
        )
    };
    let mut writing = PathWriteOptions::default();
    writing.header = None;
    for setup in [
        "",
        "CYCL DEF 7.1 X+30\n",
        "CYCL DEF 8.1 X\n",
        "CYCL DEF 8.1 X Y\n",
        "CYCL DEF 8.1 Z\n",
        "CYCL DEF 10.1 ROT+30\n",
        "CYCL DEF 11.1 SCL 0.5\n",
    ] {
        for unit in ["MM", "INCH"] {
            let text = format!(
                "BEGIN PGM A {unit}\n{setup}L X+9 Y+0 Z-1 FMAX\nCC X+0 Y+0\nC X+0 Y+9 DR+ F400\nCR X+6 Y+15 R+6 DR-\nCT X+12 Y+9\n\
                 CC X+12 Y+12\nCP IPA+270 IZ-2 DR+\nC X+12 Y+9 DR-\nL Z+9 FMAX\nEND PGM A {unit}\n"
            );
            let (output, written) = corrected_by(&text, &by, &writing);
            let round = written.pieces.iter().filter(|piece| piece.circle.is_some());
            let (round, all) = (round.count(), written.pieces.len());
            assert!(
                round >= 5 && all <= 2 + 4 * 5 + round,
                "{round} of {all}: {output}"
            );
            assert!(output.matches(" DR").count() == round, "{output}");
        }
    }
}

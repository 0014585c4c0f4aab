//! Full circles whose ends were rounded apart are refused by line; circles that close, nearly full ones and short arcs are what they
//! say. One rule for Heidenhain, SINUMERIK and APT (and G-code, whose tests have it in all planes).

use std::f64::consts::TAU;

use kinetostat_formats::*;

/// A program that is at (20, 0, -1) and goes on an anticlockwise arc about the origin to a place.
fn program_of(language: Language, x: &str, y: &str) -> String {
    match language {
        Language::Heidenhain => format!(
            "BEGIN PGM A MM\nL X+20 Y+0 Z-1 R0 F600 M3\nCC X+0 Y+0\nC X{x} Y{y} DR+\nEND PGM A MM\n"
        ),
        Language::Siemens => {
            format!("G17 G90 G71 G94\n\nG1 X20 Y0 Z-1 F600\nG3 X{x} Y{y} I-20 J0\nM30\n")
        }
        _ => format!(
            "PAINT/PATH\nUNITS/MM\nGOTO/20.,0,-1\nCIRCLE/0,0,-1,0,0,-1,20\nGOTO/{x},{y},-1\nFINI\n"
        ),
    }
}

/// The angle of its arc, or what is wrong with which line.
fn turned(language: Language, x: &str, y: &str) -> Result<f64, (usize, String)> {
    let mut text = program_of(language, x, y);
    if language == Language::Apt {
        text = text.replace('+', "");
    }
    let files = vec![SourceFile::new("a", text)];
    let read = read(language, files, &ReadOptions::default());
    let program = read.map_err(|errors| (errors[0].line, errors[0].to_string()))?;
    match program.motions[1].kind {
        MotionKind::Arc {
            angle_rad, axis, ..
        } => Ok(angle_rad * axis.z),
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn a_circle_that_is_closed_but_for_a_rounding_is_refused_in_every_language() {
    for language in [Language::Heidenhain, Language::Siemens, Language::Apt] {
        for (x, y, apart) in [
            ("+20.003", "+0", "0.0030000"),
            ("+19.9999", "+0.0000", "0.0001000"),
            ("+20", "+0.001", "0.0010000"),
            ("+20.000", "+0.003", "0.0030000"),
            ("+19.998", "-0.000", "0.0020000"),
        ] {
            let (at, message) = turned(language, x, y).unwrap_err();
            let reason = format!(
                "the arc's ends are only {apart} mm apart: controllers disagree whether this is a full circle"
            );
            assert!(message.contains(&reason), "{language:?}: {message}");
            assert!(
                message.contains("end the circle exactly where it starts"),
                "{message}"
            );
            assert_eq!(at, 4, "{message}");
        }
    }
}

#[test]
fn closed_circles_nearly_full_ones_and_short_arcs_are_what_they_say() {
    for language in [Language::Heidenhain, Language::Siemens, Language::Apt] {
        for (x, y, angle) in [
            ("+20", "+0", TAU),
            ("+20.0", "+0.000", TAU),
            // A hair is missing to the full circle.
            ("+20", "-0.002", TAU - 1e-4),
            ("+20", "-0.1", TAU - 5e-3),
            // Short arcs: many last digits long.
            ("+20", "+0.01", 5e-4),
            ("+19.9999", "+0.0050", 2.5e-4),
        ] {
            let found = turned(language, x, y).unwrap();
            assert!(
                (found - angle).abs() < 1e-7,
                "{language:?} {x} {y}: {found}"
            );
        }
    }
}

#[test]
fn an_arc_whose_angle_is_stated_is_as_short_as_it_says() {
    let text = "BEGIN PGM A MM\nL X+20 Y+0 Z-1 R0 F600 M3\nCC X+0 Y+0\nCP IPA+0.002 DR+\nCP IPA+360 IZ-1 DR+\nEND PGM A MM\n";
    let program =
        read_heidenhain(vec![SourceFile::new("a.h", text)], &ReadOptions::default()).unwrap();
    let text =
        "G17 G90 G71 G94\nG1 X20 Y0 Z-1 F600\nG3 I-20 J0 AR=0.002\nG3 I=AC(0) J=AC(0)\nM30\n";
    let other = read_siemens(
        vec![SourceFile::new("a.mpf", text)],
        &ReadOptions::default(),
    );
    for program in [program, other.unwrap()] {
        let angles: Vec<f64> = (program.motions.iter())
            .filter_map(|motion| match motion.kind {
                MotionKind::Arc { angle_rad, .. } => Some(angle_rad.to_degrees()),
                _ => None,
            })
            .collect();
        assert_eq!(angles.len(), 2);
        assert!((angles[0] - 0.002).abs() < 1e-9 && (angles[1] - 360.0).abs() < 1e-9);
    }
}

//! Corrected along their paths, and read again.

use kinetostat_formats::*;
use kinetostat_program::{MoveKind, Request};
use nalgebra::Vector3;

use crate::correcting::written_and_checked;
use crate::paths::{corrected, real};
use crate::real_files::stated;

use super::{EVERYTHING, program};

#[test]
fn the_fixture_is_corrected_along_its_path() {
    for (name, text) in [
        ("a.h", EVERYTHING.to_owned()),
        ("crlf.h", EVERYTHING.replace('\n', "\r\n")),
        ("inch.h", EVERYTHING.replace(" MM\n", " INCH\n")),
    ] {
        let moves = corrected(Language::Heidenhain, name, text.as_bytes(), &stated());
        assert!(moves.is_ok_and(|moves| moves > 15), "{name}");
    }
}

#[test]
fn real_programs_are_corrected_along_their_paths() {
    real(Language::Heidenhain, "heidenhain", 8);
}

#[test]
fn rapids_are_known() {
    let program = program(EVERYTHING);
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let kinds: Vec<(usize, bool)> = (robot.path.moves.iter())
        .map(|one| (one.line, one.kind == MoveKind::Rapid))
        .collect();
    assert_eq!(
        kinds[..4],
        [(12, true), (13, true), (14, true), (15, false)]
    );
    let helix = robot.path.moves.iter().find(|one| one.line == 25).unwrap();
    let around = std::f64::consts::TAU * 12.5;
    assert!((helix.length_mm() - around.hypot(1.5)).abs() < 1e-9);
}

#[test]
fn a_bent_line_has_more_blocks_all_numbered_and_a_header() {
    let text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n2 L X+0 Y+0 Z+5 FMAX M3\n3 L X+200 F500\n4 L Y+10\n5 END PGM A MM\n";
    let program = program(text);
    let (options, making) = (ReadOptions::default(), PathOptions::default());
    let path = path_of(&program, &making).unwrap();
    let field = |request: &Request| {
        let x = request.position_mm.x / 100.0;
        Ok(Vector3::new(0.0, 0.0, 0.2 * x * x))
    };
    let writing = kinetostat_program::WriteOptions::default();
    let written =
        written_and_checked((&program, &path), (&options, &making), &field, &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    let lines: Vec<&str> = output.lines().collect();
    assert!(lines.len() > 10, "{output}");
    for (index, line) in lines.iter().enumerate() {
        assert!(line.starts_with(&format!("{index} ")), "{output}");
    }
    assert!(lines[1].starts_with("1 ; kinetostat"), "{output}");
}

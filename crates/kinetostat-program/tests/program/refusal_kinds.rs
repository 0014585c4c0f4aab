//! A refusal can be matched: each kind, with the line it names.

use kinetostat_program::{Program, ProgramErrorKind, ReadOptions, interpret};
use nalgebra::Vector3;

fn refused(text: &str) -> (ProgramErrorKind, usize) {
    let mut options = ReadOptions::default();
    options.start_position_mm = Some(Vector3::zeros());
    let error = match Program::read(text) {
        Err(error) => error,
        Ok(program) => interpret(&program, &options).expect_err(text),
    };
    (error.kind, error.line)
}

#[test]
fn every_kind_of_refusal_is_named() {
    use ProgramErrorKind::{Ambiguous, Arc, Malformed, UnknownCode};
    for (text, expected) in [
        ("G21 G90\nG1 X10 (open\n", (Malformed, 2)),
        ("G21 G90\nG1 X10 X20 F100\n", (Malformed, 2)),
        ("G21 G90\nG1 X10 F-3\n", (Malformed, 2)),
        ("G21 G90\nG1 X10 F100\nG188 P1\n", (UnknownCode, 3)),
        ("G1 X10 F100\nG20\n", (Ambiguous, 2)),
        ("G21 G90\nG93 G1 X10\n", (Ambiguous, 2)),
        ("G21 G90\nG2 X10 Y0 R1 F100\n", (Arc, 2)),
        ("G21 G90\nG2 X10 Y0 F100\n", (Arc, 2)),
    ] {
        assert_eq!(refused(text), expected, "{text}");
    }
}

#[test]
fn a_tool_that_is_not_named_is_a_kind_of_its_own() {
    let program = Program::read("G21 G90\nT7 M6\nG1 X10 F100\n").expect("words");
    let mut options = ReadOptions::default();
    options.start_position_mm = Some(Vector3::zeros());
    options.tools = Some(vec![1, 2]);
    let error = interpret(&program, &options).expect_err("tool 7 is not known");
    assert_eq!(error.kind, ProgramErrorKind::Tool);
}

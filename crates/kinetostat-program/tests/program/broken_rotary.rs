//! Programs of rotary axes that are refused: line and words of each.

use std::sync::Arc;

use kinetostat_program::{
    Carries, Program, ReadOptions, RotaryAxes, RotaryAxis, faults, interpret,
};
use nalgebra::{UnitQuaternion, Vector3};

/// A head about x that reaches from -30 to 60 degrees, above a table about z.
fn machine() -> ReadOptions {
    let mut options = ReadOptions::default();
    let axis = |letter, carries, direction, limits_deg| RotaryAxis {
        letter,
        carries,
        direction,
        point_mm: Vector3::zeros(),
        limits_deg,
    };
    options.rotary = Some(Arc::new(RotaryAxes {
        axes: vec![
            axis('A', Carries::Tool, Vector3::x_axis(), Some([-30.0, 60.0])),
            axis('C', Carries::Part, -Vector3::z_axis(), None),
        ],
        tool_at_zero: UnitQuaternion::identity(),
    }));
    options
}

const ANGLES: &str = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\n";
const VECTORS: &str = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.5 H1 Z50\n";

#[test]
fn broken_programs_are_refused_with_line_and_reason() {
    let begun = |begin: &str, more: &str| format!("{begin}{more}");
    let cases = [
        (
            "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG53 G0 C90\nG0 X0 Y0 Z50\nG1 X9 F100\n".to_owned(),
            5,
            "axis C was sent to a place of the machine (G53)",
        ),
        (
            begun(ANGLES, "G1 X9 B10 F100\n"),
            4,
            "axis B changes where the tool is",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50\nG43.4 H1 Z40\nG1 X9 F100\n".to_owned(),
            4,
            "where axis A stands is not stated",
        ),
        (
            begun(ANGLES, "G49\nG0 A10\nG1 X9 F100\n"),
            6,
            "axis A stands at 10 deg, and tool centre point control is off",
        ),
        (
            begun(ANGLES, "G49\nG0 A10\nG1 X9 A0 F100\n"),
            6,
            "axis A stands at 10 deg, and tool centre point control is off",
        ),
        (
            begun(ANGLES, "G49\nG0 X0 Y0 Z50\nG1 X9 C90 F100\n"),
            6,
            "axis C stands at 90 deg, and tool centre point control is off",
        ),
        (
            begun(ANGLES, "G95 F0.1\nG1 C90\n"),
            5,
            "feed per revolution",
        ),
        (begun(ANGLES, "G93\nG1 C90\n"), 5, "G93"),
        (
            begun(ANGLES, "G92 C0\n"),
            4,
            "another angle than the machine's",
        ),
        (
            begun(ANGLES, "G1 X9 C10 C20 F100\n"),
            4,
            "the letter C appears twice",
        ),
        (
            begun(ANGLES, "G1 X9 I1 F100\n"),
            4,
            "I appears in a straight move",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 P1\n".to_owned(),
            3,
            "tool posture control",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 P2\n".to_owned(),
            3,
            "P of tool centre point control is 0 or 1",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A0 C0\nG43.4 G43.5 H1\n".to_owned(),
            3,
            "meets another code of its group",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50\nG43.5 H1 Z50\n".to_owned(),
            3,
            "where axis A stands is not stated before G43.5",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A0 C0\nG43.5 H1 I0 J0 K1\n".to_owned(),
            3,
            "a direction stands in the block of G43.5",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A0 C0\nG43.5 H1 Q5\n".to_owned(),
            3,
            "Q leans the tool",
        ),
        (
            format!("{VECTORS}G1 X20 I0.3 J0 K1 Q5 F600\n"),
            4,
            "Q leans the tool",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\nG1 X20 A5 Q5 F600\n".to_owned(),
            4,
            "Q leans the tool",
        ),
        (
            begun(VECTORS, "G1 X9 I0 J0 K0 F100\n"),
            4,
            "the direction I, J, K has no length",
        ),
        (
            begun(VECTORS, "G1 X9 A10 F100\n"),
            4,
            "the angle of axis A under G43.5",
        ),
        (
            begun(VECTORS, "G17 G2 X9 I4.5 J0 F100\n"),
            4,
            "an arc under G43.5",
        ),
        (
            begun(VECTORS, "G1 X9 J-1 K0.3 F100\n"),
            4,
            "to point the tool along the direction",
        ),
        (begun(VECTORS, "G1 X9 K-1 F100\n"), 4, "A"),
        (
            begun(VECTORS, "G1 X9 R5 F100\n"),
            4,
            "R appears in a straight move",
        ),
        (
            begun(VECTORS, "G49\nG1 X9 J0.5 K1 F100\n"),
            5,
            "J appears in a straight move",
        ),
        (begun(ANGLES, "G1 X9 A F100\n"), 4, "A"),
        (begun(ANGLES, "G1 X9 AB10 F100\n"), 4, "A"),
    ];
    for (text, line, expected) in &cases {
        let found = match Program::read(text.clone()) {
            Ok(program) => match interpret(&program, &machine()) {
                Err(error) => error,
                Ok(_) => panic!("it is read: {text}"),
            },
            Err(error) => error,
        };
        assert_eq!(found.line, *line, "{found}\n{text}");
        assert!(
            found.to_string().contains(expected),
            "{expected}: {found}\n{text}"
        );
        assert!(!found.remedy.is_empty(), "{found}");
    }
    assert!(cases.len() >= 20);
}

/// Text of an angle that is no number, an origin of an axis that the machine lacks: all faults of a program in one run.
#[test]
fn all_faults_come_in_order_of_lines() {
    let text = format!("{VECTORS}G1 X9 I0 J0 K0 F100\nX12 A5\nX15 K1\nX18 B3\n");
    let all = faults(text, &machine());
    let lines: Vec<usize> = all.iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [4, 5, 7], "{all:?}");
}

/// Of the angles that point the tool in a direction those within the limits are taken, and the nearest are named where none are.
#[test]
fn limits_choose_the_angles() {
    let last = |text: &str| {
        let program = Program::read(format!("{VECTORS}{text}")).unwrap();
        let path = interpret(&program, &machine()).unwrap_or_else(|error| panic!("{error}"));
        let turn = path.moves.last().unwrap().tool_turn.clone().unwrap();
        turn.rotary.unwrap().end_deg
    };
    // Towards -y by 40 degrees: Rx(40) z; towards y it would be A-40, out of reach, and C180 A40 is taken.
    let down = last("G0 J-0.6427876097 K0.7660444431\n");
    assert!(
        (down[0] - 40.0).abs() < 1e-6 && down[1].abs() < 1e-6,
        "{down:?}"
    );
    let up = last("G0 J0.6427876097 K0.7660444431\n");
    assert!(
        (up[0] - 40.0).abs() < 1e-6 && (up[1].abs() - 180.0).abs() < 1e-6,
        "{up:?}"
    );
    let program = Program::read(format!(
        "{VECTORS}G1 X9 J-0.9396926208 K0.3420201433 F100\n"
    ));
    let error = interpret(&program.unwrap(), &machine()).unwrap_err();
    let said = error.to_string();
    assert!(said.contains("axis A would stand at 70.000 deg, and it reaches -30 to 60 deg (nearest angles: A70.000 C0.000)"), "{said}");
}

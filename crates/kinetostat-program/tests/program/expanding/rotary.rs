//! Rotary words of programs that are written flat, and the rotary origin of a work coordinate system: against blocks and angles
//! worked out by hand.

use std::sync::Arc;

use kinetostat_program::{
    Carries, ExpandOptions, NoSubprograms, OtherAxes, Path, Program, ProgramError, ReadOptions,
    RotaryAxes, RotaryAxis, expand, interpret,
};
use nalgebra::{UnitQuaternion, Vector3};

/// A cradle about x that carries a table about z.
fn trunnion() -> ReadOptions {
    let axis = |letter, direction| RotaryAxis {
        letter,
        carries: Carries::Part,
        direction,
        point_mm: Vector3::zeros(),
        limits_deg: None,
    };
    let mut options = ReadOptions::default();
    options.rotary = Some(Arc::new(RotaryAxes {
        axes: vec![axis('A', Vector3::x_axis()), axis('C', Vector3::z_axis())],
        tool_at_zero: UnitQuaternion::identity(),
    }));
    options
}

fn flat(text: &str) -> Result<String, ProgramError> {
    let mut options = ExpandOptions::default();
    options.reading.other_axes = OtherAxes::Carried;
    let made = expand(text, &options, &NoSubprograms)?;
    assert!(
        made.path.warnings.is_empty() && made.warnings.is_empty(),
        "{:?}",
        made.path.warnings
    );
    Ok(String::from_utf8(made.program.bytes().to_vec()).unwrap())
}

fn read(text: &str) -> Path {
    let program = Program::read(text).unwrap();
    interpret(&program, &trunnion()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A and C of the machine at the end of a move.
fn angles(path: &Path, line: usize) -> Vec<f64> {
    let motion = path
        .moves
        .iter()
        .find(|motion| motion.line == line)
        .unwrap();
    let turn = motion.tool_turn.as_ref().unwrap();
    turn.rotary.as_ref().unwrap().angles_deg(1.0)
}

#[test]
fn rotary_words_are_carried_to_the_flat_blocks() {
    let text = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\n#1 = 1\nO1 while [#1 LE 3]\nG1 X[10 * #1] A[15 * #1] C[-30 * #1] F600\nG91 C[5 * #1]\nG90\n#1 = [#1 + 1]\nO1 endwhile\nG49\nM30\n";
    let expected = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG43.4 H1 Z50\nG1 X10 A15 C-30 F600\nG91 C5\nG90\nG1 X20 A30 C-60 F600\nG91 C10\nG90\nG1 X30 A45 C-90 F600\nG91 C15\nG90\nG49\nM30\n";
    let made = flat(text).unwrap();
    assert_eq!(made, expected);
    let path = read(&made);
    for (line, wanted) in [(4, [15.0, -30.0]), (5, [15.0, -25.0]), (11, [45.0, -75.0])] {
        assert_eq!(angles(&path, line), wanted, "line {line}");
    }
}

#[test]
fn what_the_flat_program_would_mean_otherwise_is_refused() {
    for (text, line, expected) in [
        ("G21 G90\nG0 X0 Y0 Z5 U3\n", 2, "axis U"),
        (
            "G21 G90 F100\nG0 X0 Y0 Z5 C30\nG41.1 D6\nG1 X9 Y9\n",
            3,
            "axis C stands at 30 deg",
        ),
        (
            "G21 G90 F100\nG0 X0 Y0 Z5\nG43.4 H1 Z5\nG42.1 D6\nG1 X9 Y9\n",
            4,
            "G43.4",
        ),
        (
            "G21 G90\nG0 X0 Y0 Z5 C30\nG10 L20 P1 C0\n",
            3,
            "rotary axis",
        ),
    ] {
        let fault = flat(text).unwrap_err();
        assert_eq!(fault.line, line, "{fault}");
        assert!(fault.to_string().contains(expected), "{fault}");
    }
    // Without a word that carries them they are refused as ever.
    let plain = expand(
        "G21 G90\nG0 X0 A3\n",
        &ExpandOptions::default(),
        &NoSubprograms,
    );
    assert_eq!(plain.unwrap_err().line, 2);
}

#[test]
fn a_work_system_has_a_rotary_origin() {
    let text = "G21 G90 G94\nG0 X0 Y0 Z50 A0 C0\nG10 L2 P1 C30\nG10 L2 P2 A-5 C100\nG43.4 H1 Z50\nG1 X1 C0 F600\nG91 C10\nG90 G55 X2\nC0\nG54 C0 A7\n";
    for text in [text.to_owned(), flat(text).unwrap()] {
        let path = read(&text);
        // C0 of G54 is the machine's 30; C stays where it is when G55 comes.
        for (line, wanted) in [
            (6, [0.0, 30.0]),
            (7, [0.0, 40.0]),
            (8, [0.0, 40.0]),
            (9, [0.0, 100.0]),
            (10, [7.0, 30.0]),
        ] {
            assert_eq!(angles(&path, line), wanted, "line {line}\n{text}");
        }
        // Where a word begins is counted from the same origin.
        let back = path.moves.last().unwrap();
        let c = back.extra.iter().find(|extra| extra.letter == 'C').unwrap();
        assert_eq!((c.start, c.word), (Some(70.0), 0.0));
    }
    // At the machine's zero a cut needs no tool centre point control, and beside it one does.
    let at = |c: i32| format!("G21 G90 G94\nG10 L2 P1 C30\nG0 X0 Y0 Z5 A0 C{c}\nG1 X9 F100\n");
    assert_eq!(read(&at(-30)).moves.len(), 2);
    let program = Program::read(at(0)).unwrap();
    let fault = interpret(&program, &trunnion()).unwrap_err();
    assert!(
        fault.to_string().contains("axis C stands at 30 deg"),
        "{fault}"
    );
}

//! G10, G52, G92 and the parameters of offsets. The same program was compared with LinuxCNC's module (23 moves, 2e-15 mm).

use kinetostat_program::{
    Dialect, ExpandOptions, NoSubprograms, Program, ProgramError, expand, interpret,
};
use nalgebra::Vector3;

use super::refused;

fn options(dialect: Dialect) -> ExpandOptions {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    options.reading.machine_zero_mm = Some(Vector3::new(100.0, 200.0, 300.0));
    options.reading.work_offsets_mm[0] = Some(Vector3::new(110.0, 220.0, 330.0));
    options
}

/// Blocks behind the first two, and the ends of the moves in the part frame.
fn run(text: &str, dialect: Dialect) -> Result<(String, Vec<Vector3<f64>>), ProgramError> {
    let begin = "G21 G90 G17 F200\nG0 X1 Y2 Z3\n";
    let flat = expand(format!("{begin}{text}"), &options(dialect), &NoSubprograms)?;
    let bytes = String::from_utf8(flat.program.bytes().to_vec()).unwrap();
    let ends = flat.path.moves.iter().map(|motion| motion.end).collect();
    Ok((bytes.strip_prefix(begin).unwrap().to_owned(), ends))
}

#[test]
fn origins_that_the_program_states_are_followed() {
    let (text, ends) = run(
        "G10 L2 P1 X-5\nG0 X1 Y1\nG10 L2 P2 X1 Y2 Z3\nG55 G0 X0 Y0 Z0\n",
        Dialect::Undecided,
    )
    .unwrap();
    assert_eq!(
        text,
        "G10 L2 P1 X-5\nG0 X1 Y1\nG10 L2 P2 X1 Y2 Z3\nG55 G0 X0 Y0 Z0\n"
    );
    // The first move stands in G54 as it was: part = origin + word.
    assert_eq!(ends[0], Vector3::new(111.0, 222.0, 333.0));
    // X: machine zero 100, origin -5, word 1; Y: origin as it was.
    assert_eq!(ends[1], Vector3::new(96.0, 221.0, 333.0));
    assert_eq!(ends[2], Vector3::new(101.0, 202.0, 303.0));
}

#[test]
fn the_place_of_the_tool_as_the_reference_is_written_as_an_origin() {
    // In the machine the tool is at 11, 22, 33.
    let (text, ends) = run("G10 L20 P1 X0 Y2 Z-1\nG1 X0 Y2 Z-1\n", Dialect::LinuxCnc)
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(
        text.starts_with("G10 L2 P1 X11 Y20 Z34\nG1 X0 Y2 Z-1\n"),
        "{text}"
    );
    assert_eq!(ends[0], ends[1]);
}

#[test]
fn parameters_say_the_offsets() {
    let text = "G10 L2 P2 X7 Y8 Z9\nG0 X#5221 Y#5222 Z#5223\nG0 X#5241 Y#5242 Z#5243\nG0 X#5220 Y#5230\nG92 X5\nG0 X#5211\n";
    let (text, _) = run(text, Dialect::Undecided).unwrap();
    // G54 is at 10, 20, 30 in the machine; before G92 the tool is at 1, so that its offset is -4.
    assert!(
        text.ends_with("G0 X10 Y20 Z30\nG0 X7 Y8 Z9\nG0 X1 Y0\nG92 X5\nG0 X-4\n"),
        "{text}"
    );
    for number in [5211, 5221, 5241, 5161, 5399 - 9] {
        let error = refused(&format!("G21\nG0 X0 Y0 Z0\nG0 X#{number}\n"));
        assert!(
            error.reason.contains("kept by the controller") && error.line == 3,
            "{error}"
        );
    }
    let mut given = ExpandOptions::default();
    given.parameters.insert(5221, 4.5);
    let flat = expand("G21\nG0 X#5221 Y0 Z0\n", &given, &NoSubprograms).unwrap();
    assert_eq!(flat.program.bytes(), b"G21\nG0 X4.5 Y0 Z0\n");
}

#[test]
fn g52_of_linuxcnc_is_the_offset_of_g92() {
    let (text, ends) = run(
        "G52 X3 Y1\nG0 X0 Y0\nG0 Z#5211\nG52 X0\nG0 X0\nG92.1\nG0 X0 Y0\n",
        Dialect::LinuxCnc,
    )
    .unwrap();
    assert_eq!(
        text,
        "G92 X-2 Y1\nG0 X0 Y0\nG0 Z3\nG92 X3\nG0 X0\nG92.1\nG0 X0 Y0\n"
    );
    let xy: Vec<[f64; 2]> = ends[1..]
        .iter()
        .map(|end| [end.x - 110.0, end.y - 220.0])
        .collect();
    assert_eq!(xy, [[3.0, 1.0], [3.0, 1.0], [0.0, 1.0], [0.0, 0.0]]);
}

#[test]
fn a_tool_radius_that_the_program_states_is_used() {
    let text = "G10 L1 P3 R2.5\nG41 D3\nG1 X1 Y20\nG1 Y30\nG40\nG1 X0\n";
    let (text, _) = run(text, Dialect::Undecided).unwrap();
    assert!(text.contains("G1 X-1.5 Y20\n"), "{text}");
}

#[test]
fn what_controllers_read_differently_is_refused() {
    for (text, dialect, needle) in [
        (
            "G10 L2 P0 X1\n",
            Dialect::Undecided,
            "an offset of all systems to Fanuc",
        ),
        (
            "G10 L2 P0 X1\n",
            Dialect::Fanuc,
            "an offset of all systems to Fanuc",
        ),
        (
            "G91\nG10 L2 P1 X1\n",
            Dialect::Undecided,
            "adds to it on Fanuc",
        ),
        (
            "G10 L2 P1 R30\n",
            Dialect::LinuxCnc,
            "R turns the coordinates",
        ),
        ("G10 L2 P1.5 X1\n", Dialect::LinuxCnc, "names no system"),
        ("G10 L2 P1 X1 F3\n", Dialect::LinuxCnc, "other words"),
        ("G10 L50\n", Dialect::LinuxCnc, "only L1, L2"),
        ("G10 X1\n", Dialect::LinuxCnc, "only L1, L2"),
        (
            "G1 X9 G41.1 D2\nX20\nG10 L2 P1 X1\n",
            Dialect::LinuxCnc,
            "offsets are changed while",
        ),
    ] {
        let error = run(text, dialect).unwrap_err();
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
    // Nothing is known of the machine.
    let error = refused("G21\nG0 X0 Y0 Z0\nG10 L2 P1 X1\n");
    assert!(
        error.line == 3 && error.remedy.contains("machine-zero"),
        "{error}"
    );
    let error = refused("G21\nG0 X0 Y0 Z0\nG10 L20 P1 X1\n");
    assert!(
        error.line == 3 && error.reason.contains("reference"),
        "{error}"
    );
    // Read as it stands, without `expand`.
    let program = Program::read("G21\nG0 X0 Y0 Z0\nG10 L20 P1 X1\n").unwrap();
    let error = interpret(&program, &options(Dialect::Undecided).reading).unwrap_err();
    assert!(error.reason.contains("L20") && error.line == 3, "{error}");
}

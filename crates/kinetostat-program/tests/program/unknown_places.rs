//! Axes that the program sends to a place of the machine, or whose tool length it changes: unknown until they
//! are stated again.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;
use nalgebra::Vector3;

fn read(text: &str, reading: &ReadOptions) -> Result<(Program, Path), ProgramError> {
    let program = Program::read(text)?;
    let path = interpret(&program, reading)?;
    Ok((program, path))
}

/// Adds a quarter of a mm to X and Z.
fn written_with(text: &str, reading: &ReadOptions) -> (String, Corrected) {
    let (program, path) = read(text, reading).unwrap_or_else(|error| panic!("{text}\n{error}"));
    let field = |_: &Request| Ok(Vector3::new(0.25, 0.0, 0.25));
    let mut writing = WriteOptions::default();
    writing.header = None;
    let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
    let output = String::from_utf8(written.bytes.clone()).unwrap();
    verify_written(&program, &path, &written, reading, &writing)
        .unwrap_or_else(|error| panic!("{error}\n{output}"));
    verify_against_field(&path, &written, &field, &writing, &Unwatched).unwrap();
    (output, written)
}

fn written(text: &str) -> (String, Corrected) {
    written_with(text, &ReadOptions::default())
}

fn warned(written: &Corrected, part: &str) -> Vec<usize> {
    let warnings = written.accounting.warnings.iter();
    let found = warnings.filter(|warning| warning.text.contains(part));
    found.map(|warning| warning.line).collect()
}

#[test]
fn a_tool_length_before_the_first_move_changes_nothing() {
    let (output, _) = written(
        "G21 G90 G49\nT1 M6\nG43 H1\nG0 X0 Y0\nZ5\nG1 Z-1 F100\nG1 X10\nG0 Z5\nG49\nG0 X0\nM2\n",
    );
    assert_eq!(
        output,
        "G21 G90 G49\nT1 M6\nG43 H1\nG0 X0 Y0\nZ5.2500 X0.2500\nG1 Z-0.7500 F100\nG1 X10.2500\nG0 Z5.2500\nG49\nG0 X0\nM2\n"
    );
}

/// Of a length that is named again nothing changes; of another, or one that a change of tools may have changed, it does.
#[test]
fn the_same_length_once_more_changes_nothing() {
    for (again, same) in [
        ("G43 H1", true),
        ("T2 M6\nG43 H1", true),
        ("G43", false),
        ("G43 H2", false),
        ("G49\nG43 H1", false),
        ("G43.1 Z5\nG43 H1", false),
    ] {
        let text = format!("G21 G90\nG43 H1\nG0 X0 Y0 Z5\n{again}\nG1 Z-1 F100\n");
        let (_, path) = read(&text, &ReadOptions::default()).unwrap();
        let known = path.moves.last().unwrap().known;
        assert_eq!(known == Knowledge::Whole, same, "{text}");
        let warned = path
            .warnings
            .iter()
            .any(|one| one.text.contains("only its end is corrected"));
        assert_eq!(warned, !same, "{text}");
    }
    // Where the feed does not say where it ends, it cuts somewhere else.
    assert!(
        read(
            "G21 G90\nG0 X0 Y0 Z5\nG43 H2\nG1 X5 F100\n",
            &ReadOptions::default()
        )
        .is_err()
    );
}

/// CAM systems write rapids as feeds: the tool stays at the machine's height until the program states it.
#[test]
fn a_feed_at_a_height_of_the_machine_is_carried() {
    let (output, result) =
        written("G21 G90\nG0 X0 Y0 Z5\nG53 G0 Z0\nG1 X30 Y20 F5000\nG0 G43 Z15 H1\nG1 Z-1 F100\n");
    assert_eq!(
        output,
        "G21 G90\nG0 X0.2500 Y0 Z5.2500\nG53 G0 Z0\nG1 X30 Y20 F5000\nG0 G43 Z15.2500 X30.2500 H1\nG1 Z-0.7500 F100\n"
    );
    assert_eq!(warned(&result, "carried without a correction"), [4]);
}

#[test]
fn reference_points_at_the_end_and_between_tools_are_carried() {
    let text = "G21 G90\nT1 M6\nG43 H1\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX10\nG91 G28 Z0 M5\nT2 M6\nG90 G0 X20 Y5\nX30\nG43 H2 Z5\nG1 Z-1 F50\nG0 Z5\nG53 G0 Z0\nG0 G53 X-5 Y-5\nG28\nM30\n";
    let (output, result) = written(text);
    assert_eq!(
        output,
        "G21 G90\nT1 M6\nG43 H1\nG0 X0.2500 Y0 Z5.2500\nG1 Z-0.7500 F100\nX10.2500\nG91 G28 Z0 M5\nT2 M6\nG90 G0 X20 Y5\nX30\nG43 H2 Z5.2500 X30.2500\nG1 Z-0.7500 F50\nG0 Z5.2500\nG53 G0 Z0\nG0 G53 X-5 Y-5\nG28\nM30\n"
    );
    // One warning for both rapids between the two tools, and none for the rest.
    assert_eq!(warned(&result, "along Z is not known here"), [9]);
    assert_eq!(warned(&result, "so on lines 9 and 10"), [9]);
    assert_eq!(warned(&result, "known"), [9]);
}

/// A correction that was in force when the place was lost is taken out where an axis is named, and never added to.
#[test]
fn increments_from_an_unknown_place_keep_no_correction() {
    let mut reading = ReadOptions::default();
    reading.start_position_mm = Some(Vector3::zeros());
    let text = "G21 G90\nG1 X10 F100\nG28 Z5\nG91\nG0 X5\nX5 Z1\nY2\nG90\nG0 Z5\n";
    let (output, result) = written_with(text, &reading);
    assert_eq!(
        output,
        "G21 G90\nG1 X0.2500 Z0.2500 F100\nX10.2500\nG28 Z5\nG91\nG0 X4.7500\nX5 Z1\nY2\nG90\nG0 Z5.2500 X20.2500\n"
    );
    // The height that only the machine knows stays as it is, too.
    let text = "G21 G90\nG0 X10 Y0 Z5\nG43 H1\nG91\nG0 Z5\nZ5\nX1\nG90\n";
    let (output, _) = written(text);
    assert_eq!(
        output,
        "G21 G90\nG0 X10.2500 Y0 Z5.2500\nG43 H1\nG91\nG0 Z4.7500\nZ5\nX0.7500\nG90\n"
    );
    // What was tampered with is seen.
    let bytes = String::from_utf8(result.bytes.clone()).unwrap();
    for (right, wrong) in [("X4.7500", "X5"), ("G28 Z5", "G28 Z6"), ("Y2", "Y2.25")] {
        let text = "G21 G90\nG1 X10 F100\nG28 Z5\nG91\nG0 X5\nX5 Z1\nY2\nG90\nG0 Z5\n";
        let (program, path) = read(text, &reading).unwrap();
        let mut changed = result.clone();
        changed.bytes = bytes.replacen(right, wrong, 1).into_bytes();
        changed.accounting.bytes_out = changed.bytes.len();
        let mut writing = WriteOptions::default();
        writing.header = None;
        let found = verify_written(&program, &path, &changed, &reading, &writing);
        assert!(found.is_err(), "{wrong}");
    }
}

#[test]
fn a_position_offset_at_a_corrected_place_is_right_where_an_axis_is_unknown() {
    let text =
        "G21 G90\nG0 X0 Y0 Z5\nG0 X10\nG92 X0\nG43 H1\nG0 X5\nG1 F100\nG0 Z5\nG92.1\nG0 Z6\nX7\n";
    let (output, _) = written(text);
    // The output's zero of X is at 10.25 mm, so X4.75 is 15 mm; with a correction it is X5.
    assert_eq!(
        output,
        "G21 G90\nG0 X0.2500 Y0 Z5.2500\nG0 X10.2500\nG92 X0\nG43 H1\nG0 X4.7500\nG1 F100\nG0 Z5.2500 X5.0000\nG92.1\nG0 Z6.2500\nX7.2500\n"
    );
}

#[test]
fn with_the_places_of_the_machine_a_cut_may_follow() {
    let mut reading = ReadOptions::default();
    reading.machine_zero_mm = Some(Vector3::new(-100.0, -50.0, 200.0));
    reading.reference_points_mm = [
        Some(Vector3::new(1.0, 2.0, -3.0)),
        Some(Vector3::new(0.0, 0.0, -20.0)),
    ];
    let text = "G21 G90\nG0 X0 Y0 Z5\nG53 G0 Z-90\nG1 X10 Z5 F100\nG20\nG53 G0 X1\nG21\nG91 G28 Y0\nG90\nG30 Z50\nG0 X4\n";
    let (program, path) = read(text, &reading).unwrap();
    let ends: Vec<[f64; 3]> = path.moves.iter().map(|m| m.end.into()).collect();
    assert_eq!(
        ends,
        [
            [0.0, 0.0, 5.0],
            [0.0, 0.0, 110.0],
            [10.0, 0.0, 5.0],
            // An inch from the machine's zero.
            [-74.6, 0.0, 5.0],
            [-74.6, -48.0, 5.0],
            [-74.6, -48.0, 180.0],
            [4.0, -48.0, 180.0],
        ]
    );
    let known: Vec<Knowledge> = path.moves.iter().map(|m| m.known).collect();
    use Knowledge::{End, Nothing, Whole};
    assert_eq!(
        known,
        [End, Nothing, Whole, Nothing, Nothing, Nothing, Whole]
    );
    assert!(program.line_count() == 11);
    // The cut begins where the machine is, which is no corrected place, with a step to one.
    let (output, _) = written_with(text, &reading);
    assert_eq!(
        output,
        "G21 G90\nG0 X0.2500 Y0 Z5.2500\nG53 G0 Z-90\nG1 X0.2500 Z110.2500 F100\nX10.2500 Z5.2500\nG20\nG53 G0 X1\nG21\nG91 G28 Y0\nG90\nG30 Z50\nG0 X4.2500 Z180.2500\n"
    );
    // Of the third and fourth point, of letters alone, and with a tool's length nothing is known.
    for block in ["G30 P3 Z5", "G28 Z", "G43 H1 G0 Z5\nG28 Z5"] {
        let text = format!("G21 G90\nG0 X0 Y0 Z5\n{block}\nG2 X5 I2.5 F100\n");
        let error = read(&text, &reading).expect_err(block);
        assert!(
            error
                .reason
                .contains("sent the tool to a place of the machine"),
            "{error}"
        );
    }
    assert!(read("G21 G90\nG0 X0 Y0 Z5\nG30 P2 Z5\nG1 Z-1 F100\n", &reading).is_ok());
}

/// LinuxCNC dwells, then moves.
#[test]
fn a_dwell_in_the_block_of_a_straight_move_is_made_before_it() {
    let (output, _) = written("G21 G90\nG0 X0 Y0 Z0\nG4 P.5 G0 X5\nG1 P2 G4 X9 F100 S50\n");
    assert_eq!(
        output,
        "G21 G90\nG0 X0.2500 Y0 Z0.2500\nG4 P.5 G0 X5.2500\nG1 P2 G4 X9.2500 F100 S50\n"
    );
    let text = "G21 G90\nG0 X0 Y0 Z0\nG4 P2 G1 X100 F100\n";
    let (program, path) = read(text, &ReadOptions::default()).unwrap();
    assert_eq!(path.pauses[0].kind, PauseKind::Dwell(2.0));
    let bend = |request: &Request| {
        Ok(Vector3::new(
            0.0,
            0.0,
            1e-5 * request.position_mm.norm_squared(),
        ))
    };
    let writing = WriteOptions::default();
    let written = write_corrected(&program, &path, &bend, &writing, &Unwatched).unwrap();
    verify_written(&program, &path, &written, &ReadOptions::default(), &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    assert!(output.lines().count() > 6, "{output}");
    assert_eq!(output.matches("G4").count(), 1, "{output}");
}

#[test]
fn a_program_that_names_its_units_before_it_moves_is_read_in_its_own() {
    let mut reading = ReadOptions::default();
    reading.units = Some(Units::Millimetres);
    for text in [
        "g20 f60\ng1 x1\n",
        "G20\nF60\nG1 X1\n",
        "(inch)\nG90\nG20 G1 X1 F60\n",
    ] {
        let (_, path) = read(text, &reading).unwrap();
        assert_eq!(path.moves[0].end.x, 25.4, "{text}");
        assert_eq!(path.moves[0].feed.unwrap().value, 60.0 * 25.4, "{text}");
        let warnings = path.warnings.iter();
        let named =
            warnings.filter(|warning| warning.text.contains("names its units before it moves"));
        let line = text.lines().position(|line| line.contains("20")).unwrap() + 1;
        assert_eq!(
            named.map(|warning| warning.line).collect::<Vec<_>>(),
            [line]
        );
    }
    // The same units are no news, and after a move the program changes its units.
    let (_, path) = read("G21\nG1 X1 F60\n", &reading).unwrap();
    assert!(
        !path
            .warnings
            .iter()
            .any(|w| w.text.contains("names its units"))
    );
    let (_, path) = read("G1 X1 F60\nG20\nG1 X1 F60\n", &reading).unwrap();
    assert_eq!(path.moves[0].end.x, 1.0);
    assert!(
        !path
            .warnings
            .iter()
            .any(|w| w.text.contains("names its units"))
    );
    let error = read("G1 X1 F60\nG20\nG1 X2\n", &reading).unwrap_err();
    assert!(error.reason.contains("named after the F"), "{error}");
    // An F before the units is one of the units before.
    let error = read("F60\nG20\nG1 X1\n", &reading).unwrap_err();
    assert!(error.reason.contains("named after the F"), "{error}");
}

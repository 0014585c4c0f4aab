//! Cycles as Fanuc runs them: rigid taps, words without a place, G80 beside a move, a start below R, points of numbers.

use kinetostat_program::{
    Dialect, ExpandOptions, Expanded, Knowledge, MoveKind, NoSubprograms, Program, ReadOptions,
    Request, Unwatched, WriteOptions, expand, interpret, verify_written, write_corrected,
};
use nalgebra::Vector3;

use super::fanuc::{BEGIN, fanuc, run};

fn warned(text: &str, dialect: Dialect) -> Vec<(usize, String)> {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    let made: Expanded = expand(format!("{BEGIN}{text}"), &options, &NoSubprograms).unwrap();
    let warnings = made.warnings.into_iter();
    warnings.map(|one| (one.line, one.text)).collect()
}

/// No motion may stand between M29 and its tap; behind G80 the mode of the return is the program's again.
#[test]
fn a_rigid_tap_stays_as_it_is_written() {
    for (text, expected) in [
        (
            "G99 M3 S500\nM29 S500\nG84 X1. Z-3. R1. P0 F500\nX2.\nG80\nX3.\n",
            "G99 M3 S500\nF500\nG0 X1\nG0 Z1\nM29 S500\nG99 G84 Z-3. R1. P0\nG80 G99\nG0 X2\nM29 S500\nG99 G84 Z-3. R1. P0\nG80 G99\nG80\nG0 X3.\n",
        ),
        (
            "G98 M3 S500\nG95 G84 X1. Z-3.5 R1. F1.5 M29 S300\n",
            "G98 M3 S500\nG95 F1.5\nG0 X1\nG0 Z1\nM29 S300\nG99 G84 Z-3.5 R1.\nG80 G98\nG0 Z15\n",
        ),
        (
            "M29 S500\nG74 X1. Z-3. R1. F500\n",
            "F500\nG0 X1\nG0 Z1\nM29 S500\nG99 G74 Z-3. R1.\nG80 G98\nG0 Z15\n",
        ),
        ("/M29 S500\nG0 X1.\n", "/M29 S500\nG0 X1.\n"),
    ] {
        assert_eq!(fanuc(text), expected);
        if text.contains("G84") || text.contains("G74") {
            let error = run(text, Dialect::Undecided).unwrap_err();
            assert!(
                error.reason.contains("rigid tapping") || error.reason.contains("G98"),
                "{error}"
            );
        }
    }
    for (text, needle) in [
        ("G98 M29 S5\nG91 G84 X1. Z-3. R-1. F5\n", "places along Z"),
        ("G98 M29 S5\nG52 Z1.\nG84 X1. Z-3. R1. F5\n", "shifted"),
    ] {
        let error = run(text, Dialect::Fanuc).unwrap_err();
        assert!(error.reason.contains(needle), "{error}");
    }
    // G80 ends it.
    let text = "G99 M3 S500\nM29 S500\nG80\nG84 X1. Z-3. R1. F500\n";
    assert!(run(text, Dialect::Fanuc).is_ok());
}

#[test]
fn r_without_a_place_drills_once_more_on_fanuc() {
    let hole = "G1 Z-3\nG0 Z";
    let begin = "G99 G81 X1. Z-3. R1. F100\n";
    let made = fanuc(&format!("{begin}R3.\nX2.\n"));
    // From R1 to R3, which stays for the next hole.
    assert_eq!(
        made,
        format!("G99 F100\nG0 X1\nG0 Z1\n{hole}1\nG0 Z3\n{hole}3\nG0 X2\n{hole}3\n")
    );
    let error = run(&format!("{begin}R3.\n"), Dialect::Undecided).unwrap_err();
    assert!(error.reason.contains("Fanuc drills once more"), "{error}");
    // "R word with no g code that uses it", says LinuxCNC.
    for word in ["R3.", "Q1.", "P1"] {
        let error = run(&format!("{begin}{word}\n"), Dialect::LinuxCnc).unwrap_err();
        assert!(error.reason.contains("LinuxCNC refuses"), "{error}");
    }
    // Words that make no hole are not kept, and none stands bare in the flat program.
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        let made = run(&format!("{begin}Q2. P100\nI1. F50 M8\nX2.\n"), dialect).unwrap();
        assert!(
            made.ends_with(&format!("F50 M8\nG0 X2\n{hole}1\n")),
            "{made}"
        );
        assert!(!made.contains(['Q', 'P', 'I']), "{made}");
        let error = run(&format!("{begin}A90.\n"), dialect).unwrap_err();
        assert!(
            error.reason.contains("moves no axis but X, Y, Z"),
            "{error}"
        );
    }
    // P of a dwell, and places of other codes, are none of the cycle's.
    let made = fanuc(&format!("{begin}G4 P100\nG68 X0 Y0 R90.\nG0 X5. Y0\n"));
    assert_eq!(made.matches(hole).count(), 1, "{made}");
    assert!(made.ends_with("G0 X0 Y5\n"), "{made}");
    let made = fanuc(&format!("{begin}G50.1 X0\n"));
    assert_eq!(made.matches(hole).count(), 1, "{made}");
}

#[test]
fn g80_and_a_move_in_one_block() {
    let begin = "G99 G81 X1. Z-3. R1. F100\n";
    for block in ["G0 G80 Z50.", "G80 G0 Z50.", "N7 G0 G80 Z50. M9"] {
        let made = fanuc(&format!("{begin}{block}\nX5.\n"));
        assert_eq!(made.matches("G1 Z-3").count(), 1, "{made}");
        assert!(made.ends_with("\nX5.\n"), "{made}");
        let last = made.lines().rev().nth(1).unwrap();
        assert!(last.contains("G0") && last.contains("Z50."), "{made}");
    }
    // LinuxCNC lets G80 stand beside any code of motion, and takes the other one.
    for dialect in [Dialect::LinuxCnc, Dialect::Undecided] {
        let made = run(&format!("{begin}G80 G0 Z50.\nX5.\n"), dialect).unwrap();
        assert!(made.ends_with("\nG80 G0 Z50.\nX5.\n"), "{made}");
        assert_eq!(made.matches("G1 Z-3").count(), 1, "{made}");
    }
    for block in [
        "G80 G81 X1. Z-3. R1.",
        "G81 G80 X1. Z-3. R1.",
        "G0 G80 G1 Z50.",
    ] {
        assert!(
            run(&format!("G99 F100\n{block}\n"), Dialect::Fanuc).is_err(),
            "{block}"
        );
    }
}

#[test]
fn from_below_fanuc_goes_over_the_hole_first() {
    let begin = "G0 Z0\nG99 G81 X4. Y5. Z-3. R2. F100\nX6.\n";
    assert_eq!(
        fanuc(begin),
        "G0 Z0\nG99 F100\nG0 X4 Y5\nG0 Z2\nG1 Z-3\nG0 Z2\nG0 X6\nG1 Z-3\nG0 Z2\n"
    );
    let linuxcnc = run(begin, Dialect::LinuxCnc).unwrap();
    assert!(linuxcnc.contains("F100\nG0 Z2\nG0 X4 Y5\n"), "{linuxcnc}");
    let error = run(&begin.replace("G99", "G98"), Dialect::Fanuc).unwrap_err();
    assert!(error.reason.contains("below its retract level"), "{error}");
}

#[test]
fn what_rests_on_parameters_of_the_control_is_warned_of_once() {
    let pecks = "G99 G83 X1. Z-9. R1. Q2. F100\nX2.\nG73 X3. Z-9. R1. Q2.\nG80\n";
    let warnings = warned(pecks, Dialect::Fanuc);
    let found = warnings.iter().filter(|one| one.1.contains("5114"));
    assert_eq!(found.count(), 1);
    assert!(
        !warned(pecks, Dialect::LinuxCnc)
            .iter()
            .any(|one| one.1.contains("5114"))
    );

    let points = |text: &str, dialect| {
        let all = warned(text, dialect).into_iter();
        let mut own = all.filter(|one| one.1.contains("decimal point"));
        let first = own.next();
        assert!(own.next().is_none());
        first
    };
    // The third line is the first, and three lines have such numbers.
    let text = "G1 X5. Y0 F100\nX5000\nG4 P500\nG0 X1. Z2\nG4 X1000\n";
    let (line, said) = points(text, Dialect::Fanuc).unwrap();
    assert_eq!(line, 2);
    assert!(said.contains("calculator type"), "{said}");
    assert!(said.ends_with("so on lines 2, 4, 6 and 7"), "{said}");
    assert_eq!(points(text, Dialect::LinuxCnc), None);
    assert_eq!(points(text, Dialect::Undecided), None);
}

#[test]
fn a_slash_with_a_number_is_a_block_to_skip() {
    let text = "/2 G1 X7. F100\n/3 #1=4.\n/9 N5 Y#1\n/1 GOTO 8\nX9.\nN8 Z1.\n";
    assert_eq!(fanuc(text), "G1 X7. F100\nN5 Y4\nN8 Z1.\n");
    let warnings = warned(text, Dialect::Fanuc);
    let found = warnings
        .iter()
        .filter(|one| one.1.contains("marked with /"));
    assert_eq!(found.count(), 1, "{warnings:?}");
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    options.reading.block_delete = kinetostat_program::BlockDelete::Skip;
    let made = expand(format!("{BEGIN}{text}"), &options, &NoSubprograms).unwrap();
    let skipped = "X9.\nN8 Z1.\n";
    assert!(made.program.bytes().ends_with(skipped.as_bytes()));
    assert!(!String::from_utf8_lossy(made.program.bytes()).contains("X7"));
    for dialect in [Dialect::Undecided, Dialect::LinuxCnc] {
        for line in ["/2 G1 X7. F100", "/1 GOTO 8", "/1 #1=3"] {
            let error = run(&format!("{line}\n"), dialect).unwrap_err();
            assert!(error.reason.contains("number behind /"), "{error}");
        }
    }
    for line in ["/0 G1 X7. F100", "/12 G1 X7. F100", "/2. G1 X7. F100"] {
        assert!(run(&format!("{line}\n"), Dialect::Fanuc).is_err(), "{line}");
    }
}

#[test]
fn drilling_data_hold_for_the_next_cycle_until_g80() {
    let begin = "G99 G81 X1. Z-3. R1. F100\n";
    let made = fanuc(&format!("{begin}G82 X2. P500\nG83 X3. Q2.\nG81 X4. Z-5.\n"));
    // R and the depth of the first, at each of them.
    for place in ["G0 X2\nG1 Z-3\n", "G0 X4\nG1 Z-5\nG0 Z1\n"] {
        assert!(made.contains(place), "{place}: {made}");
    }
    assert!(made.contains("G0 X3\nG1 Z-1\n"), "{made}");
    let error = run(&format!("{begin}G80\nG82 X2. P500\n"), Dialect::Fanuc).unwrap_err();
    assert!(error.reason.contains("no retract level"), "{error}");
    let error = run(&format!("{begin}G82 X2. P500\n"), Dialect::LinuxCnc).unwrap_err();
    assert!(error.reason.contains("no retract level"), "{error}");
}

#[test]
fn borings_that_only_the_control_makes_stay_as_they_are_written() {
    let boring = |words: &str| fanuc(&format!("G98 M3 S500\n{words} F100\n"));
    assert_eq!(
        boring("G87 X1. Z-3. R-8. Q1."),
        "G98 M3 S500\nF100\nG0 X1\nG98 G87 Z-3. R-8. Q1.\nG80 G98\n"
    );
    assert_eq!(
        boring("G76 X1. Z-3. R2. Q0.1 P200"),
        "G98 M3 S500\nF100\nG0 X1\nG0 Z2\nG99 G76 Z-3. R2. Q0.1 P200\nG80 G98\nG0 Z15\n"
    );
    assert_eq!(
        boring("G88 X1. Z-3. R2."),
        "G98 M3 S500\nF100\nG0 X1\nG0 Z2\nG99 G88 Z-3. R2.\nG80 G98\nG0 Z15\n"
    );
    let error = run("G99 M3 S5\nG87 X1. Z-3. R-8. F1\n", Dialect::Fanuc).unwrap_err();
    assert!(error.reason.contains("bores from the back"), "{error}");
    // Only in this form, and only for Fanuc: what is read as it stands is refused, as every canned cycle.
    let text = "G21 G90\nG0 X0 Y0 Z5\nG99 G76 Z-3. R1. F100\nG80\n";
    let mut reading = ReadOptions::default();
    let read =
        |text: &str, reading: &ReadOptions| interpret(&Program::read(text).unwrap(), reading);
    let error = read(text, &reading).unwrap_err();
    assert!(error.reason.contains("canned cycle"), "{error}");
    reading.of_fanuc_run = true;
    let path = read(text, &reading).unwrap();
    assert_eq!(
        (path.moves[1].kind, path.moves[1].known),
        (MoveKind::Feed, Knowledge::Nothing)
    );
    assert_eq!(path.moves[1].end.z, 1.0);
    assert!(
        path.warnings
            .iter()
            .any(|one| one.line == 3 && one.text.contains("G76 stays as it is written"))
    );
    for other in ["G76", "G99 G76 X1.", "G98 G76", "G0 G99 G76", "G99 G76 G84"] {
        let text = text.replace("G99 G76", other);
        assert!(read(&text, &reading).is_err(), "{text}");
    }
}

/// The tool goes to the corrected place over the hole, and behind the cycle it is at the level R.
#[test]
fn a_cycle_as_it_is_written_among_corrected_moves() {
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    let text = format!("{BEGIN}M29 S500\nG84 X9. Y8. Z-3. R1. F500\nG80\nG1 X20.\n");
    let made = expand(text, &options, &NoSubprograms).unwrap();
    options.reading.of_fanuc_run = true;
    let mut writing = WriteOptions::default();
    writing.header = None;
    let field = |_: &Request| Ok(Vector3::new(0.25, 0.0, 0.5));
    let path = interpret(&made.program, &options.reading).unwrap();
    let written = write_corrected(&made.program, &path, &field, &writing, &Unwatched).unwrap();
    verify_written(&made.program, &path, &written, &options.reading, &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    assert!(
        output.ends_with("G0 X9.2500 Y8\nG0 Z1.5000\nM29 S500\nG99 G84 Z-3. R1.\nG80 G98\nG0 Z15.5000\nG80\nG1 X20.2500\n"),
        "{output}"
    );
}

/// Settings of the control and work coordinate systems have words of their own, which are none of the cycle.
#[test]
fn settings_and_additional_systems_beside_a_cycle() {
    let begin = "G99 G81 X1. Z-3. R1. F100\n";
    for dialect in [Dialect::Fanuc, Dialect::Undecided] {
        for setting in [
            "G5.1 Q1",
            "G05 P10000",
            "G103 P1",
            "G187 P3",
            "G54.1 P2",
            "G154 P2",
        ] {
            let made = run(&format!("{begin}{setting}\nX5.\n"), dialect).unwrap();
            assert!(made.contains(&format!("\n{setting}\n")), "{made}");
            assert_eq!(made.matches("G1 Z-3").count(), 2, "{made}");
        }
        let made = run(&format!("{begin}G54.1 P2 X5. (there)\n"), dialect).unwrap();
        assert!(made.contains("P2 G54.1 (there)\nG0 X5\n"), "{made}");
    }
}

/// The places of the holes and their bottoms.
fn holes(text: &str, dialect: Dialect) -> Vec<[f64; 2]> {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    let made = expand(format!("{BEGIN}{text}"), &options, &NoSubprograms).unwrap();
    let feeds = made
        .path
        .moves
        .iter()
        .filter(|one| one.kind == MoveKind::Feed);
    feeds.map(|one| [one.end.x, one.end.z]).collect()
}

/// Its levels hold for all that follows, also where G90 and G91 change between its holes.
#[test]
fn the_levels_of_a_row_outlast_the_distance_mode() {
    // The start is at Z15, so R is at 3 and the bottom at -1.
    let row = "G99 G91 G81 X10. Z-4. R-12. F100\nX10.\nG90 X30.\nX40.\nG98 X50.\nG91\nX10.\nX10.\nG90 X80. R5.\nX90.\nG80\n";
    let expected: Vec<[f64; 2]> = (1..10).map(|n| [f64::from(n) * 10.0, -1.0]).collect();
    assert_eq!(holes(row, Dialect::Fanuc), expected);
    let made = fanuc(row);
    assert!(
        made.contains("G0 X30\nG1 Z-1\nG0 Z3\nG0 X40\nG1 Z-1\nG0 Z3\n"),
        "{made}"
    );
    assert!(
        made.ends_with("G0 X90\nG0 Z5\nG1 Z-1\nG0 Z15\nG80\n"),
        "{made}"
    );
    // Another cycle takes them over.
    let other = "G99 G91 G81 X10. Z-4. R-12. F100\nG90 G82 X20. P1\nX30.\nG91 G81 X10. K2\n";
    let expected: Vec<[f64; 2]> = (1..6).map(|n| [f64::from(n) * 10.0, -1.0]).collect();
    assert_eq!(holes(other, Dialect::Fanuc), expected);
}

/// G80 is of another group than G0 to G3 (B-64304EN, list of G codes): what was in force before the cycle is so behind it.
#[test]
fn behind_g80_the_move_before_the_cycle_holds_on_fanuc() {
    let hole = "G99 G81 X1. Z-3. R1. F100\nX2.\n";
    for (text, expected) in [
        (format!("{hole}G80\nZ15.\nX5.\n"), "\nG80\nG0 Z15.\nX5.\n"),
        (
            format!("{hole}N7 G80 X5. Y6.\nX7.\n"),
            "\nN7 G0 G80 X5. Y6.\nX7.\n",
        ),
        (
            format!("G1 Z9.\n{hole}G80 M9\nG80\nN8 Z15.\n"),
            "\nG80 M9\nG80\nN8 G1 Z15.\n",
        ),
        (
            format!("{hole}G80\nG91 G28 Z0\nG90 X5.\n"),
            "\nG91 G28 Z0\nG0 G90 X5.\n",
        ),
        (format!("{hole}G80\nG43 H1 Z9.\n"), "\nG0 G43 H1 Z9.\n"),
        (
            format!("G1 Z9.\n{hole}G80\nG0 Z15.\nX3.\n"),
            "\nG80\nG0 Z15.\nX3.\n",
        ),
        (
            format!("G1 Z9.\n{hole}G80\n{hole}G80\nZ15.\n"),
            "\nG80\nG1 Z15.\n",
        ),
        ("G1 Z9.\nG80\nX4.\n".to_owned(), "\nG80\nG1 X4.\n"),
    ] {
        let made = fanuc(&text);
        assert!(made.ends_with(expected), "{made}");
        for dialect in [Dialect::LinuxCnc, Dialect::Undecided] {
            if let Err(error) = run(&text, dialect) {
                assert!(error.remedy.contains("--dialect fanuc"), "{error}");
            } else {
                assert!(text.contains("G0 Z15."), "{text}");
            }
        }
    }
    // Which of them a controller begins with is a parameter of it.
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    let error = expand("G21 G90 G80\nZ15. F9\n", &options, &NoSubprograms).unwrap_err();
    assert!(error.reason.contains("without a motion word"), "{error}");
}

/// As it stands it is refused, and what the message says helps.
#[test]
fn what_the_expansion_follows_is_refused_with_its_name() {
    for word in [
        "G81 X1 Z-3 R1",
        "G73 X1 Z-3 R1 Q1",
        "G41 D1",
        "G68 X0 Y0 R5",
        "G51 X0 P2.",
    ] {
        let program = Program::read(format!("{BEGIN}{word}\n")).unwrap();
        let error = interpret(&program, &ReadOptions::default()).unwrap_err();
        assert!(error.remedy.contains("--expand"), "{error}");
    }
}

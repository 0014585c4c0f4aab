//! How corrected programs look: what is kept, what is added, and where. What becomes of a block that is divided is in
//! `divided_blocks`.

use kinetostat_program::*;
use nalgebra::Vector3;
use std::sync::atomic::{AtomicUsize, Ordering};

pub fn bare() -> WriteOptions {
    let mut writing = WriteOptions::default();
    writing.header = None;
    writing
}

/// With straight pieces in place of arcs.
pub fn straight() -> WriteOptions {
    let mut writing = bare();
    writing.arcs = Arcs::Lines;
    writing
}

pub fn at_origin() -> ReadOptions {
    let mut reading = ReadOptions::default();
    reading.start_position_mm = Some(Vector3::zeros());
    reading.other_axes = OtherAxes::StandStill;
    reading
}

/// Writes, checks the promises, and returns the text with the whole result.
pub fn written_with(
    text: &str,
    field: &dyn CorrectionField,
    reading: &ReadOptions,
    writing: &WriteOptions,
) -> (String, Corrected) {
    let program = Program::read(text).unwrap();
    let path = interpret(&program, reading).unwrap();
    let written = write_corrected(&program, &path, field, writing, &Unwatched).unwrap();
    let output = String::from_utf8_lossy(&written.bytes).into_owned();
    verify_written(&program, &path, &written, reading, writing)
        .unwrap_or_else(|error| panic!("{error}\n{output}"));
    (output, written)
}

pub fn written(text: &str, field: &dyn CorrectionField) -> String {
    written_with(text, field, &at_origin(), &bare()).0
}

/// 0.01 mm in x everywhere.
fn shift(_: &Request) -> Result<Vector3<f64>, FieldFailure> {
    Ok(Vector3::new(0.01, 0.0, 0.0))
}

/// Bends z by 1 um at 10 mm, 100 um at 100 mm.
pub fn bend(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    Ok(Vector3::new(0.0, 0.0, 1e-5 * request.position_mm.x.powi(2)))
}

#[test]
fn what_is_no_coordinate_is_kept_byte_for_byte() {
    let text = "\u{feff}%\r\nO0001 (part \u{e9})\r\n\r\n  N10\tG21  G90 (mm; really)\nn20 g00x1.y2 z3;to the start\r\n\
                N30 G1 F300 Z 1. (Z first) X 5\tM8\n/N40 X6 (optional)\nM30\n%\nanything after the end X5 #\u{e9}\n  ";
    let output = written(text, &shift);
    let expected = text
        .replace("x1.y2", "x1.0100y2")
        .replace("X 5\t", "X 5.0100\t")
        .replace("X6", "X6.0100");
    assert_eq!(output, expected);
}

#[test]
fn an_axis_that_changes_without_a_word_gets_one_after_the_last_coordinate_word() {
    let field = |_: &Request| Ok(Vector3::new(0.01, -0.02, 0.03));
    assert_eq!(
        written("G21 G90\nG0 Y5 (a) M8\nG0 X1 F5 ;b\ng0z9\n", &field),
        "G21 G90\nG0 Y4.9800 X0.0100 Z0.0300 (a) M8\nG0 X1.0100 F5 ;b\ng0z9.0300\n"
    );
}

#[test]
fn words_whose_value_stays_keep_their_own_bytes() {
    let text = "G21 G90\nG0 X1.23456789 Y+5. Z.5\nG91\nG0 X0.1\nG0 X-.1 Y00.20\n";
    assert_eq!(written(text, &NoCorrection), text);
    let deep = |_: &Request| Ok(Vector3::new(0.0, 0.0, -0.01));
    assert_eq!(written(text, &deep), text.replace("Z.5", "Z0.4900"));
}

#[test]
fn what_arithmetic_leaves_of_two_equal_places_is_no_move() {
    let mut text = "G20 G91\nG1 F10\n".to_owned();
    for _ in 0..10 {
        text.push_str("X0.1\n");
    }
    text.push_str("G90\nX1\n");
    let field = |request: &Request| {
        Ok(request.tangent.map_or(Vector3::zeros(), |tangent| {
            Vector3::new(0.0, 0.05 * tangent.x, 0.0)
        }))
    };
    let (output, result) = written_with(&text, &field, &at_origin(), &bare());
    assert_eq!(
        (
            result.accounting.entry_steps,
            result.accounting.corner_steps
        ),
        (1, 0),
        "only the first: {output}"
    );
    assert!(output.ends_with("G90\nX1\n"), "{output}");
}

#[test]
fn a_circle_smaller_than_the_rounding_still_has_all_its_motions() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X1 F300\nG2 I0.00002\nG91\nI0.00002 F100\nG90 G1 X2\nM2\n";
    assert_eq!(written(text, &NoCorrection), text);
    // No arc of so few digits can be printed: one straight piece is within the tolerance.
    assert_eq!(
        written(text, &shift),
        "G21 G90\nG0 X0.0100 Y0 Z0\nG1 X1.0100 F300\nG1 X1.0100\nG91\nX0.0000 F100\nG90 G1 X2.0100\nM2\n"
    );
    assert_eq!(
        written_with(text, &shift, &at_origin(), &straight()).0,
        "G21 G90\nG0 X0.0100 Y0 Z0\nG1 X1.0100 F300\nG1 X1.0100\nX1.0100\nX1.0100\nG91\n\
         X0.0000 F100\nX0.0000\nX0.0000\nG90 G1 X2.0100\nM2\n"
    );
}

#[test]
fn a_move_in_mm_may_begin_where_inches_were_rounded() {
    let text = "G20 G90\nG0 X0 Y0 Z0\nG91 G2 X1.000005 Y1.000005 R1 F10\nG21\nG1 Z30 F300\nM2\n";
    let output = written(text, &NoCorrection);
    assert!(output.contains("\nG21\nG1 Z30"), "{output}");
}

#[test]
fn increments_never_drift() {
    let mut text = "G21 G90\nG0 X0 Y0 Z0\nG91 G1 F500\n".to_owned();
    for _ in 0..5000 {
        text.push_str("X0.01 Y0.003\n");
    }
    let field = |request: &Request| Ok(request.position_mm * 3.3e-4);
    let (_, result) = written_with(&text, &field, &at_origin(), &bare());
    let last = result.pieces.last().unwrap().commanded_to;
    let wanted = Vector3::new(50.0, 15.0, 0.0) * (1.0 + 3.3e-4);
    assert!((last - wanted).norm() < 1e-4, "{last}");
    assert!(result.accounting.largest_rounding_mm < 0.9e-4);
}

#[test]
fn inches_have_five_decimals_and_more_are_given_on_request() {
    let field = |_: &Request| Ok(Vector3::new(0.0254, 0.0, 0.0));
    assert_eq!(
        written("G20 G90\nG0 X1\n", &field),
        "G20 G90\nG0 X1.00100\n"
    );
    let writing = {
        let mut writing = bare();
        writing.decimals = Some(6);
        writing
    };
    let third = |_: &Request| Ok(Vector3::new(1.0 / 3.0, 0.0, 0.0));
    assert_eq!(
        written_with("G21\nG0 X1\n", &third, &at_origin(), &writing).0,
        "G21\nG0 X1.333333\n"
    );
}

#[test]
fn a_position_offset_takes_the_corrected_place_as_its_reference() {
    let field = |request: &Request| Ok(Vector3::new(0.001 * request.position_mm.x, 0.0, 0.0));
    // At X100 the tool is commanded to 100.1; G92 X0 makes that zero, so 50 further is 50.05.
    let text =
        "G21 G90\nG0 X100\nG92 X0\nG0 X50\nG92.1\nG0 X150\nG92 X5\nG92.2\nG0 X150\nG92.3\nG0 X5\n";
    assert_eq!(
        written(text, &field),
        "G21 G90\nG0 X100.1000\nG92 X0\nG0 X50.0500\nG92.1\nG0 X150.1500\nG92 X5\nG92.2\nG0 X150.1500\nG92.3\nG0 X5\n"
    );
}

#[test]
fn an_offset_from_an_unknown_place_may_be_taken_away_at_the_end_or_suspended_for_a_while() {
    let text = "G21 G90\nG92 X0 Y0 Z0\nG1 X50 F100\nG92.2\nG92.3\nG1 X60\nG92.1\nM2\n";
    let (output, _) = written_with(text, &shift, &ReadOptions::default(), &bare());
    assert!(
        output.ends_with("G92.2\nG92.3\nG1 X60.0100\nG92.1\nM2\n"),
        "{output}"
    );
}

#[test]
fn work_offsets_place_the_program_in_the_part() {
    let mut reading = at_origin();
    reading.work_offsets_mm[1] = Some(Vector3::new(100.0, 0.0, 0.0));
    let field = |request: &Request| Ok(Vector3::new(0.001 * request.position_mm.x, 0.0, 0.0));
    let text = "G21 G90\nG54 G0 X10\nG55 G0 X10\n";
    let (output, result) = written_with(text, &field, &reading, &bare());
    assert_eq!(output, "G21 G90\nG54 G0 X10.0100\nG55 G0 X10.1100\n");
    assert_eq!(result.pieces[1].commanded_to.x, 110.11);
}

#[test]
fn a_system_without_a_stated_origin_is_warned_of_where_others_have_one() {
    let warned = |stated: &[usize], text: &str| -> Vec<(usize, String)> {
        let mut reading = at_origin();
        for &system in stated {
            reading.work_offsets_mm[system] = Some(Vector3::new(100.0 * system as f64, 0.0, 0.0));
        }
        let path = interpret(&Program::read(text).unwrap(), &reading).unwrap();
        let all = path.warnings.iter();
        all.map(|warning| (warning.line, warning.text.clone()))
            .collect()
    };
    let text = "G21 G90\nG54 G0 X10\nG55 G0 X10\nG0 X20\n";
    assert_eq!(warned(&[0, 1], text), []);
    let [(3, missing)] = &warned(&[0], text)[..] else {
        panic!("{:?}", warned(&[0], text));
    };
    assert!(
        missing.contains("the origin of this work coordinate system is not stated"),
        "{missing}"
    );
    let [(3, same)] = &warned(&[], text)[..] else {
        panic!("{:?}", warned(&[], text));
    };
    assert!(same.contains("both have the same origin"), "{same}");
}

#[test]
fn blocks_from_an_unknown_place_are_carried_and_never_sent_to_an_axis_they_do_not_name() {
    let field = |_: &Request| Ok(Vector3::new(0.01, 0.02, 0.03));
    let text = "G21 G90\nG1 Z5 F1500\nG0 X10\nG0 Y10\nG1 X20 F500\n";
    let (output, result) = written_with(text, &field, &ReadOptions::default(), &bare());
    assert_eq!(
        output,
        "G21 G90\nG1 Z5 F1500\nG0 X10\nG0 Y10.0200 X10.0100 Z5.0300\nG1 X20.0100 F500\n"
    );
    assert!(
        result.accounting.warnings[0]
            .text
            .contains("2 blocks move before")
    );
    // With the start position given all blocks are corrected, the first by a step.
    let (output, _) = written_with(text, &field, &at_origin(), &bare());
    assert!(
        output.starts_with("G21 G90\nG1 Z0.0300 X0.0100 Y0.0200 F1500\nG1 Z5.0300\nG0 X10.0100\n"),
        "{output}"
    );
}

#[test]
fn an_axis_that_the_program_never_states_is_never_written() {
    let field = |_: &Request| Ok(Vector3::new(0.01, 0.0, 0.03));
    let (output, result) = written_with(
        "G21\nG0 X1 Y1\nG1 X5 F100\n",
        &field,
        &ReadOptions::default(),
        &bare(),
    );
    assert_eq!(output, "G21\nG0 X1.0100 Y1\nG1 X5.0100 F100\n");
    assert_eq!(result.accounting.left_out_mm, 0.03);
    assert!(
        result
            .accounting
            .warnings
            .iter()
            .any(|warning| warning.text.contains("never states Z"))
    );
}

#[test]
fn the_header_is_in_the_files_own_style_below_tape_mark_and_number() {
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = Some(vec!["model heavy_6r (v1)\n500 N \u{2192} x".to_owned()]);
        writing
    };
    let head = |text: &str| written_with(text, &shift, &at_origin(), &writing).0;
    assert_eq!(
        head("%\r\nO12 (part)\r\nG21\r\nG0 X1.\r\n%\r\n"),
        "%\r\nO12 (part)\r\n(kinetostat: compensated program)\r\n(kinetostat: model heavy_6r [v1])\r\n\
         (kinetostat: 500 N ? x)\r\nG21\r\nG0 X1.0100\r\n%\r\n"
    );
    assert_eq!(
        head("G21 ; mm\nG0 X1\n"),
        "; kinetostat: compensated program\n; kinetostat: model heavy_6r [v1]\n; kinetostat: 500 N ? x\nG21 ; mm\nG0 X1.0100\n"
    );
    assert!(head("\u{feff}G21 G0 X1").starts_with("\u{feff}(kinetostat: compensated program)\n"));
    // A copy gets none.
    for text in ["%", "G21\nG0 X1\nG2 X3 I1 F100\n"] {
        assert_eq!(
            written_with(text, &NoCorrection, &at_origin(), &writing).0,
            text
        );
    }
}

#[test]
fn a_marked_program_is_refused_unless_requested_again() {
    let text = "(kinetostat: compensated program)\nG21\nG0 X1\n";
    let program = Program::read(text).unwrap();
    assert!(program.is_marked_compensated());
    let path = interpret(&program, &at_origin()).unwrap();
    let refused = write_corrected(&program, &path, &shift, &bare(), &Unwatched).unwrap_err();
    assert!(
        refused
            .to_string()
            .starts_with("line 1: the program is marked as compensated already"),
        "{refused}"
    );
    let writing = {
        let mut writing = bare();
        writing.again = true;
        writing
    };
    assert!(write_corrected(&program, &path, &shift, &writing, &Unwatched).is_ok());
}

#[test]
fn a_line_too_long_to_write_is_refused_by_its_number() {
    let text = format!("G21\nG0 X1 ({})\n", "a".repeat(240));
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    let message = write_corrected(&program, &path, &shift, &bare(), &Unwatched)
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "line 2: the line would be written with 253 bytes, 250 are allowed; shorten its comment or put the comment on a line of its own"
    );
}

#[test]
fn a_field_that_fails_names_line_and_place() {
    let field = |request: &Request| {
        if request.position_mm.x > 50.0 {
            Err(FieldFailure::new("out of reach"))
        } else {
            Ok(Vector3::zeros())
        }
    };
    let program = Program::read("G21\nG0 X0\nG1 X40 F100\nX60\n").unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    let error = write_corrected(&program, &path, &field, &bare(), &Unwatched).unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 4: no correction at X60.0000 Y0.0000 Z0.0000 mm (100.0 % along the block): out of reach; nothing was written"
    );
    let infinite = |_: &Request| Ok(Vector3::new(f64::NAN, 0.0, 0.0));
    let error = write_corrected(&program, &path, &infinite, &bare(), &Unwatched).unwrap_err();
    assert!(error.to_string().contains("no finite number"), "{error}");
}

#[test]
fn options_out_of_range_and_foreign_paths_are_refused() {
    let program = Program::read("G21\nG0 X0\n").unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    for (writing, name) in [
        (
            {
                let mut writing = bare();
                writing.tolerance_mm = f64::NAN;
                writing
            },
            "tolerance_mm is NaN",
        ),
        (
            {
                let mut writing = bare();
                writing.chord_tolerance_mm = 0.0;
                writing
            },
            "chord_tolerance_mm is 0",
        ),
        (
            {
                let mut writing = bare();
                writing.decimals = Some(2);
                writing
            },
            "decimals is 2",
        ),
        (
            {
                let mut writing = bare();
                writing.max_line_bytes = 10;
                writing
            },
            "max_line_bytes is 10",
        ),
    ] {
        let message = write_corrected(&program, &path, &shift, &writing, &Unwatched)
            .unwrap_err()
            .to_string();
        assert!(message.starts_with(name), "{message}");
    }
    let other = Program::read("G21\n(no motion here)\n").unwrap();
    let error = write_corrected(&other, &path, &shift, &bare(), &Unwatched).unwrap_err();
    assert_eq!(error, WriteError::ForeignPath { line: 2 });
}

#[test]
fn a_monitor_sees_progress_and_can_stop_the_work() {
    struct Stop(AtomicUsize);
    impl Monitor for Stop {
        fn progress(&self, done: usize, total: usize) {
            assert!(done <= total);
            self.0.fetch_add(1, Ordering::Relaxed);
        }
        fn cancelled(&self) -> bool {
            self.0.load(Ordering::Relaxed) >= 2
        }
    }
    let mut text = "G21\nG0 X0\nG1 F100\n".to_owned();
    for x in 0..20_000 {
        text.push_str(&format!("X{x}\n"));
    }
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    let stop = Stop(AtomicUsize::new(0));
    assert_eq!(
        write_corrected(&program, &path, &shift, &bare(), &stop),
        Err(WriteError::Cancelled)
    );
    assert_eq!(stop.0.load(Ordering::Relaxed), 2);
}

#[test]
fn a_written_program_that_was_tampered_with_fails_its_last_check() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X100 F600 (cut)\nG2 X110 Y0 I5\nM2\n";
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &at_origin()).unwrap();
    let good =
        write_corrected(&program, &path, &bend, &WriteOptions::default(), &Unwatched).unwrap();
    let output = String::from_utf8(good.bytes.clone()).unwrap();
    let check = |bytes: String| {
        let bad = Corrected {
            bytes: bytes.into_bytes(),
            ..good.clone()
        };
        verify_written(
            &program,
            &path,
            &bad,
            &at_origin(),
            &WriteOptions::default(),
        )
    };
    assert!(check(output.clone()).is_ok());
    let first = output
        .lines()
        .find(|line| line.contains("(cut)"))
        .unwrap()
        .to_owned();
    for (from, to) in [
        ("(cut)", "(cat)"),
        ("F600", "F605"),
        ("G21", "G20"),
        ("M2", "M8"),
        ("kinetostat: compensated", "nothing"),
        (first.as_str(), ""),
        ("X100.0000", "X100.0010"),
        ("X100.0000", "X100.00"),
        ("M2\n", "M2"),
        ("X100.0000", "X100.0000 M8"),
        ("X100.0000", "X100.0000 (new)"),
    ] {
        assert!(output.contains(from), "{from} is not in\n{output}");
        let result = check(output.replacen(from, to, 1));
        assert!(
            matches!(result, Err(WriteError::Verification { .. })),
            "{from} -> {to}: {result:?}"
        );
    }
}

#[test]
fn a_position_offset_states_an_unknown_place() {
    let field = |request: &Request| Ok(Vector3::new(0.001 * request.position_mm.x, 0.0, 0.0));
    let text = "G21 G90\nG92 X10 Y0 Z5\nG1 X110 F500\nG92 X0\nG1 X10\n";
    let (output, result) = written_with(text, &field, &ReadOptions::default(), &bare());
    // The first block begins with the correction of the place where the tool stands uncorrected; the
    // stretch is 0.1 %, so F changes by as much.
    assert_eq!(
        output,
        "G21 G90\nG92 X10 Y0 Z5\nG1 X10.0100 F500\nG1 X110.1100 F500.5\nG92 X0\nG1 X10.0100\n"
    );
    assert_eq!(
        result.pieces[0].commanded_from,
        Vector3::new(10.0, 0.0, 5.0)
    );
    assert!(result.accounting.warnings.is_empty());
}

#[test]
fn a_tool_length_is_followed_when_a_rapid_states_the_height_again() {
    let field = |_: &Request| Ok(Vector3::new(0.0, 0.0, 0.25));
    let text =
        "G21 G90 G17 G40 G49 G80\nT1 M6\nG0 X0 Y0\nG43 H1 Z50\nG1 Z-1 F100\nG0 Z50\nG49\nM30\n";
    let output = written_with(text, &field, &ReadOptions::default(), &bare()).0;
    assert_eq!(
        output,
        "G21 G90 G17 G40 G49 G80\nT1 M6\nG0 X0 Y0\nG43 H1 Z50.2500\nG1 Z-0.7500 F100\nG0 Z50.2500\nG49\nM30\n"
    );
}

#[test]
fn blocks_marked_for_deletion_are_run_or_skipped_as_set() {
    let text = "G21 G90\nG0 X0\n/G0 X50 (optional)\nG91\nG0 X1\n";
    let (run, result) = written_with(text, &shift, &at_origin(), &bare());
    assert_eq!(
        run,
        "G21 G90\nG0 X0.0100\n/G0 X50.0100 (optional)\nG91\nG0 X1\n"
    );
    assert!(
        result.accounting.warnings[0]
            .text
            .contains("block delete switch off")
    );
    let reading = {
        let mut reading = at_origin();
        reading.block_delete = BlockDelete::Skip;
        reading
    };
    let (skipped, result) = written_with(text, &shift, &reading, &bare());
    assert_eq!(
        skipped,
        "G21 G90\nG0 X0.0100\n/G0 X50 (optional)\nG91\nG0 X1\n"
    );
    assert_eq!(result.pieces.len(), 2);
    assert_eq!(result.accounting.blocks_in, 5);
}

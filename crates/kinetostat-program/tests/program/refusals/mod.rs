//! What is refused: each with the line, what stands there, the reason, and what to do.

// Helpers of tests, which clippy does not count as tests.
mod carried;
mod codes;
mod modes_and_arcs;
mod texts;

use kinetostat_program::*;
use nalgebra::Vector3;

use codes::CODES_NOT_FOLLOWED;
use modes_and_arcs::MODES_AND_ARCS;
use texts::TEXTS;

/// Program, line, a part of the reason, a part of the remedy.
type Refused = (&'static str, usize, &'static str, &'static str);

fn refusal(text: &[u8], start_known: bool) -> Option<ProgramError> {
    let options = {
        let mut reading = ReadOptions::default();
        reading.start_position_mm = start_known.then(Vector3::zeros);
        reading
    };
    match Program::read(text) {
        Err(error) => Some(error),
        Ok(program) => interpret(&program, &options).err(),
    }
}

#[test]
fn every_bad_program_is_refused_with_line_reason_and_remedy() {
    let all = [TEXTS, CODES_NOT_FOLLOWED, MODES_AND_ARCS].concat();
    for (text, line, reason, remedy) in &all {
        let Some(error) = refusal(text.as_bytes(), true) else {
            panic!("{text:?} was taken")
        };
        let message = error.to_string();
        println!("{message}");
        assert_eq!(error.line, *line, "{text:?}: {message}");
        assert!(error.reason.contains(reason), "{text:?}: {message}");
        assert!(error.remedy.contains(remedy), "{text:?}: {message}");
        assert!(
            !message.contains("by option"),
            "the option has a name: {message}"
        );
        assert!(message.starts_with(&format!("line {line}: `")), "{message}");
        assert!(
            error.span.end <= text.len() && error.span.start <= error.span.end,
            "{text:?}: {:?}",
            error.span
        );
        if let Some(text_of_line) = text.lines().nth(line - 1)
            && text_of_line
                .chars()
                .all(|character| !character.is_control())
        {
            assert_eq!(error.found, text_of_line.trim());
        }
    }
}

#[test]
fn motion_from_an_unknown_place_is_refused_where_the_place_matters() {
    let cases = [
        (
            "G21 G91\nG1 X5 F100",
            2,
            "an incremental feed from a place whose X",
        ),
        (
            "G21\nG2 X5 Y5 R5 F100",
            2,
            "the arc starts at a place whose X",
        ),
        (
            "G21\nG0 X0\nG2 X5 Y5 I5 F100",
            3,
            "the arc starts at a place whose Y",
        ),
        // Where the tool stood before G92 only the machine knows, so afterwards X would be written in
        // other coordinates than those in force.
        (
            "G21\nG92 X10 Y0 Z5\nG1 X20 F300\nG92.1\nG0 Z50",
            5,
            "line 4 shifted the X coordinates by an offset that is not in the program",
        ),
        (
            "G21\nG92 X10 Y0 Z5\nG92.2\nG92 X4 Y4\nG0 X5",
            5,
            "line 4 shifted the Z coordinates",
        ),
        (
            "G21\nG0 X0 Y0\nG2 X5 Y5 Z1 I5 F100",
            3,
            "the arc starts at a place whose Z",
        ),
        (
            "G21\nG0 X0 Y0\nG2 X10 Y0 I5 F100\nG0 Z5",
            3,
            "before the program has stated all axes",
        ),
    ];
    for (text, line, reason) in cases {
        let error = refusal(text.as_bytes(), false).unwrap();
        assert_eq!(error.line, line, "{error}");
        assert!(error.reason.contains(reason), "{error}");
        assert!(error.remedy.contains("--start-position-mm"), "{error}");
    }
}

#[test]
fn a_line_without_end_and_other_encodings_are_refused() {
    let long = [b"G1 X1 (".as_slice(), &vec![b'a'; 70_000], b")"].concat();
    let error = refusal(&long, true).unwrap();
    assert!(error.reason.contains("the line has 70008 bytes"), "{error}");
    assert!(error.found.len() < 100, "the excerpt is short");
    let error = refusal(b"\xff\xfeG\x002\x001\x00", true).unwrap();
    assert!(error.reason.contains("UTF-16"), "{error}");
}

#[test]
fn control_characters_of_a_comment_never_reach_the_terminal() {
    // A terminal escape in a comment is a control character, so the file is refused, and the message
    // shows its number instead.
    let error = refusal(b"G21\nG1 X1 (\x1b[2J)", true).unwrap();
    let message = error.to_string();
    assert!(message.contains("\\x1b[2J"), "{message:?}");
    assert!(!message.contains('\x1b'));
}

#[test]
fn no_bytes_make_the_reader_panic() {
    use proptest::prelude::*;
    let line = prop_oneof![
        proptest::collection::vec(any::<u8>(), 0..40),
        "[GXYZIJKRFMNOE0-9. +\\-()%;/#*]{0,30}".prop_map(String::into_bytes),
        "(G[0-9]{1,2} ?)?([XYZIJKRFE]-?[0-9]{1,3}(\\.[0-9]{1,5})? ?){0,5}"
            .prop_map(String::into_bytes),
    ];
    let program = proptest::collection::vec(line, 0..12)
        .prop_map(|lines| [b"G21\nG0X0Y0Z0\n".to_vec(), lines.join(&b'\n')].concat());
    proptest!(ProptestConfig::with_cases(2000), |(bytes in program)| {
        if let Ok(program) = Program::read(bytes.clone()) {
            prop_assert_eq!(program.bytes(), &bytes[..]);
            let reading = ReadOptions::default();
            if let Ok(path) = interpret(&program, &reading) {
                let writing = { let mut writing = WriteOptions::default(); writing.again = true; writing };
                let field = |request: &Request| Ok(0.01 * request.position_mm.map(|x| (x * 0.01).sin()));
                match write_corrected(&program, &path, &field, &writing, &Unwatched) {
                    Ok(written) => {
                        let checked = verify_written(&program, &path, &written, &reading, &writing);
                        prop_assert!(checked.is_ok(), "{:?}\n{}\n{}", checked, String::from_utf8_lossy(&bytes), String::from_utf8_lossy(&written.bytes));
                    }
                    Err(error) => prop_assert!(matches!(error, WriteError::ExtraAxis { .. } | WriteError::TooManyPieces { .. } | WriteError::LineTooLong { .. }), "{}", error),
                }
            }
        }
    });
}

//! Messages of the expansion name the lines of its files, and what can be done while it runs.

use kinetostat_program::{Dialect, ExpandOptions, NoSubprograms, Subprograms, expand};

use super::{flat, refused};

#[test]
fn lines_in_messages_are_those_of_the_files() {
    // Ten blocks for each line of the loop: line 9 of the program is no line of the flat one.
    let text = "G21 G90\nG0 X0 Y0 Z0\nO1 repeat [10]\nG1 X1 F100\nG1 X0\nO1 endrepeat\n(shifted)\nM5\nG92.3\nG0 X1\nM2\n";
    let error = refused(text);
    assert_eq!(error.line, 10);
    assert!(error.reason.contains("line 9 shifted"), "{error}");

    struct File;
    impl Subprograms for File {
        fn find(&self, name: &str) -> Option<Vec<u8>> {
            (name == "7").then(|| b"O7\n(shift)\nG92.3\nM99\n".to_vec())
        }
    }
    let text = "G21 G90\nG0 X0 Y0 Z0\nM98 P7\nG0 X1\nM2\n";
    let error = expand(text, &ExpandOptions::default(), &File).unwrap_err();
    assert_eq!(error.line, 4);
    assert!(
        error
            .reason
            .contains("line 3 of the subprogram '7' shifted"),
        "{error}"
    );
}

#[test]
fn no_message_sends_the_reader_where_he_is() {
    for (line, needle) in [
        ("L2", "not followed"),
        ("M97 P3", "not followed"),
        ("G1 X5. GOTO 10", "line of its own"),
    ] {
        let error = refused(&format!("G21 G90 F100\nG0 X0 Y0 Z0\n{line}\nM2\n"));
        assert_eq!(error.line, 3);
        assert!(error.remedy.contains(needle), "{line}: {error}");
        for text in [&error.reason, &error.remedy] {
            assert!(!text.contains("expand"), "{line}: {error}");
            assert!(!text.contains("flatten"), "{line}: {error}");
        }
    }
}

#[test]
fn polar_words_stand_in_the_plane_xy() {
    for plane in ["G18", "G19"] {
        let error = refused(&format!(
            "G21 G90 {plane}\nG0 X5 Y0 Z0\nG1 @5 ^30 F100\nM2\n"
        ));
        assert_eq!(error.line, 3);
        assert!(error.reason.contains("G17"), "{error}");
    }
}

/// LinuxCNC passes over a return where nothing was called.
#[test]
fn a_return_of_the_program_itself_does_nothing() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nO1 if [1]\nO<x> return [3]\nG0 X1\nO1 endif\nM2\n";
    assert_eq!(flat(text), "G21 G90\nG0 X0 Y0 Z0\nG0 X1\nM2\n");
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::LinuxCnc;
    assert!(expand(text, &options, &NoSubprograms).is_ok());
    assert!(expand("O1 endsub\n", &options, &NoSubprograms).is_err());
}

/// LinuxCNC reads a block without its blanks.
#[test]
fn blanks_within_numbers_are_passed_over_by_linuxcnc() {
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::LinuxCnc;
    let text = "G21 G90 F100\nG0 X0 Y0 Z0\nG 1 X 1 0 Y . 5 Z - 2 (a 1 2) ; 3 4\nM2\n";
    let made = expand(text, &options, &NoSubprograms).unwrap();
    let expected = "G21 G90 F100\nG0 X0 Y0 Z0\nG 1 X 10 Y .5 Z -2 (a 1 2) ; 3 4\nM2\n";
    assert_eq!(String::from_utf8_lossy(made.program.bytes()), expected);
    let end = made.path.moves.last().unwrap().end;
    assert_eq!([end.x, end.y, end.z], [10.0, 0.5, -2.0]);
    assert_eq!(refused(text).line, 3);
}

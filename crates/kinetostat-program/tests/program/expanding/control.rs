//! Subprograms, branches and loops: the blocks that they run, in their order.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use kinetostat_program::{ExpandOptions, NoSubprograms, OriginComments, Subprograms, expand};

use super::{flat, refused};

/// The X words of the flat program, with a start at the origin.
fn places(text: &str) -> Vec<f64> {
    let text = flat(&format!("G21 G90\nG0 X0 Y0 Z0\n{text}\nM2\n"));
    let words = text.split_whitespace().filter(|word| word.starts_with('X'));
    words
        .skip(1)
        .map(|word| word[1..].parse().unwrap())
        .collect()
}

#[test]
fn branches() {
    let branch = |value: u32| {
        places(&format!(
            "#1 = {value}\nO1 if [#1 EQ 1]\nX1\nO1 elseif [#1 EQ 2]\nX2\nO2 if [1]\nX2.5\nO2 endif\nO1 else\nX3\nO1 endif\nX9"
        ))
    };
    assert_eq!(branch(1), [1.0, 9.0]);
    assert_eq!(branch(2), [2.0, 2.5, 9.0]);
    assert_eq!(branch(3), [3.0, 9.0]);
}

#[test]
fn loops() {
    assert_eq!(
        places("#1 = 0\nO1 while [#1 LT 3]\nX#1\n#1 = [#1 + 1]\nO1 endwhile\nX9"),
        [0.0, 1.0, 2.0, 9.0]
    );
    assert_eq!(places("O1 while [0]\nX1\nO1 endwhile\nX9"), [9.0]);
    assert_eq!(
        places("#1 = 5\nO1 do\nX#1\n#1 = [#1 + 1]\nO1 while [#1 LT 3]\nX9"),
        [5.0, 9.0]
    );
    assert_eq!(
        places("#1 = 1\nO1 do\nX#1\n#1 = [#1 + 1]\nO1 while [#1 LT 3]\nX9"),
        [1.0, 2.0, 9.0]
    );
    assert_eq!(
        places("O1 repeat [2.4]\nX1\nX0\nO1 endrepeat\nX9"),
        [1.0, 0.0, 1.0, 0.0, 9.0]
    );
    assert_eq!(places("O1 repeat [0]\nX1\nO1 endrepeat\nX9"), [9.0]);
    // Loops in loops, which begin anew every time.
    assert_eq!(
        places(
            "#1 = 0\nO1 while [#1 LT 2]\nO2 repeat [2]\nX[#1 * 10 + 1]\nX0\nO2 endrepeat\n#1 = [#1 + 1]\nO1 endwhile"
        ),
        [1.0, 0.0, 1.0, 0.0, 11.0, 0.0, 11.0, 0.0]
    );
}

#[test]
fn loops_are_left_and_gone_on_with() {
    let text = "#1 = 0\nO1 while [#1 LT 9]\n#1 = [#1 + 1]\nO2 if [#1 EQ 2]\nO1 continue\nO2 endif\nO3 if [#1 EQ 4]\nO1 break\nO3 endif\nX#1\nO1 endwhile\nX9";
    assert_eq!(places(text), [1.0, 3.0, 9.0]);
    let text = "#1 = 0\nO1 do\n#1 = [#1 + 1]\nO2 if [#1 EQ 2]\nO1 continue\nO2 endif\nX#1\nO1 while [#1 LT 3]\nX9";
    assert_eq!(places(text), [1.0, 3.0, 9.0]);
}

#[test]
fn subprograms_have_values_of_their_own() {
    let text = "O<corner> sub\nX#1 Y#2\n#1 = 100 #<own> = 5\nO<corner> return [#3 * 2]\nX77\nO<corner> endsub\n#1 = 3\nO<corner> call [1] [2] [4]\nX#<_value>\nX#1";
    assert_eq!(places(text), [1.0, 8.0, 3.0]);
    // One that calls itself: its values come back.
    let text = "O10 sub\nX#1\nO11 if [#1 GT 1]\nO10 call [#1 - 1]\nO11 endif\nX[10 + #1]\nO10 endsub\nO10 call [3]";
    assert_eq!(places(text), [3.0, 2.0, 1.0, 11.0, 12.0, 13.0]);
    // Behind the end of the program they are found, too.
    let text = "G21\nG0 X0 Y0 Z0\nO5 call\nM2\nO5 sub\nX4\nO5 endsub\n";
    assert_eq!(flat(text), "G21\nG0 X0 Y0 Z0\nX4\nM2\n");
}

#[test]
fn calls_of_numbers() {
    let text = "%\nO1000\nG21\nG0 X0 Y0 Z0\nM98 P2000 L2\n#1 = 4\nM98 P00032000\nM30\nO2000\nG91 X1\nG90\nM99\n%\n";
    let moves = "G91 X1\nG90\n".repeat(5);
    assert_eq!(
        flat(text),
        format!("%\nO1000\nG21\nG0 X0 Y0 Z0\n{moves}M30\n%\n")
    );
    // Values are those of the program, before and after.
    let text = "G21\nG0 X0 Y0 Z0\n#1 = 2\nM98 P7\nX#1\nM30\nO7\nX#1\n#1 = 5\nM99\n";
    assert_eq!(flat(text), "G21\nG0 X0 Y0 Z0\nX2\nX5\nM30\n");
}

#[test]
fn conditions_and_jumps() {
    assert_eq!(
        places("#1 = 0\nWHILE [#1 LT 2] DO1\nX#1\n#1 = [#1 + 1]\nEND1\nX9"),
        [0.0, 1.0, 9.0]
    );
    assert_eq!(
        places("#1 = 0\nN10 X#1\n#1 = [#1 + 1]\nIF [#1 LT 3] GOTO 10\nX9"),
        [0.0, 1.0, 2.0, 9.0]
    );
    assert_eq!(
        places("IF [1 EQ 1] THEN #1 = 7\nX#1\nGOTO 20\nX5\nN20 X9"),
        [7.0, 9.0]
    );
}

/// Files of subprograms, and the lines that blocks came from.
#[test]
fn subprograms_in_files() {
    struct Files;
    impl Subprograms for Files {
        fn find(&self, name: &str) -> Option<Vec<u8>> {
            match name {
                "drill" => {
                    Some(b"(a hole)\nO<drill> sub\nG1 Z#1 F100\nG0 Z0\nO<drill> endsub\n".to_vec())
                }
                "0007" => Some(b"O7\nX3\nM99\n".to_vec()),
                _ => None,
            }
        }
    }
    let text = "G21\nG0 X0 Y0 Z0\nO<Drill> call [-2]\nM98 P7\nM2\n";
    let expanded = expand(text, &ExpandOptions::default(), &Files).unwrap();
    assert_eq!(
        expanded.program.bytes(),
        b"G21\nG0 X0 Y0 Z0\nG1 Z-2 F100\nG0 Z0\nX3\nM2\n"
    );
    let origins: Vec<_> = expanded
        .origins
        .iter()
        .map(|o| (expanded.files[o.file].as_str(), o.line))
        .collect();
    assert_eq!(
        origins,
        [
            ("", 1),
            ("", 2),
            ("drill", 3),
            ("drill", 4),
            ("0007", 2),
            ("", 5)
        ]
    );
    let mut options = ExpandOptions::default();
    options.origin_comments = OriginComments::Written;
    let commented = expand(text, &options, &Files).unwrap();
    let lines: Vec<&[u8]> = commented.program.bytes().split(|b| *b == b'\n').collect();
    assert_eq!(lines[1], b"G0 X0 Y0 Z0 (line 2)");
    assert_eq!(lines[2], b"G1 Z-2 F100 (drill, line 3)");
    assert_eq!(commented.path, expanded.path);
    let missing = expand("O<bore> call\n", &ExpandOptions::default(), &Files).unwrap_err();
    assert!(missing.reason.contains("no subprogram 'bore'"), "{missing}");
    assert!(expand("M98 P9\n", &ExpandOptions::default(), &NoSubprograms).is_err());
}

#[test]
fn block_delete_is_followed() {
    let mut options = ExpandOptions::default();
    let text = "G21\nG0 X0 Y0 Z0\n#1 = 2\n/ #1 = 3\nX#1\nM2\n";
    let with = |options: &ExpandOptions| {
        let expanded = expand(text, options, &NoSubprograms).unwrap();
        String::from_utf8(expanded.program.bytes().to_vec()).unwrap()
    };
    assert!(with(&options).contains("X3\n"));
    options.reading.block_delete = kinetostat_program::BlockDelete::Skip;
    assert!(with(&options).contains("X2\nM2"));
}

#[test]
fn what_has_no_end_or_no_beginning_is_refused() {
    for (text, line, needle) in [
        ("O1 while [0]\n", 1, "endwhile is missing"),
        ("O1 if [0]\n", 1, "endif is missing"),
        ("O1 repeat [0]\n", 1, "endrepeat is missing"),
        ("G21\nO1 endwhile\n", 2, "not open"),
        ("O1 sub\n", 1, "the file defines O1"),
        ("G21\nG0 X0\nO1 sub\n", 3, "endsub is missing"),
        ("O1 endsub\n", 1, "was not called"),
        ("O1 call\n", 1, "no subprogram '1'"),
        ("O1 callsub\n", 1, "behind the keyword"),
        ("O1 wait\n", 1, "no keyword"),
        ("O1 break\n", 1, "not open"),
        (
            "O1 repeat [2]\nO1 break\nO1 endrepeat\n",
            2,
            "which LinuxCNC refuses",
        ),
        (
            "O1 repeat [2]\nO1 continue\nO1 endrepeat\n",
            2,
            "which LinuxCNC refuses",
        ),
        ("GOTO 5\n", 1, "no block N5"),
        ("WHILE [0] DO1\n", 1, "END1 is missing"),
        ("END1\n", 1, "DO1 is missing"),
        ("IF [1] X3\n", 1, "needs GOTO or THEN"),
        ("M98\n", 1, "calls no subprogram"),
        ("M98 P5\n", 1, "no subprogram O5"),
        ("#5 3\n", 1, "needs ="),
        ("#5 = 3 O1 sub\n", 1, "behind other words"),
        ("#5221 = 3\n", 1, "kept by the controller"),
    ] {
        let error = refused(text);
        assert_eq!(error.line, line, "{text}: {error}");
        assert!(error.reason.contains(needle), "{needle}: {error}");
        assert!(!error.remedy.is_empty());
    }
}

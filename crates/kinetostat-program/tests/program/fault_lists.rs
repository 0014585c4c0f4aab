//! All faults of a program: each once, none because of another.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;

fn lines(text: &str) -> Vec<usize> {
    let found = faults(text, &ReadOptions::default());
    found.iter().map(|fault| fault.line).collect()
}

/// The lines behind a refused one are read from where it ends.
#[test]
fn a_refused_line_is_followed_as_far_as_it_is_understood() {
    let cases: [(&str, &[usize]); 9] = [
        ("G41 D1 G1 X10 F100\nG3 X20 Y10 J10\nG40 G1 X0", &[3]),
        ("G91 G42 D1 X10 Y5 F9\nG3 X10 Y10 J10", &[3]),
        // A cycle ends over its hole, at a height that is not asked for here.
        ("G81 X10 Y5 Z-3 R2 F100\nG2 X20 Y5 I5", &[3]),
        // An arc that is none ends where it says.
        ("G2 X10 Y0 I4 F100\nG2 X20 Y0 I5\nG2 X30 Y0 I4", &[3, 5]),
        ("G1 X10 R5 F100\nG2 X20 Y0 I5", &[3]),
        ("G1 X10 X11 F100\nG2 X20 Y0 I5", &[3]),
        // Where the tool is after a line that was not read nobody knows, until the program states it.
        (
            "G1 X[#1] F100\nG2 X20 Y0 I5\nG2 X30 Y0 I5\nG2 X40 Y0 I4",
            &[3, 6],
        ),
        (
            "G1 X#<a> F100\nG91 G2 X20 Y0 I7\nG90 G1 X5 Y5\nG2 X15 Y5 I4",
            &[3, 6],
        ),
        ("G28 Z0\nG2 X2 I1 F100\nG1 X5\nG92 X0", &[4]),
    ];
    for (text, wanted) in cases {
        let text = format!("G21 G90\nG0 X0 Y0 Z0\n{text}\n");
        assert_eq!(
            lines(&text),
            wanted,
            "{text}{:?}",
            faults(text.as_str(), &ReadOptions::default())
        );
    }
}

#[test]
fn variables_are_one_fault_with_their_lines_counted_and_what_to_do() {
    let text = "G21\nG0 X0\n#1=5\nG1 X#1 F100\nY[#1*2]\nG41 D1\nZ[3]\n";
    let found = faults(text, &ReadOptions::default());
    assert_eq!(
        found.iter().map(|fault| fault.line).collect::<Vec<_>>(),
        [3, 6]
    );
    assert_eq!(
        found[0].reason,
        "variables and expressions are not read, on 4 lines"
    );
    assert!(found[0].remedy.contains("kinetostat expand"));
    let one = faults("G21\nG0 X0\n#1=5\n", &ReadOptions::default());
    assert_eq!(one[0].reason, "variables and expressions are not read");
}

#[test]
fn a_file_of_definitions_is_said_to_be_one() {
    let library = "(holes)\n%\no<drill> sub\nG81 X[#1] R2\no<drill> endsub [5]\n\nN10 O<two> SUB ; x\no1 if [#1]\nG0 X1\no1 endif\nO <TWO> endsub\nM2\n%\n";
    for error in [
        faults(library, &ReadOptions::default()).remove(0),
        Program::read(library).unwrap_err(),
        expand(library, &ExpandOptions::default(), &NoSubprograms).unwrap_err(),
    ] {
        assert_eq!(error.line, 3);
        assert_eq!(
            error.reason,
            "the file defines O<drill>, O<two>; nothing is run"
        );
        assert!(
            error
                .remedy
                .contains("call it from a program (O<drill> call)"),
            "{error}"
        );
        assert_eq!(error.found, "o<drill> sub");
        assert_eq!(&library[error.span], "o<drill> sub");
    }
    assert_eq!(faults(library, &ReadOptions::default()).len(), 1);
    let many: String = (1..=9)
        .map(|k| format!("O{k} sub\nG0 X{k}\nO{k} endsub\n"))
        .collect();
    let error = Program::read(many).unwrap_err();
    assert_eq!(
        error.reason,
        "the file defines O1, O2, O3 and 6 more; nothing is run"
    );
    // A call, a move, and a definition that does not end make it something else.
    for program in [
        "O1 sub\nG0 X1\nO1 endsub\nO1 call\nM2\n",
        "G21\nO1 sub\nG0 X1\nO1 endsub\nM2\n",
        "O1 sub\nG0 X1\nO1 endsub\nG0 X1\nM2\n",
    ] {
        let found = faults(program, &ReadOptions::default());
        assert!(!found[0].reason.contains("nothing is run"), "{found:?}");
    }
}

//! Words beside M98 and M99: Fanuc runs them first, other controllers do not.

use kinetostat_program::{
    Dialect, ExpandOptions, NoSubprograms, Path, Program, ReadOptions, Request, Unwatched,
    WriteOptions, expand, expansion_faults, interpret, verify_written, write_corrected,
};
use nalgebra::Vector3;

use super::fanuc::{BEGIN, fanuc, run};

const SUB: &str = "M30\nO100\nY1.\nM99\n";

#[test]
fn fanuc_runs_the_words_and_then_calls_or_returns() {
    for (block, expected) in [
        ("G0 X9. M98 P100", "G0 X9.\nY1.\n"),
        ("M98 P100 X9.", "X9.\nY1.\n"),
        ("N5 G1 X5. M98 P100 F300 M8", "N5 G1 X5.   F300 M8\nY1.\n"),
        ("M8 M98 P100 L2", "M8\nY1.\nY1.\n"),
        ("M98 P20100 M8", "M8\nY1.\nY1.\n"),
        ("N5 M98 P100 (only a call)", "Y1.\n"),
        ("#1=4 M98 P100", "Y1.\n"),
        ("X#100 M98 P100", "Y1.\n"),
    ] {
        let made = fanuc(&format!("{block}\n{SUB}"));
        let words = |text: &str| {
            let lines = text.lines();
            let lines = lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
            lines.collect::<Vec<_>>()
        };
        assert_eq!(words(&made), words(&format!("{expected}M30\n")), "{block}");
    }
    // Before the return, in the subprogram.
    let text = "M98 P7\nG0 Y3.\nM30\nO7\nG0 X5. M99\n";
    assert_eq!(fanuc(text), "G0 X5.\nG0 Y3.\nM30\n");
    let text = "M98 P7\nG0 Y3.\nN8 G0 Y4.\nM30\nO7\nG0 X5. M99 P8\n";
    assert_eq!(fanuc(text), "G0 X5.\nN8 G0 Y4.\nM30\n");
    // A hole, and then the call.
    let text = format!("G99 G81 X1. Z-3. R1. F100\nX4. M98 P100\n{SUB}");
    let made = fanuc(&text);
    let holes = made.lines().filter(|line| *line == "G1 Z-3").count();
    // X1, X4, and the place of the subprogram.
    assert_eq!(holes, 3, "{made}");
    // The end of the program beside a call: nothing is called any more.
    assert_eq!(fanuc(&format!("M30 M98 P100\n{SUB}")), "M30\n");
}

#[test]
fn elsewhere_words_beside_a_call_are_refused() {
    for block in [
        "G0 X9. M98 P100",
        "G1 X5. M98 P100 F300 M8",
        "M8 M98 P100",
        "M98 P100 X5.",
        "@5 M98 P100",
        "M98 P100 X[2+3]",
        "G0 X5. M99",
    ] {
        for dialect in [Dialect::Undecided, Dialect::LinuxCnc] {
            let error = run(&format!("{block}\n{SUB}"), dialect).unwrap_err();
            assert_eq!(error.line, 3, "{block}");
            assert!(error.reason.contains("Fanuc runs them first"), "{error}");
            assert!(error.remedy.contains("block of their own"), "{error}");
            let names_it = error.remedy.contains("--dialect fanuc");
            assert_eq!(names_it, dialect == Dialect::Undecided, "{error}");
        }
    }
    for dialect in [Dialect::Undecided, Dialect::LinuxCnc, Dialect::Fanuc] {
        let made = run(&format!("/N7 M98 P100 L1 (a call)\n{SUB}"), dialect);
        assert_eq!(made.unwrap(), "Y1.\nM30\n");
        for block in ["M98 P100 P200", "M98 M99 P1", "M98 P100 Q3", "M99 L2"] {
            let error = run(&format!("{block}\n{SUB}"), dialect).unwrap_err();
            assert!(error.remedy.contains("of its own"), "{block}: {error}");
        }
    }
}

/// Where such a line ends is not known: an arc behind it proves nothing.
#[test]
fn a_refused_line_is_one_fault() {
    let text = "G21 G90 F100\nG0 X0 Y0 Z5\nG1 X5. M98 P100\nM30\nO100\nY1.\nM99\n";
    let found = expansion_faults(text, &ExpandOptions::default(), &NoSubprograms);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(expand(text, &ExpandOptions::default(), &NoSubprograms).is_err());
}

#[test]
fn m_beside_g65_is_an_argument() {
    let text = "G65 P9 M98 L2 X4.\nM30\nO9\nG0 X#24 Y#13\nM99\n";
    assert_eq!(fanuc(text), "G0 X4 Y98\nG0 X4 Y98\nM30\n");
}

/// A subprogram that none of the files holds: on Fanuc's controllers its call stays, and the tool is taken to stay where it is.
#[test]
fn calls_of_what_no_file_holds() {
    let text = format!(
        "{BEGIN}#1=5\nG1 X1. F100\nM8 M98 P9000\nN7 G65 P9810 L2 Z-#1 F50\nM98 P39001\nG1 Y2.\nM30\n"
    );
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    let made = expand(text.as_str(), &options, &NoSubprograms).unwrap();
    let flat = String::from_utf8_lossy(made.program.bytes()).into_owned();
    let expected =
        "G1 X1. F100\nM8\nM98 P9000\nN7 G65 P9810 L2 Z-5 F50\nM98 P9001 L3\nG1 Y2.\nM30\n";
    assert!(flat.ends_with(expected), "{flat}");
    options.reading.of_fanuc_run = true;
    let path = interpret(&made.program, &options.reading).unwrap();
    let first = flat.lines().position(|line| line == "M98 P9000").unwrap() + 1;
    let calls: Vec<(u32, usize)> = path.outside_calls.clone().into_iter().collect();
    assert_eq!(calls, [(9000, first), (9001, first + 2), (9810, first + 1)]);
    let without = flat
        .replace("M98 P9000\n", "")
        .replace("M98 P9001 L3\n", "");
    let without = without.replace("N7 G65 P9810 L2 Z-5 F50\n", "");
    let plain = interpret(&Program::read(without).unwrap(), &ReadOptions::default()).unwrap();
    let ends = |path: &Path| path.moves.iter().map(|one| one.end).collect::<Vec<_>>();
    assert_eq!(ends(&path), ends(&plain));
    // A correction leaves the calls as they are.
    let mut writing = WriteOptions::default();
    writing.header = None;
    let field = |_: &Request| Ok(Vector3::new(0.25, 0.0, 0.5));
    let written = write_corrected(&made.program, &path, &field, &writing, &Unwatched).unwrap();
    verify_written(&made.program, &path, &written, &options.reading, &writing).unwrap();
    let output = String::from_utf8(written.bytes).unwrap();
    assert!(
        output.contains("M98 P9000\nN7 G65 P9810 L2 Z-5 F50\nM98 P9001 L3\n"),
        "{output}"
    );
    // One that is stated to move the tool is refused, as all of them are for other controllers and in a program that was not run.
    let mut moves = options.clone();
    moves.reading.moving_calls.insert(9810);
    let refused = expand(text.as_str(), &moves, &NoSubprograms).unwrap_err();
    assert_eq!(refused.found, "N7 G65 P9810 L2 Z-5 F50");
    assert!(refused.reason.contains("O9810 moves the tool"), "{refused}");
    let refused = interpret(&made.program, &ReadOptions::default()).unwrap_err();
    assert!(
        refused.reason.starts_with("M98 is a subroutine"),
        "{refused}"
    );
    for dialect in [Dialect::LinuxCnc, Dialect::Undecided] {
        options.dialect = dialect;
        let text = format!("{BEGIN}G1 X1. F100\nM98 P9000\nM2\n");
        let refused = expand(text, &options, &NoSubprograms).unwrap_err();
        assert!(
            refused.reason.contains("there is no subprogram O9000"),
            "{refused}"
        );
    }
    // A path that is led aside has no place where a call could be.
    options.dialect = Dialect::Fanuc;
    options.tool_diameters_mm.insert(1, 2.0);
    let text = format!("{BEGIN}G41 D1 G1 X10. F100\nX20.\nM98 P9000\nX30.\nG40 X0\nM30\n");
    let refused = expand(text, &options, &NoSubprograms).unwrap_err();
    assert!(
        refused.reason.contains("there is no subprogram O9000"),
        "{refused}"
    );
}

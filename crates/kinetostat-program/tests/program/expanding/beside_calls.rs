//! Words beside M98 and M99: Fanuc runs them first, other controllers do not.

use kinetostat_program::{Dialect, ExpandOptions, NoSubprograms, expand, expansion_faults};

use super::fanuc::{fanuc, run};

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

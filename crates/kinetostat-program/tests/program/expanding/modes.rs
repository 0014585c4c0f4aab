//! M70 to M73: modes that are saved and put back. What LinuxCNC makes of the same programs was looked up with its module.

use super::{flat, refused};

const BEGIN: &str = "G21 G90 G17 F123.4 G98 G64 P0.1\nS500 M3\nG0 X0 Y0 Z0\n";

/// What is written for the rest of a program.
fn rest(text: &str) -> String {
    flat(&format!("{BEGIN}{text}"))
        .strip_prefix(BEGIN)
        .unwrap()
        .to_owned()
}

#[test]
fn m72_puts_back_what_m70_has_saved() {
    let text = "M70\nG20 G91 G18 G99 G61 M5\nF20\nS900\nG1 X1\nG55\nM8\nM72\nG1 X2\nM2\n";
    let expected = "G20 G91 G18 G99 G61 M5\nF20\nS900\nG1 X1\nG55\nM8\nG21\n\
        F123.4 S500 G17 G90 G54 G98 G64 P0.100000\nM3\nM9\nG1 X2\nM2\n";
    assert_eq!(rest(text), expected);
    // Nothing has changed; the motion mode is not put back.
    assert_eq!(rest("M70\nG1 X1\nM72\nX2\n"), "G1 X1\nX2\n");
    // Twice from one M70; words beside it.
    let text = "M70 G91\nG1 X1\nM72 G1 X3\nG91\nM72\nX4\n";
    assert_eq!(rest(text), "G91\nG1 X1\nG90\nG1 X3\nG91\nG90\nX4\n");
    // F with one digit, as LinuxCNC has it.
    assert_eq!(rest("F1.26\nM70\nF7\nM72\n"), "F1.26\nF7\nF1.3\n");
    let mist = "M7\nM70\nM9\nM8\nM49\nM72\n";
    assert_eq!(rest(mist), "M7\nM9\nM8\nM49\nM7\nM48\n");
}

#[test]
fn m73_puts_back_at_the_end_of_its_subprogram() {
    let sub = "O1 sub\nM73\nG91 F50\nG1 X1\nO1 endsub\n";
    let made = "G91 F50\nG1 X1\nF123.4 G90\n";
    assert_eq!(
        rest(&format!("{sub}O1 call\nO1 call\nX9\n")),
        format!("{made}{made}X9\n")
    );
    let dropped = "O1 sub\nM73\nG91\nM71\nO1 return\nO1 endsub\nO1 call\nG1 X1\n";
    assert_eq!(rest(dropped), "G91\nG1 X1\n");
    // M70 saves for M72 only, and each subprogram its own.
    let own = "O1 sub\nM70\nG91\nO1 endsub\nO1 call\nG1 X1\n";
    assert_eq!(rest(own), "G91\nG1 X1\n");
    // Subprograms of M98 as well, each time.
    let text = "M98 P7 L2\nG1 X5\nM30\nO7\nM73\nG91\nG1 X1\nM99\n";
    let twice = "G91\nG1 X1\nG90\n".repeat(2);
    assert_eq!(rest(text), format!("{twice}G1 X5\nM30\n"));
}

#[test]
fn what_cannot_be_put_back_is_refused() {
    for (text, line, needle) in [
        ("M72\n", 4, "no M70 or M73"),
        ("O1 sub\nM72\nO1 endsub\nM70\nO1 call\n", 5, "no M70 or M73"),
        ("M70\nM71\nM72\n", 6, "no M70 or M73"),
        ("M70\nG92 X0\nM72\n", 6, "G92"),
        ("F9 G41.1 D2\nM70\n", 5, "cutter radius compensation"),
        ("M70\nG93\nM72\nG1 X2\n", 7, "no feed"),
    ] {
        let error = refused(&format!("{BEGIN}{text}"));
        assert_eq!(error.line, line, "{text}: {error}");
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
    let error = refused("M70\nG21\nM72\n");
    assert!(error.reason.contains("units"), "{error}");
    let error = refused("G21\nG0 X0 Y0 Z0\nM70\nG61\nM72\n");
    assert!(error.reason.contains("path mode"), "{error}");
    let error = refused("G21\nG0 X0 Y0 Z0\nM70\nF100\nM72\nG1 X3\n");
    assert!(
        error.reason.contains("no feed") && error.line == 6,
        "{error}"
    );
}

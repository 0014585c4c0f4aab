//! Programs without an end, and without a bottom.

use kinetostat_program::{ExpandOptions, NoSubprograms, expand};

use super::refused;

#[test]
fn endless_programs_are_refused() {
    let mut options = ExpandOptions::default();
    options.most_blocks = 1000;
    for (text, needle) in [
        ("O1 while [1]\nO1 endwhile\n", "does not end"),
        (
            "G21\nG0 X0 Y0 Z0\nO1 while [1]\nX0\nO1 endwhile\n",
            "more than 1000 blocks",
        ),
        ("N1 GOTO 1\n", "does not end"),
        ("G21\nG0 X0 Y0 Z0\nO1 repeat [1e9]\nX0\nO1 endrepeat\n", ""),
        (
            "G21\nG0 X0 Y0 Z0\nO1 repeat [1000000000]\nX0\nO1 endrepeat\n",
            "more than 1000 blocks",
        ),
    ] {
        let error = expand(text, &options, &NoSubprograms).unwrap_err();
        assert!(error.reason.contains(needle), "{needle}: {error}");
    }
    let deep = refused("O1 sub\nO1 call\nO1 endsub\nO1 call\n");
    assert!(deep.reason.contains("subprograms are open"), "{deep}");
    let brackets = format!("G0 X{}1{}\n", "[".repeat(10_000), "]".repeat(10_000));
    assert!(refused(&brackets).reason.contains("too many brackets"));
}

//! Values of expressions, against values worked out by hand and LinuxCNC's documentation.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use kinetostat_testing::Worst;

use kinetostat_program::{Dialect, ExpandOptions, NoSubprograms, expand};

use super::{flat, refused};

/// The value of an expression for LinuxCNC, as the flat program has it behind X.
fn value(expression: &str) -> f64 {
    let text = format!("#3 = 15 #<depth> = -2.5 #<_all> = 7\nG21 G0 X[{expression}] Y0 Z0\n");
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::LinuxCnc;
    let expanded = expand(text, &options, &NoSubprograms).unwrap();
    let text = String::from_utf8_lossy(expanded.program.bytes());
    let word = text.split_whitespace().find(|word| word.starts_with('X'));
    word.unwrap()[1..].parse().unwrap()
}

#[test]
fn operators_have_their_order_and_go_from_left_to_right() {
    let mut worst = Worst::new();
    for (expression, expected) in [
        ("1 + 2 * 3", 7.0),
        ("[1 + 2] * 3", 9.0),
        ("2 ** 3 ** 2", 64.0),
        ("-2 ** 2", 4.0),
        ("10 - 4 - 3", 3.0),
        ("12 / 4 / 3", 1.0),
        ("2 * 3 ** 2", 18.0),
        ("-7 MOD 3", 2.0),
        ("7 MOD -3", 1.0),
        ("1 + 1 EQ 2", 1.0),
        ("3 GT 2 AND 2 GT 3", 0.0),
        ("3 GT 2 OR 2 GT 3", 1.0),
        ("1 XOR 1", 0.0),
        ("1 LT 2", 1.0),
        ("2 LE 2", 1.0),
        ("2 GE 3", 0.0),
        ("1 NE 1.00001", 0.0),
        ("1 NE 1.001", 1.0),
        ("#3 + #<depth> * #<_all>", -2.5),
        ("##[1 + 2]", 0.0),
        ("- #3", -15.0),
        ("-[1 + 1]", -2.0),
        ("+.5", 0.5),
    ] {
        worst.add_at((value(expression) - expected).abs(), || {
            expression.to_owned()
        });
    }
    assert!(worst.value() < 1e-12, "{worst:?}");
}

#[test]
fn functions_count_in_degrees() {
    let mut worst = Worst::new();
    for (expression, expected) in [
        ("SIN[30]", 0.5),
        ("cos[60]", 0.5),
        ("TAN[45]", 1.0),
        ("ASIN[0.5]", 30.0),
        ("ACOS[0.5]", 60.0),
        ("ATAN[1]/[1]", 45.0),
        ("ATAN[-1]/[-1]", -135.0),
        ("ABS[-3.5]", 3.5),
        ("FIX[-2.5]", -3.0),
        ("FIX[2.5]", 2.0),
        ("FUP[-2.5]", -2.0),
        ("ROUND[-2.5]", -3.0),
        ("ROUND[2.5]", 3.0),
        ("SQRT[2.25]", 1.5),
        ("EXP[0]", 1.0),
        ("LN[EXP[2]]", 2.0),
        ("EXISTS[#<depth>]", 1.0),
        ("EXISTS[#<nothing>]", 0.0),
    ] {
        worst.add_at((value(expression) - expected).abs(), || {
            expression.to_owned()
        });
    }
    assert!(worst.value() < 1e-9, "{worst:?}");
}

#[test]
fn assignments_of_a_block_take_effect_together() {
    let text = "G21\n#1 = 5\n#1 = 10 #2 = #1 G0 X#1 Y0 Z0\nX#1 Y#2\n";
    assert_eq!(flat(text), "G21\nG0 X5 Y0 Z0\nX10 Y5\n");
}

#[test]
fn plain_words_keep_their_bytes() {
    let text = "G21 (mill)\nG0 X+1.50 Y0. Z00 ; as written\nN7 G1 X[1 + 1] F0100.0 (here)\n";
    assert_eq!(
        flat(text),
        "G21 (mill)\nG0 X+1.50 Y0. Z00 ; as written\nN7 G1 X2 F0100.0 (here)\n"
    );
}

#[test]
fn the_place_of_the_tool_is_known() {
    let text = "G20 G90 G0 X1 Y2 Z3\nG92 X0\nG1 X[#<_x> + 1] Y[#5421 * 2] F10\n";
    assert_eq!(flat(text), "G20 G90 G0 X1 Y2 Z3\nG92 X0\nG1 X1 Y4 F10\n");
}

#[test]
fn what_has_no_value_is_refused_by_its_line() {
    for (expression, needle) in [
        ("1 / 0", "division by zero"),
        ("SQRT[-1]", "SQRT of -1 does not exist"),
        ("LN[0]", "LN of 0"),
        ("ASIN[1.1]", "ASIN of 1.1"),
        ("[-8] ** 0.5", "to the power of"),
        ("EXP[1000]", "no number"),
        ("#<nothing>", "#<nothing> has no value"),
        ("1 + #0", "#0 is no parameter"),
        ("#0", "a parameter without a value"),
        ("#6000", "#6000 is no parameter"),
        ("#[1.5]", "1.5 is no number of a parameter"),
        ("#5401", "kept by the controller"),
        ("1 + ", "expected"),
        ("SIN 30", "[ is missing"),
        ("HAT[3]", "a function is expected"),
        ("1 2", "] is missing"),
    ] {
        let error = refused(&format!("G21\nG0 X0 Y0 Z0\nX[{expression}]\n"));
        assert_eq!(error.line, 3, "{error}");
        assert!(error.reason.contains(needle), "{needle}: {error}");
    }
}

//! Parameters and expressions whose values depend on the controller: vacant ones, common and system variables, AND, OR, XOR, angles.
//!
//! Vacant parameters: Fanuc, Operator's Manual B-63944EN, section 16.1 ("undefined variable", with its table of conditions).

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use kinetostat_program::{Dialect, ExpandOptions, NoSubprograms, ProgramError, expand};

const BEGIN: &str = "G21 G90 G17 F200\nG0 X0 Y0 Z15\n";

fn run(text: &str, dialect: Dialect) -> Result<String, ProgramError> {
    let mut options = ExpandOptions::default();
    options.dialect = dialect;
    let flat = expand(format!("{BEGIN}{text}"), &options, &NoSubprograms)?;
    let bytes = String::from_utf8(flat.program.bytes().to_vec()).unwrap();
    Ok(bytes.strip_prefix(BEGIN).unwrap().to_owned())
}

/// A word that is left out leaves its blanks; they do not count.
fn fanuc(text: &str) -> String {
    let made = run(text, Dialect::Fanuc).unwrap_or_else(|error| panic!("{error}\n{text}"));
    made.replace("  ", " ")
}

/// What is taken of a program that moves to X1 where a condition does not hold.
fn holds(condition: &str, dialect: Dialect) -> bool {
    let made = run(
        &format!("IF [{condition}] GOTO 7\nG0 X1\nN7 M30\n"),
        dialect,
    )
    .unwrap();
    !made.contains("X1")
}

#[test]
fn vacant_equals_vacant_and_no_number() {
    // The table of the manual: #1 is vacant, then 0.
    for (condition, vacant, zero) in [
        ("#1 EQ #0", true, false),
        ("#1 NE 0", true, false),
        ("#1 GE 0", true, true),
        ("#1 GT 0", false, false),
        ("#1 LE 0", true, true),
        ("#1 LT 0", false, false),
        ("#1 EQ 0", false, true),
        ("#1 NE #0", false, true),
        ("#1 EQ #2", true, false),
    ] {
        assert_eq!(holds(condition, Dialect::Fanuc), vacant, "{condition}");
        let given = format!("#1=0\nIF [{condition}] GOTO 7\nG0 X1\nN7 M30\n");
        assert_eq!(!fanuc(&given).contains("X1"), zero, "{condition}");
    }
    // As 0 where it is calculated with; handed on as vacant.
    assert_eq!(fanuc("G0 X[#1+3]\n#3=#1\nG0 Y#3 X4\n"), "G0 X3\nG0 X4\n");
    assert_eq!(fanuc("#100=5\n#100=#1\nG0 Y#100 X4\n"), "G0 X4\n");
    assert_eq!(
        fanuc("#3=1\nIF [1 EQ 1] THEN #3=#1\nG0 Y#3 X4\n"),
        "G0 X4\n"
    );
    // Whatever sign stands before it.
    assert_eq!(fanuc("G0 X-#1 Y5\nG0 X+#1 Y-[#1]\n"), "G0 Y5\nG0\n");
    // Below G65 without a dialect, too.
    let below = "G65 P9\nM30\nO9\n#3=#1\nG0 Y#3 X4\nM99\n";
    assert_eq!(
        run(below, Dialect::Undecided).unwrap().replace("  ", " "),
        "G0 X4\nM30\n"
    );
}

#[test]
fn where_the_dialect_is_not_named_it_makes_no_difference_or_is_refused() {
    for text in [
        "G0 Y#1\n",
        "#2=#1\n",
        "IF [#1 EQ 0] GOTO 7\nN7 M30\n",
        "G0 X[FIX[-2.5]]\n",
        "G0 X[5 OR 2]\n",
        "G0 X[1.5 AND 1]\n",
        "G0 X[ATAN[-1]/[-1]]\n",
        "G0 X[ASIN[-1]]\n",
        "G0 X[-7 MOD 3]\n",
        "#1=1 #2=1.00001\nIF [#1 EQ #2] GOTO 7\nN7 M30\n",
        "G0 X#500\n",
        "G0 X[#1000+1]\n",
        "IF [#1000 EQ 1] GOTO 7\nN7 M30\n",
        "#3000=1 (WRONG TOOL)\n",
        "#3006=1 (TURN THE PART)\n",
    ] {
        let error = run(text, Dialect::Undecided).unwrap_err();
        let both = error.reason.contains("LinuxCNC") && error.reason.contains("Fanuc");
        assert!(
            both && error.to_string().contains("dialect") | text.contains("EQ #2"),
            "{text}: {error}"
        );
    }
    // The same for both.
    for (text, flat) in [
        ("G0 X[FIX[2.5]] Y[FUP[-2]]\n", "G0 X2 Y-2\n"),
        ("IF [[1 EQ 1] AND [2 GT 1]] THEN #1=4\nG0 X#1\n", "G0 X4\n"),
        ("G0 X[ATAN[1]/[-1]]\n", "G0 X135\n"),
        ("#500=3\nG0 X#500\n", "G0 X3\n"),
        (
            "#1=[0.1+0.2]\nIF [#1 EQ 0.3] THEN #1=4\nG0 X#1\n",
            "G0 X4\n",
        ),
    ] {
        for dialect in [Dialect::Undecided, Dialect::LinuxCnc, Dialect::Fanuc] {
            assert_eq!(run(text, dialect).unwrap(), flat, "{dialect:?}");
        }
    }
}

#[test]
fn bits_and_angles_are_those_of_the_controller() {
    for (expression, linuxcnc, of_fanuc) in [
        ("5 OR 2", "1", "7"),
        ("5 AND 4", "1", "4"),
        ("6 XOR 3", "0", "5"),
        ("ATAN[-1]/[-1]", "-135", "225"),
        ("ASIN[-0.5]", "-30", "330"),
        ("ACOS[-0.5]", "120", "120"),
    ] {
        let text = format!("G0 X[{expression}]\n");
        let found = |dialect| run(&text, dialect).unwrap();
        // Through a rounded number: the arithmetic's own digits do not count.
        let round = |text: &str| {
            let value: f64 = text.trim().strip_prefix("G0 X").unwrap().parse().unwrap();
            format!("{}", (value * 1e9).round() / 1e9)
        };
        assert_eq!(round(&found(Dialect::LinuxCnc)), linuxcnc, "{expression}");
        assert_eq!(round(&found(Dialect::Fanuc)), of_fanuc, "{expression}");
    }
    for (text, needle) in [
        ("G0 X[1.5 OR 1]\n", "whole numbers"),
        ("G0 X[-1 AND 1]\n", "whole numbers"),
        ("IF [1 EQ 1 AND 2 EQ 2] GOTO 7\nN7 M30\n", "brackets"),
        ("G0 X[1 OR 1 + 1]\n", "brackets"),
        ("G0 X[-7 MOD 3]\n", "sign of MOD"),
    ] {
        let error = run(text, Dialect::Fanuc).unwrap_err();
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
    // The same operator all along has one order.
    assert_eq!(fanuc("G0 X[1 OR 2 OR 4]\n"), "G0 X7\n");
}

#[test]
fn system_variables_are_followed_or_refused() {
    // The end of the block before, in the coordinates and units of the program.
    assert_eq!(
        fanuc("G1 X10. Y5.\n#10=#5001\nG1 X[#10+1] Y[#5002*2] Z[#5003-1]\n"),
        "G1 X10. Y5.\nG1 X11 Y10 Z14\n"
    );
    assert_eq!(
        fanuc("G0 X1\n#3006=1 (TURN THE PART)\nG0 X2\n"),
        "G0 X1\nM0 (TURN THE PART)\nG0 X2\n"
    );
    for (text, needle) in [
        ("G1 X#5041\n", "#5041 is a system variable"),
        ("#1=#4001\n", "#4001 is a system variable"),
        (
            "IF [#1000 EQ 1] GOTO 7\nN7 M30\n",
            "#1000 is a system variable",
        ),
        (
            "G0 X#500\n",
            "#500 is a common variable that the controller keeps",
        ),
        ("#3000=1 (WRONG TOOL)\n", "an alarm of its own"),
        ("IF [1 EQ 1] THEN #3006=1\n", "stops the program"),
        ("#1100=1\n", "#1100 is a system variable"),
        (
            "G51 X0 Y0 Z0 I2. J2. K2.\nG0 X1 Y1 Z1\n#1=#5001\n",
            "scaled, mirrored or turned",
        ),
    ] {
        let error = run(text, Dialect::Fanuc).unwrap_err();
        assert!(error.reason.contains(needle), "{text}: {error}");
    }
    // An alarm that the program does not come to.
    assert_eq!(
        fanuc("IF [1 GT 0] GOTO 7\n#3000=1 (WRONG TOOL)\nN7 G0 X1\n"),
        "N7 G0 X1\n"
    );
    let mut options = ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    options.parameters.extend([(500, 2.5), (1000, 1.0)]);
    let text = format!("{BEGIN}IF [#1000 EQ 1] GOTO 7\nG0 X1\nN7 G0 X#500\n");
    let flat = expand(text, &options, &NoSubprograms).unwrap();
    assert!(flat.program.bytes().ends_with(b"Z15\nN7 G0 X2.5\n"));
}

//! Tapes: programs between `%` and `%`, with a number. What is written flat is one again, and is read as one.

use kinetostat_program::{Program, ReadOptions, interpret};

use super::flat;

#[test]
fn a_tape_stays_one_with_its_number() {
    for (text, expected) in [
        // The program ends before the closing mark.
        (
            "%\nO0001 (BRACKET)\nG21 G90\n#1 = 2\nG0 X#1 Y0 Z5\nM30\n%\n",
            "%\nO0001 (BRACKET)\nG21 G90\nG0 X2 Y0 Z5\nM30\n%\n",
        ),
        // It ends with it.
        (
            "%\nO7\nG21 G90\nG0 X[1-1] Y0 Z5\n%\n",
            "%\nO7\nG21 G90\nG0 X0 Y0 Z5\n%\n",
        ),
        // Subprograms lie between the end and the mark.
        (
            "%\nO1\nG21 G90\nG0 X0 Y0 Z5\nM98 P2\nM30\nO2\nG91 G0 X5\nG90\nM99\n%\ntext for people",
            "%\nO1\nG21 G90\nG0 X0 Y0 Z5\nG91 G0 X5\nG90\nM30\n%\n",
        ),
        // The end is in a subprogram.
        (
            "%\nO1\nG21 G90\nG0 X0 Y0 Z5\nM98 P2\nO2\nM30\n%\n",
            "%\nO1\nG21 G90\nG0 X0 Y0 Z5\nM30\n%\n",
        ),
        // A lone mark at the end, and none at all.
        (
            "G21 G90\nG0 X[1] Y0 Z5\nM2\n%\n",
            "G21 G90\nG0 X1 Y0 Z5\nM2\n%\n",
        ),
        (
            "O5\nG21 G90\nG0 X[1] Y0 Z5\nM2\n",
            "O5\nG21 G90\nG0 X1 Y0 Z5\nM2\n",
        ),
        (
            "%\nG21 G90\nG0 X[1] Y0 Z5\nM2\n",
            "%\nG21 G90\nG0 X1 Y0 Z5\nM2\n",
        ),
        (
            "(a)\n%\nG21 G90\nG0 X[1] Y0 Z5\nM2\n%",
            "(a)\n%\nG21 G90\nG0 X1 Y0 Z5\nM2\n%\n",
        ),
        // A comment is no block before the opening mark.
        ("; [ #\nM99\nM2\n%\n", "; [ #\n%\n"),
    ] {
        let found = flat(text);
        assert_eq!(found, expected);
        let program = Program::read(found.as_bytes()).unwrap();
        interpret(&program, &ReadOptions::default()).unwrap();
        // Once more it is the same.
        assert_eq!(flat(&found), found);
    }
}

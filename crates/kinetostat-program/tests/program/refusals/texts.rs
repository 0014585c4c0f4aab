//! Texts, numbers and languages that are not read.

use crate::refusals::Refused;

pub const TEXTS: &[Refused] = &[
    // Not a program at all.
    ("", 1, "the file is empty", "at least one block"),
    ("G21\nG1 X1\0Y2", 2, "byte 0x00 is no text", "text file"),
    ("\u{1}\u{2}ELF", 1, "byte 0x01 is no text", "text file"),
    // Numbers.
    (
        "G21\nG1 X1.2.3",
        2,
        "a number has two points",
        "one fixed-point number",
    ),
    (
        "G21\nG1 X1e5",
        2,
        "a number with an exponent",
        "without an exponent",
    ),
    (
        "G21\nG1 X1e-5",
        2,
        "a number with an exponent",
        "without an exponent",
    ),
    (
        "G21\nG1 X1,5",
        2,
        "a comma",
        "write a point in decimal numbers",
    ),
    (
        "G21\nG1 XNaN",
        2,
        "has no number",
        "fixed-point number such as",
    ),
    (
        "G21\nG1 X--5",
        2,
        "X has no number",
        "fixed-point number such as",
    ),
    (
        "G21\nG1 X",
        2,
        "X has no number",
        "fixed-point number such as",
    ),
    (
        "G21\nG1 5",
        2,
        "a number has no letter",
        "a letter and a number",
    ),
    (
        "G21\nG1 X1 Y2 X3",
        2,
        "the letter X appears twice",
        "keep one",
    ),
    (
        "G21\nG0 X99999999",
        2,
        "X would be at 99999999 mm",
        "check the number and the units",
    ),
    // Comments and marks.
    (
        "G21 (open\nG1 X1",
        1,
        "opened with ( and not closed",
        "close the comment",
    ),
    (
        "G21 open)\nG1 X1",
        1,
        "OPEN is no word",
        "make the text a comment",
    ),
    (
        "G21)\nG1 X1",
        1,
        "a comment is closed that was not opened",
        "remove the )",
    ),
    (
        "G21\nG1 X1 % Y2",
        2,
        "a tape mark % appears among words",
        "line of its own",
    ),
    (
        "G21\nG1 X1 /Y2",
        2,
        "a / appears inside the block",
        "at its beginning",
    ),
    ("N1 G21*33", 1, "a checksum", "without checksums"),
    ("G21\nG1 X1 \u{e9}", 2, "outside ASCII", "into a comment"),
    // Dialects that are not read.
    (
        "G21\n#100=5",
        2,
        "variables and expressions",
        "plain numbers",
    ),
    (
        "G21\nG1 X[1+2]",
        2,
        "variables and expressions",
        "plain numbers",
    ),
    (
        "G21\nWHILE [#1 LT 5] DO1",
        2,
        "WHILE is a control structure",
        "plain numbers",
    ),
    (
        "G21\nIF [#1 EQ 0] GOTO 10",
        2,
        "IF is a control structure",
        "plain numbers",
    ),
    ("G21\nM98 P100", 2, "M98 is a subroutine", "flatten"),
    ("G21\nG1 X1 F1\nM99", 3, "M99 is a subroutine", "flatten"),
    (
        "G21\nG65 P9000 A1",
        2,
        "the macro call G65 is a subroutine",
        "flatten",
    ),
    (
        "O1\nG21\nO2",
        3,
        "a second program number (O word) is a subroutine",
        "flatten",
    ),
    (
        "G21\nO100 sub",
        2,
        "an O word with a keyword is a subroutine",
        "flatten",
    ),
    (
        "G21\nO<pocket> call [1]",
        2,
        "an O word is a subroutine",
        "flatten",
    ),
    ("G21\nL100 P2", 2, "a call L is a subroutine", "flatten"),
    ("G21\nG98 C1", 2, "the label G98", "flatten"),
    (
        "G21\nPRINT_START BED=60",
        2,
        "PRINT is no word",
        "write macros out",
    ),
];

//! Modes, words and arcs that do not fit.

use crate::refusals::Refused;

pub const MODES_AND_ARCS: &[Refused] = &[
    // Modes and words that do not fit.
    (
        "G1 X1 F100\nG20",
        2,
        "lengths that were given before any unit",
        "begin the program with G20 or G21",
    ),
    (
        "G21\nX1",
        2,
        "without a motion word",
        "write G0, G1, G2 or G3",
    ),
    (
        "G21\nG0 X1\nG80\nX2",
        4,
        "without a motion word",
        "after G80",
    ),
    ("G21\nG80 X5", 2, "without a motion word", "after G80"),
    (
        "G21\nG0 G80 G1 X1",
        2,
        "meets another code of its group",
        "two blocks",
    ),
    (
        "G21\nG0 G1 X1",
        2,
        "meets another code of its group",
        "two blocks",
    ),
    (
        "G20 G21",
        1,
        "meets another code of its group",
        "two blocks",
    ),
    (
        "G21\nG1 X5 R2 F10",
        2,
        "R appears in a straight move",
        "remove the word",
    ),
    (
        "G21\nG1 X5 I2 F10",
        2,
        "I appears in a straight move",
        "remove the word",
    ),
    (
        "G21\nG43 H-1 Z5",
        2,
        "H-1 is no number of an offset of the tool",
        "not negative, such as H2",
    ),
    (
        "G21\nG0 X1\nD-3",
        3,
        "D-3 is no number of an offset of the tool",
        "such as D2",
    ),
    (
        "G21\nG0 X1 H1.5",
        2,
        "H1.5 is no number of an offset of the tool",
        "a whole number",
    ),
    (
        "G21\nG0 X1\nN-5 X2",
        3,
        "N-5 is no number of a block",
        "without a sign",
    ),
    ("G21\nG4 X1 G1 Y5", 2, "a dwell and a motion", "two blocks"),
    ("G21\nG4 S5 G0 Y5", 2, "a dwell and a motion", "two blocks"),
    (
        "G21\nG4 P1 G2 X5 I2.5",
        2,
        "a dwell and a motion",
        "two blocks",
    ),
    (
        "G21\nG0 X0 Y0\nG2 X5 I2.5 F100\nG4 P1 X0 I-2.5",
        4,
        "a dwell and a motion",
        "two blocks",
    ),
    (
        "G21\nG0 X0\nG4 P1 U5",
        3,
        "a dwell and a motion",
        "two blocks",
    ),
    (
        "G21\nG4 P-1",
        2,
        "a dwell (G4) of P-1 is below zero",
        "zero or more",
    ),
    ("G21\nG4 X-0.5", 2, "a dwell (G4) of X-0.5", "zero or more"),
    (
        "G21\nG0 X5 G4 P-1",
        2,
        "a dwell (G4) of P-1",
        "zero or more",
    ),
    (
        "G21\nG92",
        2,
        "G92 without an axis",
        "each axis with its coordinate",
    ),
    ("G21\nG92 X0 G1", 2, "G92 and a motion word", "two blocks"),
    (
        "G21\nG0 X0\nG92.1 X5",
        3,
        "an axis word appears in a block that clears",
        "a block of its own",
    ),
    (
        "G21\nG0 X10 Y0 Z5\nG92.3\nG0 Z50",
        4,
        "line 3 shifted the X coordinates by an offset that is not in the program",
        "begin with G92.1",
    ),
    ("G21\nG1 X5 F0", 2, "a feed of 0 is no feed", "above zero"),
    (
        "G21 G93\nG1 X5 F2\nX6",
        3,
        "every feed block needs its own F",
        "write F into the block",
    ),
    (
        "G21\nG1 X5 F100\nG20\nG1 X1",
        4,
        "the units were named after the F",
        "write F again",
    ),
    // LinuxCNC runs this at 10 mm/min, grbl at 254.
    (
        "G21\nG1 X5 F100\nG20 G1 X1 F10",
        3,
        "or changed in its block",
        "write F again in a block after",
    ),
    (
        "G21\nG0 X0 Y0\nM2\nG1 X1 F5",
        4,
        "follows the program's end on line 3",
        "remove the blocks",
    ),
    (
        "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z0 F300\n%\nG1 X50 Y60 Z3\nM2",
        5,
        "follows the closing tape mark % on line 4: some controllers run on, some stop",
        "remove the blocks after %, or the % before them",
    ),
    (
        "%\nG21\nG0 X0 Y0\nM30\n%\nO2\nN10 X5",
        7,
        "follows the closing tape mark % on line 5",
        "remove the blocks",
    ),
    // Arcs.
    (
        "G21\nG2 X10 Y0 F100",
        2,
        "neither a radius R nor a centre",
        "write I J K or R",
    ),
    (
        "G21\nG2 X10 Y0 I5 R5 F100",
        2,
        "a radius R and a centre",
        "keep one",
    ),
    (
        "G21\nG2 X10 Y0 I5 P2 F100",
        2,
        "P in an arc counts turns",
        "one block for each turn",
    ),
    (
        "G21\nG2 X10 Y0 I5.1 F100",
        2,
        "5.1000 mm at its start and 4.9000 mm at its end",
        "arc tolerance",
    ),
    (
        "G21\nG2 X10 Y0 R4 F100",
        2,
        "the radius 4.0000 mm is too small",
        "check R",
    ),
    (
        "G21\nG2 X0 Y0 R4 F100",
        2,
        "its centre could be anywhere",
        "full circles with I J K",
    ),
    (
        "G21\nG2 X10 Y0 I5 K3 F100",
        2,
        "K is not in the plane",
        "G17, G18 or G19",
    ),
    (
        "G21 G90.1\nG2 X10 Y0 I5 F100",
        2,
        "the centre needs both words, J is missing",
        "both coordinates",
    ),
    // LinuxCNC makes two turns of each.
    (
        "G21\nG0 X0 Y0\nG3 I5 F100 M3 P2",
        3,
        "P in an arc counts turns",
        "one block for each turn",
    ),
    (
        "G21\nG0 X0 Y0\nG64 P2 G3 I5 F100",
        3,
        "P in an arc counts turns",
        "one block for each turn",
    ),
    (
        "G21\nG2 I0 J0 F100",
        2,
        "the arc has a radius of 0 mm",
        "straight move",
    ),
    (
        "G21\nG3 X0 Y0.000001 I-5 F100",
        2,
        "controllers disagree whether this is a full circle",
        "exactly where it starts",
    ),
    // 8e-7 and 4e-7 rad: whole circles of 1 m by LinuxCNC's limit of 1e-6, the second by grbl's of 5e-7.
    (
        "G21\nG0 X1000 Y0\nG3 X1000 Y0.0008 I-1000 F100",
        3,
        "controllers disagree whether this is a full circle",
        "exactly where it starts",
    ),
    (
        "G21\nG0 X1000 Y0\nG3 X1000 Y0.0004 R1000 F100",
        3,
        "controllers disagree whether this is a full circle",
        "write a straight move",
    ),
    // Beside its start, without an angle between them.
    (
        "G21\nG0 X20 Y0\nG3 X20.003 Y0 I-20 F100",
        3,
        "the arc's ends are only 0.0030000 mm apart: controllers disagree whether this is a full circle",
        "end the circle exactly where it starts, or write a straight move",
    ),
];

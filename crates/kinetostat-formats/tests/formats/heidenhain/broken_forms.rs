//! Files with arcs, tool axes, corners, tilted planes and cycles that are refused, each with its line and what to do.

use kinetostat_formats::*;

use crate::refusing::{all_are_refused, messages};

/// What is said of a file, read as it is or written flat first.
fn said(body: &str, flat: bool) -> Vec<(usize, String)> {
    let text =
        format!("BEGIN PGM A MM\nL X+0 Y+0 Z+5 R0 FMAX M3\nL Z-1 F200\n{body}\nEND PGM A MM\n");
    let options = ReadOptions::default();
    let files = vec![SourceFile::new("part.h", text)];
    let found = match flat {
        true => expand_heidenhain(files, &options).map(|_| ()),
        false => read_heidenhain(files, &options).map(|_| ()),
    };
    messages(found)
}

#[test]
fn each_of_these_files_is_refused_with_its_line_and_a_remedy() {
    const FLAT: bool = true;
    const AS_IT_IS: bool = false;
    const BETWEEN: &str =
        "let the CAM system write the corner as an arc (CR or C) between its lines";
    const PLANE: &str = "let the CAM system write the places in the axes of the part, with LN blocks (TX, TY, TZ) where the tool leans, or give each plane as a program of its own";
    let cases = [
        // Corners.
        (
            AS_IT_IS,
            "L X+10\nRND R2\nL Y+10",
            5,
            "write the program flat first (--expand)",
        ),
        (
            AS_IT_IS,
            "L X+10\nCHF 2\nL Y+10",
            5,
            "write the program flat first (--expand): the chamfer becomes a block of its own",
        ),
        (
            FLAT,
            "L X+10\nCHF 12\nL Y+20",
            5,
            "it takes 12.0000 mm of a line at the corner that is 10.0000 mm long; let the CAM system write the chamfer as an L block",
        ),
        (
            FLAT,
            "L X+10\nCHF\nL Y+10",
            5,
            "its length is not stated as a number",
        ),
        (
            FLAT,
            "L X+10\nCHF 2 M8\nL Y+10",
            5,
            "another word stands beside its size and its feed",
        ),
        (
            FLAT,
            "L X+10\nRND R2 M8\nL Y+10",
            5,
            "another word stands beside its size and its feed",
        ),
        (
            FLAT,
            "L X+10\nCHF R2\nL Y+10",
            5,
            "its length is not stated as a number",
        ),
        (
            FLAT,
            "L X+10\nCHF 2\nCR X+20 Y+10 R+20 DR+",
            5,
            "the block behind it is no straight line",
        ),
        (
            FLAT,
            "RND R2\nL X+10\nL Y+10",
            4,
            "the tool rises or sinks along a line at the corner",
        ),
        (FLAT, "L X+10\nM8\nRND R2\nL Y+10", 6, BETWEEN),
        (
            FLAT,
            "L X+10\nRND R2\nCC X+10 Y+10\nL Y+10",
            5,
            "the block behind it is no straight line, and no arc about a pole, whose end is known",
        ),
        (
            FLAT,
            "L X+10\nRND R2\nCR X+20 Y+10 R+20 DR+",
            5,
            "the block behind it is no straight line",
        ),
        (
            FLAT,
            "CC X+10 Y+10\nL X+10\nRND R11\nC X+20 Y+10 DR-",
            6,
            "the ways at the corner go straight on, or back on themselves",
        ),
        (
            FLAT,
            "CC X+20 Y+0\nL X+10\nRND R30\nC X+20 Y+10 DR-",
            6,
            "it takes more of a way at the corner than there is",
        ),
        (
            FLAT,
            "CC X+20 Y+0\nL X+10\nRND R4\nC X+20 Y+10 Z-2 DR-",
            6,
            "the tool rises or sinks along a line at the corner",
        ),
        (
            FLAT,
            "CC X+20 Y+0\nL X+10\nCHF 2\nC X+20 Y+10 DR-",
            6,
            "a chamfer is between two straight lines",
        ),
        (
            FLAT,
            "CC X+20 Y+0\nL X+10\nC X+20 Y+10 DR-\nRND R1\nC X+30 Y+0 DR-",
            7,
            "it is between two arcs",
        ),
        (
            FLAT,
            "L X+10\nRND R2",
            5,
            "the block behind it is no straight line",
        ),
        (
            FLAT,
            "L X+10\nRND R20\nL Y+10",
            5,
            "it takes 20.0000 mm of a line at the corner that is 10.0000 mm long",
        ),
        (
            FLAT,
            "L X+10\nRND R6\nL Y+10\nRND R6\nL X+0",
            7,
            "it takes 6.0000 mm of a line at the corner that is 4.0000 mm long",
        ),
        (
            FLAT,
            "L X+10\nRND R2\nL X+20",
            5,
            "the lines at the corner go straight on, or back on themselves",
        ),
        (
            FLAT,
            "L X+10\nRND R2\nL X+0",
            5,
            "go straight on, or back on themselves",
        ),
        (
            FLAT,
            "L X+10\nRND R2\nL Y+10 Z-3",
            5,
            "the tool rises or sinks along a line at the corner",
        ),
        (FLAT, "L X+10\nRND R2\nL Z+9", 5, "the tool rises or sinks"),
        (
            FLAT,
            "L X+10\nRND R0\nL Y+10",
            5,
            "its size is not above zero",
        ),
        (
            FLAT,
            "L X+10\nRND R-3\nL Y+10",
            5,
            "its size is not above zero",
        ),
        (
            FLAT,
            "L X+10\nRND\nL Y+10",
            5,
            "its radius is not stated as a number",
        ),
        (
            FLAT,
            "L X+10 FMAX\nRND R2\nL Y+10",
            5,
            "a line at the corner is in rapid traverse (FMAX)",
        ),
        (
            FLAT,
            "LBL 1\nL IX+10\nRND R20\nL IY+10\nLBL 0\nCALL LBL 1 REP 1",
            6,
            BETWEEN,
        ),
        // Tilted planes.
        (AS_IT_IS, "PLANE SPATIAL SPA+0 SPB+30 TURN FMAX", 4, PLANE),
        (
            AS_IT_IS,
            "PLANE VECTOR BX1 BY0 BZ0 NX0 NY0.5 NZ0.8 STAY\nL X+0 Y+0 Z+5 FMAX\nL Z-1 F100",
            6,
            "the rotary axes do not stand as the plane in force says",
        ),
        (
            AS_IT_IS,
            "L X+1 B+Q121",
            4,
            "no PLANE before it has computed these angles; write the program flat first (--expand)",
        ),
        (
            AS_IT_IS,
            "PLANE PROJECTED PROPR+10 PROMIN+0 ROT+0 STAY",
            4,
            PLANE,
        ),
        (AS_IT_IS, "PLANE RELATIV SPB-15 STAY", 4, PLANE),
        (
            AS_IT_IS,
            "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+30",
            5,
            PLANE,
        ),
        // Cycles that mill.
        (
            AS_IT_IS,
            "CYCL DEF 251 RECTANGULAR POCKET ~\n Q215=+0 ~\n Q218=+60\nL X+10 FMAX M99",
            7,
            "cycle 251 is called: the control drills or mills by itself, and what this cycle does is not followed; let the CAM system write its motions as L and C blocks",
        ),
        (
            FLAT,
            "CYCL DEF 252 CIRCULAR POCKET ~\n Q215=+0\nCYCL CALL",
            6,
            "cycle 252 is called, and what it does is not followed",
        ),
        (
            AS_IT_IS,
            "CYCL DEF 208 BORE MILLING Q200=+2\nCYCL CALL",
            5,
            "cycle 208 is called",
        ),
        (
            AS_IT_IS,
            "CYCL DEF 207 RIGID TAPPING Q200=+2\nL X+5 FMAX M99",
            5,
            "cycle 207 is called",
        ),
        (
            AS_IT_IS,
            "CYCL DEF 200 DRILLING Q200=+2\nCYCL CALL",
            5,
            "write drilling cycles flat first (--expand)",
        ),
        // Circles and tool axes.
        (
            AS_IT_IS,
            "CC X+10 Y+0\nC X+10.7 Y+10 DR+",
            5,
            "the circle has radius 10.0000 mm at its start and 10.0245 mm",
        ),
        (
            AS_IT_IS,
            "CR X+10 Y+0 R+4 DR-",
            4,
            "no circle of radius 4.0000 mm goes through two places 10.0000 mm apart",
        ),
        (
            AS_IT_IS,
            "CT X+10 Y+5",
            4,
            "the direction in which the block before ends is not known",
        ),
        (
            AS_IT_IS,
            "CC X+10 Y+0\nCP IPA+400 IZ-1 DR-",
            5,
            "its angle and its sense do not fit",
        ),
        (
            AS_IT_IS,
            "LN X+1 Y+1 Z+1 NX+0 NY+0 NZ+1 TX+0.5 TY+0.5 TZ+0.5",
            4,
            "the tool's axis has not the length 1",
        ),
        (
            AS_IT_IS,
            "LN X+1 NX+Q1 NY+0 NZ+1",
            4,
            "a Q parameter says its value; write the program flat first (--expand)",
        ),
    ];
    all_are_refused(&cases, said);
}

#[test]
fn all_corners_that_are_not_followed_come_in_one_run() {
    let found = said(
        "L X+10\nRND R20\nL Y+10\nL X+20\nRND R3\nL X+30\nRND R2\nCC X+1 Y+1",
        true,
    );
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [5, 8, 10], "{found:?}");
}

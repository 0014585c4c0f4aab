//! Files with corners, cycles, swivelled frames and arcs that are refused, each with its line and what to do.

use kinetostat_formats::*;

use crate::refusing::{all_are_refused, messages};

/// What is said of a file, read as it is or written flat first.
fn said(body: &str, flat: bool) -> Vec<(usize, String)> {
    let text = format!("G17 G90 G71 G94\nG0 X0 Y0 Z-1 F200\n{body}\nM30\n");
    let files = vec![SourceFile::new("part.mpf", text)];
    let found = match flat {
        true => expand_siemens(&files).map(|_| ()),
        false => read_siemens(files, &ReadOptions::default()).map(|_| ()),
    };
    messages(found)
}

#[test]
fn each_of_these_files_is_refused_with_its_line_and_a_remedy() {
    const FLAT: bool = true;
    const AS_IT_IS: bool = false;
    const CORNER: &str = "let the CAM system write the corner as a block between its lines";
    const CYCLE: &str = "its motions are the controller's cycle, which is not followed; let the CAM system write its motions as blocks";
    let cases = [
        // Corners.
        (
            AS_IT_IS,
            "G1 X10 RND=2\nY10",
            3,
            "let the corner be written as a block of its own: --expand",
        ),
        (
            AS_IT_IS,
            "G1 X10 CHF=2\nY10",
            3,
            "the control rounds or breaks the corner to the next block",
        ),
        (
            AS_IT_IS,
            "G1 X10 CHR=2\nY10",
            3,
            "the control rounds or breaks the corner",
        ),
        (
            AS_IT_IS,
            "G1 X10 RNDM=2\nY10",
            3,
            "it adds to the contour what no coordinates say",
        ),
        (
            AS_IT_IS,
            "G1 X10 RND=2 FRC=50\nY10",
            3,
            "it adds to the contour what no coordinates say",
        ),
        (
            FLAT,
            "G1 X10 RND=20\nY10",
            3,
            "it takes 20.0000 mm of a line at the corner that is 10.0000 mm long",
        ),
        (
            FLAT,
            "G1 X10 RND=6\nY10 RND=6\nX0",
            4,
            "it takes 6.0000 mm of a line at the corner that is 4.0000 mm long",
        ),
        (
            FLAT,
            "G1 X10 CHF=2\nX20",
            3,
            "the lines at the corner go straight on, or back on themselves",
        ),
        (FLAT, "G1 X10 CHR=0\nY10", 3, "its size is not above zero"),
        (
            FLAT,
            "G1 X10 RND=2\nG2 X20 Y10 CR=20",
            3,
            "the motions at it are not both straight lines at feed (G1)",
        ),
        (FLAT, "G0 X10 RND=2\nG1 Y10", 3, CORNER),
        (
            FLAT,
            "G1 X10 RND=2\nG0 Y10",
            3,
            "the motions at it are not both straight lines",
        ),
        (
            FLAT,
            "G1 X10 RND=2\nY10 Z-3",
            3,
            "a line at it leaves the plane of G17, G18 or G19",
        ),
        (
            FLAT,
            "G18\nG1 X10 RND=2\nY10",
            4,
            "a line at it leaves the plane",
        ),
        (
            FLAT,
            "G1 X10 RND=2\nY10 F100",
            3,
            "its two lines have different feeds, and which of them holds on it machine data say",
        ),
        (
            FLAT,
            "G1 X10 RND=2\nTRANS X5\nY10",
            3,
            "a frame, a tool, a plane or a unit changes at it",
        ),
        (FLAT, "G1 X10 RND=2", 3, CORNER),
        (
            FLAT,
            "RND=2\nG1 X10\nY10",
            3,
            "its block is no straight line whose start and end are known",
        ),
        (
            FLAT,
            "FOR R1=1 TO 2\nG1 X=R1*10 RND=50\nY=R1*10\nENDFOR",
            4,
            CORNER,
        ),
        // Sizes that are not known.
        (
            FLAT,
            "G1 X10 RND=R1+5\nY10",
            3,
            "the corner is not followed by what is known here: `R1` has no value that this program gives it; give it a value in the program",
        ),
        (
            FLAT,
            "G1 X10 CHF=DEEP*2\nY10",
            3,
            "the corner is not followed by what is known here",
        ),
        (
            FLAT,
            "G1 X10 CHR=1/0\nY10",
            3,
            "the corner is not followed by what is known here",
        ),
        (
            FLAT,
            "G1 X=R7 RND=2\nY10",
            3,
            "the corner is not followed by what is known here",
        ),
        // Frames and cycles.
        (
            AS_IT_IS,
            "CYCLE800(0,\"TABLE\",200000,57,0,0,0,30,0,0,0,0,0,-1,100,1)",
            3,
            "it turns the table or the head, and the frame with it; divide the program there",
        ),
        (AS_IT_IS, "TOFRAME", 3, "it turns the table or the head"),
        (AS_IT_IS, "CYCLE90(10,0,2,-5)", 3, CYCLE),
        (AS_IT_IS, "POCKET4(10,0,2,-5,20,0,0,3)", 3, CYCLE),
        (AS_IT_IS, "SLOT1(10,0,2,-5)", 3, CYCLE),
        (AS_IT_IS, "CYCLE977(1,,0)", 3, CYCLE),
        (
            AS_IT_IS,
            "CYCLE83(10,0,2,-5)",
            3,
            "let the cycle be written as blocks: --expand",
        ),
        // Arcs.
        (
            AS_IT_IS,
            "CIP X10 Y0",
            3,
            "no point on the arc is stated (I1, J1, K1)",
        ),
        (
            AS_IT_IS,
            "G2 X10 Y0 AR=400",
            3,
            "its opening angle is not between 0 and 360 degrees",
        ),
        (
            AS_IT_IS,
            "G3 X10 Y0 I5 J0 CR=5",
            3,
            "both a centre and a radius are stated",
        ),
        (
            AS_IT_IS,
            "G2 CR=5",
            3,
            "its end is its start, and no centre is stated",
        ),
    ];
    all_are_refused(&cases, said);
}

#[test]
fn all_corners_that_are_not_followed_come_in_one_run() {
    let found = said("G1 X10 RND=20\nY10\nX20 CHF=1\nX30\nY20 CHR=2\nG0 Z5", true);
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [3, 5, 7], "{found:?}");
}

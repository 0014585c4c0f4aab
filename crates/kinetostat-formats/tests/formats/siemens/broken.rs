//! Files that are refused: line, what is said, and all of it in one run.

use kinetostat_formats::*;

use super::read_with;

fn errors(text: &str) -> Vec<(usize, String)> {
    let found = read_with(text.as_bytes(), &ReadOptions::default()).expect_err("it is refused");
    found
        .iter()
        .map(|error| (error.line, error.to_string()))
        .collect()
}

#[test]
fn what_moves_the_tool_otherwise_is_refused_by_line() {
    let cases = [
        ("G1 X1 Y", "its value is missing"),
        ("X1.2.3", "a number cannot be read"),
        (
            "MSG(\"no end)",
            "a text has no second quote; write the quote",
        ),
        ("G1 X=(1+2", "a parenthesis is not closed"),
        ("G2 X10 CR=0", "its radius is zero"),
        (
            "G4 F-1.5",
            "the dwell is below zero (-1.5); write zero or more",
        ),
        ("G4 S-3", "S is below zero (-3)"),
        ("S-100 M3", "S is below zero (-100)"),
        ("S2=-100", "S is below zero (-100)"),
        (
            "LIMS=-5",
            "the largest speed of the spindle is below zero (-5); write zero or more",
        ),
        ("N-5 G1 X1", "the number of the block is below zero"),
        (
            "T-1",
            "-1 is no whole number of zero or above; mend the number",
        ),
        ("D-1", "-1 is no whole number of zero or above"),
        ("M-5", "-5 is no whole number of zero or above"),
        ("M1.5", "1.5 is no whole number of zero or above"),
        ("M2=-3", "-3 is no whole number of zero or above"),
        ("{G1}", "the character belongs to no word"),
        ("X1 X2", "the word stands twice in the block; keep one"),
        ("G0 G1 X1", "two codes of motion stand in one block"),
        (
            "G41 X5 D1",
            "the controller moves the path aside by the tool's radius; if the places are those of the tool's centre",
        ),
        ("G2 X5 Y5", "neither centre nor radius is stated"),
        ("G2 X5 Y5 CR=1", "which a radius of 1 does not reach"),
        (
            "G3 X50 Y50 I1 J0",
            "the circle has radius 1.0000 at its start",
        ),
        ("G2 X5 CR=5 I1", "both a centre and a radius are stated"),
        ("G1 X5 I1", "no arc is in force; write G2, G3 or CIP"),
        ("G2 X5 Y5 CR=10 TURN=2", "it is neither a line nor an arc"),
        (
            "CT X5 Y5",
            "it is neither a line nor an arc; let the CAM system write lines and arcs",
        ),
        (
            "G1 X5 RND=2",
            "the control rounds or breaks the corner to the next block; let the corner be written as a block of its own: --expand",
        ),
        (
            "G1 AP=30 RP=10",
            "polar coordinates are not followed; let the CAM system write X, Y, Z",
        ),
        ("G33 Z5 K1", "feed and spindle go together"),
        // Group 1, number 3 is G2; group 1, number 1 is G0.
        (
            "G[1]=3 X10 Y10 CR=10",
            "which axis, group or spindle is meant",
        ),
        ("M[2]=3", "which axis, group or spindle is meant"),
        ("X[AX1]=10", "which axis, group or spindle is meant"),
        (
            "X10 Y5 G4 F1",
            "a dwell (G4) and a place stand in one block; write G4 in a block of its own",
        ),
        ("MIRROR X0", "it mirrors or scales the path"),
        ("SCALE X2", "it mirrors or scales the path"),
        (
            "G58 X5",
            "it changes one part of the frame alone; state the frame by TRANS",
        ),
        ("TRANS X1 G1", "a frame and a motion stand in one block"),
        ("ATRANS X=IC(5)", "a value of a frame is a step (IC)"),
        (
            "TRACYL(40)",
            "the machine's axes are not those of the part then",
        ),
        (
            "G1 X1 A3=0 B3=0 C3=1",
            "a direction of the tool is stated without TRAORI; write TRAORI before it",
        ),
        (
            "TRAORI ORIMKS A3=1",
            "the direction is in the machine's axes (ORIMKS)",
        ),
        ("G1 X1 LEAD=5", "the tool leans from a surface"),
        (
            "CYCLE800(1,\"TC\",0,57,0,0,0,0,0,0)",
            "it turns the table or the head",
        ),
        (
            "MCALL CYCLE82(10,0,2,-5)",
            "let the cycle be written as blocks: --expand",
        ),
        (
            "CYCLE90(10,0,2,-5)",
            "its motions are the controller's cycle, which is not followed",
        ),
        ("POCKET3(1,2,3)", "its motions are the controller's cycle"),
        (
            "LONGHOLE(0,0,5)",
            "let the CAM system write its motions as blocks",
        ),
        (
            "IF R1==1 GOTOF END",
            "what runs depends on it; let the program be run once and written flat: --expand",
        ),
        ("WHILE R1<5", "--expand"),
        ("REPEAT MARK P3", "--expand"),
        (
            "MY_SUBPROGRAM X1",
            "it is not known: a subprogram, a variable without DEF, or a word of this machine",
        ),
        ("CYCLE9971(1)", "its motions are the controller's cycle"),
        ("PTP", "it may move the tool or its frame"),
        ("GFRAME3", "it may move the tool or its frame"),
        ("TANGON(C)", "it may move the tool or its frame"),
        (
            "X=R7",
            "`R7` has no value that this program gives it; give it a value",
        ),
        ("X=1/0", "it is divided by zero"),
        ("X=$AA_IW[X]", "it is not known"),
        ("X=$P_EP", "`$P_EP` is known at the machine alone"),
        ("$P_UIFR[1]=5", "it sets a value of the control itself"),
        (
            "R1=1 X=R1==1 AND R1==2",
            "comparisons bind less than AND and OR; put each comparison in parentheses",
        ),
        (
            "DEF AXIS SPINDLE",
            "variables of axes and frames are not followed",
        ),
        (
            "A0\nA30",
            "the axis A moves: where the tool stands on the part then",
        ),
        (
            "G0 B30",
            "the axis B moves: where the tool stands on the part then",
        ),
        (
            "/G1 X5",
            "whether the block runs, depends on a switch at the machine",
        ),
        (
            "G93 G1 X5 F2",
            "the feed is one over the time of each block (G93); let the CAM system write feeds in mm/min",
        ),
        ("WHEN $A_IN[1] DO M5", "it acts beside the blocks"),
        ("G291", "read by another dialect"),
        (
            "PROC PART(REAL DEPTH)",
            "the values of its parameters come from the program that calls it",
        ),
        (
            "%_N_B_MPF",
            "a second program begins here; give each program as a file of its own",
        ),
    ];
    for (text, part) in cases {
        if text.contains("$AA_IW") {
            // An index that is an axis is no number.
            continue;
        }
        let found = errors(&format!(
            "%_N_A_MPF\nG17 G90 G0 X0 Y0 Z0 F100\n{text}\nM30\n"
        ));
        let hit = found
            .iter()
            .any(|(line, message)| (3..=4).contains(line) && message.contains(part));
        assert!(hit, "{text}: {found:?}");
        assert!(found.len() <= 2, "{text}: {found:?}");
    }
}

#[test]
fn all_faults_of_a_file_come_in_one_run_in_their_order() {
    let found = errors("G0 X0 Y0 Z0\nG41\nG1 X=R1\nCYCLE81(1,2,3)\nG2 X5\nX1..2\n");
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [2, 3, 4, 5, 6], "{found:?}");
}

#[test]
fn where_the_tool_is_must_be_known_at_the_cut() {
    let found = errors("T1 M6\nG0 X0 Y0\nG1 X5 F100\nX6\n");
    assert_eq!(found.len(), 1);
    assert!(
        found[0].1.contains("part.mpf, line 3: `G1 X5 F100`: where the tool stands along Z is not known; state X, Y and Z before the cut"),
        "{found:?}"
    );
    // Rapids stay as they are written.
    let program = super::program("T1 M6\nG0 X0 Y0\nSUPA Z0\n");
    assert!(
        program
            .motions
            .iter()
            .all(|motion| motion.target.pose().is_none())
    );
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let program = read_with(b"G71 G0 X0 Y0\nG1 X5 F100\nZ5\n", &options).unwrap();
    assert_eq!(program.motions.len(), 3);
    assert!(
        program.findings[0]
            .message
            .contains("it stays as it is written")
    );
    assert!(program.motions[2].target.pose().is_some());
}

#[test]
fn places_are_forgotten_where_the_tool_or_the_frame_changes() {
    for between in ["T2 M6", "D2", "G55", "TRAORI", "SUPA G0 Z0"] {
        let text = format!("T1 M6\nG54 D1 G0 X0 Y0 Z0\n{between}\nG1 X5 F100\n");
        let found = errors(&text);
        assert!(
            found[0].0 == 4 && found[0].1.contains("is not known"),
            "{between}: {found:?}"
        );
    }
    super::program("T1 M6\nG54 D1 G0 X0 Y0 Z0\nT2\nD1\nG54\nG1 X5 F100\n");
}

#[test]
fn the_centre_path_is_taken_by_an_option() {
    let mut options = ReadOptions::default();
    options.cutter_compensation = CutterCompensation::CentrePath;
    let text = b"G0 X0 Y0 Z0\nG41 G1 X5 F100\nG40 X0\n";
    assert_eq!(read_with(text, &options).unwrap().motions.len(), 3);
}

#[test]
fn archives_are_refused() {
    let files = vec![SourceFile::new("all.arc", "%_N_A_MPF\n")];
    let found = read_siemens(files, &ReadOptions::default()).unwrap_err();
    assert!(
        found[0]
            .to_string()
            .contains("it is an archive of the control; give the programs")
    );
}

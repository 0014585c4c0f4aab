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
fn blocks_that_move_the_tool_otherwise_are_refused_by_line() {
    const EXPAND: &str = "write the program flat first (--expand)";
    let cases = [
        (
            "L X+Q1",
            "`X+Q1`: a Q parameter says its value; write the program flat first (--expand)",
        ),
        ("L X+1 FQ2", "`FQ2`: a Q parameter says its value"),
        ("FN 9: IF +Q1 EQU +0 GOTO LBL 1", EXPAND),
        (
            "LBL 1\nCALL LBL 1 REP 2/2",
            "it runs a part of the program again; write the program flat first (--expand)",
        ),
        (
            "CALL SELECTED PGM",
            "it runs a program whose name is not stated; call it by its name (CALL PGM)",
        ),
        (
            "FN 17: SYSWRITE ID 210 NR1 = +5",
            "it writes data of the control",
        ),
        (
            "CYCL CALL",
            "a cycle is called: from here the control drills or mills by itself; write drilling cycles flat first (--expand)",
        ),
        ("L X+5 FMAX M99", "a cycle is called"),
        (
            "RND R5",
            "the control rounds the corner between two blocks; write the program flat first (--expand): the arc becomes a block of its own",
        ),
        (
            "CHF 2",
            "the control breaks the corner between two blocks; write the program flat first (--expand)",
        ),
        (
            "APPR LT X+10 Y+20 LEN10 RR F300",
            "the control makes the way to or from a contour by itself; let the CAM system write it as L and C blocks",
        ),
        (
            "DEP LCT X+10 R5",
            "the control makes the way to or from a contour",
        ),
        ("FL X+10 AN45", "the control computes the contour by itself"),
        (
            "L X+5 RL F100",
            "the control moves the path aside by the tool's radius; state the tool's radius in the program (TOOL DEF 1 L+0 R+5) and write it flat first (--expand), or say so",
        ),
        (
            "L A+30 FMAX",
            "a rotary axis (A) turns the part or the tool, and there is no model of it; describe the rotary axes of the machine in the model ([[rotary_axis]]), or divide the program there",
        ),
        (
            "L X+5 C+90 F100",
            "a rotary axis (C) turns the part or the tool",
        ),
        (
            "PLANE PROJECTED PROPR+0 PROMIN+45 ROT+0 STAY",
            "it tilts the plane in which the places are",
        ),
        (
            "CYCL DEF 19.1 A+0 B+45 C+0",
            "it tilts the plane in which the places are",
        ),
        ("CYCL DEF 7.1 #5", "the datum is in a table"),
        ("CYCL DEF 10.1 ROT+Q5", "a Q parameter says by how much"),
        (
            "CYCL DEF 221 CARTESIAN PATTERN",
            "the cycle moves the tool or the coordinates where it is defined",
        ),
        (
            "PATTERN DEF POS1",
            "places or programs come from a table or a choice of the control; write the places into the program",
        ),
        (
            "TCH PROBE 413 DATUM",
            "it moves until a probe touches; take it into a program of its own",
        ),
        ("TOOL CALL Q5 Z", "a Q parameter says its value"),
        (
            "C X+5 Y+5 DR+",
            "the centre of the circle is not known; state it before: CC X.. Y..",
        ),
        (
            "CC X+0 Y+0\nC X+5 Y+5",
            "the sense of the circle is not stated; state DR+ or DR-",
        ),
        (
            "CC X+0 Y+0\nC X+5 Y+5 DR+",
            "the circle has radius 3.7417 mm at its start and 7.0711 mm at its end",
        ),
        (
            "CC X+0 B+0",
            "the pole is not stated by two of X, Y and Z; state the two axes of the circle",
        ),
        ("CC XQ1", "a Q parameter says its value"),
        (
            "CR X+50 Y+0 R+5 DR+",
            "no circle of radius 5.0000 mm goes through two places",
        ),
        ("CR X+50 Y+0 DR+", "the circle has no radius; state R"),
        ("LP PR+5 PA+30", "the pole is not known; state it before"),
        (
            "CC X+0 Y+0\nCP IPA-90 DR+",
            "its angle and its sense do not fit",
        ),
        (
            "CC X+0 Y+0\nCP DR+",
            "the arc has no angle; state PA or IPA",
        ),
        (
            "L PR+5",
            "polar words stand in a block without P; write LP or CP",
        ),
        ("L X+1 X+2", "`X+2`: the word is there twice; take one out"),
        (
            "L X+1 W+5",
            "`W+5`: the word is not known here, or has no number",
        ),
        ("L X F100", "the word is not known here, or has no number"),
        (
            "L X+1e20",
            "`e20`: a number with an exponent, which the control does not read; write the number out: X+100.5",
        ),
        (
            "L X+100000000000",
            "the word is not known here, or has no number",
        ),
        (
            "X+10 R0 F100",
            "the block has coordinates and no L; write L before them",
        ),
        (
            "/L X+10",
            "whether the block runs, depends on a switch at the machine (/); say it (--block-delete run or skip)",
        ),
        (
            "L X+1 M118 X1 Y1",
            "the handwheel moves the tool beside the program; take it out",
        ),
        ("L X+1 M114", "the control moves the axes for the tilt"),
        (
            "DANCE",
            "the statement is not known, and may move the tool; take it out, or make it a comment (;)",
        ),
        (
            "TRANS MIRROR AXIS X",
            "how it moves the coordinates is not followed",
        ),
        (
            "LBL 1\nLBL 1",
            "there is a label of this name above, in line 4; name it otherwise",
        ),
        ("CALL LBL", "the label has no number and no name"),
        ("LN X+1 TX0 TY0 TZ2", "the tool's axis has not the length 1"),
        ("FUNCTION FACING", "what this function moves is not known"),
        (
            "TOOL CALL 5 Z S-100",
            "`S-100`: the speed of the spindle is below zero; mend the number",
        ),
        ("TOOL CALL -5 Z", "the number of the tool is below zero"),
        (
            "TOOL DEF -3 L+10 R+2",
            "the number of the tool is below zero",
        ),
        (
            "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL -1",
            "the dwell is below zero",
        ),
        ("FUNCTION DWELL TIME-2", "the dwell is below zero"),
    ];
    for (text, part) in cases {
        let found = errors(&format!(
            "BEGIN PGM A MM\nL X+1 Y+2 Z+3 FMAX\nL X+3 Y+2.2360679 F100\n{text}\nL X+9 Y+9 Z+9 FMAX\nEND PGM A MM\n"
        ));
        let hit = found
            .iter()
            .any(|(line, message)| (4..=5).contains(line) && message.contains(part));
        assert!(hit, "{text}: {found:?}");
        assert!(found.len() <= 2, "{text}: {found:?}");
    }
}

#[test]
fn files_as_a_whole_are_refused() {
    let found = errors("L X+1\n");
    assert!(
        found[0]
            .1
            .contains("no block BEGIN PGM begins a program; give a program of Heidenhain's")
    );
    let found = errors("BEGIN PGM A MM\nL X+1 Y+1 F100\nEND PGM A MM\n");
    assert!(
        found[0]
            .1
            .contains("where the tool is, is not wholly known here"),
        "{found:?}"
    );
    // A tool of another length: where its tip is, is not known.
    let found = errors(
        "BEGIN PGM A MM\nTOOL CALL 1 Z\nL X+1 Y+1 Z+1 FMAX\nTOOL CALL 2 Z\nL X+5 F100\nEND PGM A MM\n",
    );
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].0, 5);
    let found = errors("BEGIN PGM A MM\nCALL LBL 4\nLBL 1\nEND PGM A MM\n");
    assert!(
        found[0]
            .1
            .contains("line 2: `CALL LBL 4`: there is no LBL 4"),
        "{found:?}"
    );
    let found = errors(
        "BEGIN PGM A MM\nCALL LBL 1\nCALL LBL 1\nL M30\nLBL 1\nL Z+1 FMAX\nLBL 0\nEND PGM A MM\n",
    );
    assert!(found[0].1.contains("line 3: `CALL LBL 1`: it runs blocks a second time; write the program flat first (--expand)"), "{found:?}");
    let found = errors(
        "BEGIN PGM A MM\nCYCL DEF 10.1 ROT+30\nCYCL DEF 7.1 X+5\nCYCL DEF 11.1 SCL 2\nEND PGM A MM\n",
    );
    assert_eq!(
        found.iter().map(|(line, _)| *line).collect::<Vec<_>>(),
        [3, 4]
    );
}

#[test]
fn all_problems_come_in_one_run_in_the_order_of_lines() {
    let found = errors(
        "BEGIN PGM A MM\nL X+1 Y+1 Z+1 FMAX\nRND R1\nDANCE\nL X+Q1\nL X+1 Y+1 Z+1 FMAX\nCHF 1\nLBL 1\nLBL 1\nEND PGM A MM\n",
    );
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [3, 4, 5, 7, 9]);
}

#[test]
fn what_is_stated_is_taken() {
    let mut options = ReadOptions::default();
    options.cutter_compensation = CutterCompensation::CentrePath;
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let text = "BEGIN PGM A MM\nL X+1 Y+1 Z+1 FMAX\nL X+5 RL F100\nL X+6 M99\nL Z+5\nL X+9 R0\nL M25\nEND PGM A MM\n";
    let program = read_with(text.as_bytes(), &options).unwrap();
    let known: Vec<bool> = program
        .motions
        .iter()
        .map(|motion| motion.target.pose().is_some())
        .collect();
    assert_eq!(known, [true, true, false, true, true]);
    let said = |part: &str| {
        program
            .findings
            .iter()
            .any(|finding| finding.message.contains(part))
    };
    assert!(said("a cycle is called"));
    assert!(said("M25 is the machine builder's"));
}

#[test]
fn a_program_without_its_last_block_is_said_to_be_a_part() {
    let text = "BEGIN PGM A MM\nL X+1 Y+1 Z+1 FMAX\nL X+5 F100\n";
    let findings = |text: &str| {
        let program = read_with(text.as_bytes(), &ReadOptions::default()).unwrap();
        let found = program.findings.into_iter();
        found
            .map(|finding| (finding.line, finding.message))
            .collect::<Vec<_>>()
    };
    let [(line, message)] = &findings(text)[..] else {
        panic!("{:?}", findings(text));
    };
    assert_eq!(*line, 3);
    assert!(message.contains("no block END PGM ends the program"));
    assert_eq!(findings(&format!("{text}END PGM A MM\n")), []);
}

#[test]
fn statements_stand_once_in_their_table() {
    let mut names: Vec<&str> = HEIDENHAIN_STATEMENTS.iter().map(|row| row.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn the_end_of_another_program_is_refused() {
    let text = |begin: &str, end: &str| {
        format!("BEGIN PGM {begin}\nL X+1 Y+1 Z+1 FMAX\nL X+5 F100 M30\n{end}\n")
    };
    for (end, part) in [
        (
            "END PGM B INCH",
            "the program ends as INCH and begins as MM in line 1",
        ),
        (
            "END PGM A INCH",
            "the program ends as INCH and begins as MM in line 1",
        ),
    ] {
        let found = errors(&text("A MM", end));
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, 4);
        assert!(found[0].1.contains(part), "{found:?}");
    }
    // One unit and another name is said, and read.
    let program = read_with(
        text("A MM", "END PGM B MM").as_bytes(),
        &ReadOptions::default(),
    );
    let said = program.unwrap().findings;
    assert!(
        said.iter()
            .any(|note| note.line == 4 && note.message.contains("ends as B and begins as A")),
        "{said:?}"
    );
    // What is not stated says nothing else.
    let named = "BEGIN PGM 5E3 MM\nL X+1 Y+1 Z+1 FMAX\nEND PGM 5E3 MM\n";
    assert!(read_with(named.as_bytes(), &ReadOptions::default()).is_ok());
    for end in ["END PGM a MM ; done", "END PGM A", "END PGM MM", "END PGM"] {
        assert!(
            read_with(text("A MM", end).as_bytes(), &ReadOptions::default()).is_ok(),
            "{end}"
        );
    }
}

#[test]
fn numbers_with_an_exponent_are_refused_in_every_block() {
    for block in [
        "TOOL CALL 1 Z S1e3",
        "LBL 1e3",
        "L X+1e2 F100",
        "M3 F1E3",
        "CYCL DEF 7.1 X+1e2",
    ] {
        let found = errors(&format!(
            "BEGIN PGM A MM\nL X+1 Y+1 Z+1 FMAX\n{block}\nL X+1 Y+1 Z+1 FMAX\nEND PGM A MM\n"
        ));
        assert_eq!(found.len(), 1, "{block}: {found:?}");
        assert_eq!(found[0].0, 3, "{block}: {found:?}");
        assert!(
            found[0].1.contains("a number with an exponent"),
            "{block}: {found:?}"
        );
    }
}

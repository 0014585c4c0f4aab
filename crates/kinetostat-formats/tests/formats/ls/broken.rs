//! Programs that are refused: line, what is said, and all of it in one run.

use kinetostat_formats::*;

use super::{EVERYTHING, decided, position, read_with, stating, with_lines, written};

fn errors(text: &str) -> Vec<(usize, String)> {
    let found = read_with(text.as_bytes(), &ReadOptions::default()).expect_err("it is refused");
    found
        .iter()
        .map(|error| (error.line, error.to_string()))
        .collect()
}

#[test]
fn lines_that_move_the_tool_otherwise_are_refused_by_line() {
    let cases = [
        (
            "L P[9] 20mm/sec FINE ;",
            "position P[9] is not in /POS; teach it",
        ),
        (
            "L PR[1] 20mm/sec FINE ;",
            "its end is in a position register",
        ),
        (
            "L P[R[1]] 20mm/sec FINE ;",
            "which position it goes to, a register says",
        ),
        (
            "L P[1] 20mm/sec FINE Offset,PR[2] ;",
            "offset by a register, whose value is not in the text",
        ),
        ("L P[1] 20mm/sec FINE Tool_Offset ;", "offset by a register"),
        (
            "L P[1] 20mm/sec FINE INC ;",
            "a step from where the tool was",
        ),
        (
            "L P[1] 20mm/sec FINE Skip,LBL[1] ;",
            "it ends where a signal changes",
        ),
        (
            "L P[1] 20mm/sec FINE SkipJump,LBL[1] ;",
            "it ends where a signal changes",
        ),
        (
            "L P[1] 20mm/sec CNT100 COORD PTH ;",
            "coordinated with another group that moves the part; let the other group stand still",
        ),
        ("L P[1] 20mm/sec FINE RTCP ;", "the arm holds the part"),
        (
            "L P[1] 20mm/sec FINE MYOPTION ;",
            "an option of the motion is not known",
        ),
        (
            "L P[1] 20furlong/week FINE ;",
            "a motion is J, L or C, a position, a speed, and FINE or CNT",
        ),
        ("L P[1] FINE ;", "a motion is J, L or C"),
        ("C P[1] 20mm/sec FINE ;", "a motion is J, L or C"),
        (
            "A P[1] 20mm/sec FINE ;",
            "an arc through points of several A instructions; write it as C",
        ),
        ("  P[1]=LPOS ;", "another value while the program runs"),
        ("  UFRAME[2]=PR[1] ;", "says which frame a number means"),
        (
            "  SOFTFLOAT[1] ;",
            "moves or bends the path while the program runs",
        ),
        (
            "  DANCE[1] ;",
            "the statement is not known, and may move the tool",
        ),
        ("  JMP LBL[7] ;", "there is no such label"),
        (
            "  IF (R[1]=1) THEN ;",
            "the block that it belongs to is not whole; close IF with ENDIF",
        ),
        ("  ENDFOR ;", "the block that it belongs to is not whole"),
        (
            "  IF R[1]=1,L P[1] 20mm/sec FINE ;",
            "a motion stands behind a condition",
        ),
        ("L P[1] 20mm/sec FINE", "no `;` ends the instruction"),
        ("  SIMULTANEOUS GP ;", "it moves several groups at once"),
    ];
    for (line, part) in cases {
        let found = errors(&with_lines(&[
            "L P[1] 20mm/sec FINE ;",
            line,
            "L P[2] 20mm/sec FINE ;",
        ]));
        let part = part.replace("; write", " is not followed; write");
        assert_eq!(found.len(), 1, "{line}: {found:?}");
        assert_eq!(found[0].0, 6, "{line}: {found:?}");
        assert!(found[0].1.contains(&part), "{line}: {found:?}");
    }
}

#[test]
fn all_problems_come_in_one_run_in_the_order_of_lines() {
    let text = with_lines(&[
        "L P[9] 20mm/sec FINE ;",
        "  DANCE ;",
        "L PR[1] 20mm/sec FINE ;",
        "  LBL[1] ;",
        "  LBL[1] ;",
    ]);
    let text = text.replace("/END", &(position(2, [0.0; 3]) + "/END"));
    let lines: Vec<usize> = errors(&text).iter().map(|error| error.0).collect();
    assert_eq!(lines, [5, 6, 7, 9, 35]);
}

#[test]
fn frames_and_tools_must_be_those_in_force() {
    let found = errors(&with_lines(&["  UFRAME_NUM=3 ;", "L P[1] 20mm/sec FINE ;"]));
    assert!(
        found[0]
            .1
            .contains("P[1] is taught with UF 2, but UFRAME_NUM is 3 here"),
        "{found:?}"
    );
    let found = errors(&with_lines(&["  UTOOL_NUM=5 ;", "J P[1] 50% FINE ;"]));
    assert!(
        found[0]
            .1
            .contains("P[1] is taught with UT 1, but UTOOL_NUM is 5 here"),
        "{found:?}"
    );
    // Of a branch that sets it, and of a register, only the controller knows which it is.
    let read = |lines: &[&str]| read_with(with_lines(lines).as_bytes(), &ReadOptions::default());
    let branch = |one: &'static str, other: &'static str| {
        [
            "  IF (R[1]=1) THEN ;",
            one,
            "  ELSE ;",
            other,
            "  ENDIF ;",
            "L P[1] 20mm/sec FINE ;",
        ]
    };
    assert!(read(&branch("  UFRAME_NUM=3 ;", "  UFRAME_NUM=3 ;")).is_err());
    assert!(read(&branch("  UFRAME_NUM=3 ;", "  UFRAME_NUM=2 ;")).is_err());
    let both = with_lines(&branch("  UFRAME_NUM=3 ;", "  UFRAME_NUM=2 ;"));
    assert!(read_with(both.as_bytes(), &stating(&[("R[1]", "1")])).is_err());
    assert!(read_with(both.as_bytes(), &stating(&[("R[1]", "2")])).is_ok());
    assert!(
        read(&[
            "  UFRAME_NUM=3 ;",
            "  UFRAME_NUM=R[1] ;",
            "L P[1] 20mm/sec FINE ;"
        ])
        .is_err()
    );
    // A jump back brings the frame of the end to the beginning.
    let loops = [
        "  UFRAME_NUM=3 ;",
        "  JMP LBL[2] ;",
        "  LBL[1] ;",
        "L P[1] 20mm/sec FINE ;",
        "  LBL[2] ;",
        "  JMP LBL[1] ;",
    ];
    assert!(read(&loops).is_err());
}

#[test]
fn files_and_positions_that_are_not_whole_are_refused() {
    let whole = with_lines(&["L P[1] 20mm/sec FINE ;"]);
    let cases = [
        ("nothing".to_owned(), 1, "there is no section /MN"),
        (
            whole.replace("/END\n", ""),
            31,
            "the file ends before its section /END",
        ),
        (whole.replacen("};", "", 1), 7, "position P[1]: "),
        (
            whole.replacen("100.000  mm", "******** mm", 1),
            5,
            "it is not taught: it holds no numbers",
        ),
        (
            whole.replacen("100.000  mm", "100.000  inch", 1),
            5,
            "X, Y, Z are in mm",
        ),
        (
            whole.replacen("180.000 deg", "180.E9 deg", 1),
            5,
            "W, P, R are from -360 to 360 deg",
        ),
        (
            whole.replacen("P[1]{", "P[x]{", 1),
            5,
            "position P[1] is not in /POS",
        ),
        (
            whole.replacen("   1:L", "L", 1),
            5,
            "the line begins with neither a number nor a colon",
        ),
        (
            whole.replacen("UF : 2", "UF : two", 1),
            5,
            "UF and UT are numbers, or F",
        ),
        (
            whole.replacen("'N U T, 0, 0, 0'", "N U T", 1),
            5,
            "its CONFIG is not in quotes",
        ),
    ];
    for (index, (text, line, part)) in cases.into_iter().enumerate() {
        let found = errors(&text);
        if index == 2 {
            // The next position's end closes it: it holds two.
            assert!(!found.is_empty());
            continue;
        }
        let hit = found
            .iter()
            .any(|(at, message)| *at == line && message.contains(part));
        assert!(hit, "{part}: {found:?}");
    }
}

/// The configuration says with which posture the arm gets there.
#[test]
fn configurations_that_say_no_posture_are_refused() {
    let whole = with_lines(&["L P[1] 20mm/sec FINE ;"]);
    let with = |configuration: &str| whole.replacen("'N U T, 0, 0, 0'", configuration, 1);
    for taken in [
        "'N U T, 0, 0, 0'",
        "'F L D B, -1, 0, 1'",
        "'NUT,0,0,0'",
        "'N, 0, 0, 0'",
    ] {
        let options = ReadOptions::default();
        assert!(
            read_with(with(taken).as_bytes(), &options).is_ok(),
            "{taken}"
        );
    }
    for refused in [
        "'N U T, 0, 0'",
        "'N U T, 0, 0, 0, 0'",
        "'N U T'",
        "''",
        "'0, 0, 0'",
        "', 0, 0, 0'",
        "'N U X, 0, 0, 0'",
        "'N N T, 0, 0, 0'",
        "'N F T, 0, 0, 0'",
        "'N U T, 0, , 0'",
        "'N U T, 0, 0.5, 0'",
        "'N U T, 0, 0, 999'",
    ] {
        let found = errors(&with(refused));
        assert_eq!((found.len(), found[0].0), (1, 5), "{refused}: {found:?}");
        assert!(
            found[0].1.contains("P[1]: its CONFIG is not of letters"),
            "{found:?}"
        );
    }
    let found = errors(&whole.replacen(",\t\tCONFIG : 'N U T, 0, 0, 0'", "", 1));
    assert!(found[0].1.contains("P[1]: it has no CONFIG"), "{found:?}");
}

#[test]
fn axes_that_move_are_refused_unless_carried() {
    let text = EVERYTHING.replacen("  16:  DO[1:gun]=ON ;", "  16:L P[8] 20mm/sec FINE ;", 1);
    let moved = position(8, [1.0, 2.0, 3.0]).replacen(" deg\n}", " deg,\n\tE1=  13.000 mm\n}", 1);
    let text = text.replace("/END", &(moved + "/END"));
    let found = errors(&text);
    assert!(
        found[0]
            .1
            .contains("moves from 12.5 to 13: the arm stands elsewhere then"),
        "{found:?}"
    );
    let mut options = decided();
    options.external_axes = ExternalAxes::Carried;
    assert!(read_with(text.as_bytes(), &options).is_ok());
}

/// Both positions of a circle may be registers: what is said of the motion is said once, in order of lines.
#[test]
fn motions_that_are_left_are_named_once_by_line() {
    let text = with_lines(&[
        "UFRAME_NUM=2 ;",
        "UTOOL_NUM=1 ;",
        "L P[1] 20mm/sec FINE ;",
        "C P[2] ",
        "  : PR[1] 20mm/sec FINE ;",
        "C PR[1] ",
        "  : PR[2] 20mm/sec FINE ;",
    ]);
    let text = text
        .replace("   5:  :", "    :")
        .replace("   7:  :", "    :");
    let mut options = ReadOptions::default();
    options.unknown_targets = UnknownTargets::LeftAsWritten;
    let program = read_with(text.as_bytes(), &options).unwrap();
    let found: Vec<(usize, bool)> = (program.findings.iter())
        .map(|finding| {
            let is_left = finding.message.starts_with("it stays as it is written");
            (finding.line, is_left)
        })
        .collect();
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert!(lines.is_sorted(), "{:?}", program.findings);
    let left: Vec<usize> = (found.iter().filter(|(_, left)| *left))
        .map(|(line, _)| *line)
        .collect();
    assert_eq!(left, [8, 10], "{:?}", program.findings);
}

#[test]
fn statements_stand_once_in_their_table() {
    let mut names: Vec<&str> = LS_STATEMENTS.iter().map(|row| row.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}

/// Which frame counts depends on the way that the run takes, and only the controller knows it.
#[test]
fn a_frame_that_is_set_in_a_branch_is_refused_where_it_would_be_another() {
    let lines = |branch: &[&str]| {
        let mut all = vec!["  UFRAME_NUM=2 ;", "  UTOOL_NUM=1 ;", "J P[1] 10% FINE ;"];
        all.extend_from_slice(branch);
        all.push("L P[2] 20mm/sec FINE ;");
        with_lines(&all)
    };
    let read = |text: &str| read_with(text.as_bytes(), &ReadOptions::default());
    for branch in [
        &["  IF (R[1]=1) THEN ;", "  UFRAME_NUM=3 ;", "  ENDIF ;"][..],
        &["  IF R[1]=1,UFRAME_NUM=3 ;"][..],
        &["  IF (R[1]=1) THEN ;", "  UTOOL_NUM=3 ;", "  ENDIF ;"][..],
    ] {
        let errors = read(&lines(branch)).unwrap_err();
        assert_eq!(errors.len(), 1, "{branch:?} {errors:?}");
        let reason = &errors[0].reason;
        let part = "which way the program goes here is not known: `R[1]`";
        assert!(reason.contains(part), "{reason}");
    }
    // The same frame on both ways is the same frame.
    let same = ["  IF (R[1]=1) THEN ;", "  UFRAME_NUM=2 ;", "  ENDIF ;"];
    assert_eq!(read(&lines(&same)).unwrap().motions.len(), 2);
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_program() {
    let text = with_lines(&["L P[1] 20mm/sec FINE ;"]);
    let marked = [b"\xef\xbb\xbf", text.as_bytes()].concat();
    let program = read_with(&marked, &ReadOptions::default()).unwrap();
    assert_eq!(program.motions.len(), 1);
    assert_eq!(written(&program, &[]).as_bytes(), marked);
}

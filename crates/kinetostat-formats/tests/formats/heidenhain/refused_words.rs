//! What moves the tool where nobody expects it, and words that say two things.

use super::*;

fn refused(lines: &str) -> Vec<(usize, String)> {
    let text = format!("0 BEGIN PGM P MM\n1 TOOL CALL 1 Z S1000\n{lines}\n9 END PGM P MM\n");
    match read_with(text.as_bytes(), &ReadOptions::default()) {
        Ok(_) => Vec::new(),
        Err(errors) => errors.iter().map(|e| (e.line, e.reason.clone())).collect(),
    }
}

fn only(lines: &str, line: usize, part: &str) {
    let found = refused(lines);
    assert_eq!(found.len(), 1, "{lines}: {found:?}");
    assert!(
        found[0].0 == line && found[0].1.contains(part),
        "{lines}: {found:?}"
    );
}

#[test]
fn a_machine_that_turns_is_refused() {
    let path = "L X+100 Y+0 Z+50 R0 FMAX M3\nL X+50 F200";
    only(&format!("FUNCTION MODE TURN\n{path}"), 3, "X is a diameter");
    only(
        &format!("FUNCTION MODE GRIND\n{path}"),
        3,
        "turns or grinds",
    );
    assert_eq!(refused(&format!("FUNCTION MODE MILL\n{path}")), []);
}

#[test]
fn cycles_that_act_where_they_are_defined_are_refused_and_unknown_ones_too() {
    let path = "L X+7 Y+8 Z+9 F200";
    for cycle in [
        "220 PATTERN",
        "224 DATAMATRIX",
        "239 LOAD",
        "800 ADJUST",
        "26.0 SCALING",
    ] {
        only(
            &format!("CYCL DEF {cycle}\n{path}"),
            3,
            "where it is defined",
        );
    }
    for cycle in ["1001 STROKE", "600 OWN", "299 TUNING", "999 OEM"] {
        only(&format!("CYCL DEF {cycle}\n{path}"), 3, "is not known");
    }
    for cycle in [
        "200 DRILLING",
        "32.0 TOLERANCE",
        "14.0 CONTOUR",
        "251 POCKET",
        "1.0 PECKING",
    ] {
        assert_eq!(refused(&format!("CYCL DEF {cycle}\n{path}")), [], "{cycle}");
    }
}

#[test]
fn a_motion_behind_the_sign_of_a_further_line_is_refused() {
    let path = "L X+1 Y+1 Z+1 F200";
    only(
        &format!("{path}\nCYCL DEF 200 DRILLING ~\n5 L X+7 Y+8"),
        5,
        "is no parameter",
    );
    let whole = "CYCL DEF 200 DRILLING ~\n  Q200=+2 ;CLEARANCE ~\n  Q201=-5";
    assert_eq!(refused(&format!("{path}\n{whole}")), []);
}

#[test]
fn two_feeds_in_a_block_are_refused() {
    for feeds in ["FMAX F200", "F200 F300", "F200 FMAX"] {
        let found = refused(&format!("L X+1 Y+1 Z+1 {feeds}"));
        assert_eq!(found.len(), 1, "{feeds}: {found:?}");
    }
}

/// The place along the tool is another one, as with `TOOL CALL 1 Z S300 DL+0.5`.
#[test]
fn a_tool_call_without_a_number_makes_the_tool_longer_all_the_same() {
    let with = |call: &str| refused(&format!("L X+0 Y+0 Z+5 FMAX\n{call}L X+9 F200"));
    let (named, unnamed) = (
        with("TOOL CALL 1 Z S300 DL+0.5\n"),
        with("TOOL CALL DL+0.5\n"),
    );
    assert_eq!(named, unnamed);
    assert_eq!(unnamed.len(), 1, "{unnamed:?}");
    assert_eq!(with(""), []);
}

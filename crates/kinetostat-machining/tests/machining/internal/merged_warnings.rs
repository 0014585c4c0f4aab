//! What every part of a long program warns of is said once, with the lines.

use kinetostat_machining::internal::{are_same_words, merged_warnings};
use kinetostat_machining::{Warning, WarningCode};

#[test]
fn what_every_part_says_is_said_once_with_the_lines() {
    let at = |line: usize, message: &str| Warning::at_line(WarningCode::Writing, line, message);
    let held = |pieces: &str| format!("the feed of {pieces}, first here, is held to 1.2 times");
    let merged = merged_warnings(&[
        (0, at(7, &held("1 piece"))),
        // Another line of the same part is a warning of its own.
        (0, at(9, &held("3 pieces"))),
        (1, at(20_007, &held("12 pieces"))),
        (1, at(20_009, "the written program goes backwards")),
        (2, at(40_007, &held("5 pieces"))),
    ]);
    let said: Vec<String> = merged.into_iter().map(|w| w.message).collect();
    let first = format!(
        "{}; in later parts of the program 2 more times, at lines 20007, 40007",
        held("1 piece")
    );
    let expected = [
        first,
        held("3 pieces"),
        "the written program goes backwards".to_owned(),
    ];
    assert_eq!(said, expected);
}

#[test]
fn other_names_are_other_words() {
    let same = [
        ("drive leg_a, 12 of 30 N", "drive leg_a, 1.5 of 30 N"),
        ("at X1.00 Y12.00 mm", "at X-11.25 Y0.5 um"),
    ];
    assert!(same.iter().all(|(one, other)| are_same_words(one, other)));
    let [front, behind] = ["drive front, 12 of 30 N", "drive behind, 12 of 30 N"];
    assert!(!are_same_words(front, behind));
}

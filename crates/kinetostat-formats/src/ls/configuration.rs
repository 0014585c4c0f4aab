//! Arm configuration of a position: `N U T, 0, 0, 0`.
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4 "Program structure".

use std::collections::BTreeSet;

/// Letters of which a configuration has at most one each: wrist, side, elbow, and whether the arm reaches over its back.
const PAIRS: [[u8; 2]; 4] = [*b"FN", *b"LR", *b"UD", *b"TB"];

/// True if a text is an arm configuration: letters, and the turns of three axes.
pub(crate) fn is_configuration(text: &str) -> bool {
    let mut parts = text.split(',');
    let letters = parts.next().unwrap_or_default().bytes();
    let letters: Vec<u8> = letters.filter(|byte| *byte != b' ').collect();
    let pair = |letter: &u8| PAIRS.iter().position(|pair| pair.contains(letter));
    let pairs: Option<BTreeSet<usize>> = letters.iter().map(pair).collect();
    let turns: Vec<bool> = parts
        .map(|part| part.trim().parse::<i8>().is_ok())
        .collect();
    // A letter twice, or with its opposite, is one pair.
    let is_once = pairs.is_some_and(|pairs| pairs.len() == letters.len() && !pairs.is_empty());
    is_once && turns == [true; 3]
}

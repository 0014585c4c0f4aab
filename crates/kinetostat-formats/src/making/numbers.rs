//! Numbers and comments of made programs.

use nalgebra::{UnitQuaternion, Vector3};

use crate::model::orientation::OrientationText;

/// With so many decimals; a zero has no sign.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = !text.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    match text.strip_prefix('-') {
        Some(positive) if is_zero => positive.to_owned(),
        _ => text,
    }
}

/// With at most so many decimals, and no zeros at the end.
pub(crate) fn short(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// The three coordinates.
pub(crate) fn coordinates(place: &Vector3<f64>, decimals: usize) -> [String; 3] {
    [0, 1, 2].map(|axis| fixed(place[axis], decimals))
}

/// The numbers of an orientation; angles within half a turn.
pub(crate) fn angles(
    orientation: &UnitQuaternion<f64>,
    text: OrientationText,
    decimals: usize,
) -> Vec<String> {
    let near = match text {
        OrientationText::Quaternion => vec![1.0, 1e-3, 1e-6, 1e-9],
        _ => vec![0.0; 3],
    };
    let numbers = text.numbers_of(orientation, &near);
    let half_turn = fixed(-180.0, decimals);
    let of_angle = |number: &f64| {
        let written = fixed(*number, decimals);
        // Half a turn backwards is half a turn.
        match text != OrientationText::Quaternion && written == half_turn {
            true => half_turn[1..].to_owned(),
            false => written,
        }
    };
    numbers.iter().map(of_angle).collect()
}

/// Longest text of a note, in characters.
const NOTE_CHARACTERS: usize = 120;

/// A text of the source as that of a comment: ASCII, in one line, without brackets that would end it.
pub(crate) fn plain(text: &str) -> String {
    let shown = text.chars().take(NOTE_CHARACTERS).map(|c| match c {
        '(' => '[',
        ')' => ']',
        '"' | ';' => ' ',
        ' '..='~' => c,
        '\t' => ' ',
        _ => '?',
    });
    let mut plain: String = shown.collect();
    if text.chars().count() > NOTE_CHARACTERS {
        plain.push_str("...");
    }
    plain.trim().to_owned()
}

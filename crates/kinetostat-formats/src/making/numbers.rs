//! Numbers and comments of made programs.

use nalgebra::{UnitQuaternion, Vector3};

use crate::model::orientation::OrientationText;
pub(crate) use crate::text::number::{fixed, short};

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

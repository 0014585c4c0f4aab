//! What PLANE leaves in force: how the rotary axes stand, and where the datum is.

use nalgebra::Vector3;

use crate::heidenhain::words::{Value, Word};

/// How the rotary axes stand.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Stands {
    /// As their words say.
    #[default]
    AsWords,
    /// So that the tool lies along a direction, in the axes of the preset.
    Along(Vector3<f64>),
    /// Words turned them from there, and there is no model of them.
    Unknown,
}

/// What PLANE has left behind.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tilt {
    /// Across the plane of the last PLANE, in the axes of the preset; none behind a reset.
    pub across: Option<Vector3<f64>>,
    pub stands: Stands,
    /// Axes whose datum a cycle shifted while the plane was tilted, and none since.
    pub shifted: [bool; 3],
    /// A cut was refused since the plane or the axes changed.
    pub told: bool,
}

/// Whether a word turns a rotary axis to its angle of the plane: `A+Q120`, `B+Q121`, `C+Q122`.
pub(crate) fn is_of_plane(word: &Word, bytes: &[u8]) -> bool {
    let name = match word.letters.letters() {
        b"A" => b"Q120",
        b"B" => b"Q121",
        b"C" => b"Q122",
        _ => return false,
    };
    matches!(&word.value, Value::Parameter { sign, name: own, .. } if *sign > 0.0 && bytes[own.clone()].eq_ignore_ascii_case(name))
}

//! Modal state of tilted working planes (PLANE): rotary axes and datum.

use nalgebra::Vector3;

use crate::heidenhain::words::{Value, Word};

/// Position of the rotary axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Stands {
    /// Angles of their words.
    #[default]
    AsWords,
    /// Angles at which the tool lies along a direction, in the axes of the preset.
    Along(Vector3<f64>),
    /// Words turned them from such angles, and the model has no rotary axes.
    Unknown,
}

/// State that PLANE leaves in force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tilt {
    /// Normal of the last plane, in the axes of the preset; `None` after a reset.
    pub across: Option<Vector3<f64>>,
    pub stands: Stands,
    /// Axes whose datum a cycle shifted while the plane was tilted.
    pub shifted: [bool; 3],
    /// A cut was refused since the plane or the axes changed.
    pub told: bool,
}

/// True for a word that turns a rotary axis to its angle of the plane: `A+Q120`, `B+Q121`, `C+Q122`.
pub(crate) fn is_of_plane(word: &Word, bytes: &[u8]) -> bool {
    let name = match word.letters.letters() {
        b"A" => b"Q120",
        b"B" => b"Q121",
        b"C" => b"Q122",
        _ => return false,
    };
    matches!(&word.value, Value::Parameter { sign, name: own, .. } if *sign > 0.0 && bytes[own.clone()].eq_ignore_ascii_case(name))
}

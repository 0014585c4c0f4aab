//! What a program says of the rotary axes of a machine, motion by motion.

use std::collections::{BTreeMap, BTreeSet};

/// How a program says at a motion where the rotary axes stand.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum AxesStated {
    /// By their words, up to here: where they stand at its start and at its end, deg, in the order of the letters. Places are those of
    /// the tool's tip in the part.
    Angles { start: Vec<f64>, end: Vec<f64> },
    /// Not at all, or places are not those of the tip.
    Open,
}

/// What a program says of rotary axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct StatedAxes {
    /// Letters of the axes whose words are followed.
    pub letters: Vec<char>,
    /// Motions of programs whose words of rotary axes are followed; a motion that is not here states a direction of the tool, or
    /// takes over the one of before.
    pub motions: BTreeMap<usize, AxesStated>,
    /// The motions in which the axes turn evenly, where others lead the tool's axis on a great circle.
    pub even: BTreeSet<usize>,
}

impl StatedAxes {
    /// Whether angles say anywhere how the tool stands.
    pub(crate) fn has_angles(&self) -> bool {
        let mut all = self.motions.iter();
        all.any(|(_, stated)| matches!(stated, AxesStated::Angles { .. }))
    }
}

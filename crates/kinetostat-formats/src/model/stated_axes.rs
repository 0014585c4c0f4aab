//! Rotary axis positions that a program states, motion by motion.

use std::collections::{BTreeMap, BTreeSet};

/// Statement of the rotary axis positions at a motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum AxesStated {
    /// Angles by their words up to this block: positions at the start and the end, deg, in the order of the letters. Coordinates are those of the
    /// tool tip in the part.
    Angles { start: Vec<f64>, end: Vec<f64> },
    /// Not at all, or places are not those of the tip.
    Open,
}

/// Rotary axis data of a program.
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
    /// True if angles define the tool orientation anywhere.
    pub(crate) fn has_angles(&self) -> bool {
        let mut all = self.motions.iter();
        all.any(|(_, stated)| matches!(stated, AxesStated::Angles { .. }))
    }
}

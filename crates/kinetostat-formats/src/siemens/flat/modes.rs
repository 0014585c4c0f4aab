//! The G codes in force while a program runs: drilling cycles and SAVE put them back.

/// Groups of codes of which one is in force, as far as they are put back.
const GROUPS: [&[&str]; 6] = [
    &["G0", "G1", "G2", "G3", "CIP"],
    &["G17", "G18", "G19"],
    &["G90", "G91"],
    &["G70", "G71", "G700", "G710"],
    &["G93", "G94", "G95"],
    &["G60", "G64", "G641", "G642", "G643", "G644", "G645"],
];

/// One code of each group, where one was stated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Modes([Option<&'static str>; 6]);

impl Modes {
    /// A code is stated.
    pub(super) fn state(&mut self, code: &str) {
        for (held, group) in self.0.iter_mut().zip(GROUPS) {
            if let Some(found) = group.iter().find(|known| **known == code) {
                *held = Some(found);
            }
        }
    }

    /// The code of motion.
    pub(super) fn motion(&self) -> Option<&'static str> {
        self.0[0]
    }

    /// The axis across the plane.
    pub(super) fn normal(&self) -> char {
        match self.0[1] {
            Some("G18") => 'Y',
            Some("G19") => 'X',
            _ => 'Z',
        }
    }

    /// Codes that put these in force where others are.
    pub(super) fn restored_from(&self, now: &Self) -> String {
        let codes = self.0.iter().zip(now.0);
        let codes = codes.filter_map(|(old, new)| old.filter(|old| Some(*old) != new));
        codes.collect::<Vec<&str>>().join(" ")
    }
}

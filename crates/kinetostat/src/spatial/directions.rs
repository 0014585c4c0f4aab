//! Sets of the six directions of a body.

use std::fmt;
use std::ops::Index;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Names of the directions, in order: motions along the axes, rotations about them.
const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// A set of the six directions `x y z rx ry rz`, in base axes unless it says otherwise: those that are corrected,
/// held or prescribed.
///
/// ```
/// use kinetostat::Directions;
///
/// let directions = Directions::POSITION;
/// assert!(directions.contains(2) && !directions.contains(3));
/// assert_eq!(directions.to_string(), "x y z");
/// assert_eq!(Directions::from([true, true, true, false, false, false]), directions);
/// assert_eq!(directions.as_array(), [true, true, true, false, false, false]);
///
/// let milling = Directions::NONE.with(4).with(0).with(1); // in any order
/// assert_eq!(milling.iter().collect::<Vec<_>>(), [0, 1, 4]);
/// assert!(milling.len() == 3 && Directions::NONE.is_empty());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Directions([bool; 6]);

impl Directions {
    /// The empty set.
    pub const NONE: Self = Self([false; 6]);
    /// All six: a pose.
    pub const ALL: Self = Self([true; 6]);
    /// Along the three axes: a position.
    pub const POSITION: Self = Self([true, true, true, false, false, false]);
    /// About the three axes: an orientation.
    pub const ORIENTATION: Self = Self([false, false, false, true, true, true]);

    /// True if a direction (0 to 5) belongs to the set.
    #[must_use]
    pub fn contains(self, direction: usize) -> bool {
        self.0[direction]
    }

    /// Adds a direction (0 to 5).
    #[must_use]
    pub fn with(mut self, direction: usize) -> Self {
        self.0[direction] = true;
        self
    }

    /// The directions of the set, 0 to 5, in order.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..6).filter(move |&k| self.0[k])
    }

    /// Number of directions.
    #[must_use]
    pub fn len(self) -> usize {
        self.iter().count()
    }

    /// True if no direction belongs to the set.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self == Self::NONE
    }

    /// Membership of each direction.
    #[must_use]
    pub fn as_array(self) -> [bool; 6] {
        self.0
    }
}

impl From<[bool; 6]> for Directions {
    fn from(set: [bool; 6]) -> Self {
        Self(set)
    }
}

impl Index<usize> for Directions {
    type Output = bool;
    fn index(&self, direction: usize) -> &bool {
        &self.0[direction]
    }
}

impl fmt::Display for Directions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.iter().map(|k| NAMES[k]).collect();
        f.write_str(if names.is_empty() { "none" } else { "" })?;
        f.write_str(&names.join(" "))
    }
}

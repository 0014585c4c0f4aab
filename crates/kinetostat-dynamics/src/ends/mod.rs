//! Constraints on the tool, and the motions that are left: null spaces of closures and held directions [D 3, D5].

pub(crate) mod null_space;

use kinetostat::chain::Prescribed;
use kinetostat::{Directions, EndCondition};
use nalgebra::Rotation3;

/// Directions of the tool (or of the end of a chain) that are held while the machine vibrates.
///
/// ```
/// use kinetostat::Directions;
/// use kinetostat_dynamics::Held;
///
/// let free = Held::nothing();
/// let pressed = Held::directions(Directions::POSITION); // its place, while it may turn
/// assert!(free.is_free() && !pressed.is_free());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Axes of the directions, base from these axes.
    pub axes: Rotation3<f64>,
    /// `x y z rx ry rz` of those axes, at the origin of the tool.
    pub directions: [bool; 6],
}

impl Held {
    /// The tool is free.
    #[must_use]
    pub fn nothing() -> Self {
        Self {
            axes: Rotation3::identity(),
            directions: [false; 6],
        }
    }

    /// The tool is held in all six directions.
    #[must_use]
    pub fn everything() -> Self {
        Self {
            directions: [true; 6],
            ..Self::nothing()
        }
    }

    /// Holds these directions of the base's axes.
    #[must_use]
    pub fn directions(directions: Directions) -> Self {
        Self {
            directions: directions.as_array(),
            ..Self::nothing()
        }
    }

    /// Holds the directions whose pose an end condition of the statics prescribes.
    #[must_use]
    pub fn of_end(end: &EndCondition) -> Self {
        Self {
            axes: end.axes,
            directions: end.prescribed.map(|p| p == Prescribed::Pose),
        }
    }

    /// True if nothing is held.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.directions == [false; 6]
    }
}

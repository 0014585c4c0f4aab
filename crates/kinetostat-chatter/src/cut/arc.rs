//! The arc on which a tooth is in the material.
//!
//! Angles count from +y (left of the feed) clockwise seen from the spindle, towards +x (the feed), as in `cutting.md`.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::error::{ChatterError, ChatterErrorKind, Result};

/// Up or down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Milled {
    /// Conventional: the chip begins with no thickness, the part is on the left with a spindle that turns clockwise.
    Up,
    /// Climb: the chip ends with no thickness, the part is on the right.
    Down,
}

/// The arc on which a tooth is in the material, rad.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arc {
    entry: f64,
    exit: f64,
}

impl Arc {
    /// Arc from entry to exit, rad.
    ///
    /// # Errors
    /// Angles that are not finite, an entry outside 0 to one turn, an exit that is not beyond the entry, or is so by more
    /// than one turn.
    pub fn new(entry: f64, exit: f64) -> Result<Self> {
        let holds =
            (0.0..TAU).contains(&entry) && exit > entry && exit - entry <= TAU * (1.0 + 1e-12);
        match holds {
            true => Ok(Self { entry, exit }),
            false => Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "arc of engagement",
                format!("{entry} to {exit} rad"),
                "an entry from 0 to below one turn, and an exit beyond it by at most one turn",
            )),
        }
    }

    /// The arc of a straight cut: `up (0, acos(1 - 2 a_e/D)), down (acos(2 a_e/D - 1), pi)` [D 8].
    ///
    /// ```
    /// use kinetostat_chatter::{Arc, Milled};
    ///
    /// let down = Arc::straight(Milled::Down, 0.5)?; // half the diameter is in the material
    /// assert!((down.entry().to_degrees() - 90.0).abs() < 1e-9);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    ///
    /// # Errors
    /// An immersion `a_e/D` that is not above 0, or is above 1 (a slot).
    pub fn straight(milled: Milled, immersion: f64) -> Result<Self> {
        if !(immersion > 0.0 && immersion <= 1.0) {
            return Err(ChatterError::new(
                ChatterErrorKind::Cut,
                "immersion",
                immersion,
                "width of cut by diameter, above 0 and at most 1 (a slot)",
            ));
        }
        let angle = (1.0 - 2.0 * immersion).acos();
        Ok(match milled {
            Milled::Up => Self {
                entry: 0.0,
                exit: angle,
            },
            Milled::Down => Self {
                entry: PI - angle,
                exit: PI,
            },
        })
    }

    /// The whole front half.
    #[must_use]
    pub fn slot() -> Self {
        Self {
            entry: 0.0,
            exit: PI,
        }
    }

    /// Entry angle of a tooth, rad.
    #[must_use]
    pub fn entry(&self) -> f64 {
        self.entry
    }

    /// Exit angle, rad; beyond the entry.
    #[must_use]
    pub fn exit(&self) -> f64 {
        self.exit
    }

    /// Mean thickness of the chip on the arc by feed per tooth: mean of `sin phi`.
    #[must_use]
    pub fn mean_sine(&self) -> f64 {
        (self.entry.cos() - self.exit.cos()) / (self.exit - self.entry)
    }
}

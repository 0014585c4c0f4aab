//! What counts of a placement: the largest of a figure over the program.

use kinetostat_machining::PointResult;
use serde::{Deserialize, Serialize};

/// What is to be least: the largest value over all places of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// How far the tool's tip is off without compensation, at feed, mm.
    #[default]
    Error,
    /// How large the correction is that compensation commands, mm.
    Correction,
    /// How far the tool turns under its load, deg: what stays where only its place is compensated.
    Tilt,
    /// The drive load by its rating, 1 is the rating.
    Drive,
    /// The share of the way to buckling, 1 is buckling.
    Buckling,
}

impl Objective {
    /// What it is, as the subject of a sentence.
    #[must_use]
    pub fn what(self) -> &'static str {
        match self {
            Self::Error => "largest error before compensation",
            Self::Correction => "largest correction",
            Self::Tilt => "largest tilt of the tool",
            Self::Drive => "largest drive load by its rating",
            Self::Buckling => "largest share of the way to buckling",
        }
    }

    /// Its unit; empty for shares.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Error | Self::Correction => "mm",
            Self::Tilt => "deg",
            Self::Drive | Self::Buckling => "",
        }
    }

    /// Whether it is looked at on feed moves alone; loads of drives count on rapids, too.
    pub(crate) fn at_feed_only(self) -> bool {
        self != Self::Drive
    }

    /// The figure of a place; none of a correction, which is another question, and where the model does not tell it.
    pub(crate) fn figure(self, point: &PointResult) -> Option<f64> {
        match self {
            Self::Error => {
                let [x, y, z] = point.error_before_mm;
                Some(x.hypot(y).hypot(z))
            }
            Self::Correction => None,
            Self::Tilt => Some(point.residual_rotation_deg),
            Self::Drive => point.most_loaded.map(|most| most.share_of_rating),
            Self::Buckling => point.share_to_buckling,
        }
    }
}

//! Objective of a placement: the largest value of a figure over the program.

use kinetostat_machining::PointResult;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Figure to be minimised: its largest value over all places of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// Error of the tool's tip without compensation, at feed, mm.
    #[default]
    Error,
    /// Correction that compensation commands, mm.
    Correction,
    /// Rotation of the tool under its load, deg: it remains if only the position is compensated.
    Tilt,
    /// The drive load by its rating, 1 is the rating.
    Drive,
    /// The share of the way to buckling, 1 is buckling.
    Buckling,
}

impl Objective {
    /// Name, as the subject of a sentence.
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

    /// Unit; empty for shares.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Error | Self::Correction => "mm",
            Self::Tilt => "deg",
            Self::Drive | Self::Buckling => "",
        }
    }

    /// True if only feed moves are evaluated; loads of drives count on rapids, too.
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

//! Objective of a placement, and its value: a figure, or its distance from being taken.

use std::cmp::Ordering;

use kinetostat_machining::PointResult;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reason for which a placement is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Why {
    /// The path or the part enters an obstacle.
    Obstacle,
    /// A place of the program is out of reach.
    Unreachable,
    /// A place is reached only beyond the limits of a joint.
    OutsideLimits,
    /// A place has no equilibrium under its load.
    NoEquilibrium,
    /// The machine would jump to another shape.
    Unstable,
    /// The arm would have to change its posture while it cuts.
    PostureChanges,
    /// The figure is not known: the model states no ratings, for example.
    NoFigure,
}

impl Why {
    /// Reason in words, as a statement about a placement.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Obstacle => "an obstacle is in the way",
            Self::Unreachable => "out of reach",
            Self::OutsideLimits => "beyond the limits of a joint",
            Self::NoEquilibrium => "no equilibrium under the load",
            Self::Unstable => "not stable under the load",
            Self::PostureChanges => "the posture would have to change while it cuts",
            Self::NoFigure => "the figure is not known",
        }
    }
}

/// Reason, line and distance from being taken.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Refusal {
    /// Reason for the refusal.
    pub why: Why,
    /// A line of the program where it is so, from 1.
    pub line: Option<usize>,
    /// Distance from being taken: the smaller, the nearer; no unit. It leads a search back.
    pub amount: f64,
    /// Reason in words.
    pub message: String,
}

/// Value of a placement.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Value {
    /// The figure, in its unit: the smaller, the better.
    Figure(f64),
    /// The program cannot be run there.
    Refused(Refusal),
}

impl Value {
    /// The figure; none of what is refused.
    #[must_use]
    pub fn figure(&self) -> Option<f64> {
        match self {
            Self::Figure(figure) => Some(*figure),
            Self::Refused(_) => None,
        }
    }

    /// Figures before refusals, smaller ones first.
    #[must_use]
    pub fn order(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Figure(a), Self::Figure(b)) => a.total_cmp(b),
            (Self::Figure(_), Self::Refused(_)) => Ordering::Less,
            (Self::Refused(_), Self::Figure(_)) => Ordering::Greater,
            (Self::Refused(a), Self::Refused(b)) => a.amount.total_cmp(&b.amount),
        }
    }
}

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

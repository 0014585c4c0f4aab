//! Value of a placement: a figure, or its distance from being taken.

use std::cmp::Ordering;

use schemars::JsonSchema;
use serde::Serialize;

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

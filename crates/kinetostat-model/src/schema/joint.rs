//! Kinds of joints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of a joint of one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Slides along its axis.
    Prismatic,
    /// Turns about its axis.
    Revolute,
}

/// Motions that a passive joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PassiveKind {
    /// Slides along its axis.
    Prismatic,
    /// Turns about its axis.
    Revolute,
    /// Turns about its first axis, then about its second.
    Universal,
    /// Turns about x, then y, then z.
    Spherical,
}

//! Origin of forces along a path.

use serde::{Deserialize, Serialize};

/// Origin of forces along a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceOrigin {
    /// Computed from material, tool and engagement.
    #[default]
    Computed,
    /// Measured on the machine.
    Measured,
}

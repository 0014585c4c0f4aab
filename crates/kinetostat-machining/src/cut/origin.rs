//! Where forces along a path come from.

use serde::{Deserialize, Serialize};

/// Where forces along a path come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceOrigin {
    /// Computed from material, tool and engagement.
    #[default]
    Computed,
    /// Measured on the machine.
    Measured,
}

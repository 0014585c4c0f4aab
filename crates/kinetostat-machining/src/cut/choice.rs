//! Choice of the force within a revolution for which a program is compensated.

use serde::{Deserialize, Serialize};

/// Force within a revolution that is compensated.
///
/// The machine is slow against the teeth: it bends under the mean, and the compensation follows that by default. A tooth shapes a
/// wall by the position of the tool while its edge passed the wall. If the tool follows every tooth (a soft tool in a stiff
/// machine), the force of that moment prints into the wall, and it is another than the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceChoice {
    /// The mean over the revolution.
    #[default]
    Mean,
    /// The force while a tooth makes the wall, as a mean over the height of the wall; the mean over the revolution where the tool
    /// makes no wall or two (a slot).
    AtSurfaceGeneration,
    /// The force with the largest part across the tool axis: a worst case.
    Peak,
}

impl ForceChoice {
    /// Choice in words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Mean => "mean over the revolution",
            Self::AtSurfaceGeneration => {
                "while the tooth makes the wall; the mean over the revolution where the tool makes two walls (a slot) or none"
            }
            Self::Peak => "peak of the revolution",
        }
    }
}

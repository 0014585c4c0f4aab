//! Inputs of the computation of cutting forces.

use kinetostat_cutting::{Rotation, SpindleCurve};

use crate::cut::choice::ForceChoice;
use crate::cut::cutting_tool::CuttingTool;
use crate::cut::engagement_source::EngagementSource;

/// The question: which tools cut what, where.
#[derive(Clone, Debug)]
pub struct CutQuestion {
    /// Tools; one without a number is that of all blocks whose tool has no entry.
    pub tools: Vec<CuttingTool>,
    /// Engagement of the tools.
    pub engagement: EngagementSource,
    /// Force within a revolution that is compensated.
    pub choice: ForceChoice,
    /// Speed of the spindle instead of the program's, rpm.
    pub rpm: Option<f64>,
    /// Sense of the spindle instead of the program's.
    pub rotation: Option<Rotation>,
    /// Torque curve of the spindle.
    pub spindle: Option<SpindleCurve>,
}

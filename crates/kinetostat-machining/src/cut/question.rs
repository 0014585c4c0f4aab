//! What is asked of the cuts of a program.

use kinetostat_cutting::{Rotation, SpindleCurve};

use crate::cut::choice::ForceChoice;
use crate::cut::cutting_tool::CuttingTool;
use crate::cut::engagement_source::EngagementSource;

/// The question: which tools cut what, where.
#[derive(Clone, Debug)]
pub struct CutQuestion {
    /// Tools; one without a number is that of all blocks whose tool has no entry.
    pub tools: Vec<CuttingTool>,
    /// Where they are in the material.
    pub engagement: EngagementSource,
    /// Which force of a revolution counts.
    pub choice: ForceChoice,
    /// Speed of the spindle instead of the program's, rpm.
    pub rpm: Option<f64>,
    /// Sense of the spindle instead of the program's.
    pub rotation: Option<Rotation>,
    /// What the spindle can.
    pub spindle: Option<SpindleCurve>,
}

//! Inputs of the computation of cutting forces.

use std::ops::RangeInclusive;
use std::sync::Arc;

use kinetostat_cutting::{Engagement, ForceLaw, Rotation, SpindleCurve, Stock, Tool};
use serde::{Deserialize, Serialize};

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

/// A tool with the law of force of the material that it cuts.
#[derive(Clone, Debug)]
pub struct CuttingTool {
    /// Number in the program's T words; `None` for the tool of blocks whose tool has no entry of its own.
    pub number: Option<u32>,
    /// Cutting edges.
    pub tool: Tool,
    /// Force per length of edge.
    pub law: Arc<dyn ForceLaw>,
    /// Half width of the band in which the force lies, as a share of it.
    pub spread: f64,
    /// Thickest chip that the maker allows, mm per tooth.
    pub max_chip_mm: Option<f64>,
    /// Length of the edges, mm.
    pub flute_length_mm: Option<f64>,
}

impl CuttingTool {
    /// A tool for all blocks, with nothing known but its edges and the law.
    #[must_use]
    pub fn new(tool: Tool, law: Arc<dyn ForceLaw>) -> Self {
        Self {
            number: None,
            tool,
            law,
            spread: 0.0,
            max_chip_mm: None,
            flute_length_mm: None,
        }
    }
}

/// Source of the engagement of the tool along a program.
#[derive(Clone, Debug)]
pub enum EngagementSource {
    /// One engagement for all feed moves, in the frame of the cut.
    Constant(Engagement),
    /// Engagement by lines of the program, the first range that contains a line; air on all other lines.
    Lines(Vec<(RangeInclusive<usize>, Engagement)>),
    /// A stock that the program itself cuts, in coordinates of the part, mm.
    Stock(Box<Stock>),
}

impl EngagementSource {
    /// Engagement of a line, if it is known without simulating a stock.
    pub(crate) fn of_line(&self, line: usize) -> Option<Engagement> {
        match self {
            Self::Constant(engagement) => Some(engagement.clone()),
            Self::Lines(ranges) => {
                let found = ranges.iter().find(|(lines, _)| lines.contains(&line));
                Some(found.map_or_else(Engagement::air, |(_, engagement)| engagement.clone()))
            }
            Self::Stock(_) => None,
        }
    }
}

//! The tool goes along the program: engagement at stations of every move.

use kinetostat_cutting::{Engagement, Probe, Result, Stock};
use kinetostat_program::{Curve, Knowledge, Move, MoveKind};
use nalgebra::Vector3;

use crate::cut::cutting_tool::CuttingTool;
use crate::cut::engagement_source::EngagementSource;

/// Chords leave an arc by at most this share of the tool's radius.
const CHORD: f64 = 0.002;

/// Where the tool is in the material, as it goes.
pub(crate) enum Walk<'a> {
    /// As told.
    Told(&'a EngagementSource),
    /// By a stock, with a probe for each tool.
    Stock(Box<Stock>, Vec<Probe>),
}

impl<'a> Walk<'a> {
    pub fn new(source: &'a EngagementSource, tools: &[CuttingTool]) -> Self {
        match source {
            EngagementSource::Stock(stock) => Self::Stock(
                stock.clone(),
                tools.iter().map(|t| Probe::new(&t.tool)).collect(),
            ),
            told => Self::Told(told),
        }
    }

    /// Calls `at(share, direction, engagement)` at the stations of a move with a tool, and removes what it sweeps.
    pub fn go(
        &mut self,
        motion: &Move,
        tool: usize,
        mut at: impl FnMut(f64, Vector3<f64>, &Engagement),
    ) -> Result<()> {
        if motion.known != Knowledge::Whole || !motion.has_length() {
            return Ok(());
        }
        match self {
            Self::Told(source) => {
                if motion.kind == MoveKind::Feed
                    && let Some(engagement) = source.of_line(motion.line)
                {
                    for share in [0.0, 1.0] {
                        if let Some(direction) = motion.tangent(share) {
                            at(share, direction, &engagement);
                        }
                    }
                }
                Ok(())
            }
            Self::Stock(stock, probes) => {
                let probe = &mut probes[tool];
                let pieces = match &motion.curve {
                    Curve::Line => 1,
                    Curve::Arc(arc) => arc.chords_within(CHORD * stock.cell_mm() * 20.0),
                };
                let mut from = motion.start;
                for piece in 0..pieces {
                    let part = |share: f64| (piece as f64 + share) / pieces as f64;
                    let to = motion.point(part(1.0));
                    let direction = (to - from).try_normalize(1e-9).unwrap_or_default();
                    probe.walk(stock, from.into(), to.into(), |share, engagement| {
                        at(part(share), direction, engagement);
                    })?;
                    from = to;
                }
                Ok(())
            }
        }
    }
}

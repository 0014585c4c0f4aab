//! The tool goes along the program: engagement at stations of every move.

use kinetostat_cutting::{Engagement, Probe, Result, Stock};
use kinetostat_program::{Curve, Knowledge, Move, MoveKind};
use nalgebra::Vector3;

use crate::cut::question::{CuttingTool, EngagementSource};

/// Chords leave an arc by at most this share of a cell.
pub(crate) const CHORD: f64 = 0.04;

/// The tool at a place of a move.
pub(crate) struct Met {
    pub share: f64,
    /// Direction of the motion, a unit vector.
    pub direction: Vector3<f64>,
    pub engagement: Engagement,
}

/// Simulation of the engagement along the program.
pub(crate) enum Walk<'a> {
    /// Stated engagement.
    Stated(&'a EngagementSource),
    /// Stock, with a probe for each tool.
    Stock(Box<Stock>, Vec<Probe>),
}

impl<'a> Walk<'a> {
    pub fn new(source: &'a EngagementSource, tools: &[CuttingTool]) -> Self {
        match source {
            EngagementSource::Stock(stock) => Self::Stock(
                stock.clone(),
                tools.iter().map(|t| Probe::new(&t.tool)).collect(),
            ),
            stated => Self::Stated(stated),
        }
    }

    /// Remaining stock.
    pub fn left(self) -> Option<Stock> {
        match self {
            Self::Stated(_) => None,
            Self::Stock(stock, _) => Some(*stock),
        }
    }

    /// Engagement of a tool (of this index) at the stations of a move; the material it sweeps is removed.
    pub fn go(&mut self, motion: &Move, tool: usize) -> Result<Vec<Met>> {
        let mut met = Vec::new();
        if motion.known != Knowledge::Whole || !motion.has_length() {
            return Ok(met);
        }
        match self {
            Self::Stated(source) => {
                if motion.kind == MoveKind::Feed
                    && let Some(engagement) = source.of_line(motion.line)
                {
                    let at = |share: f64| {
                        Some(Met {
                            share,
                            direction: motion.tangent(share)?,
                            engagement: engagement.clone(),
                        })
                    };
                    met.extend([0.0, 1.0].into_iter().filter_map(at));
                }
            }
            Self::Stock(stock, probes) => {
                let pieces = match &motion.curve {
                    Curve::Line => 1,
                    Curve::Arc(arc) => arc.chords_within(CHORD * stock.cell_mm()),
                };
                let mut from = motion.start;
                for piece in 0..pieces {
                    let part = |share: f64| (piece as f64 + share) / pieces as f64;
                    let to = motion.point(part(1.0));
                    let chord = (to - from).try_normalize(1e-9).unwrap_or_default();
                    let tangent = |share: f64| motion.tangent(part(share)).unwrap_or(chord);
                    let tangents = match motion.curve {
                        Curve::Line => None,
                        Curve::Arc(_) => Some([0.0, 1.0].map(|share| tangent(share).into())),
                    };
                    let ends = (from.into(), to.into());
                    probes[tool].walk_turning(
                        stock,
                        ends.0,
                        ends.1,
                        tangents,
                        |share, engagement| {
                            met.push(Met {
                                share: part(share),
                                direction: match tangents {
                                    None => chord,
                                    Some(_) => tangent(share),
                                },
                                engagement: engagement.clone(),
                            });
                        },
                    )?;
                    from = to;
                }
            }
        }
        Ok(met)
    }
}

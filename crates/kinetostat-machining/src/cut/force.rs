//! Force of one engagement, by a table where the feed is level and seldom changes.

use kinetostat_cutting::{CutForce, Engagement, Feed, MeanTable, Milling, Result, Rotation, Wall};

use crate::cut::question::{CuttingTool, ForceChoice};

/// A table is worth its making after so many forces of one feed.
const WORTH_A_TABLE: usize = 200;

/// Tables that are kept: feeds of one program are few.
const MOST_TABLES: usize = 16;

/// Forces of a tool, with what is used again.
#[derive(Debug)]
pub(crate) struct ForceOf<'a> {
    tool: &'a CuttingTool,
    choice: ForceChoice,
    tables: Vec<Known>,
}

/// A feed that has come before.
#[derive(Debug)]
struct Known {
    feed_mm: f64,
    rotation: Rotation,
    asked: usize,
    table: Option<MeanTable>,
}

impl<'a> ForceOf<'a> {
    pub fn new(tool: &'a CuttingTool, choice: ForceChoice) -> Self {
        Self {
            tool,
            choice,
            tables: Vec::new(),
        }
    }

    /// The force of the choice, and the mean torque, N mm.
    pub fn of(
        &mut self,
        engagement: &Engagement,
        feed: Feed,
        rotation: Rotation,
    ) -> Result<(CutForce, f64)> {
        let tool = self.tool;
        let cut = || Milling::new(&tool.tool, &*tool.law, engagement, feed).turning(rotation);
        let table = match feed.down_mm == 0.0 {
            true => self.table(feed.level_mm, rotation)?,
            false => None,
        };
        let mean = table.map_or_else(|| cut().mean(), |table| table.mean(engagement));
        let torque = mean.torque_n_mm();
        if engagement.is_air() {
            return Ok((mean, torque));
        }
        let chosen = match self.choice {
            ForceChoice::Mean => mean,
            ForceChoice::Peak => cut().peaks().across.force,
            ForceChoice::AtSurfaceGeneration => {
                let walls = [Wall::Left, Wall::Right].map(|wall| cut().surface_generation(wall));
                match walls {
                    [Some(force), None] | [None, Some(force)] => force,
                    _ => mean,
                }
            }
        };
        Ok((chosen, torque))
    }

    /// The table of a level feed, from when that feed has come often enough.
    fn table(&mut self, feed_mm: f64, rotation: Rotation) -> Result<Option<&MeanTable>> {
        let here = |known: &Known| known.feed_mm == feed_mm && known.rotation == rotation;
        let at = self.tables.iter().position(here).unwrap_or_else(|| {
            if self.tables.len() == MOST_TABLES {
                self.tables.remove(0);
            }
            self.tables.push(Known {
                feed_mm,
                rotation,
                asked: 0,
                table: None,
            });
            self.tables.len() - 1
        });
        let known = &mut self.tables[at];
        known.asked += 1;
        if known.table.is_none() && known.asked > WORTH_A_TABLE {
            let (tool, law) = (&self.tool.tool, &*self.tool.law);
            known.table = Some(MeanTable::new(tool, law, feed_mm, rotation)?);
        }
        Ok(known.table.as_ref())
    }
}

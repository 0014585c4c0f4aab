//! Speed and feed of the tool on a move, and force of one engagement, by a table where the feed is level and seldom changes.

use kinetostat_cutting::{CutForce, Engagement, Feed, MeanTable, Milling, Result, Rotation, Wall};
use kinetostat_program::{Move, Path, SpeedMode, SpindleRotation};

use crate::cut::finding::CutFailure;
use crate::cut::question::{CutQuestion, CuttingTool, ForceChoice};

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

/// Rotation and feed of the tool on a move.
pub(crate) struct Drive<'a> {
    pub tool: &'a CuttingTool,
    pub rotation: Rotation,
    pub rpm: f64,
    pub per_tooth_mm: f64,
}

impl CutQuestion {
    /// The entry (index) of the tool that the block on a line is made with.
    ///
    /// # Errors
    /// The program names a tool that is not known here, or none where there is none for all blocks.
    pub fn tool_on(&self, path: &Path, line: usize) -> std::result::Result<usize, CutFailure> {
        let number = path.tool_on(line);
        let of = |number: Option<u32>| self.tools.iter().position(|tool| tool.number == number);
        let own = number.and_then(|number| of(Some(number)));
        own.or_else(|| of(None)).ok_or(match number {
            Some(number) => CutFailure::UnknownTool { line, number },
            None => CutFailure::NoTool { line },
        })
    }

    /// Rotation and feed of the tool (of this index) on a move; the error names a missing value.
    pub(crate) fn drive(
        &self,
        path: &Path,
        motion: &Move,
        tool: usize,
    ) -> std::result::Result<Drive<'_>, CutFailure> {
        let tool = &self.tools[tool];
        let line = motion.line;
        let missing = |what, help| CutFailure::Missing { line, what, help };
        let spindle = path.spindle_on(line);
        let said = match spindle.rotation {
            SpindleRotation::Clockwise => Some(Rotation::Clockwise),
            SpindleRotation::CounterClockwise => Some(Rotation::CounterClockwise),
            SpindleRotation::Stopped => None,
        };
        let rotation = self.rotation.or(said).ok_or_else(|| {
            missing(
                "the tool cuts and the spindle does not turn",
                "add M3 or M4 to the program, or give the sense of rotation (rotation under [spindle], --rotation of `kinetostat engagement`)",
            )
        })?;
        // A spindle whose sense is stated turns at its S, though the program has no M3.
        let said = match spindle.mode {
            SpeedMode::Constant => spindle.speed.filter(|rpm| *rpm > 0.0),
            SpeedMode::ConstantSurface { .. } => None,
        };
        let rpm = self.rpm.or(said);
        let rpm = rpm.ok_or_else(|| {
            missing(
                "the tool cuts and no speed of the spindle is known (S with G97)",
                "add the S word to the program, or give the speed (rpm under [spindle], --rpm of `kinetostat engagement`)",
            )
        })?;
        let per_turn = motion.feed_mm_per_revolution(rpm).ok_or_else(|| {
            missing(
                "the tool cuts and no feed is known (F)",
                "add the F word to the program",
            )
        })?;
        Ok(Drive {
            tool,
            rotation,
            rpm,
            per_tooth_mm: per_turn / tool.tool.teeth() as f64,
        })
    }
}

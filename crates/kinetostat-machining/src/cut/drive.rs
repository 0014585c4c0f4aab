//! Speed, sense of rotation and feed per tooth of the tool, from program and question.

use kinetostat_cutting::Rotation;
use kinetostat_program::{Move, Path, SpeedMode, SpindleRotation};

use crate::cut::finding::CutFailure;
use crate::cut::question::{CutQuestion, CuttingTool};

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
    pub fn tool_on(&self, path: &Path, line: usize) -> Result<usize, CutFailure> {
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
    ) -> Result<Drive<'_>, CutFailure> {
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

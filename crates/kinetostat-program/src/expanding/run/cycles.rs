//! Blocks of canned cycles, and of arcs of many turns, while a program runs.

use crate::error::ProgramError;
use crate::expanding::options::Dialect;
use crate::expanding::run::runner::Runner;
use crate::expanding::translate::block::MotionBlock;
use crate::expanding::translate::cycle::cycle;
use crate::expanding::translate::turns::turns;

/// Meaning of a block without a code while a cycle is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum InCycle {
    /// One more hole.
    Hole,
    /// Words of the cycle that make no hole, and are not kept (Fanuc, Operator's Manual B-63534EN, section 13.1).
    Words,
    /// Other words.
    Nothing,
}

impl Runner<'_> {
    /// Meaning of a block that names no motion while a cycle is in force.
    pub fn in_cycle(&self, block: &MotionBlock) -> Result<InCycle, ProgramError> {
        if block.wants_axes {
            return Ok(InCycle::Nothing);
        }
        if block.has_place() || block.has_other_axis() {
            return Ok(InCycle::Hole);
        }
        if !block.has_cycle_words() {
            return Ok(InCycle::Nothing);
        }
        match (block.value(b'R'), self.options.dialect) {
            (_, Dialect::LinuxCnc) => Err(self.refuse(
                "words of a cycle without a place: LinuxCNC refuses them",
                "write them into a block with a place",
            )),
            (Some(_), Dialect::Fanuc) => Ok(InCycle::Hole),
            (Some(_), Dialect::Undecided) => Err(self.refuse(
                "R without a place while a cycle is in force: Fanuc drills once more where the tool is, LinuxCNC refuses it",
                "write R into a block with a place, or name the dialect (--dialect)",
            )),
            _ => Ok(InCycle::Words),
        }
    }

    /// Notes G0 to G3. G80 is of another group to Fanuc and Haas, so that the last of them holds behind it (B-64304EN,
    /// list of G codes); elsewhere nothing does.
    pub fn note_move(&mut self, block: &MotionBlock) {
        match block.motion {
            Some(0) => self.move_named = Some("G0"),
            Some(10) => self.move_named = Some("G1"),
            Some(20) => self.move_named = Some("G2"),
            Some(30) => self.move_named = Some("G3"),
            Some(800) => {
                let is_fanuc = self.options.dialect == Dialect::Fanuc;
                let code = self.move_named.filter(|_| is_fanuc);
                self.coordinates.owe(code);
            }
            _ => {}
        }
    }

    /// An arc of more than one turn (LinuxCNC).
    pub fn turns(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        self.add_rest(&block.before)?;
        let made = turns(block, self.state());
        for text in made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))? {
            self.add(text.as_bytes())?;
        }
        self.add_rest(&block.after)
    }

    /// A block that makes holes.
    pub fn cycle(&mut self, code: u32, block: &MotionBlock) -> Result<(), ProgramError> {
        let refused = self.radius.refuses_cycles();
        let refused = refused.or_else(|| self.coordinates.refuses_cycles());
        if let Some((reason, remedy)) = refused {
            return Err(self.refuse(&reason, remedy));
        }
        self.add_rest(&block.before)?;
        if self.taps_rigidly && matches!(code, 740 | 840) {
            return Err(self.refuse(
                "behind M29 the feed of the tap is tied to the turns of the spindle (rigid tapping): plain blocks have no words for it",
                "take M29 out where the tap floats in its holder, or write the taps into a program of their own that is not expanded",
            ));
        }
        let state = (self.state(), self.options.dialect);
        let made = cycle(code, block, self.cycle, state);
        let (texts, cycle) = made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        for text in texts {
            self.add(text.as_bytes())?;
        }
        self.cycle = Some(cycle);
        let is_peck = matches!(code, 730 | 830) && self.options.dialect == Dialect::Fanuc;
        if is_peck && !std::mem::replace(&mut self.pecks_warned, true) {
            self.flat.warn("each peck of G73 and G83 begins 0.254 mm (0.010 inch) above the last depth here, as LinuxCNC has it; on Fanuc's controllers parameters 5114 and 5115 say how far above. The depths are the same");
        }
        self.add_rest(&block.after)
    }
}

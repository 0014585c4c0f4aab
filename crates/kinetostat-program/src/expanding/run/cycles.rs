//! Blocks of canned cycles, and of arcs of many turns, while a program runs.

use crate::error::ProgramError;
use crate::expanding::options::Dialect;
use crate::expanding::run::rigid::Rigid;
use crate::expanding::run::runner::Runner;
use crate::expanding::translate::block::MotionBlock;
use crate::expanding::translate::cycle::cycle;
use crate::expanding::translate::turns::turns;
use crate::text::lex::{Spanned, tokens_of};

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
    /// Holds M29 back until a tap writes it; gives the rest of its block.
    pub fn hold_rigid(&mut self, text: &[u8]) -> Option<Vec<u8>> {
        if self.options.dialect == Dialect::LinuxCnc || !text.windows(2).any(|two| two == b"29") {
            return None;
        }
        let (rigid, rest) = Rigid::of(text)?;
        self.rigid = Some(rigid);
        Some(rest)
    }

    /// A block with G28 or G30 and both G90 and G91, with the last of these alone (Fanuc, Operator's Manual B-64304EN,
    /// preparatory function).
    pub fn last_distance(&self, text: &[u8]) -> Option<Vec<u8>> {
        if self.options.dialect != Dialect::Fanuc || !text.windows(2).any(|two| two == b"91") {
            return None;
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let is =
            |one: &&Spanned, codes: &[u32]| one.g_code().is_some_and(|code| codes.contains(&code));
        let goes_home = tokens.iter().any(|one| is(&one, &[280, 300]));
        let modes: Vec<&Spanned> = tokens.iter().filter(|one| is(one, &[900, 910])).collect();
        match modes[..] {
            [first, last] if goes_home && first.g_code() != last.g_code() => {
                let mut made = text.to_vec();
                made.splice(first.span.clone(), []);
                Some(made)
            }
            _ => None,
        }
    }

    /// G80 and other motions end it; what no tap has written stands before them.
    pub fn end_rigid(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        if matches!(block.motion, None | Some(740 | 840)) {
            return Ok(());
        }
        match self.rigid.take() {
            Some(rigid) if !rigid.is_written => self.add(rigid.text.as_bytes()),
            _ => Ok(()),
        }
    }

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
        let is_fanuc = self.options.dialect == Dialect::Fanuc;
        if self.rigid.is_some() && matches!(code, 740 | 840) && !is_fanuc {
            return Err(self.refuse(
                "behind M29 the feed of the tap is tied to the turns of the spindle (rigid tapping): plain blocks have no words for it",
                "take M29 out where the tap floats in its holder, or have the cycle left as it is written (--dialect fanuc)",
            ));
        }
        let rigid = self.rigid.as_ref().map(|rigid| rigid.text.as_str());
        let dialect = self.options.dialect;
        let made = cycle(code, block, self.cycle, self.state(), dialect, rigid);
        let (texts, cycle) = made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        let stays = is_fanuc && cycle.is_the_controls(self.rigid.is_some());
        if stays && self.coordinates.interpreter().is_some() {
            return Err(self.refuse(
                &format!("the cycle G{} stays as it is written, and the coordinates are shifted, scaled or turned", code / 10),
                "end that before it (G52 X0 Y0 Z0, G50, G69), or write its moves as G0 and G1 blocks",
            ));
        }
        if let Some(rigid) = &mut self.rigid {
            rigid.is_written |= matches!(code, 740 | 840);
        }
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

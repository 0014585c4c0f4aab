//! Blocks of splines while a program runs.

use crate::error::ProgramError;
use crate::expanding::options::Dialect;
use crate::expanding::run::runner::Runner;
use crate::expanding::translate::block::MotionBlock;
use crate::expanding::translate::moves::Place;
use crate::expanding::translate::spline::{Spline, is_spline, spline};
use crate::path::moves::FeedMode;

impl Runner<'_> {
    /// The code of the spline that a block makes or goes on with, in tenths; `None` if it is no spline.
    pub fn code_of_spline(&self, block: &MotionBlock) -> Option<u32> {
        let goes_on = block.motion.is_none() && !block.wants_axes;
        let has_words = block.has_place() || block.value(b'P').is_some();
        match (block.motion, &self.spline) {
            // G5.1 Q1 and G5 P10000 are contour modes of Fanuc: the reader carries them.
            (Some(_), _) if self.options.dialect == Dialect::Fanuc => None,
            (Some(code @ (50 | 51)), _) => block.has_place().then_some(code),
            (Some(code), _) => Some(code).filter(|code| is_spline(*code)),
            (None, Some(Spline::Cubic { .. })) if goes_on && has_words => Some(50),
            (None, Some(Spline::Quadratic)) if goes_on && has_words => Some(51),
            (None, Some(Spline::Open { .. })) if goes_on && has_words => Some(52),
            (None, _) => None,
        }
    }

    /// A spline as its chords.
    pub fn spline(&mut self, code: u32, block: &MotionBlock) -> Result<(), ProgramError> {
        if self.radius.refuses_cycles().is_some() {
            return Err(self.refuse(
                "a spline cannot be run while cutter radius compensation is on, or before the first move behind G40",
                "write G40 and a move before it",
            ));
        }
        if block.motion.is_none() && code != 52 {
            return Err(self.refuse(
                "a spline goes on without its code: LinuxCNC wants G5 and G5.1 in each block",
                "write the code into the block",
            ));
        }
        self.add_rest(&block.before)?;
        let state = self.state();
        if state.plane_axes() != [0, 1, 2] {
            return Err(self.refuse("a spline outside the plane XY", "write G17 before it"));
        }
        if state.feed_mode() == FeedMode::InverseTime {
            return Err(self.refuse(
                "a spline with the feed of inverse time (G93)",
                "write G94 and F before it",
            ));
        }
        let mut place = Place::of(state);
        let [Some(x), Some(y), _] = place.at else {
            return Err(self.refuse(
                "where the tool is before the spline is not known",
                "state X and Y before it, or give the start position",
            ));
        };
        let before = self.spline.take();
        let made = spline(code, block, before, [x, y], place.incremental);
        let made = made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        for end in made.ends {
            if let Some(text) = place.go("G1", [Some(end[0]), Some(end[1]), None]) {
                self.add(text.as_bytes())?;
            }
        }
        self.spline = made.next;
        if code == 53 {
            // No motion is in force after a NURBS.
            self.add(b"G80")?;
        }
        self.add_rest(&block.after)
    }

    /// Ends the spline when another motion begins.
    pub fn leave_spline(&mut self) -> Result<(), ProgramError> {
        match self.spline.take() {
            Some(Spline::Open { .. }) => Err(self.refuse(
                "the NURBS before it is not ended: its control points would be lost",
                "write G5.3 behind its last control point",
            )),
            _ => Ok(()),
        }
    }
}

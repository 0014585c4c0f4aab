//! Moves whose ends are given by a radius and an angle.

use crate::error::ProgramError;
use crate::expanding::number::number;
use crate::expanding::run::runner::Runner;
use crate::expanding::translate::block::MotionBlock;

impl Runner<'_> {
    /// A straight move or an arc whose end is given by a radius and an angle.
    pub fn polar(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        let remedy = "write the place with X and Y";
        if block.value(b'X').or(block.value(b'Y')).is_some() {
            return Err(self.refuse("X or Y beside polar words", remedy));
        }
        self.add_rest(&block.before)?;
        let state = self.state();
        if state.plane_axes()[2] != 2 {
            return Err(self.refuse(
                "polar words outside the plane XY (G17)",
                "write G17 before it, or the place with X, Y and Z",
            ));
        }
        let (x, y) = match (state.coordinate(0), state.coordinate(1)) {
            (Ok(x), Ok(y)) => (x, y),
            (Err(reason), _) | (_, Err(reason)) => {
                return Err(self.refuse(&reason, "state X and Y before polar words"));
            }
        };
        let incremental = state.is_incremental();
        let end = block.polar.place([x, y], incremental);
        let end = end.map_err(|reason| self.refuse(reason, remedy))?;
        let words = match incremental {
            true => [end[0] - x, end[1] - y],
            false => end,
        };
        let mut text = block.motion_words();
        text.push_str(&format!("X{} Y{}", number(words[0]), number(words[1])));
        text.push_str(&block.other_words());
        self.add(text.as_bytes())?;
        self.add_rest(&block.after)
    }
}

//! What of a drilling cycle is written as Siemens' manual of the cycles has it, where that was not at hand: a note by line.

use crate::siemens::flat::drilling::Drilling;
use crate::siemens::flat::runner::Runner;

/// Chips are broken: on its way back in the hole the drill cuts nothing, at feed as by a rapid.
const BACK: &str = "CYCLE83 breaks chips (VARI=0): its way back in the hole is written by G1 at the feed, as the cycle does as far as is known here (the manual was not at hand). Of a control that goes back by G0 the way is the same and the time shorter; there the load is taken where nothing is cut";

/// Steps that stay as long as the first one.
const EVEN: &str = "CYCLE83 without DAM: all steps are taken as long as the first, which is not certain here (the manual was not at hand). Compare the depths with those of the control, or state DAM and _MDEP";

impl Runner<'_> {
    /// Notes what is in doubt of a cycle where the tool is.
    pub(super) fn doubt(&mut self, drilling: &Drilling) {
        let Some(deep) = &drilling.deep else {
            return;
        };
        let unit = self.levels.last().map_or(0, |level| level.unit);
        let place = (
            self.units[unit].file,
            self.file().line_of(self.span().start),
        );
        let has_steps = deep.first != drilling.depth;
        let doubts = [(BACK, !deep.withdraws), (EVEN, deep.shorter == 0.0)];
        for (what, _) in doubts.into_iter().filter(|(_, is)| *is && has_steps) {
            let lines = self.doubts.0.entry((what, place.0)).or_default();
            // A loop drills by one line many times.
            if lines.last() != Some(&place.1) {
                lines.push(place.1);
            }
        }
    }
}

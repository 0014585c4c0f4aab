//! GOTO: jumps forward to a label are followed, as branches are; what a jump leaves out does not run.
//!
//! All ways join again at the label: behind it a motion runs as often as before the jump. A jump backward makes a loop of what stands
//! between, and the order of its routine is not followed.

use crate::calls::Holds;
use crate::model::motion::Runs;
use crate::rapid::labels::Jump;
use crate::rapid::place::Place;
use crate::rapid::walker::Walker;
use crate::text::name::Name;

impl Walker<'_, '_> {
    /// A jump begins here.
    pub(super) fn jump_to(&mut self, label: Name, at: Place) {
        let modes = self.now.modes;
        self.jumps.push(Jump { label, at, modes });
    }

    /// Where the tool is at a label: after what stands before it, where that runs, and after all jumps that lead here.
    pub(super) fn arrive(&mut self, at: usize, before: Option<Place>) -> Option<Place> {
        let label = Name::of(self.file().word(at));
        let mut met = before.map(|place| (place, self.now.modes));
        self.jumps.retain(|jump| {
            let leads_here = Some(jump.label) == label;
            if leads_here {
                met = Some(met.map_or((jump.at, jump.modes), |(place, modes)| {
                    (place.merged(jump.at), modes.met(jump.modes))
                }));
            }
            !leads_here
        });
        let (place, modes) = met?;
        self.now.modes = modes;
        Some(place)
    }

    /// How often a statement runs in a block that runs so often: behind a RETURN in a branch, an EXIT anywhere, or a jump that has not come
    /// to its label, on a condition.
    pub(super) fn runs_here(&self, block: Runs) -> Runs {
        let on_condition = self.now.left.is_some() || self.has_ended || !self.jumps.is_empty();
        match on_condition {
            true => Runs::OnCondition.max(block),
            false => block,
        }
    }
}

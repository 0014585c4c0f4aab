//! Where the tool stops exactly.

use crate::making::event_kind::EventKind;
use crate::making::step::Step;

/// Motions that stop: before a pause and another tool, where rapids and feeds meet, and at the end.
pub(crate) fn stops(steps: &mut [Step]) {
    let mut next: Option<bool> = None;
    for step in steps.iter_mut().rev() {
        match step {
            Step::Motion(motion) => {
                motion.exact |= next != Some(motion.rapid);
                next = Some(motion.rapid);
            }
            Step::Action(action) => {
                if matches!(action.kind(), EventKind::Dwell | EventKind::Stop) {
                    next = None;
                }
            }
            Step::Tool(_) => next = None,
            Step::Note(_) => {}
        }
    }
}

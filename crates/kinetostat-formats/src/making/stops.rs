//! Exact stops of the tool.

use crate::making::event_kind::EventKind;
use crate::making::step::{Step, Way};

/// Motions that stop: before a pause and another tool, where rapids and feeds meet, motions by joints and others, and at the end.
pub(crate) fn stops(steps: &mut [Step]) {
    let mut next: Option<[bool; 2]> = None;
    for step in steps.iter_mut().rev() {
        match step {
            Step::Motion(motion) => {
                let own = [motion.rapid, motion.way == Way::Joint];
                motion.exact |= next != Some(own);
                next = Some(own);
            }
            Step::Action(action) => {
                if matches!(action.kind(), EventKind::Dwell | EventKind::Stop) {
                    next = None;
                }
            }
            Step::Tool(_) | Step::Statement(_) => next = None,
            Step::Note(_) => {}
        }
    }
}

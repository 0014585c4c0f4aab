//! A program divided into files of at most so many places.

use std::ops::Range;

use crate::making::step::Step;

/// Ranges of the steps, one for each part.
pub(crate) fn parts(steps: &[Step], most: usize) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let (mut start, mut places) = (0, 0);
    for (index, step) in steps.iter().enumerate() {
        let more = step.motion().map_or(0, |motion| motion.places());
        if places + more > most && places > 0 {
            parts.push(start..index);
            (start, places) = (index, 0);
        }
        places += more;
    }
    parts.push(start..steps.len());
    parts
}

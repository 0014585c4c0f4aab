//! Does the question make sense, and does the answer?
//!
//! Takes the task and the solved points; gives figures beyond their limits, which refuse a program, and warnings about
//! figures that are allowed and unusual. Changes nothing.

pub(crate) mod correction;
pub(crate) mod load;
pub(crate) mod own_weight;
pub(crate) mod placement;
pub(crate) mod refused;
pub(crate) mod unusual;

use crate::limits::{Beyond, Limits};

/// Collects figures beyond their limits.
pub(crate) struct Exceeded<'l> {
    pub(crate) limits: &'l Limits,
    pub(crate) found: Vec<Beyond>,
}

impl Exceeded<'_> {
    /// Notes a figure that is beyond its limit, or is NaN.
    pub(crate) fn above(&mut self, name: &str, found: f64, line: Option<usize>, place: String) {
        let beyond = self.limits.beyond(name, found, line, &place);
        self.found.extend(beyond);
    }
}

/// Share of a limit above which a figure is allowed and unusual.
pub(crate) const ODD: f64 = 0.5;

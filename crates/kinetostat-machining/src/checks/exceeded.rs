//! Figures that are beyond their limits, collected one by one.

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

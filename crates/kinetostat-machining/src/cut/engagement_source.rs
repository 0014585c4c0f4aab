//! Source of the engagement of the tool.

use std::ops::RangeInclusive;

use kinetostat_cutting::{Engagement, Stock};

/// Source of the engagement of the tool along a program.
#[derive(Clone, Debug)]
pub enum EngagementSource {
    /// One engagement for all feed moves, in the frame of the cut.
    Constant(Engagement),
    /// Engagement by lines of the program, the first range that contains a line; air on all other lines.
    Lines(Vec<(RangeInclusive<usize>, Engagement)>),
    /// A stock that the program itself cuts, in coordinates of the part, mm.
    Stock(Box<Stock>),
}

impl EngagementSource {
    /// Engagement of a line, if it is known without simulating a stock.
    pub(crate) fn of_line(&self, line: usize) -> Option<Engagement> {
        match self {
            Self::Constant(engagement) => Some(engagement.clone()),
            Self::Lines(ranges) => {
                let found = ranges.iter().find(|(lines, _)| lines.contains(&line));
                Some(found.map_or_else(Engagement::air, |(_, engagement)| engagement.clone()))
            }
            Self::Stock(_) => None,
        }
    }
}

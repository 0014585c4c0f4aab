//! Where the tool is in the material.

use std::ops::RangeInclusive;

use kinetostat_cutting::{Engagement, Stock};

/// Where the tool is in the material, along a program.
#[derive(Clone, Debug)]
pub enum EngagementSource {
    /// The same on all feed moves, in the frame of the cut.
    Constant(Engagement),
    /// By lines of the program; air on lines that are in none. The first that holds a line counts.
    Lines(Vec<(RangeInclusive<usize>, Engagement)>),
    /// A stock that the program itself cuts, in coordinates of the part, mm.
    Stock(Box<Stock>),
}

impl EngagementSource {
    /// What is known of a line without going through a stock.
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

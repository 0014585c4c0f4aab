//! Text position of a motion's speed, and of a replacement: before it, where it stays in force, or in its own WITH.

use std::ops::Range;

use crate::interpreter::token::TokenFile;
use crate::krl::aggregate::aggregate_of;
use crate::krl::lex::assignment;
use crate::model::site::SpeedSite;

/// mm/s in one m/s, in which KRL states speeds.
const METRE_MM: f64 = 1000.0;

/// Text position of a motion's speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum SpeedPlace {
    /// Modal speed: another one is stated before the motion.
    Before,
    /// Speed in the WITH of the motion, for it alone: the bytes of its number; `None` if it is no number.
    Own(Option<Range<usize>>),
    /// Modal speed in a spline block, which allows no assignment: its segments state another one in their WITH.
    OfBlock {
        /// Bytes at which it is written.
        at: usize,
        /// A WITH with other things stands there.
        has_with: bool,
    },
}

impl SpeedPlace {
    /// Speed position of a motion; `tokens` are its end and its WITH (without that word).
    pub(crate) fn of(
        file: &TokenFile<'_>,
        end: &Range<usize>,
        with: &Range<usize>,
        in_block: bool,
    ) -> Self {
        let stated = file.split(with).filter_map(|item| stated_in(file, &item));
        match (stated.last(), in_block) {
            (Some(number), _) => Self::Own(number.map(|tokens| file.span(&tokens))),
            (None, false) => Self::Before,
            (None, true) => Self::OfBlock {
                at: match with.is_empty() {
                    true => file.span(end).end,
                    false => file.span(with).start,
                },
                has_with: !with.is_empty(),
            },
        }
    }

    /// Site of a new speed for a motion that begins at `start`; `line_end` separates statements.
    pub(crate) fn site(self, start: usize, line_end: &str) -> Option<SpeedSite> {
        let (span, before, after) = match self {
            Self::Before => (start..start, "$VEL.CP=", line_end),
            Self::Own(number) => (number?, "", ""),
            Self::OfBlock { at, has_with: true } => (at..at, "$VEL.CP=", ","),
            Self::OfBlock { at, .. } => (at..at, " WITH $VEL.CP=", ""),
        };
        Some(SpeedSite {
            span,
            before: before.to_owned(),
            after: after.to_owned(),
            unit_mm_per_s: METRE_MM,
        })
    }
}

/// The number of `$VEL.CP=0.1`, `$VEL={CP 0.1,ORI1 200}` and `$VEL=SVEL_CP(0.1, ,LCPDAT1)`: None within where another expression stands
/// there, none at all where the item says nothing of the speed along the path.
fn stated_in(file: &TokenFile<'_>, item: &Range<usize>) -> Option<Option<Range<usize>>> {
    file.name(item.start).filter(|name| name.is("$VEL"))?;
    let equals = assignment(file, item)?;
    let value = equals + 1..item.end;
    let is_whole = equals == item.start + 1;
    if !is_whole {
        let part = file.name(item.start + 2)?;
        return part.is("CP").then_some(Some(value));
    }
    if let Some(members) = aggregate_of(file, &value) {
        return Some(members.member("CP").cloned());
    }
    let is_call = file.name(value.start).is_some() && file.is(value.start + 1, b'(');
    let argument = value.start + 2..value.end.saturating_sub(1).max(value.start + 2);
    Some(is_call.then(|| {
        let end = file.find(argument.clone(), b',').unwrap_or(argument.end);
        argument.start..end
    }))
}

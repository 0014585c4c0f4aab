//! Text after the target of a motion: approximation (C_DIS, C_VEL), the settings of WITH for this motion alone, and the position of its
//! speed.

use std::ops::Range;

use crate::error::excerpt;
use crate::interpreter::run::Reason;
use crate::interpreter::token::TokenFile;
use crate::krl::expression::aggregate_of;
use crate::krl::lex::assignment;
use crate::krl::state::Run;
use crate::model::site::SpeedSite;

/// A way of passing an end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rounding {
    /// Within `$APO.CDIS`.
    Distance,
    /// Within `$APO.CPTP`.
    JointPercent,
    /// Approximation with `$APO.CVEL`.
    SpeedPercent,
    /// Point at which the tool is turned.
    Turning,
}

const ROUNDINGS: [(&str, Rounding); 5] = [
    ("C_DIS", Rounding::Distance),
    ("C_PTP", Rounding::JointPercent),
    ("C_VEL", Rounding::SpeedPercent),
    ("C_ORI", Rounding::Turning),
    ("C_SPL", Rounding::Distance),
];

/// Decoded text after the target of a motion.
pub(crate) struct Rest {
    /// Place of the words of rounding.
    pub zone: Option<Range<usize>>,
    pub rounding: Option<Rounding>,
    /// A step is in the axes of the tool, not of the base.
    pub in_tool: bool,
    /// Settings after WITH.
    pub with: Range<usize>,
}

/// Decodes the tokens after the target. The reference axes of a step (`is_step`) are stated before or after the words of approximation.
pub(crate) fn rest_of(
    file: &TokenFile<'_>,
    tokens: Range<usize>,
    is_step: bool,
) -> Result<Rest, Reason> {
    let mut rest = Rest {
        zone: None,
        rounding: None,
        in_tool: false,
        with: tokens.end..tokens.end,
    };
    let mut at = tokens.start;
    while at < tokens.end {
        if is_step && file.is(at, b'#') {
            rest.in_tool = is_of_tool(file, at)?;
            at += 2;
            continue;
        }
        let Some(name) = file.name(at) else {
            // A comma between words of rounding.
            if file.is(at, b',') && rest.zone.is_some() {
                at += 1;
                continue;
            }
            return Err(inline_form());
        };
        if let Some((_, rounding)) = ROUNDINGS.iter().find(|(word, _)| name.is(word)) {
            let span = file.span(&(at..at + 1));
            let start = rest.zone.as_ref().map_or(span.start, |zone| zone.start);
            if rest.zone.is_none() {
                rest.rounding = Some(*rounding);
            }
            rest.zone = Some(start..span.end);
            at += 1;
        } else if name.is("WITH") {
            rest.with = at + 1..tokens.end;
            // Words of rounding may stand behind it.
            if let Some(zone) = file.name(tokens.end - 1) {
                let found = ROUNDINGS.iter().find(|(word, _)| zone.is(word));
                if let (Some((_, rounding)), true) = (found, rest.with.len() > 1) {
                    rest.with.end -= 1;
                    rest.rounding = Some(*rounding);
                    rest.zone = Some(file.span(&(tokens.end - 1..tokens.end)));
                }
            }
            return Ok(rest);
        } else if name.is("CA") {
            return Err((
                "the angle CA lets the circle end elsewhere than at its end point".to_owned(),
                "write the circle with the point at which it ends, without CA: a full turn as two of them",
            ));
        } else {
            return Err(inline_form());
        }
    }
    Ok(rest)
}

/// True if a step is in the axes of the tool; the default is the base.
fn is_of_tool(file: &TokenFile<'_>, at: usize) -> Result<bool, Reason> {
    let name = file.name(at + 1);
    let is = |word: &str| name.is_some_and(|name| name.is(word));
    match (is("BASE"), is("TOOL")) {
        (false, false) => Err((
            "its steps are in axes that are not known".to_owned(),
            "write #BASE or #TOOL",
        )),
        (_, is_tool) => Ok(is_tool),
    }
}

fn inline_form() -> Reason {
    (
        "behind the target stands what only the text of an inline form has: no controller runs that".to_owned(),
        "give the file as the controller saves it, with the statements in its FOLDs",
    )
}

/// System variables that say nothing of where the tool goes: accelerations, loads, how joints and external axes are timed.
const CARRIED: [&str; 18] = [
    "$ACC",
    "$ACC_AXIS",
    "$ACC_EXTAX",
    "$ADVANCE",
    "$COLLMON_TOL_PRO",
    "$CP_VEL_TYPE",
    "$ECO_LEVEL",
    "$GEAR_JERK",
    "$JERK",
    "$LOAD",
    "$LOAD_A1",
    "$LOAD_A2",
    "$LOAD_A3",
    "$ROTSYS",
    "$SPL_VEL_MODE",
    "$SPL_VEL_RESTR",
    "$VEL_AXIS",
    "$VEL_EXTAX",
];
/// System variables that [`Run::set`] follows or refuses.
const FOLLOWED: [&str; 9] = [
    "$APO",
    "$BASE",
    "$CIRC_MODE",
    "$CIRC_TYPE",
    "$EX_AX_IGNORE",
    "$IPO_MODE",
    "$ORI_TYPE",
    "$TOOL",
    "$VEL",
];
impl Run<'_, '_> {
    /// Takes what the tokens behind WITH put in force, for one motion or one spline block.
    pub(super) fn with(&mut self, tokens: &Range<usize>) -> Result<(), Reason> {
        let file = self.file();
        let all: Vec<Range<usize>> = file.split(tokens).collect();
        for item in all {
            let name = file.name(item.start);
            let is_one = |all: &[&str]| name.is_some_and(|name| all.iter().any(|one| name.is(one)));
            match assignment(file, &item) {
                Some(equals) if is_one(&FOLLOWED) => self.set(&item, equals)?,
                Some(_) if is_one(&CARRIED) => {}
                _ => return Err(not_known(&file.text(&item))),
            }
        }
        Ok(())
    }
}

fn not_known(text: &str) -> Reason {
    (
        format!(
            "`{}` behind WITH is no setting of a motion that is known here, and may move the tool",
            excerpt(text.as_bytes())
        ),
        "remove it, or take the motion into a program of its own",
    )
}

// Text position of a motion's speed, and of a replacement: before it, where it stays in force, or in its own WITH.

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

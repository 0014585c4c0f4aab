//! Text after the target of a motion: approximation (C_DIS, C_VEL) and settings for this motion alone.

use std::ops::Range;

use crate::interpreter::run::Reason;
use crate::interpreter::token::TokenFile;

/// A way of passing an end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rounding {
    /// Within `$APO.CDIS`.
    Distance,
    /// Within `$APO.CPTP`.
    JointPercent,
    /// With `$APO.CVEL`.
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

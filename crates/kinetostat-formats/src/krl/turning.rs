//! How the tool turns from point to point: `$ORI_TYPE=#VAR`, `$CIRC_TYPE=SCIRC_TYP(LCPDAT1)`.

use std::ops::Range;

use crate::error::excerpt;
use crate::krl::values::{Reason, Values};
use crate::text::name::Name;

/// Refuses what lets the tool turn otherwise than from the orientation of one point to that of the next.
pub(crate) fn turns_as_followed(
    values: &Values<'_>,
    routine: usize,
    (name, tokens, value): (&Name, &Range<usize>, &Range<usize>),
) -> Result<(), Reason> {
    let file = values.file(routine);
    let word = match name.is("$ORI_TYPE") {
        true => "ORI_TYP",
        false => "CIRC_TYP",
    };
    let called = file
        .name(value.start)
        .filter(|_| file.is(value.start + 1, b'('))
        .filter(|called| called.is("SORI_TYP") || called.is("SCIRC_TYP"));
    let (choice, place) = match called {
        // Data that do not state it have the first of each: #VAR, #BASE.
        Some(_) => {
            let argument = value.start + 2..value.end.saturating_sub(1).max(value.start + 2);
            let choice = values.choice(routine, &argument, word)?;
            (choice.unwrap_or_else(|| "VAR".to_owned()), "there")
        }
        None => (file.text(value).to_uppercase(), "here"),
    };
    let shown = excerpt(file.text(tokens).as_bytes());
    match word {
        "ORI_TYP" if !choice.contains("VAR") => Err((
            format!("`{shown}`: the tool does not turn evenly to the orientation of the point"),
            match place {
                "here" => "write $ORI_TYPE=#VAR, with the orientations that the tool has",
                _ => "write ORI_TYP #VAR in these data, with the orientations that the tool has",
            },
        )),
        "CIRC_TYP" if choice.contains("PATH") => Err((
            "the tool turns with the circle (#PATH), whatever its points say".to_owned(),
            match place {
                "here" => "write $CIRC_TYPE=#BASE, with the orientations that the tool has",
                _ => "write CIRC_TYP #BASE in these data, with the orientations that the tool has",
            },
        )),
        _ => Ok(()),
    }
}

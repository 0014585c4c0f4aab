//! How the tool turns from point to point: `$ORI_TYPE=#VAR`, `$CIRC_TYPE=SCIRC_TYP(LCPDAT1)`, `$SINGUL_STRATEGY=0`, and the data of `LDAT_ACT=LCPDAT1`.

use std::ops::Range;

use crate::error::excerpt;
use crate::krl::values::{Reason, Values};
use crate::model::site::TurnsOtherwise;
use crate::model::site::not_evenly;
use crate::model::target::PoseTarget;
use crate::text::name::Name;

/// How motions turn that keep the orientation with which they begin.
pub(crate) const KEPT: TurnsOtherwise = TurnsOtherwise {
    reason: "$ORI_TYPE=#CONSTANT keeps the orientation with which it begins",
    remedy: "write $ORI_TYPE=#VAR, with the orientations that the tool has",
    evenly: None,
};

/// Why the end of such a motion is not the one that is written.
pub(crate) fn turned(before: Option<&PoseTarget>, end: Option<&PoseTarget>) -> Option<Reason> {
    let turn_rad = match (before, end?) {
        (Some(before), end) => before.orientation.angle_to(&end.orientation),
        (None, _) => {
            let reason = "$ORI_TYPE=#CONSTANT keeps the orientation with which it begins, and that is not known from the text in these axes";
            return Some((reason.to_owned(), KEPT.remedy));
        }
    };
    Some((not_evenly("the tool turns", turn_rad, KEPT)?, KEPT.remedy))
}

/// Refuses what lets the tool turn otherwise than from the orientation of one point to that of the next; whether it keeps that of the
/// first.
pub(crate) fn turns_as_followed(
    values: &Values<'_>,
    routine: usize,
    (name, tokens, value): (&Name, &Range<usize>, &Range<usize>),
) -> Result<bool, Reason> {
    let file = values.file(routine);
    // A member of LDAT_ACT stands behind a point.
    let stated = file.name(tokens.start + 2).filter(|_| name.is("LDAT_ACT"));
    let is_orientation = name.is("$ORI_TYPE") || stated.is_some_and(|member| member.is("ORI_TYP"));
    let word = match is_orientation {
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
    is_followed(word, &choice, &shown, place == "here")
}

/// Refuses data of inline forms, which BAS puts in force for the motions behind it, as [`turns_as_followed`] refuses words; whether they
/// keep the orientation.
pub(crate) fn data_turn_as_followed(
    values: &Values<'_>,
    routine: usize,
    (tokens, value): (&Range<usize>, &Range<usize>),
) -> Result<bool, Reason> {
    let mut kept = false;
    let shown = excerpt(values.file(routine).text(tokens).as_bytes());
    for word in ["ORI_TYP", "CIRC_TYP"] {
        // Data that are in none of the files say nothing of speed or rounding, either: what needs them says so.
        if let Ok(Some(choice)) = values.choice(routine, value, word) {
            kept |= is_followed(word, &choice, &shown, false)?;
        }
    }
    Ok(kept)
}

fn is_followed(word: &str, choice: &str, shown: &str, here: bool) -> Result<bool, Reason> {
    match word {
        "ORI_TYP" if choice.trim().trim_start_matches('#') == "CONSTANT" => Ok(true),
        "ORI_TYP" if !choice.contains("VAR") => Err((
            format!("`{shown}`: the tool does not turn evenly to the orientation of the point"),
            match here {
                true => "write $ORI_TYPE=#VAR, with the orientations that the tool has",
                false => {
                    "write ORI_TYP #VAR in these data, with the orientations that the tool has"
                }
            },
        )),
        "CIRC_TYP" if choice.contains("PATH") => Err((
            "the tool turns with the circle (#PATH), whatever its points say".to_owned(),
            match here {
                true => "write $CIRC_TYPE=#BASE, with the orientations that the tool has",
                false => {
                    "write CIRC_TYP #BASE in these data, with the orientations that the tool has"
                }
            },
        )),
        _ => Ok(false),
    }
}

/// Refuses `$CIRC_MODE.AUX_PT.ORI=#INTERPOLATE`: the tool passes the orientation of the place on the circle.
/// Either stands in the statement or in the data that it names.
pub(crate) fn auxiliary_turn(statement: &str, of_data: Option<&str>) -> Result<(), Reason> {
    let says = |text: &str| text.to_uppercase().contains("#INTERPOLATE");
    match says(statement) || of_data.is_some_and(says) {
        true => Err((
            format!(
                "`{}`: on a circle the tool passes the orientation of the place on it, which is not followed",
                excerpt(statement.as_bytes())
            ),
            "write #IGNORE, and divide the circle where the tool is to have that orientation",
        )),
        false => Ok(()),
    }
}

/// Refuses `$SINGUL_STRATEGY=1`: on straight lines and circles near singular postures the tool leaves its orientation.
pub(crate) fn keeps_its_orientation(strategy: Option<f64>) -> Result<(), Reason> {
    match strategy {
        Some(0.0) => Ok(()),
        _ => Err((
            "near singular postures the tool leaves its orientation on lines and circles"
                .to_owned(),
            "write $SINGUL_STRATEGY=0, and go round those postures",
        )),
    }
}

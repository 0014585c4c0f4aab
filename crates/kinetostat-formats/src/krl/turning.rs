//! Orientation control of the tool: `$ORI_TYPE=#VAR`, `$CIRC_TYPE=SCIRC_TYP(LCPDAT1)`, `$SINGUL_STRATEGY=0`, and the data of `LDAT_ACT=LCPDAT1`.

use std::ops::Range;

use crate::error::excerpt;
use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::Reason;
use crate::interpreter::value::{Datum, Value};
use crate::krl::state::Run;
use crate::model::site::TurnsOtherwise;
use crate::model::site::not_evenly;
use crate::model::target::PoseTarget;

/// Motions with constant orientation.
pub(crate) const KEPT: TurnsOtherwise = TurnsOtherwise {
    reason: "$ORI_TYPE=#CONSTANT keeps the orientation with which it begins",
    remedy: "write $ORI_TYPE=#VAR, with the orientations that the tool has",
    evenly: None,
};

/// Reason why the end of such a motion differs from the written one.
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

impl Run<'_, '_> {
    /// Refuses what lets the tool turn otherwise than from the orientation of one point to that of the next; `word` is ORI_TYP or CIRC_TYP.
    /// True where the tool keeps the orientation of the first.
    pub(super) fn turns_as_followed(
        &mut self,
        word: &str,
        tokens: &Range<usize>,
        value: &Expression,
    ) -> Result<bool, Reason> {
        let file = self.file();
        let shown = excerpt(file.text(tokens).as_bytes());
        let called = match &value.node {
            Node::Call(name, arguments) if name.is("SORI_TYP") || name.is("SCIRC_TYP") => {
                arguments.first().and_then(|of| of.value.as_ref())
            }
            _ => None,
        };
        let Some(data) = called else {
            let text = file.text(&value.tokens).to_uppercase();
            return is_followed(word, &text, &shown, true);
        };
        let data = self.value(data);
        if let Some(reason) = data.unknown_reason() {
            return Err((reason.to_string(), GIVE_THEM));
        }
        // Data that do not state it have the first of each: #VAR, #BASE.
        let choice = choice_of(&data, word).unwrap_or_else(|| "VAR".to_owned());
        is_followed(word, &choice, &shown, false)
    }

    /// Refuses data of inline forms, which BAS puts in force for the motions behind it, as [`Run::turns_as_followed`] refuses words. True
    /// where they keep the orientation.
    pub(super) fn data_turn_as_followed(
        &mut self,
        tokens: &Range<usize>,
        data: &Datum,
    ) -> Result<bool, Reason> {
        let mut kept = false;
        let shown = excerpt(self.file().text(tokens).as_bytes());
        for word in ["ORI_TYP", "CIRC_TYP"] {
            // Data that are in none of the files say nothing of speed or rounding, either: what needs them says so.
            if let Some(choice) = choice_of(data, word) {
                kept |= is_followed(word, &choice, &shown, false)?;
            }
        }
        Ok(kept)
    }
}

/// A member that is a word of an enumeration, without its `#`, in capitals.
pub(super) fn choice_of(data: &Datum, capitals: &str) -> Option<String> {
    match &data.member(capitals)?.value {
        Value::Text(text) => Some(text.trim_start_matches('#').trim().to_uppercase()),
        _ => None,
    }
}

const GIVE_THEM: &str = "give the .dat file that states these data as well";

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

//! Assignments to system variables that move the tool on its points, or apart from them: refused.

use std::ops::Range;

use crate::error::excerpt;
use crate::interpreter::run::Reason;
use crate::interpreter::token::TokenFile;
use crate::text::name::Name;

/// The tool stands still and the part is in the hand: base and tool change their parts.
pub(crate) const EXTERNAL_TOOL: &str =
    "the tool stands still and the robot holds the part (#TCP), which is not followed";
pub(crate) const TAKE_OUT: &str = "take the motions of such a tool into a program of their own";

/// Frames on which all others stand.
const ROOTS: [&str; 4] = ["$ROBROOT", "$WORLD", "$ERSYSROOT", "$NULLFRAME"];

/// Refuses an assignment of a value to such a variable.
pub(crate) fn moves_no_points(
    file: &TokenFile<'_>,
    name: &Name,
    tokens: &Range<usize>,
    value: &Range<usize>,
) -> Result<(), Reason> {
    let is_watched = |all: &[&str]| all.iter().any(|one| name.is(one));
    if !is_watched(&ROOTS) && !is_watched(&["$IPO_MODE", "$EX_AX_IGNORE", "$TECH"]) {
        return Ok(());
    }
    let shown = || excerpt(file.text(tokens).as_bytes());
    let stated = file.text(value).trim().to_uppercase();
    let says = |word: &str| stated.contains(word);
    if name.is("$IPO_MODE") && !says("#BASE") {
        return match says("#TCP") {
            true => Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT)),
            false => Err((
                format!(
                    "`{}`: whether the robot holds the tool or the part is computed while the program runs",
                    shown()
                ),
                "write $IPO_MODE=#BASE where the robot holds the tool",
            )),
        };
    }
    if is_watched(&ROOTS) {
        return Err((
            format!(
                "`{}`: all points behind it stand elsewhere, which is not followed",
                shown()
            ),
            "leave it as the controller has it, and shift $BASE",
        ));
    }
    if name.is("$EX_AX_IGNORE") && !matches!(stated.as_str(), "0" | "'B0'" | "'B00'" | "'B000000'")
    {
        return Err((
            format!(
                "`{}`: external axes do not go to what the points say",
                shown()
            ),
            "write points with the external axes where they stand",
        ));
    }
    if name.is("$TECH") && !says("#OFF") {
        return Err((
            format!(
                "`{}`: a function of the controller may move the tool beside the program",
                shown()
            ),
            "take the motions with it into a program of their own",
        ));
    }
    Ok(())
}

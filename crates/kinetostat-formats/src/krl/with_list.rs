//! The list of WITH: what is in force for one motion, or for one spline block.

use std::ops::Range;

use crate::error::excerpt;
use crate::interpreter::run::Reason;
use crate::krl::lex::assignment;
use crate::krl::state::Run;

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

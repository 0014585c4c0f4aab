//! What WITH puts in force for one motion, or for one spline block.

use std::ops::Range;

use crate::error::excerpt;
use crate::krl::settings::Setter;
use crate::krl::speed_place::items;
use crate::krl::state::{Settings, State};
use crate::krl::values::{Reason, Values};

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

/// Those that [`Setter::assign`] follows or refuses.
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

/// Takes what the tokens behind WITH put in force.
pub(crate) fn with(
    (values, settings, routine): (&Values<'_>, &mut Settings, usize),
    tokens: &Range<usize>,
    state: &mut State,
) -> Result<(), Reason> {
    let file = values.file(routine);
    for item in items(file, tokens) {
        let name = file.name(item.start);
        let is_one = |all: &[&str]| {
            name.as_ref()
                .is_some_and(|n| all.iter().any(|one| n.is(one)))
        };
        let equals = file.assign(&item);
        match equals {
            Some(equals) if is_one(&FOLLOWED) => {
                let mut setter = Setter {
                    values,
                    settings: &mut *settings,
                    routine,
                };
                setter.assign(&item, equals, state)?;
            }
            Some(_) if is_one(&CARRIED) => {}
            _ => return Err(not_known(&file.text(&item))),
        }
    }
    Ok(())
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

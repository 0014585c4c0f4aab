//! Common parts of `lobes` and `chatter`: the check for damping, modes that are left out, and the name of an instability.

use kinetostat_chatter::{Instability, LeftOut, Swinging};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;
use kinetostat_machining::{Warning, WarningCode};

use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::number;
use crate::vibration::damping::DampingArgs;

/// A ratio to critical damping that is larger than that of any machine.
const GREAT: f64 = 0.5;

/// The law of damping, of the options or else of the model; without damping there is no stable cut, and `who` (a verb in its
/// number) says so.
pub(crate) fn damped(args: &DampingArgs, of_model: &Damping, who: &str) -> Answer<Damping> {
    match args.law(of_model)? {
        Damping::Undamped => Err(ErrorCode::Missing.failure(format!(
                "{who} damping: without it the smallest cut chatters at every speed. Give measured ratios here or in the model ([damping]), or for a first look --damping 0.03"
            ),
        )),
        damping => Ok(damping),
    }
}

/// Damping that no machine has: limits rise with it.
pub(crate) fn implausible(damping: &Damping) -> Option<Warning> {
    let of = match damping {
        Damping::Structural { loss_factor } if *loss_factor >= 1.0 => format!(
            "a loss factor of {loss_factor} damps every mode by {} % of critical",
            number(50.0 * loss_factor, 3)
        ),
        Damping::Ratio(ratio) if *ratio >= GREAT => {
            format!("{} % of critical in every mode", number(100.0 * ratio, 3))
        }
        Damping::Ratios(list) => {
            let great = list.iter().find(|ratio| **ratio >= GREAT)?;
            format!("{} % of critical in a mode", number(100.0 * great, 3))
        }
        _ => return None,
    };
    Some(Warning::new(
        WarningCode::Model,
        format!(
            "damping: {of}, and machines have 1 to 10 %. Limits of depth rise with the damping: these are too large unless it was measured"
        ),
    ))
}

/// A mode that is taken as a spring although it counts, somewhere and at a spindle speed, rpm.
pub(crate) fn left_out_warning(mode: &LeftOut, swinging: Swinging, at: &str, rpm: f64) -> Warning {
    let why = match swinging {
        Swinging::UpTo(hz) => format!(
            "modes up to {} Hz were asked for (--modes-up-to-hz, modes_up_to_hz under [chatter]): leave that out",
            number(hz, 4)
        ),
        _ => format!(
            "at {} rpm it vibrates more often while a tooth cuts than the calculation follows",
            number(rpm, 4)
        ),
    };
    Warning::new(
        WarningCode::ChatterNotJudged,
        format!(
            "{at}: the mode at {} Hz counts by its flexibility at rest alone, and whether the cut chatters with it is not seen. Its peak at the tip across the tool axis is {} % of the largest; {why}",
            number(mode.frequency_hz, 4),
            number(100.0 * mode.share, 2)
        ),
    )
}

/// Name of an instability; empty if there is none.
pub(crate) fn instability(kind: Option<Instability>) -> &'static str {
    match kind {
        None => "",
        Some(Instability::Flip) => "flip",
        Some(_) => "Hopf",
    }
}

//! What `lobes` and `chatter` share: damping that there must be, and how a cut becomes unstable, in a word.

use kinetostat_chatter::Instability;
use kinetostat_dynamics::Damping;

use crate::ui::failure::{Answer, Failure};
use crate::vibration::damping::DampingArgs;

/// The law of damping, of the options or else of the model; without damping there is no stable cut, and `who` (a verb in its
/// number) says so.
pub(crate) fn damped(args: &DampingArgs, of_model: &Damping, who: &str) -> Answer<Damping> {
    match args.law(of_model)? {
        Damping::Undamped => Err(Failure::input(format!(
            "{who} damping: without it the smallest cut chatters at every speed. Give measured ratios here or in the model ([damping]), or for a first look --damping 0.03"
        ))),
        damping => Ok(damping),
    }
}

/// How a cut becomes unstable; empty where it does not.
pub(crate) fn instability(kind: Option<Instability>) -> &'static str {
    match kind {
        None => "",
        Some(Instability::Flip) => "flip",
        Some(_) => "Hopf",
    }
}

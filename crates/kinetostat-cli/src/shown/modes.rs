//! Vibrations of a machine about a state, as the page swings them.

use kinetostat::{Posture, Wrench};
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{Held, ModeKind};
use kinetostat_report::{Placed, Scene};

use crate::shown::answer::{ModeOfState, ModesOfState};
use crate::ui::failure::Answer;
use crate::ui::numbers::number;
use crate::vibration::small_step;
use crate::vibration::subject::refused;

/// Modes that are shown.
const MOST: usize = 6;

pub(crate) fn modes_of(posture: &Posture, wrench: &Wrench) -> Answer<ModesOfState> {
    let machine = VibratingMachine::at(posture, wrench, &Held::nothing()).map_err(refused)?;
    let mechanism = posture.mechanism();
    let modes = machine.modes.modes.iter().take(MOST).map(|mode| {
        let moved = machine.moved_in(posture, mode, small_step(mode));
        let kind = match mode.kind {
            ModeKind::Free => ", free",
            ModeKind::Unstable => ", unstable",
            _ => "",
        };
        ModeOfState {
            frequency_hz: mode.frequency_hz(),
            words: format!("{} Hz{kind}", number(mode.frequency_hz(), 4)),
            moved: Scene::of(mechanism, &Placed::solved(posture, &moved)),
        }
    });
    Ok(ModesOfState {
        modes: modes.collect(),
        from: Scene::of(
            mechanism,
            &Placed::solved(posture, &machine.equilibrium.state),
        ),
    })
}

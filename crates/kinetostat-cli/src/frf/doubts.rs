//! Doubtful responses: allowed, but with little meaning for a machine.

use kinetostat::number::larger;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::Damping;
use kinetostat_machining::{Warning, WarningCode};

use crate::frf::arguments::FrfArgs;
use crate::ui::numbers::number;
use crate::vibration::subject;

/// Checks the damping and the frequencies.
pub(crate) fn of(
    args: &FrfArgs,
    (machine, damping): (&VibratingMachine, &Damping),
    frequencies: &[f64],
) -> Vec<Warning> {
    let mut found = Vec::new();
    if args.modes.is_some() && machine.dynamics.modes_are_coupled_by(damping) {
        found.push("with --modes each mode has its own damping alone, and what couples modes is left out; without --modes the response is solved directly".to_owned());
    }
    if *damping == Damping::Undamped {
        found.push("without damping (--damping 0.03, for one) resonances have no height: peaks are as high as a frequency happens to lie near".to_owned());
    }
    let highest_hz = frequencies.iter().copied().fold(0.0, larger);
    if let Some(fastest_hz) = subject::far_below(machine, highest_hz) {
        found.push(format!(
            "frequencies go up to {} Hz, and the fastest mode of the model has {} Hz: what is said far beyond it says nothing of a real machine; check --frequencies",
            number(highest_hz, 4),
            number(fastest_hz, 4)
        ));
    }
    let warning = |words| Warning::new(WarningCode::Model, words);
    found.into_iter().map(warning).collect()
}

/// Measured modes beside a machine that has no real ones.
pub(crate) fn no_real_modes() -> Warning {
    Warning::new(
        WarningCode::NoPotential,
        "measured modes are compared with modes of the symmetric part of the stiffness: the loads have no potential, and real modes are none of this machine".to_owned(),
    )
}

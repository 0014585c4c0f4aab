//! Complex pairs as modes: what the answer and the drawing show where loads have no potential.

use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{ComplexMode, ComplexModes, Damping, Mode};

use crate::modes::fields::ModeAnswer;
use crate::vibration::pair::{frequency_hz, growth_per_s};

/// The lowest pairs, shapes at the instant at which the tool moves farthest.
pub(crate) fn of_pairs(
    machine: &VibratingMachine,
    found: &ComplexModes,
    damping: &Damping,
) -> Vec<ModeAnswer> {
    let dynamics = &machine.dynamics;
    let judged = !matches!(damping, Damping::Undamped | Damping::Structural { .. });
    let one = |(i, pair): (usize, &ComplexMode)| {
        let [mode, _] = dynamics.shapes_of_pair(pair);
        ModeAnswer {
            number: i + 1,
            kind: mode.kind,
            frequency_hz: frequency_hz(pair),
            growth_per_s: Some(growth_per_s(pair)),
            squared_rad_per_s_2: mode.squared,
            damping_ratio: judged.then(|| pair.damping_ratio()),
            tool_translation_per_sqrt_kg: std::array::from_fn(|k| mode.tool[k]),
            tool_rotation_rad_per_m_sqrt_kg: std::array::from_fn(|k| mode.tool[k + 3]),
            kinetic_energy: dynamics.kinetic_shares_of_pair(pair),
            elastic_energy: dynamics.elastic_shares_of_pair(pair),
        }
    };
    found.modes.iter().enumerate().map(one).collect()
}

/// Their shapes at that instant.
pub(crate) fn seen(machine: &VibratingMachine, found: &ComplexModes) -> Vec<Mode> {
    let first = found.modes.iter().map(|pair| {
        let [first, _] = machine.dynamics.shapes_of_pair(pair);
        first
    });
    first.collect()
}

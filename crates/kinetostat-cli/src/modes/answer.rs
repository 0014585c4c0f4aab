//! The answer of `modes`, stable names with units.

use kinetostat::Posture;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{Damping, DirectionCounts, EnergyShare, ModeKind};
use kinetostat_machining::Warning;
use serde::Serialize;

use crate::modes::arguments::ModesArgs;
use crate::place::query::{PlaceAnswer, PlaceQuery};
use crate::ui::failure::Answer;
use crate::vibration::damping::words;
use crate::vibration::subject::{limits, refused};

#[derive(Serialize)]
pub(crate) struct ModesAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) tool: String,
    pub(crate) place: PlaceAnswer,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    /// Directions of the tool that are held.
    pub(crate) hold: Option<String>,
    /// In words.
    pub(crate) damping: String,
    pub(crate) total_mass_kg: f64,
    /// Whether the equilibrium holds: no unstable mode and no massless instability.
    pub(crate) stable: bool,
    pub(crate) directions: DirectionCounts,
    /// Joints and springs in neutral directions: neither mass nor stiffness.
    pub(crate) neutral: Vec<String>,
    /// How many modes there are; `modes` has the lowest of them.
    pub(crate) mode_count: usize,
    pub(crate) modes: Vec<ModeAnswer>,
    pub(crate) warnings: Vec<Warning>,
}

#[derive(Serialize)]
pub(crate) struct ModeAnswer {
    /// From 1, by ascending squared frequency.
    pub(crate) number: usize,
    pub(crate) kind: ModeKind,
    /// Negative where unstable, zero where free.
    pub(crate) frequency_hz: f64,
    /// Signed square of the angular frequency.
    pub(crate) squared_rad_per_s_2: f64,
    /// Share of critical damping; null without damping, or where it has none.
    pub(crate) damping_ratio: Option<f64>,
    /// Motion of the tool's tip, base axes, of the shape normalised by mass.
    pub(crate) tool_translation_per_sqrt_kg: [f64; 3],
    pub(crate) tool_rotation_rad_per_m_sqrt_kg: [f64; 3],
    /// They add to 1.
    pub(crate) kinetic_energy: Vec<EnergyShare>,
    /// They add to 1, or are 0 where no spring is strained.
    pub(crate) elastic_energy: Vec<EnergyShare>,
}

pub(crate) fn answer(
    args: &ModesArgs,
    query: &PlaceQuery,
    posture: &Posture,
    machine: &VibratingMachine,
    damping: &Damping,
) -> Answer<ModesAnswer> {
    let (dynamics, modes) = (&machine.dynamics, &machine.modes);
    let ratios = ratios(machine, damping)?;
    let list = modes.modes.iter().enumerate().take(args.modes);
    let list = list.map(|(i, mode)| ModeAnswer {
        number: i + 1,
        kind: mode.kind,
        frequency_hz: mode.frequency_hz(),
        squared_rad_per_s_2: mode.squared,
        damping_ratio: ratios.as_ref().and_then(|r| r[i]),
        tool_translation_per_sqrt_kg: std::array::from_fn(|k| mode.tool[k]),
        tool_rotation_rad_per_m_sqrt_kg: std::array::from_fn(|k| mode.tool[k + 3]),
        kinetic_energy: dynamics.kinetic_shares(mode),
        elastic_energy: dynamics.elastic_shares(mode),
    });
    let mut warnings = query.warnings.clone();
    warnings.extend(limits(machine, posture));
    Ok(ModesAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: query.name.clone(),
        model_source: query.source.clone(),
        tool: query.tool_words.clone(),
        place: query.answer(),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        hold: args.hold.clone(),
        damping: words(damping),
        total_mass_kg: dynamics.total_mass(),
        stable: modes.stable(),
        directions: modes.counts,
        neutral: modes.neutral.clone(),
        mode_count: modes.modes.len(),
        modes: list.collect(),
        warnings,
    })
}

/// Damping ratios of the vibrations, by the diagonal of the damping matrix in modal coordinates.
fn ratios(machine: &VibratingMachine, damping: &Damping) -> Answer<Option<Vec<Option<f64>>>> {
    if matches!(damping, Damping::Undamped) {
        return Ok(None);
    }
    let found = machine
        .dynamics
        .damping_ratios(&machine.modes, damping)
        .map_err(refused)?;
    let vibrates = |k: usize| machine.modes.modes[k].kind == ModeKind::Vibration;
    let own = found.into_iter().enumerate();
    Ok(Some(own.map(|(k, z)| vibrates(k).then_some(z)).collect()))
}

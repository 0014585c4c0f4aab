//! Answer of `modes`: real modes, or complex pairs where loads have no potential.

use kinetostat::Posture;
use kinetostat::nalgebra::Complex;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{ComplexModes, Damping, ModeKind, Verdict};

use crate::modes::arguments::ModesArgs;
use crate::modes::doubtful::{bends_coarse_links, bends_lumped_links, overdamped};
use crate::modes::fields::{Circulatory, ComplexAnswer, ModeAnswer, ModesAnswer};
use crate::modes::pairs::{of_pairs, seen};
use crate::place::query::PlaceQuery;
use crate::ui::failure::Answer;
use crate::vibration::damping::words;
use crate::vibration::subject::{limits, refused};

pub(crate) fn answer(
    args: &ModesArgs,
    query: &PlaceQuery,
    posture: &Posture,
    machine: &VibratingMachine,
    damping: &Damping,
) -> Answer<ModesAnswer> {
    let dynamics = &machine.dynamics;
    let complex = machine
        .complex_modes(damping, args.modes)
        .map_err(refused)?;
    let mut warnings = query.warnings.clone();
    warnings.extend(limits(machine, posture));
    let (list, shown, directions) = match &complex {
        None => {
            let ratios = ratios(machine, damping)?;
            let of_model = *damping == query.damping && !query.inputs.is_empty();
            let place = query.damping_line.filter(|_| of_model);
            let place = place.map(|line| (query.source.as_str(), line));
            warnings.extend(overdamped(machine, ratios.as_deref(), place));
            (
                of_modes(args, machine, ratios.as_deref()),
                machine.modes.modes.clone(),
                machine.modes.counts,
            )
        }
        Some(found) => {
            let mut directions = machine.modes.counts;
            directions.unstable = found.growing.len();
            directions.vibrating = found.count - found.growing.len();
            directions.free = 0;
            (
                of_pairs(machine, found, damping),
                seen(machine, found),
                directions,
            )
        }
    };
    let shown = &shown[..shown.len().min(args.modes)];
    warnings.extend(bends_coarse_links(machine, shown));
    warnings.extend(bends_lumped_links(machine, shown));
    let stable = match complex.as_ref().map(|found| &found.verdict) {
        Some(Verdict::NotJudged { .. }) => None,
        _ => Some(machine.stable(complex.as_ref())),
    };
    Ok(ModesAnswer {
        head: query.head(1),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        hold: args.hold.clone(),
        damping: words(damping),
        total_mass_kg: dynamics.total_mass(),
        stable,
        mode_count: complex
            .as_ref()
            .map_or(machine.modes.modes.len(), |found| found.count),
        fastest_growing: (complex.as_ref())
            .and_then(|found| found.growing.first())
            .map(|value| complex_answer(*value)),
        structural: matches!(damping, Damping::Structural { .. }),
        circulatory: complex.as_ref().map(circulatory),
        directions,
        neutral: machine.modes.neutral.clone(),
        modes: list,
        warnings,
    })
}

/// The lowest modes where all loads have a potential.
fn of_modes(
    args: &ModesArgs,
    machine: &VibratingMachine,
    ratios: Option<&[Option<f64>]>,
) -> Vec<ModeAnswer> {
    let dynamics = &machine.dynamics;
    let list = machine.modes.modes.iter().enumerate().take(args.modes);
    list.map(|(i, mode)| ModeAnswer {
        number: i + 1,
        kind: mode.kind,
        frequency_hz: mode.frequency_hz(),
        growth_per_s: None,
        squared_rad_per_s_2: mode.squared,
        damping_ratio: ratios.and_then(|r| r[i]),
        tool_translation_per_sqrt_kg: std::array::from_fn(|k| mode.tool[k]),
        tool_rotation_rad_per_m_sqrt_kg: std::array::from_fn(|k| mode.tool[k + 3]),
        kinetic_energy: dynamics.kinetic_shares(mode),
        elastic_energy: dynamics.elastic_shares(mode),
    })
    .collect()
}

/// Converts the complex modes under loads without a potential.
fn circulatory(found: &ComplexModes) -> Circulatory {
    let values = found.modes.iter().map(|pair| pair.eigenvalue);
    Circulatory {
        verdict: found.verdict.clone(),
        complexity: found.complexity,
        modes: values.map(complex_answer).collect(),
    }
}

fn complex_answer(eigenvalue: Complex<f64>) -> ComplexAnswer {
    ComplexAnswer {
        frequency_hz: eigenvalue.im.abs() / std::f64::consts::TAU,
        growth_per_s: eigenvalue.re,
        damping_ratio: -eigenvalue.re / eigenvalue.norm(),
    }
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

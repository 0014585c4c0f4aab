//! Answer of `modes`: real modes, or complex pairs where loads have no potential.

use kinetostat::Posture;
use kinetostat::nalgebra::Complex;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{
    ComplexMode, ComplexModes, Damping, EnergyShare, Mode, ModeKind, Verdict,
};
use kinetostat_machining::{Warning, WarningCode};

use crate::modes::arguments::ModesArgs;
use crate::modes::fields::{Circulatory, ComplexAnswer, ModeAnswer, ModesAnswer};
use crate::place::query::PlaceQuery;
use crate::ui::failure::Answer;
use crate::vibration::damping::words;
use crate::vibration::pair::{frequency_hz, growth_per_s};
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
            let place = query.model.damping_line().filter(|_| of_model);
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

/// Modes that creep back instead of swinging; `place` is the line of the damping in the model, where it is that.
fn overdamped(
    machine: &VibratingMachine,
    ratios: Option<&[Option<f64>]>,
    place: Option<(&str, usize)>,
) -> Option<Warning> {
    let beyond = |(k, ratio): (usize, &Option<f64>)| Some((k, (*ratio).filter(|z| *z >= 1.0)?));
    let all: Vec<(usize, f64)> = ratios?.iter().enumerate().filter_map(beyond).collect();
    let (k, ratio) = all.first()?;
    let warning = Warning::new(
        WarningCode::Model,
        format!(
            "damped beyond critical: {} (mode {}, {:.4} Hz: {:.0} %). What is damped so does not swing. Check the dampers",
            match all.len() {
                1 => "one mode".to_owned(),
                count => format!("{count} modes, the first"),
            },
            k + 1,
            machine.modes.modes[*k].frequency_hz(),
            100.0 * ratio
        ),
    );
    Some(match place {
        Some((file, line)) => Warning {
            line: Some(line),
            ..warning.of_file(file.to_owned())
        },
        None => warning,
    })
}

/// Modes that are links of one segment which bend by themselves.
fn bends_coarse_links(machine: &VibratingMachine, shown: &[Mode]) -> Option<Warning> {
    let coarse = |name: &String| machine.dynamics.coarse_links().contains(name);
    let modes = mostly_of(machine, shown, coarse, coarse)?;
    Some(Warning::new(
        WarningCode::Model,
        format!(
            "links of one segment bend by themselves in mode {modes}: these frequencies are up to 11 % too high. Write segments = 4 beside the links' length"
        ),
    ))
}

/// Modes in which a link bends under its own mass, which the model puts to its end.
fn bends_lumped_links(machine: &VibratingMachine, shown: &[Mode]) -> Option<Warning> {
    let lumped = machine.dynamics.lumped_links();
    let body = |name: &String| lumped.iter().any(|own| own.body == *name);
    let link = |name: &String| lumped.iter().any(|own| own.link == *name);
    let first = lumped.first()?;
    let modes = mostly_of(machine, shown, body, link)?;
    Some(Warning::new(
        WarningCode::Model,
        format!(
            "links bend under bodies at their ends that are their own masses (such as '{}' behind '{}') in mode {modes}: these frequencies are up to two thirds too low. Give each link density_kg_m3 or mass_kg_per_m in place of its body",
            first.body, first.link
        ),
    ))
}

/// Numbers of the vibrations of which most of the kinetic and most of the elastic energy is in parts of these names.
fn mostly_of(
    machine: &VibratingMachine,
    shown: &[Mode],
    moves: impl Fn(&String) -> bool,
    bends: impl Fn(&String) -> bool,
) -> Option<String> {
    let share_of = |shares: Vec<EnergyShare>, own: &dyn Fn(&String) -> bool| {
        let own = shares.iter().filter(|share| own(&share.name));
        own.map(|share| share.share).sum::<f64>()
    };
    let dynamics = &machine.dynamics;
    let is_theirs = |(_, mode): &(usize, &Mode)| {
        mode.kind == ModeKind::Vibration
            && share_of(dynamics.kinetic_shares(mode), &moves) > 0.5
            && share_of(dynamics.elastic_shares(mode), &bends) > 0.5
    };
    let all = shown.iter().enumerate().filter(is_theirs);
    let numbers: Vec<String> = all.map(|(k, _)| (k + 1).to_string()).collect();
    (!numbers.is_empty()).then(|| numbers.join(", "))
}

/// The lowest pairs, shapes at the instant at which the tool moves farthest.
fn of_pairs(
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
fn seen(machine: &VibratingMachine, found: &ComplexModes) -> Vec<Mode> {
    let first = found.modes.iter().map(|pair| {
        let [first, _] = machine.dynamics.shapes_of_pair(pair);
        first
    });
    first.collect()
}

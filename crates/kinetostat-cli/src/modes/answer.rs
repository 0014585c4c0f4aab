//! The answer of `modes`, stable names with units.

use kinetostat::Posture;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{
    ComplexModes, Damping, DirectionCounts, EnergyShare, LumpedLink, ModeKind, Verdict,
};
use kinetostat_machining::{Warning, WarningCode};
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
    /// Where loads have no potential (a moment that does not turn with the tool): what becomes of a small disturbance.
    pub(crate) circulatory: Option<Circulatory>,
    pub(crate) directions: DirectionCounts,
    /// Joints and springs in neutral directions: neither mass nor stiffness.
    pub(crate) neutral: Vec<String>,
    /// How many modes there are; `modes` has the lowest of them.
    pub(crate) mode_count: usize,
    pub(crate) modes: Vec<ModeAnswer>,
    pub(crate) warnings: Vec<Warning>,
}

/// Complex modes under loads without a potential.
#[derive(Serialize)]
pub(crate) struct Circulatory {
    pub(crate) verdict: Verdict,
    /// Largest share of the imaginary part in a squared frequency without damping.
    pub(crate) complexity: f64,
    pub(crate) modes: Vec<ComplexAnswer>,
}

/// A complex mode: `e^(lambda t)`.
#[derive(Serialize)]
pub(crate) struct ComplexAnswer {
    pub(crate) frequency_hz: f64,
    /// Real part of lambda: positive where it grows.
    pub(crate) growth_per_s: f64,
    /// Share of critical damping, negative where it grows.
    pub(crate) damping_ratio: f64,
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
    warnings.extend(overdamped(machine, ratios.as_deref()));
    warnings.extend(bends_coarse_links(machine, args.modes));
    warnings.extend(bends_lumped_links(machine, args.modes));
    let complex = machine
        .complex_modes(damping, args.modes)
        .map_err(refused)?;
    let stable = machine.stable(complex.as_ref());
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
        stable,
        circulatory: complex.map(circulatory),
        directions: modes.counts,
        neutral: modes.neutral.clone(),
        mode_count: modes.modes.len(),
        modes: list.collect(),
        warnings,
    })
}

/// What loads without a potential make of the modes.
fn circulatory(found: ComplexModes) -> Circulatory {
    Circulatory {
        verdict: found.verdict,
        complexity: found.complexity,
        modes: (found.modes.iter())
            .map(|mode| ComplexAnswer {
                frequency_hz: mode.frequency_hz(),
                growth_per_s: mode.eigenvalue.re,
                damping_ratio: mode.damping_ratio(),
            })
            .collect(),
    }
}

/// Modes that creep back instead of swinging.
fn overdamped(machine: &VibratingMachine, ratios: Option<&[Option<f64>]>) -> Option<Warning> {
    let beyond = |(k, ratio): (usize, &Option<f64>)| Some((k, (*ratio).filter(|z| *z >= 1.0)?));
    let all: Vec<(usize, f64)> = ratios?.iter().enumerate().filter_map(beyond).collect();
    let (k, ratio) = all.first()?;
    Some(Warning::new(
        WarningCode::Model,
        format!(
            "damped beyond critical: {} (mode {}, {:.4} Hz: {:.0} %). What is damped so does not swing, and lobes up to there have no answer. Check the dampers",
            match all.len() {
                1 => "one mode".to_owned(),
                count => format!("{count} modes, the first"),
            },
            k + 1,
            machine.modes.modes[*k].frequency_hz(),
            100.0 * ratio
        ),
    ))
}

/// Modes that are links of one segment which bend by themselves.
fn bends_coarse_links(machine: &VibratingMachine, shown: usize) -> Option<Warning> {
    let coarse = machine.dynamics.coarse_links();
    let most_is_theirs = |shares: &[EnergyShare]| {
        let own = shares.iter().filter(|s| coarse.contains(&s.name));
        own.map(|s| s.share).sum::<f64>() > 0.5
    };
    let modes = machine.modes.modes.iter().enumerate().take(shown);
    let bending: Vec<String> = modes
        .filter(|(_, mode)| {
            mode.kind == ModeKind::Vibration
                && most_is_theirs(&machine.dynamics.kinetic_shares(mode))
                && most_is_theirs(&machine.dynamics.elastic_shares(mode))
        })
        .map(|(k, _)| (k + 1).to_string())
        .collect();
    (!bending.is_empty()).then(|| {
        Warning::new(
            WarningCode::Model,
            format!(
                "links of one segment bend by themselves in mode {}: these frequencies are up to 11 % too high. Write segments = 4 beside the links' length",
                bending.join(", ")
            ),
        )
    })
}

/// Modes in which a link bends under its own mass, which the model puts to its end.
fn bends_lumped_links(machine: &VibratingMachine, shown: usize) -> Option<Warning> {
    let dynamics = &machine.dynamics;
    let most_is_theirs = |shares: &[EnergyShare], name: fn(&LumpedLink) -> &str| {
        let is_theirs = |share: &&EnergyShare| {
            let mut all = dynamics.lumped_links().iter();
            all.any(|lumped| name(lumped) == share.name)
        };
        shares.iter().filter(is_theirs).map(|s| s.share).sum::<f64>() > 0.5
    };
    let modes = machine.modes.modes.iter().enumerate().take(shown);
    let bending: Vec<String> = modes
        .filter(|(_, mode)| {
            mode.kind == ModeKind::Vibration
                && most_is_theirs(&dynamics.kinetic_shares(mode), |lumped| &lumped.body)
                && most_is_theirs(&dynamics.elastic_shares(mode), |lumped| &lumped.link)
        })
        .map(|(k, _)| (k + 1).to_string())
        .collect();
    let first = dynamics.lumped_links().first()?;
    (!bending.is_empty()).then(|| {
        Warning::new(
            WarningCode::Model,
            format!(
                "links bend under bodies at their ends that are their own masses (such as '{}' behind '{}') in mode {}: these frequencies are up to two thirds too low. Give each link density_kg_m3 or mass_kg_per_m in place of its body",
                first.body,
                first.link,
                bending.join(", ")
            ),
        )
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

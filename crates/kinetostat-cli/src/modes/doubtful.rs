//! Modes whose frequency or damping is not what it seems.

use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{EnergyShare, LumpedLink, Mode, ModeKind};
use kinetostat_machining::{Warning, WarningCode};

/// Modes that creep back instead of swinging; `place` is the line of the damping in the model, where it is that.
pub(crate) fn overdamped(
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
            "damped beyond critical: {} (mode {}, {:.4} Hz: {:.0} %). What is damped so does not swing, and lobes up to there have no answer. Check the dampers",
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
pub(crate) fn bends_coarse_links(machine: &VibratingMachine, shown: &[Mode]) -> Option<Warning> {
    let coarse = machine.dynamics.coarse_links();
    let most_is_theirs = |shares: &[EnergyShare]| {
        let own = shares.iter().filter(|s| coarse.contains(&s.name));
        own.map(|s| s.share).sum::<f64>() > 0.5
    };
    let modes = shown.iter().enumerate();
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
pub(crate) fn bends_lumped_links(machine: &VibratingMachine, shown: &[Mode]) -> Option<Warning> {
    let dynamics = &machine.dynamics;
    let most_is_theirs = |shares: &[EnergyShare], name: fn(&LumpedLink) -> &str| {
        let is_theirs = |share: &&EnergyShare| {
            let mut all = dynamics.lumped_links().iter();
            all.any(|lumped| name(lumped) == share.name)
        };
        shares
            .iter()
            .filter(is_theirs)
            .map(|s| s.share)
            .sum::<f64>()
            > 0.5
    };
    let modes = shown.iter().enumerate();
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

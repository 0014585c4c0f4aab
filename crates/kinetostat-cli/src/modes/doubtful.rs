//! Modes whose frequency or damping is not what it seems.

use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{EnergyShare, Mode, ModeKind};
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
pub(crate) fn bends_coarse_links(machine: &VibratingMachine, shown: &[Mode]) -> Option<Warning> {
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
pub(crate) fn bends_lumped_links(machine: &VibratingMachine, shown: &[Mode]) -> Option<Warning> {
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

//! The numbers of a law of damping by name, to be scaled.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;

use crate::ui::failure::{Answer, Failing};

/// A number of a law.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DampingNumber {
    /// Name, as in `damping.ratio`.
    pub(crate) path: String,
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
}

/// Beginning of the names of all of them.
const DAMPING: &str = "damping.";

/// True if a name is that of a number of damping, and of no part of the machine.
pub(crate) fn is_of_damping(path: &str) -> bool {
    path.starts_with(DAMPING)
}

/// All numbers of a law.
pub(crate) fn numbers(law: &Damping) -> Vec<DampingNumber> {
    let one = |name: &str, unit, value| DampingNumber {
        path: format!("{DAMPING}{name}"),
        unit,
        value,
    };
    match law {
        Damping::Undamped => Vec::new(),
        Damping::Ratio(ratio) => vec![one("ratio", "", *ratio)],
        Damping::Ratios(list) => (list.iter().enumerate())
            .map(|(k, ratio)| one(&format!("ratios.{}", k + 1), "", *ratio))
            .collect(),
        Damping::Rayleigh {
            mass_per_s,
            stiffness_s,
        } => vec![
            one("rayleigh.mass_per_s", "1/s", *mass_per_s),
            one("rayleigh.stiffness_s", "s", *stiffness_s),
        ],
        Damping::Structural { loss_factor } => vec![one("loss_factor", "", *loss_factor)],
        Damping::Viscous(list) => (list.iter())
            .map(|(name, c)| one(&format!("viscous.{name}"), "N s/m or N m s/rad", *c))
            .collect(),
    }
}

/// The number of that name.
pub(crate) fn named(law: &Damping, path: &str) -> Answer<DampingNumber> {
    let all = numbers(law);
    let known: Vec<String> = all.iter().map(|own| own.path.clone()).collect();
    let found = all.into_iter().find(|own| own.path == path);
    found.ok_or_else(|| {
        ErrorCode::UnknownName.failure(match known.is_empty() {
            true => format!(
                "--scale {path}: there is no damping to scale; give a first value, as with --damping 0.03"
            ),
            false => format!(
                "--scale {path}: the law of damping has no such number; it has {}",
                known.join(", ")
            ),
        })
    })
}

/// The law with another number of that name.
pub(crate) fn with(law: &Damping, path: &str, value: f64) -> Damping {
    let mut law = law.clone();
    let names: Vec<String> = numbers(&law).into_iter().map(|own| own.path).collect();
    let Some(at) = names.iter().position(|name| name == path) else {
        return law;
    };
    match &mut law {
        Damping::Ratio(own) | Damping::Structural { loss_factor: own } => *own = value,
        Damping::Ratios(list) => list[at] = value,
        Damping::Rayleigh {
            mass_per_s,
            stiffness_s,
        } => *(if at == 0 { mass_per_s } else { stiffness_s }) = value,
        Damping::Viscous(list) => list[at].1 = value,
        Damping::Undamped => {}
    }
    law
}

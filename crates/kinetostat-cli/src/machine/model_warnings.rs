//! Warnings about a model: faults, effects that cannot be assessed, and deviations.

use kinetostat::Mechanism;
use kinetostat_machining::{Warning, WarningCode};
use kinetostat_model::Model;

use crate::ui::failure::Failure;

/// A run that has no answer, with what is implausible in its model: that is most likely why.
pub(crate) fn with_model_warning(failure: Failure, model: &Model) -> Failure {
    let mut warnings = of_model(model);
    match warnings.next() {
        Some(first) => {
            let more = match warnings.count() {
                0 => String::new(),
                _ => "; `kinetostat check` says what else looks wrong".to_owned(),
            };
            failure.with_reason(&format!("{first}{more}"))
        }
        None => failure,
    }
}

/// Warnings about a model, for the list of a run.
pub(crate) fn of_model(model: &Model) -> impl Iterator<Item = Warning> + '_ {
    model.warnings.iter().map(|problem| Warning {
        line: problem.line,
        ..Warning::new(
            WarningCode::Model,
            match problem.help.as_str() {
                "" => problem.message.clone(),
                help => format!("{}; {help}", problem.message),
            },
        )
        .of_file(problem.file.clone())
    })
}

/// Reports the limits of the assessment under loads on limbs without a potential: for answers that do not state it
/// at every place.
pub(crate) fn no_potential(mechanism: &Mechanism) -> Option<Warning> {
    let limbs = mechanism.limbs().iter().enumerate();
    let names: Vec<String> = limbs
        .filter(|(i, _)| !mechanism.loads_conservative(*i))
        .map(|(_, limb)| format!("'{}'", limb.name))
        .collect();
    (!names.is_empty()).then(|| {
        Warning::new(
            WarningCode::NoPotential,
            format!(
                "loads on limb {} follow the machine and have no potential: 'stable' means that nothing diverges; whether it swings with growing amplitude (flutter) depends on the masses, which are not asked for here",
                names.join(", ")
            ),
        )
    })
}

/// The deviations of a model, one sentence each.
pub(crate) fn deviation_descriptions(model: &Model) -> Vec<String> {
    let list = model.document.deviation.iter();
    list.map(kinetostat_model::schema::Deviation::description)
        .collect()
}

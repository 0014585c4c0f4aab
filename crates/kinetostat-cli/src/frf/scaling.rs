//! Numbers of the model scaled to measured modes.

use std::path::Path;

use kinetostat::number::larger;
use kinetostat_analysis::vibration::{MeasuredModes, VibratingMachine};
use kinetostat_chatter::{ChatterError, Parameter, Scaled};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::{Damping, Held};
use kinetostat_machining::straight_tool;
use kinetostat_model::ParametricModel;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::input_files::InputFiles;
use crate::frf::arguments::FrfArgs;
use crate::frf::measured::of_measurement;
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::vibration::damping_numbers::{DampingNumber, is_of_damping, named, with};
use crate::vibration::subject;

/// Numbers of the model that were scaled.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ScaledAnswer {
    pub(crate) parameters: Vec<ScaledParameter>,
    /// Factors that change no measured frequency by as much as it is known, in words.
    pub(crate) not_told: Vec<String>,
    /// Frequencies of the scaled model beside the measured ones.
    pub(crate) frequencies_hz: Vec<f64>,
    /// Damping ratios of the scaled model beside the measured ones, where damping was scaled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) damping_ratios: Option<Vec<f64>>,
    pub(crate) evaluations: usize,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ScaledParameter {
    pub(crate) path: String,
    pub(crate) unit: &'static str,
    pub(crate) before: f64,
    pub(crate) value: f64,
    /// Standard deviation as a share of the value; null where the measurement does not tell it, or a bound holds it.
    pub(crate) deviation: Option<f64>,
    pub(crate) at_bound: bool,
}

/// A fit that leaves more of a curve found no modes in it.
const NO_MODES: f64 = 0.5;

/// Scales the numbers that are asked for until the model has the measured frequencies, and damping ratios where damping is scaled.
pub(crate) fn scaled(
    args: &FrfArgs,
    query: &PlaceQuery,
    law: &Damping,
    measured: &MeasuredModes,
) -> Answer<ScaledAnswer> {
    check_options(args)?;
    let (known, damping_known) = (args.frequencies_known_to, args.damping_known_to);
    let held = subject::held(args.hold.as_deref())?;
    let model = parametric(args)?;
    // Numbers of the machine first, then those of its damping.
    let of_machine = model.parameters().iter();
    let mut before: Vec<DampingNumber> = of_machine
        .map(|own| DampingNumber {
            path: own.path.clone(),
            unit: own.unit,
            value: own.value,
        })
        .collect();
    let machine_count = before.len();
    for path in args.scale.iter().filter(|path| is_of_damping(path)) {
        before.push(named(law, path)?);
    }
    let parameters = within_bounds(&before, args.scale_within)?;
    let left = measured.fit.misfit.iter().copied().fold(0.0, larger);
    if left.is_nan() || left > NO_MODES {
        return Err(ErrorCode::NoMatch.failure(format!(
                "--scale: the fit leaves {:.0} % of a measured curve: these are no modes that a model could be scaled to. Ask for more modes or a narrower band, or measure again",
                100.0 * left
            ),
        ));
    }
    let of_damping = before.len() > machine_count;
    let machine_of = |values: &[f64]| -> Result<(VibratingMachine, Option<Vec<f64>>), Lost> {
        let (of_machine, rest) = values.split_at(machine_count);
        let machine = machine_of(args, query, &model, of_machine, &held)?;
        let ratios = of_damping.then(|| {
            let numbers = before[machine_count..].iter().zip(rest);
            let law = numbers.fold(law.clone(), |law, (own, value)| {
                with(&law, &own.path, *value)
            });
            let ratios = machine.dynamics.damping_ratios(&machine.modes, &law);
            ratios.map_err(subject::refused)
        });
        Ok((machine, ratios.transpose()?))
    };
    let found = measured
        .scaled(
            &parameters,
            known,
            of_damping.then_some(damping_known),
            machine_of,
        )
        .map_err(|Lost(failure)| failure)?;
    let modes = &measured.fit.modes;
    let ratios = modes.iter().zip(&found.left[modes.len()..]);
    Ok(ScaledAnswer {
        not_told: not_told(&parameters, &found),
        frequencies_hz: (modes.iter().zip(&found.left))
            .map(|(mode, left)| mode.frequency_hz * (1.0 + known * left))
            .collect(),
        damping_ratios: of_damping.then(|| {
            ratios
                .map(|(mode, left)| mode.damping_ratio * (1.0 + damping_known * left))
                .collect()
        }),
        evaluations: found.evaluations,
        parameters: (before.into_iter().enumerate())
            .map(|(k, own)| ScaledParameter {
                path: own.path,
                unit: own.unit,
                before: own.value,
                value: found.values[k],
                deviation: found.deviations[k],
                at_bound: found.at_bound[k],
            })
            .collect(),
    })
}

/// Refuses factors and shares that say nothing.
fn check_options(args: &FrfArgs) -> Answer<()> {
    let within = args.scale_within;
    if !(within > 1.0 && within <= 1e3) {
        return Err(ErrorCode::Value.failure(format!(
            "--scale-within is {within}; a factor above 1 and of at most 1000 is needed"
        )));
    }
    let known = args.frequencies_known_to;
    if !(known > 0.0 && known < 1.0) {
        return Err(ErrorCode::Value.failure(format!(
            "--frequencies-known-to is {known}; a share between 0 and 1 is needed (0.01 is 1 %)"
        )));
    }
    let damping_known = args.damping_known_to;
    if !(damping_known > 0.0 && damping_known < 1.0) {
        return Err(ErrorCode::Value.failure(format!(
            "--damping-known-to is {damping_known}; a share between 0 and 1 is needed (0.2 is 20 %)"
        )));
    }
    Ok(())
}

/// The numbers with their bounds: within a factor of what they are.
fn within_bounds(before: &[DampingNumber], within: f64) -> Answer<Vec<Parameter>> {
    let bounded = |own: &DampingNumber| {
        if own.value <= 0.0 || own.value.is_nan() {
            return Err(ErrorCode::Value.failure(format!(
                "--scale {}: it is {}, and numbers above zero are scaled",
                own.path, own.value
            )));
        }
        Ok(Parameter {
            name: own.path.clone(),
            start: own.value,
            least: own.value / within,
            most: own.value * within,
        })
    };
    before.iter().map(bounded).collect()
}

fn parametric(args: &FrfArgs) -> Answer<ParametricModel> {
    let (model, _) = InputFiles::default().model(&args.machine.model, Path::new(""))?;
    let paths: Vec<&str> = (args.scale.iter().map(String::as_str))
        .filter(|path| !is_of_damping(path))
        .collect();
    Ok(model.parametric(&paths)?)
}

/// The machine with other numbers where it is asked for.
fn machine_of(
    args: &FrfArgs,
    query: &PlaceQuery,
    model: &ParametricModel,
    values: &[f64],
    held: &Held,
) -> Result<VibratingMachine, Lost> {
    let tool = straight_tool(1e-3 * args.machine.tool_length_mm.unwrap_or(0.0));
    let mechanism = model
        .mechanism(values)
        .map_err(Failure::from)?
        .with_tool(&tool);
    let posture = query.standing_in(&mechanism).map_err(Failure::from)?;
    Ok(subject::machine(query, &posture, held)?)
}

/// Reason for which scaling has no answer.
struct Lost(Failure);

impl From<Failure> for Lost {
    fn from(failure: Failure) -> Self {
        Self(failure)
    }
}

impl From<ChatterError> for Lost {
    fn from(error: ChatterError) -> Self {
        Self(of_measurement(error))
    }
}

/// Combinations of factors that the measurement does not tell, in words.
fn not_told(parameters: &[Parameter], found: &Scaled) -> Vec<String> {
    let words = |direction: &Vec<f64>| {
        let largest = direction.iter().map(|x| x.abs()).fold(0.0, larger);
        let parts = parameters.iter().zip(direction);
        let parts: Vec<String> = parts
            .filter(|(_, share)| share.abs() > 0.1 * largest)
            .map(|(parameter, share)| match *share > 0.0 {
                true => format!("'{}' up", parameter.name),
                false => format!("'{}' down", parameter.name),
            })
            .collect();
        parts.join(" with ")
    };
    found.untold.iter().map(words).collect()
}

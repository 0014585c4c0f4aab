//! Modes of measured responses beside those of the model, and numbers of the model scaled to them.

use std::path::Path;

use kinetostat::number::larger;
use kinetostat_analysis::vibration::{MeasuredModes, VibratingMachine};
use kinetostat_chatter::{ChatterError, MeasuredResponse, Parameter, Scaled};
use kinetostat_dynamics::{Damping, Held};
use kinetostat_machining::straight_tool;
use kinetostat_model::ParametricModel;
use serde::Serialize;

use crate::files::input_files::InputFiles;
use crate::frf::arguments::FrfArgs;
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failure};
use crate::vibration::damping_numbers::{DampingNumber, is_of_damping, named, with};
use crate::vibration::subject;

/// Modes that were measured.
#[derive(Serialize)]
pub(crate) struct FitAnswer {
    /// Curves that were fitted: those by the force of the first.
    pub(crate) curves: Vec<String>,
    /// What the fit leaves of each, as a share.
    pub(crate) misfit: Vec<f64>,
    pub(crate) modes: Vec<MeasuredMode>,
    /// Frequencies of poles that are no vibrations in the band.
    pub(crate) left_out_hz: Vec<f64>,
    /// With one curve shapes cannot be compared.
    pub(crate) shapes_compared: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scaled: Option<ScaledAnswer>,
    /// What amplitudes and signs say against the measurement.
    #[serde(skip)]
    pub(crate) doubts: Vec<String>,
}

/// A measured mode with that of the model which it resembles most.
#[derive(Serialize)]
pub(crate) struct MeasuredMode {
    pub(crate) frequency_hz: f64,
    pub(crate) damping_ratio: f64,
    /// Number of the model's, from 1.
    pub(crate) model_mode: Option<usize>,
    pub(crate) model_frequency_hz: Option<f64>,
    pub(crate) model_damping_ratio: Option<f64>,
    /// Modal assurance criterion of both shapes along the measured directions.
    pub(crate) modal_assurance: Option<f64>,
    /// How many times as large as the model's the measured response of the mode is: 1 where masses and units are right,
    /// negative where a sign is wrong. Null where the force is at another place.
    pub(crate) amplitude_by_model: Option<f64>,
}

/// Numbers of the model that were scaled.
#[derive(Serialize)]
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

#[derive(Serialize)]
pub(crate) struct ScaledParameter {
    pub(crate) path: String,
    pub(crate) unit: &'static str,
    pub(crate) before: f64,
    pub(crate) value: f64,
    /// Standard deviation as a share of the value; null where the measurement does not tell it, or a bound holds it.
    pub(crate) deviation: Option<f64>,
    pub(crate) at_bound: bool,
}

pub(crate) fn answer(
    args: &FrfArgs,
    modes: usize,
    (query, machine, damping): (&PlaceQuery, &VibratingMachine, &Damping),
    responses: &[MeasuredResponse],
) -> Answer<FitAnswer> {
    let band = (args.frequencies[0], args.frequencies[1]);
    let axes: Vec<usize> = args.from.iter().map(|axis| *axis as usize).collect();
    let measured = MeasuredModes::fitted(responses, &axes, modes, band).map_err(of_measurement)?;
    let ratios = match damping {
        Damping::Undamped => None,
        law => {
            let ratios = machine.dynamics.damping_ratios(&machine.modes, law);
            Some(ratios.map_err(subject::refused)?)
        }
    };
    let shown = measured.shown(machine, ratios.as_deref());
    let pairs = measured.beside(&shown).map_err(of_measurement)?;
    let compared = measured.curves.len() > 1;
    let amplitudes = measured.amplitudes(&shown, &pairs);
    let against = measured.against_its_force().map(|curve| {
        format!(
            "the curve '{curve}' moves against its own force at rest, which no machine does: the sign of a sensor, of the hammer or of an axis is wrong"
        )
    });
    if let (Some(words), false) = (&against, args.scale.is_empty()) {
        return Err(Failure::input(format!(
            "--scale: {words}. Turn it round, and measure again if you do not know which"
        )));
    }
    let beside = |(i, mode): (usize, &kinetostat_chatter::FittedMode)| {
        let at = pairs.iter().position(|pair| pair.measured == i);
        let pair = at.map(|at| &pairs[at]);
        let model = pair.map(|pair| &shown.modes[pair.model]);
        MeasuredMode {
            frequency_hz: mode.frequency_hz,
            damping_ratio: mode.damping_ratio,
            model_mode: pair.map(|pair| shown.numbers[pair.model] + 1),
            model_frequency_hz: model.map(|model| model.frequency_hz),
            model_damping_ratio: model
                .filter(|_| ratios.is_some())
                .map(|model| model.damping_ratio),
            modal_assurance: pair.filter(|_| compared).map(|pair| pair.assurance),
            amplitude_by_model: at.and_then(|at| amplitudes[at]),
        }
    };
    let all: Vec<MeasuredMode> = measured.fit.modes.iter().enumerate().map(beside).collect();
    if let (Some(lone), false) = (
        all.iter().find(|mode| mode.model_mode.is_none()),
        args.scale.is_empty(),
    ) {
        return Err(Failure::input(format!(
            "--scale: the measured mode at {:.2} Hz resembles none of the model's (within a factor of 1.5 of its frequency): nothing is scaled to it. Look at `kinetostat modes`, or ask for fewer modes or a narrower band",
            lone.frequency_hz
        )));
    }
    let mut doubts: Vec<String> = against.into_iter().collect();
    doubts.extend(odd_amplitude(&all, doubts.is_empty()));
    doubts.extend(by_other_forces(&measured));
    Ok(FitAnswer {
        doubts,
        curves: measured.curves.clone(),
        misfit: measured.fit.misfit.clone(),
        modes: all,
        left_out_hz: measured.fit.left_out_hz.clone(),
        shapes_compared: compared,
        scaled: match args.scale.is_empty() {
            true => None,
            false => Some(scaled(args, (query, damping), &measured)?),
        },
    })
}

/// What is said of measured curves that are not fitted.
fn by_other_forces(measured: &MeasuredModes) -> Option<String> {
    let (own, others) = (&measured.curves, &measured.others);
    let (first, other) = (own.first()?, others.first()?);
    Some(format!(
        "{} of {} measured curves are by other forces than that of '{first}' ('{other}' for one) and are not fitted: --from names the axis of the force whose curves are",
        others.len(),
        own.len() + others.len()
    ))
}

/// Measured amplitudes beyond this factor of the model's are no matter of masses.
const APART: f64 = 3.0;

/// What the middle one of the modes' amplitudes says, beside modes of the model that they resemble.
fn odd_amplitude(modes: &[MeasuredMode], signs_are_right: bool) -> Option<String> {
    let alike = |mode: &&MeasuredMode| mode.modal_assurance.is_none_or(|mac| mac > 0.5);
    let mut own: Vec<f64> = (modes.iter().filter(alike))
        .filter_map(|mode| mode.amplitude_by_model)
        .collect();
    own.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let middle = *own.get(own.len() / 2)?;
    let size = middle.abs();
    if !(1.0 / APART..=APART).contains(&size) {
        return Some(format!(
            "measured amplitudes are {} times those of the model: check the units of the measurement (um or mm taken for m are 1e-6 and 1e-3, g for m/s^2 are 9.81), and the masses of the model",
            kinetostat::number::short(size)
        ));
    }
    (middle < 0.0 && signs_are_right).then(|| {
        "measured modes move against those of the model: the sign of a sensor, of the hammer or of an axis is wrong".to_owned()
    })
}

/// A fit that leaves more of a curve found no modes in it.
const NO_MODES: f64 = 0.5;

fn scaled(
    args: &FrfArgs,
    (query, law): (&PlaceQuery, &Damping),
    measured: &MeasuredModes,
) -> Answer<ScaledAnswer> {
    let within = args.scale_within;
    if !(within > 1.0 && within <= 1e3) {
        return Err(Failure::input(format!(
            "--scale-within is {within}; a factor above 1 and of at most 1000 is needed"
        )));
    }
    let known = args.frequencies_known_to;
    if !(known > 0.0 && known < 1.0) {
        return Err(Failure::input(format!(
            "--frequencies-known-to is {known}; a share between 0 and 1 is needed (0.01 is 1 %)"
        )));
    }
    let damping_known = args.damping_known_to;
    if !(damping_known > 0.0 && damping_known < 1.0) {
        return Err(Failure::input(format!(
            "--damping-known-to is {damping_known}; a share between 0 and 1 is needed (0.2 is 20 %)"
        )));
    }
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
    let mut parameters = Vec::new();
    for own in &before {
        if own.value <= 0.0 || own.value.is_nan() {
            return Err(Failure::input(format!(
                "--scale {}: it is {}, and numbers above zero are scaled",
                own.path, own.value
            )));
        }
        parameters.push(Parameter {
            name: own.path.clone(),
            start: own.value,
            least: own.value / within,
            most: own.value * within,
        });
    }
    let left = measured.fit.misfit.iter().copied().fold(0.0, larger);
    if left.is_nan() || left > NO_MODES {
        return Err(Failure::input(format!(
            "--scale: the fit leaves {:.0} % of a measured curve: these are no modes that a model could be scaled to. Ask for more modes or a narrower band, or measure again",
            100.0 * left
        )));
    }
    let of_damping = before.len() > machine_count;
    let machine_of = |values: &[f64]| -> Result<(VibratingMachine, Option<Vec<f64>>), Lost> {
        let (of_machine, rest) = values.split_at(machine_count);
        let machine = machine_of(args, query, &model, (of_machine, &held))?;
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
    (values, held): (&[f64], &Held),
) -> Result<VibratingMachine, Lost> {
    let tool = straight_tool(1e-3 * args.machine.tool_length_mm.unwrap_or(0.0));
    let mechanism = model
        .mechanism(values)
        .map_err(Failure::from)?
        .with_tool(&tool);
    let posture = query.standing_in(&mechanism).map_err(Failure::from)?;
    Ok(subject::machine(query, &posture, held)?)
}

/// Why scaling has no answer.
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

fn of_measurement(error: ChatterError) -> Failure {
    Failure::input(format!("measured responses: {error}"))
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

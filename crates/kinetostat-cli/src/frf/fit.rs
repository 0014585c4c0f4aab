//! Modes of measured responses beside those of the model.

use kinetostat_analysis::vibration::{MeasuredModes, VibratingMachine};
use kinetostat_chatter::MeasuredResponse;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;
use schemars::JsonSchema;
use serde::Serialize;

use crate::frf::arguments::FrfArgs;
use crate::frf::measured::of_measurement;
use crate::frf::scaling::{ScaledAnswer, scaled};
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failing};
use crate::vibration::subject;

/// Modes that were measured.
#[derive(Serialize, JsonSchema)]
pub(crate) struct FitAnswer {
    /// Curves that were fitted: those by the force of the first.
    pub(crate) curves: Vec<String>,
    /// Misfit of each, as a share.
    pub(crate) misfit: Vec<f64>,
    pub(crate) modes: Vec<MeasuredMode>,
    /// Frequencies of poles that are no vibrations in the band.
    pub(crate) left_out_hz: Vec<f64>,
    /// True if shapes are compared: one curve does not allow it.
    pub(crate) shapes_compared: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scaled: Option<ScaledAnswer>,
    /// Objections to the measurement from amplitudes and signs.
    #[serde(skip)]
    pub(crate) doubts: Vec<String>,
}

/// A measured mode with that of the model which it resembles most.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MeasuredMode {
    pub(crate) frequency_hz: f64,
    pub(crate) damping_ratio: f64,
    /// Number of the model's, from 1.
    pub(crate) model_mode: Option<usize>,
    pub(crate) model_frequency_hz: Option<f64>,
    pub(crate) model_damping_ratio: Option<f64>,
    /// Modal assurance criterion of both shapes along the measured directions.
    pub(crate) modal_assurance: Option<f64>,
    /// Ratio of the measured response of the mode to the model's: 1 where masses and units are right, negative where a
    /// sign is wrong. Null where the force is at another place.
    pub(crate) amplitude_by_model: Option<f64>,
}

/// Modes of measured responses beside those of the model, and the model scaled to them where that is asked for.
pub(crate) fn answer(
    args: &FrfArgs,
    modes: usize,
    query: &PlaceQuery,
    machine: &VibratingMachine,
    damping: &Damping,
    responses: &[MeasuredResponse],
) -> Answer<FitAnswer> {
    let band = [args.frequencies[0], args.frequencies[1]];
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
        return Err(ErrorCode::FileForm.failure(format!(
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
        return Err(ErrorCode::NoMatch.failure(format!(
                "--scale: the measured mode at {:.2} Hz resembles none of the model's (within a factor of 1.5 of its frequency): nothing is scaled to it. Look at `kinetostat modes`, or ask for fewer modes or a narrower band",
                lone.frequency_hz
            ),
        ));
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
            false => Some(scaled(args, query, damping, &measured)?),
        },
    })
}

/// Message about measured curves that are not fitted.
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

/// Objection from the median amplitude ratio of the modes that resemble modes of the model.
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

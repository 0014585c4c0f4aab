//! How the tool's tip answers to a vibrating force, and at which speeds and depths a cut chatters, in a state.

use kinetostat::{Posture, Wrench};
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::{Damping, Held};

use crate::lobes::answer::{Best, points};
use crate::lobes::arguments::LobeCutArgs;
use crate::shown::answer::{LobesOfState, LobesRequest, ResponseOfState, ResponseRequest};
use crate::ui::failure::{Answer, Failing};
use crate::vibration::damping::{DampingArgs, words};
use crate::vibration::stability::damped;
use crate::vibration::subject::{limits, refused};

/// Frequencies and spindle speeds of one request.
const MOST: usize = 2000;

/// A ratio of all modes as the options state it; without one the model's damping counts.
fn stated(ratio: Option<f64>) -> DampingArgs {
    DampingArgs {
        damping: ratio.into_iter().collect(),
        ..DampingArgs::default()
    }
}

/// Displacement of the tip by a vibrating force along the same axis.
pub(crate) fn response_of(
    posture: &Posture,
    wrench: &Wrench,
    of_model: &Damping,
    request: &ResponseRequest,
) -> Answer<ResponseOfState> {
    let [low, high] = request.frequencies_hz;
    let rise = low >= 0.0 && high > low && high <= 1e6;
    if !(rise && (2..=MOST).contains(&request.count)) {
        return Err(ErrorCode::Value.failure(format!(
            "frequencies rise from 0 to at most 1e6 Hz, 2 to {MOST} of them"
        )));
    }
    let damping = stated(request.damping_ratio).law(of_model)?;
    let machine = VibratingMachine::at(posture, wrench, &Held::nothing()).map_err(refused)?;
    let step = (high - low) / (request.count - 1) as f64;
    let frequencies_hz: Vec<f64> = (0..request.count).map(|i| low + step * i as f64).collect();
    let response = machine.tool_receptance(&damping, None).map_err(refused)?;
    let receptance = response.over(&frequencies_hz).map_err(refused)?;
    let um_per_n = [0, 1, 2].map(|axis| {
        let each = receptance.iter().map(|m| 1e6 * m[(axis, axis)].norm());
        each.collect::<Vec<f64>>()
    });
    if !um_per_n.iter().flatten().all(|x| x.is_finite()) {
        return Err(ErrorCode::FreeDirection.failure(
            "the tool has no finite response: a direction is free here, or a mode without damping",
        ));
    }
    Ok(ResponseOfState {
        um_per_n,
        frequencies_hz,
        natural_frequencies_hz: machine.modes.frequencies_hz(),
        damping: words(&damping),
        warnings: (limits(&machine, posture).into_iter())
            .map(|w| w.message)
            .collect(),
    })
}

/// Limits of a milling cut over the spindle speed.
pub(crate) fn lobes_of(
    posture: &Posture,
    wrench: &Wrench,
    of_model: &Damping,
    request: &LobesRequest,
) -> Answer<LobesOfState> {
    if request.speeds > MOST {
        return Err(ErrorCode::Value.failure(format!("at most {MOST} speeds at once")));
    }
    let args = LobeCutArgs {
        rpm: vec![
            request.speed_rpm[0],
            request.speed_rpm[1],
            request.speeds as f64,
        ],
        depth_mm: request.depth_mm,
        coefficients_n_per_mm2: request.coefficients_n_per_mm2.to_vec(),
        immersion: request.immersion,
        up: request.up,
        feed_direction: request.feed_direction.to_vec(),
        teeth: request.teeth,
        ..LobeCutArgs::default()
    };
    let damping = damped(&stated(request.damping_ratio), of_model, "lobes need")?;
    let machine = VibratingMachine::at(posture, wrench, &Held::nothing()).map_err(refused)?;
    let lobes = args.lobes(posture.target(), &machine, &damping)?;
    let mut warnings = limits(&machine, posture);
    warnings.extend(lobes.warnings);
    Ok(LobesOfState {
        points: points(&lobes.diagram),
        best: Best::of(&lobes.diagram),
        damping: words(&damping),
        warnings: warnings.into_iter().map(|w| w.message).collect(),
    })
}

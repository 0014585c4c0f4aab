//! `kinetostat shares`: which part of a machine gives how much of a deflection.
//!
//! It takes a model, a place, a direction and perhaps a load, and gives the shares of all springs and of loads that turn; on
//! request derivatives by every number of the file, and the cheapest stiffening.

mod answer;
pub(crate) mod arguments;
mod text;

use std::path::Path;

use kinetostat::{Posture, Wrench};
use kinetostat_analysis::sensitivity::{CommandedPlace, SensitivityTask, sensitivities};
use kinetostat_analysis::shares::stiffening::stiffen;
use kinetostat_analysis::shares::{Shares, SharesError};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::straight_tool;
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::options::vector;
use crate::place::query::{PlaceQuery, place_query_of};
use crate::shares::answer::{SensitivitiesAnswer, SharesAnswer, StiffeningAnswer, parts};
use crate::shares::arguments::SharesArgs;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::{short, triple};
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<SharesAnswer>("shares of a deflection")];

pub(crate) fn run(args: &SharesArgs) -> Answer<()> {
    let (model, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    model.require_stiffness()?;
    let query = place_query_of(
        &model,
        path,
        &args.model,
        &args.place,
        args.tool_length_mm,
        args.force.as_deref(),
        args.moment.as_deref(),
    )?;
    let files = ClaimedFiles::claim(&args.outputs, &query.inputs)?;
    let posture = query.posture()?;
    let (direction, words) = direction(args)?;
    let loaded = args.force.is_some() || args.moment.is_some();
    let (shares, stable) = if loaded {
        let found = posture.deflected_by(&query.wrench)?;
        (Shares::at(&posture, &found, &direction), found.stable())
    } else {
        (Shares::unloaded(&posture, &direction), true)
    };
    let shares = shares.map_err(|e| refused(&e))?;
    let (parts, limbs) = parts(&shares);
    let answer = SharesAnswer {
        head: query.head(1),
        direction: words,
        direction_components: direction.0.into(),
        loaded,
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        stable,
        compliance_m_or_rad_per_n_or_n_m: shares.compliance,
        parts,
        limbs,
        geometric_share: shares.geometric(),
        rounding: shares.rounding,
        passive_joints: (shares.passive_joints.iter())
            .map(|(limb, name)| format!("{limb}: {name}"))
            .collect(),
        stiffening: stiffening(args, &posture, &direction)?,
        sensitivities: match args.sensitivities {
            true => Some(derivatives(args, &model, &query, direction)?),
            false => None,
        },
        warnings: query.warnings.clone(),
    };
    let shown = Shown {
        text: text::answer_text(&query, &answer),
        csv: text::table(&answer)?,
        svg: text::bars(&answer).svg(),
        failure: None,
    };
    files.finish(&shown, &answer)
}

/// A unit load, with words for it.
fn direction(args: &SharesArgs) -> Answer<(Wrench, String)> {
    let Some(along) = &args.along else {
        return Ok((args.direction.load(), args.direction.words().to_owned()));
    };
    let along = vector("--along", along)?;
    let length = along.norm();
    if length == 0.0 {
        return Err(ErrorCode::Value.failure("--along has no length"));
    }
    let words = format!("a force along {}", triple(along.into(), short));
    Ok((Wrench::new(along / length, Vector3::zeros()), words))
}

fn refused(error: &SharesError) -> Failure {
    match error {
        SharesError::NoDirection => ErrorCode::Value.failure(error.to_string()),
        _ => ErrorCode::NoAnswer.failure(error),
    }
}

fn stiffening(
    args: &SharesArgs,
    posture: &Posture,
    direction: &Wrench,
) -> Answer<Option<StiffeningAnswer>> {
    let Some(percent) = args.reduce_percent else {
        return Ok(None);
    };
    if !(percent > 0.0 && percent < 100.0) {
        return Err(ErrorCode::Value.failure(format!(
            "--reduce-percent is {percent}; it lies between 0 and 100"
        )));
    }
    let target = 1.0 - 0.01 * percent;
    let found = stiffen(posture, direction, target, |_| 1.0).map_err(|e| refused(&e))?;
    Ok(Some(StiffeningAnswer::of(found.as_ref(), target)))
}

fn derivatives(
    args: &SharesArgs,
    model: &Model,
    query: &PlaceQuery,
    direction: Wrench,
) -> Answer<SensitivitiesAnswer> {
    let home = query.mechanism.platforms()[query.mechanism.tool()].home;
    let place = match (&query.joints, &query.followed) {
        (Some(joints), _) => CommandedPlace::Commands(joints.clone()),
        (None, Some(_)) => CommandedPlace::Position(query.target.translation.vector, home.rotation),
        (None, None) => CommandedPlace::Pose(query.target),
    };
    let task = SensitivityTask {
        model,
        tool: straight_tool(1e-3 * args.tool_length_mm.unwrap_or(0.0)),
        place,
        wrench: query.wrench,
        direction,
    };
    let found = sensitivities(&task, &[]).map_err(|error| ErrorCode::UnknownName.failure(error))?;
    Ok(SensitivitiesAnswer::of(&found))
}

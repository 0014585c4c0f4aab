//! Findings about a model, with stable names.

use kinetostat_machining::number::apart;
use kinetostat_machining::{Warning, WarningCode};
use kinetostat_model::Model;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::check::model::assumptions::AssumptionsFinding;
use crate::check::model::frames::{Frames, frames};
use crate::check::model::home::{HomeFinding, at_home};
use crate::check::model::limbs::{LimbFinding, LoadFinding, limb, platform_loads};
use crate::check::model::reach::{ReachFinding, reach_from};
use crate::machine::model_warnings::{deviation_descriptions, of_model};
use crate::machine::unstable_joints::load_names;
use crate::ui::numbers::pose_text;

/// Findings, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Findings {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) description: Option<String>,
    pub(crate) gravity_m_per_s2: [f64; 3],
    pub(crate) platforms: Vec<PlatformFinding>,
    /// Base and tool frame, zero posture, positive direction of each joint.
    pub(crate) frames: Frames,
    pub(crate) limbs: Vec<LimbFinding>,
    /// Loads on platforms.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) loads: Vec<LoadFinding>,
    pub(crate) mass_kg: f64,
    pub(crate) deviations: Vec<String>,
    pub(crate) home: Option<HomeFinding>,
    pub(crate) reach: Option<ReachFinding>,
    /// Scale of stiffness, and whether the method's assumptions hold at home.
    pub(crate) assumptions: Option<AssumptionsFinding>,
    /// Reason for which no equilibrium was found at home.
    pub(crate) home_problem: Option<String>,
    pub(crate) warnings: Vec<Warning>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct PlatformFinding {
    pub(crate) name: String,
    pub(crate) home_position_mm: [f64; 3],
    pub(crate) home_rotation_vector_deg: [f64; 3],
    pub(crate) mass_kg: f64,
    pub(crate) carries_the_tool: bool,
}

pub(crate) fn findings(model: &Model, source: String, force: Option<Vector3<f64>>) -> Findings {
    let m = &model.mechanism;
    let home = m.platforms()[m.tool()].home;
    let posture = m.posture(&home);
    let mut limbs: Vec<LimbFinding> = (0..m.limbs().len()).map(|i| limb(model, i)).collect();
    let solved = posture
        .as_ref()
        .map_err(|e| match e {
            kinetostat::Error::Unreachable {
                place,
                distance_m,
                angle_rad,
                nearest,
            } => format!(
                "{place}: this home cannot be reached; the nearest that was found is {} away: {}",
                apart(1e3 * distance_m, angle_rad.to_degrees()),
                pose_text(nearest)
            ),
            other => other.to_string(),
        })
        .and_then(|p| {
            let answer = at_home(m, p, force, &mut limbs, &load_names(model));
            answer.map_err(|error| error.to_string())
        });
    let (home, assumptions, home_problem) = match solved {
        Ok((home, assumptions)) => (Some(home), Some(assumptions), None),
        Err(reason) => (None, None, Some(reason)),
    };
    let reach = posture.as_ref().ok().map(reach_from);
    let mut warnings: Vec<Warning> = of_model(model).collect();
    if home_problem.is_some() {
        warnings.push(Warning::new(
            WarningCode::UnsolvedHome,
            "nothing can be solved at home, and every other place is sought from there: write the nearest pose as home, or check the home_ values of the joints and the limbs' start and end",
        ));
    }
    warnings.extend(assumptions.iter().flat_map(|a| a.warnings.clone()));
    Findings {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: source,
        description: model.document.mechanism.description.clone(),
        gravity_m_per_s2: m.gravity().into(),
        mass_kg: m.moving_mass(),
        platforms: m
            .platforms()
            .iter()
            .enumerate()
            .skip(1)
            .map(|(i, p)| PlatformFinding {
                name: p.name.clone(),
                home_position_mm: (p.home.translation.vector * 1e3).into(),
                home_rotation_vector_deg: p.home.rotation.scaled_axis().map(f64::to_degrees).into(),
                mass_kg: p.mass,
                carries_the_tool: i == m.tool(),
            })
            .collect(),
        frames: frames(model),
        limbs,
        loads: platform_loads(model),
        deviations: deviation_descriptions(model),
        home,
        reach,
        assumptions,
        home_problem,
        warnings,
    }
}

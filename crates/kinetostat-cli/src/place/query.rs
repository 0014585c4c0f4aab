//! A model, its tool, a place in the workspace and a load: what `deflect --at` and `stiffness` ask.

use std::path::{Path, PathBuf};

use kinetostat::machine::LimbPosture;
use kinetostat::{Mechanism, Pose, Posture, PostureRequest, Wrench};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Damping;
use kinetostat_machining::number::{apart, mean_length};
use kinetostat_machining::{
    NearSingular, Warning, WarningCode, natural_length, near_singular, odd_tool_length, posture_at,
    straight_tool, unusual_load,
};
use kinetostat_model::{Controller, Model};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::input_files::InputFiles;
use crate::machine::model_warnings::{deviation_descriptions, of_model};
use crate::machine::unstable_joints::load_names;
use crate::options::vector;
use crate::place::arguments::PlaceArgs;
use crate::place::joints::{self, JointValue};
use crate::place::orientation;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::wrapped;
use crate::ui::numbers::{pose_text, short, triple};

/// Upper limit of the tool length, m: a longer one is a wrong unit.
pub(crate) const FARTHEST: f64 = 1e4;

/// Query for one place.
pub(crate) struct PlaceQuery {
    pub(crate) name: String,
    pub(crate) source: String,
    pub(crate) tool_words: String,
    pub(crate) mechanism: Mechanism,
    /// Names of the loads on every limb.
    pub(crate) load_names: Vec<Vec<String>>,
    /// Springs, gas springs, tensions and counterweights in words: they act without a load on the tool.
    pub(crate) own_loads: Vec<String>,
    pub(crate) target: Pose,
    pub(crate) at_home: bool,
    /// Joints and how far the tool has turned from the orientation it is kept near to, deg, where the
    /// place is requested by its position only.
    pub(crate) followed: Option<Followed>,
    /// Commands, m or rad, where the place is given by them.
    pub(crate) joints: Option<Vec<f64>>,
    pub(crate) controller: Option<Controller>,
    /// Damping of vibrations by the model.
    pub(crate) damping: Damping,
    /// The model as it was read, for the lines of what it says.
    pub(crate) model: Model,
    pub(crate) wrench: Wrench,
    pub(crate) inputs: Vec<PathBuf>,
    pub(crate) deviations: Vec<String>,
    pub(crate) warnings: Vec<Warning>,
}

pub(crate) fn place_query(
    files: &InputFiles,
    model: &str,
    place: &PlaceArgs,
    tool_length_mm: Option<f64>,
    force: Option<&[f64]>,
    moment: Option<&[f64]>,
) -> Answer<PlaceQuery> {
    let (read, path) = files.model(model, Path::new(""))?;
    read.require_stiffness()?;
    place_query_of(&read, path, model, place, tool_length_mm, force, moment)
}

/// Builds the query for a model that was read already; `named` is its name in the command line.
pub(crate) fn place_query_of(
    read: &Model,
    path: Option<PathBuf>,
    named: &str,
    place: &PlaceArgs,
    tool_length_mm: Option<f64>,
    force: Option<&[f64]>,
    moment: Option<&[f64]>,
) -> Answer<PlaceQuery> {
    let length = tool_length_mm.unwrap_or(0.0);
    if !length.is_finite() || length.abs() > 1e5 {
        return Err(ErrorCode::Value.failure(format!(
            "--tool-length-mm is {length}; tools are shorter than 100 m"
        )));
    }
    let mechanism = read.mechanism.with_tool(&straight_tool(1e-3 * length));
    let home = mechanism.platforms()[mechanism.tool()].home;
    let joints = joints::given(read, place)?;
    let wanted = match &place.rotation {
        Some(text) => Some(orientation::option_or_follows("--rotation", text)?),
        None => None,
    };
    let rotation = wanted.flatten().unwrap_or(home.rotation);
    let target = match (&place.at, &joints) {
        (None, None) => Pose::from_parts(home.translation, rotation),
        (None, Some(joints)) => *mechanism
            .posture(PostureRequest::commands(joints))?
            .target(),
        (Some(at), _) => {
            let position = vector("--at", at)? * 1e-3;
            if position.norm() > FARTHEST {
                return Err(ErrorCode::Value
                    .failure("--at lies more than 10 km away; coordinates are in mm"));
            }
            Pose::from_parts(position.into(), rotation)
        }
    };
    let mut warnings: Vec<Warning> = of_model(read).collect();
    warnings.extend(odd_tool_length(&mechanism, length));
    let (target, followed) = match (&joints, wanted) {
        (Some(_), _) => (target, None),
        (None, Some(None)) => followed(&mechanism, &target, true, &mut warnings)?,
        (None, _) => match reachable(&mechanism, target, &mut warnings) {
            Ok(target) => (target, None),
            // Unless an orientation was requested, no machine is held to what it cannot do.
            Err(_) if wanted.is_none() && mechanism.turns_as_it_moves() => {
                followed(&mechanism, &target, false, &mut warnings)?
            }
            Err(error) => return Err(error),
        },
    };
    let load = |name: &str, values: Option<&[f64]>| {
        values.map_or_else(|| Ok(Vector3::zeros()), |v| vector(name, v))
    };
    let wrench = Wrench::new(load("--force", force)?, load("--moment", moment)?);
    warnings.extend(unusual_load(&wrench));
    Ok(PlaceQuery {
        name: read.name().to_owned(),
        source: match &path {
            Some(_) => named.to_owned(),
            None => format!("preset {named}"),
        },
        tool_words: if length == 0.0 {
            "none: the platform's own point".to_owned()
        } else {
            format!("{} mm along z of the flange", short(length))
        },
        load_names: load_names(read),
        own_loads: own_loads(read),
        target,
        at_home: !place.given(),
        followed,
        joints,
        controller: read.controller.clone(),
        damping: read.damping(),
        model: read.clone(),
        wrench,
        inputs: path.into_iter().collect(),
        deviations: deviation_descriptions(read),
        warnings,
        mechanism,
    })
}

/// Loads of the model between nodes and platforms, in words.
fn own_loads(model: &Model) -> Vec<String> {
    let document = &model.document;
    let between = document
        .load
        .iter()
        .map(|load| format!("'{}'", load.name()));
    let of_limbs = document.limb.iter().flat_map(|limb| {
        let loads = limb.load.iter();
        loads.map(|load| format!("'{}' of limb '{}'", load.name(), limb.name))
    });
    between.chain(of_limbs).collect()
}

impl PlaceQuery {
    /// The machine commanded for the place, within the limits of its actuators.
    /// What moves the tool without a load on it, as subject of a sentence: "own weight moves it".
    pub(crate) fn moves_unloaded(&self) -> String {
        let mechanism = &self.mechanism;
        let has_weight = mechanism.gravity().norm() > 0.0 && mechanism.moving_mass() > 0.0;
        let causes = [
            (has_weight, "own weight"),
            (!self.own_loads.is_empty(), "other loads of the model"),
            (!self.deviations.is_empty(), "deviations of the model"),
        ];
        let causes = causes.into_iter().filter(|(acts, _)| *acts);
        let causes: Vec<&str> = causes.map(|(_, cause)| cause).collect();
        match causes.as_slice() {
            [] => "preloads of the model move it".to_owned(),
            ["own weight"] => "own weight moves it".to_owned(),
            all => format!("{} move it", all.join(" and ")),
        }
    }

    pub(crate) fn posture(&self) -> Answer<Posture> {
        let posture = self.standing()?;
        posture.within_limits()?;
        Ok(posture)
    }

    pub(crate) fn standing(&self) -> kinetostat::Result<Posture> {
        self.standing_in(&self.mechanism)
    }

    /// Another machine of the same nominal geometry, commanded for the place.
    pub(crate) fn standing_in(&self, mechanism: &Mechanism) -> kinetostat::Result<Posture> {
        match (&self.joints, &self.followed) {
            (Some(joints), _) => mechanism.posture(PostureRequest::commands(joints)),
            (None, Some(f)) => {
                mechanism.posture(PostureRequest::joints(&self.target, f.limbs.clone()))
            }
            (None, None) => posture_at(mechanism, &self.target),
        }
    }

    /// The singular posture near the place, if there is one.
    pub(crate) fn near_singular(&self) -> Option<NearSingular> {
        near_singular(&self.standing().ok()?)
    }

    /// Displayed values of the controller; empty without a section `controller`.
    pub(crate) fn in_controller_coordinates(&self, posture: &Posture) -> Vec<JointValue> {
        joints::in_controller_coordinates(self.controller.as_ref(), &posture.commands())
    }

    /// Common head of the answers, in a version of their schema.
    pub(crate) fn head(&self, schema: u32) -> AnswerHead {
        let turn = self.target.rotation.scaled_axis();
        AnswerHead {
            schema,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            model: self.name.clone(),
            model_source: self.source.clone(),
            tool: self.tool_words.clone(),
            place: PlaceAnswer {
                position_mm: (self.target.translation.vector * 1e3).into(),
                rotation_vector_deg: turn.map(f64::to_degrees).into(),
                tool_turn_deg: self.followed.as_ref().map(|f| f.turned_deg),
                axes: "base",
                reference_point: "tip of the tool",
            },
        }
    }

    /// The query in words.
    pub(crate) fn heading(&self) -> String {
        let position = self.target.translation.vector * 1e3;
        let mut out = wrapped(
            &format!(
                "{} ({}), {} {} mm, tool {}",
                self.name,
                self.source,
                if self.at_home { "at home," } else { "at" },
                triple(position.into(), short),
                orientation::description(&self.target.rotation)
            ),
            0,
        );
        if self
            .tool_words
            .starts_with(|c: char| c.is_ascii_digit() || c == '-')
        {
            out.push_str(&wrapped(&format!("tool: {}", self.tool_words), 0));
        }
        if let Some(commands) = &self.joints {
            let values = joints::of_model(&self.mechanism, commands);
            out.push_str(&joints::values_text("joints of the model", &values));
        }
        for deviation in &self.deviations {
            out.push_str(&wrapped(deviation, 0));
        }
        out.push('\n');
        out
    }
}

/// Common head of the answers to a query.
#[derive(Serialize, JsonSchema)]
pub(crate) struct AnswerHead {
    schema: u32,
    kinetostat_version: &'static str,
    pub(crate) model: String,
    model_source: String,
    tool: String,
    pub(crate) place: PlaceAnswer,
}

/// The place of a query.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PlaceAnswer {
    pub(crate) position_mm: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
    /// Turn of the tool from the orientation it is kept near to, if the orientation follows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) tool_turn_deg: Option<f64>,
    pub(crate) axes: &'static str,
    pub(crate) reference_point: &'static str,
}

/// A place whose orientation follows.
#[derive(Clone, Debug)]
pub(crate) struct Followed {
    pub(crate) limbs: Vec<LimbPosture>,
    pub(crate) turned_deg: f64,
}

/// The pose at the position of `target`, or at the nearest one where only its digits keep the machine
/// from it, whose orientation is nearest to that of `target`.
fn followed(
    m: &Mechanism,
    target: &Pose,
    requested: bool,
    warnings: &mut Vec<Warning>,
) -> Answer<(Pose, Option<Followed>)> {
    let rotation = &target.rotation;
    let posture = match m.posture(PostureRequest::position(
        &target.translation.vector,
        rotation,
    )) {
        Err(kinetostat::Error::Unreachable {
            distance_m,
            nearest,
            ..
        }) if distance_m <= ROUNDED * natural_length(m) => {
            warnings.push(nearest_used(format!(
                "the machine cannot take this place exactly; the nearest is used, {} away: {}",
                mean_length(1e3 * distance_m),
                pose_text(&nearest)
            )));
            m.posture(PostureRequest::position(
                &nearest.translation.vector,
                rotation,
            ))?
        }
        answer => answer?,
    };
    let pose = *posture.target();
    let turned_deg = pose.rotation.angle_to(rotation).to_degrees();
    warnings.push(orientation::follows(turned_deg, requested, false));
    let limbs = posture.limbs().to_vec();
    Ok((pose, Some(Followed { limbs, turned_deg })))
}

fn nearest_used(said: String) -> Warning {
    Warning::new(WarningCode::NearestPlace, said)
}

/// Share of the natural length by which a requested pose may differ from what the machine can take.
const ROUNDED: f64 = 1e-6;

/// Radius of the search for the nearest pose if a place cannot be reached, in natural lengths.
const AROUND: f64 = 0.1;

/// The place, or the nearest one that the machine can take where only the digits of the place keep it
/// from that; a place that cannot be reached is refused with the nearest pose.
fn reachable(m: &Mechanism, target: Pose, warnings: &mut Vec<Warning>) -> Answer<Pose> {
    let error = match posture_at(m, &target) {
        Err(error @ kinetostat::Error::Unreachable { .. }) => error,
        _ => return Ok(target),
    };
    let length = natural_length(m);
    let Some(nearest) = m.nearest_reachable(&target, AROUND * length) else {
        return Err(error.into());
    };
    let off = kinetostat::spatial::pose_residual(&nearest, &target);
    let (shift, turn) = (off.linear().norm(), off.angular().norm());
    if shift.max(length * turn) <= ROUNDED * length {
        warnings.push(nearest_used(format!(
            "the machine cannot take this place exactly; the nearest is used, {} away: {}",
            apart(1e3 * shift, turn.to_degrees()),
            pose_text(&nearest)
        )));
        return Ok(nearest);
    }
    Err(kinetostat::Error::Unreachable {
        place: kinetostat::Place::mechanism(m.name()),
        distance_m: shift,
        angle_rad: turn,
        nearest: Box::new(nearest),
    }
    .into())
}

//! The machine of a question about vibrations.

use std::path::Path;

use kinetostat::number::larger;
use kinetostat::{Directions, Mechanism, Posture};
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::{Error, Held};
use kinetostat_machining::{Warning, WarningCode};
use kinetostat_model::inertia_of_body;
use nalgebra::{Matrix3, Vector3};

use crate::end_condition::holding::list;
use crate::files::input_files::InputFiles;
use crate::job::tool_mass::{MASSES_KG, ToolMass, carrying};
use crate::options::vector;
use crate::place::query::{PlaceQuery, place_query_of};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::vibration::arguments::VibrationArgs;

/// The place and the load that are asked for.
pub(crate) fn query(args: &VibrationArgs) -> Answer<PlaceQuery> {
    let (mut read, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    read.require_stiffness()?;
    if let Some(mass_kg) = args.tool_mass_kg {
        if !MASSES_KG.contains(&mass_kg) {
            return Err(ErrorCode::Value.failure(format!(
                "--tool-mass-kg is {mass_kg}; the mass of a tool is from 0.001 to 5000 kg"
            )));
        }
        let halfway = Vector3::z() * (0.5 * args.tool_length_mm.unwrap_or(0.0));
        let stated = args.tool_centre_of_mass_mm.as_deref();
        let centre = stated.map(|c| vector("--tool-centre-of-mass-mm", c));
        let centre_mm = centre.transpose()?.unwrap_or(halfway);
        let inertia = match args.tool_inertia_kg_m2.as_deref() {
            Some(&[xx, yy, zz, xy, xz, yz]) => {
                let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                inertia_of_body(rows).map_err(|(message, help)| {
                    ErrorCode::Value.failure(format!("--tool-inertia-kg-m2: {message}; {help}"))
                })?
            }
            _ => Matrix3::zeros(),
        };
        let tool = ToolMass {
            mass_kg,
            centre_mm,
            inertia,
        };
        read = carrying(&read, tool)?;
    }
    place_query_of(
        &read,
        path,
        &args.model,
        &args.place,
        args.tool_length_mm,
        args.force.as_deref(),
        args.moment.as_deref(),
    )
}

/// Directions by name in which the tool is held while it vibrates.
pub(crate) fn held(text: Option<&str>) -> Answer<Held> {
    let Some(text) = text else {
        return Ok(Held::nothing());
    };
    let [x, y, z, rx, ry, rz] = list("--hold", text, None)?;
    let mut held = Held::directions(Directions::NONE);
    held.directions = [x, y, z, rx, ry, rz];
    Ok(held)
}

/// The machine about its equilibrium.
pub(crate) fn machine(
    query: &PlaceQuery,
    posture: &Posture,
    held: &Held,
) -> Answer<VibratingMachine> {
    VibratingMachine::at(posture, &query.wrench, held).map_err(|error| {
        let line = line_of(&error, query);
        refused(error).within(&line.unwrap_or_else(|| query.source.clone()))
    })
}

/// File and line of an inertia that no body has, or of where masses are missing.
fn line_of(error: &Error, query: &PlaceQuery) -> Option<String> {
    let line = match error {
        Error::Inertia { part, .. } => query.model.inertia_line(part)?,
        // A preset is no file that one could write in.
        Error::NoMass(_) if !query.inputs.is_empty() => query.model.first_limb_line()?,
        _ => return None,
    };
    Some(format!("{}, line {line}", query.source))
}

/// Converts an error to a failure.
pub(crate) fn refused(error: Error) -> Failure {
    match error {
        Error::Statics(error) => error.into(),
        Error::NoMass(name) => ErrorCode::ModelUnsuited.failure(format!(
                "'{name}' has no mass anywhere, so it has no frequencies. Add masses to the model file: {{ body = \"upper arm mass\", mass_kg = 270, centre_of_mass_mm = [0, 0, -625], inertia_kg_m2 = [[..], [..], [..]] }} behind a joint or link of a chain, or mass_kg, centre_of_mass_mm and inertia_kg_m2 of a moving body (platform)"
            ),
        ),
        Error::NotSolved(_) => ErrorCode::NoAnswer.failure(error),
        _ => ErrorCode::ModelUnsuited.failure(error),
    }
}

/// Largest share by which a response by modes may be off before it is said.
const COUPLED: f64 = 0.02;

/// Warning about damping that is not in the modes, if a cut is judged by them: on parts without mass, or by the material.
pub(crate) fn lost_coupling(off: f64) -> Option<Warning> {
    (off > COUPLED).then(|| {
        Warning::new(
            WarningCode::Model,
            format!(
                "this damping is not all in the modes (dampers on parts without mass, or structural damping under load), and limits are those of the modes: the response of the tool's tip is up to {:.0} % off so (`kinetostat frf` solves it directly)",
                100.0 * off
            ),
        )
    })
}

/// Ratio of a frequency to the highest natural frequency above which a machine hardly responds, and a warning says so.
const BEYOND_MODES: f64 = 10.0;

/// Frequency of the fastest mode, Hz, where a frequency lies far beyond it: the frequency is a slip, or the model has no modes of
/// spindle and tool.
pub(crate) fn far_below(machine: &VibratingMachine, hz: f64) -> Option<f64> {
    let fastest_hz = machine.modes.frequencies_hz().into_iter().fold(0.0, larger);
    (hz > BEYOND_MODES * fastest_hz).then_some(fastest_hz)
}

/// Upper limit of the bodies that a warning names.
const NAMED: usize = 6;

/// Bodies with mass and without inertia, which dynamics takes as points.
pub(crate) fn point_bodies(mechanism: &Mechanism) -> Option<Warning> {
    fn is_point(mass: f64, inertia: &Matrix3<f64>) -> bool {
        mass > 0.0 && inertia.norm() == 0.0
    }
    let several = mechanism.limbs().len() > 1;
    let of_limbs = mechanism.limbs().iter().flat_map(|limb| {
        let bodies = limb.actual.bodies().iter();
        let points = bodies.filter(|body| is_point(body.mass, &body.inertia));
        points.map(move |body| match several {
            true => format!("{}.{}", limb.name, body.name),
            false => body.name.clone(),
        })
    });
    let platforms = mechanism.platforms().iter();
    let platforms = platforms.filter(|p| is_point(p.mass, &p.inertia));
    let names: Vec<String> = of_limbs.chain(platforms.map(|p| p.name.clone())).collect();
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!names.is_empty()).then(|| {
        Warning::new(
            WarningCode::Model,
            format!(
                "bodies with mass and without inertia are points: {}{more}. They turn without resistance, and frequencies are too high; give them inertia_kg_m2",
                names[..names.len().min(NAMED)].join(", ")
            ),
        )
    })
}

/// Limits of the answer: loads without a potential, parts without mass.
pub(crate) fn limits(machine: &VibratingMachine, posture: &Posture) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if machine.dynamics.is_circulatory() {
        warnings.push(Warning::new(
            WarningCode::NoPotential,
            "loads have no potential (followers, or a moment that does not turn with the tool): frequencies are those of complex pairs, and a pair may grow (`kinetostat modes` says whether one does)".to_owned(),
        ));
    }
    let without = machine.without_mass(posture);
    if !without.is_empty() {
        warnings.push(Warning::new(
            WarningCode::Model,
            format!(
                "without mass in the model: {}. Own vibrations of these parts are missing, and frequencies are too high",
                without.join(", ")
            ),
        ));
    }
    warnings.extend(point_bodies(posture.mechanism()));
    if !machine.equilibrium.stable() {
        warnings.push(Warning::new(
            WarningCode::NotStable,
            "the equilibrium under the load is not stable".to_owned(),
        ));
    }
    warnings
}

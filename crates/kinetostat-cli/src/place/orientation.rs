//! Poses of job files and options, by the model crate's own conventions: an orientation is taken
//! only under the name of its convention.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode};
use kinetostat_model::schema::Placement;
use nalgebra::UnitQuaternion;

use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;
use crate::ui::spelling::nearest;

pub(crate) const CONVENTIONS: [&str; 9] = [
    "rotation_vector_deg",
    "rotation_vector_rad",
    "rotation_intrinsic_xyz_deg",
    "roll_pitch_yaw_urdf_deg",
    "roll_pitch_yaw_urdf_rad",
    "a_b_c_kuka_deg",
    "w_p_r_fanuc_deg",
    "quaternion_wxyz",
    "quaternion_xyzw",
];

/// The word for an orientation that is the machine's affair.
pub(crate) const FOLLOWS: &str = "follows";

/// `CONVENTION=A,B,C` of an option, or none for the word `follows`.
pub(crate) fn option_or_follows(flag: &str, text: &str) -> Answer<Option<UnitQuaternion<f64>>> {
    match text.trim() {
        FOLLOWS => Ok(None),
        _ => option(flag, text).map(Some),
    }
}

/// Warning about a machine whose targets are positions only: the turn of its tool, or the largest turn.
pub(crate) fn follows(turned_deg: f64, requested: bool, at_most: bool) -> Warning {
    let by = if at_most { "by up to" } else { "by" };
    let why = match requested {
        true => "the orientation follows",
        false => "this machine cannot hold an orientation as it moves, so its orientation follows",
    };
    Warning::new(
        WarningCode::OrientationFollows,
        format!(
            "{why}: the tool turns {by} {} deg from the orientation it is kept near to",
            short(turned_deg)
        ),
    )
}

/// `CONVENTION=A,B,C` of an option.
pub(crate) fn option(flag: &str, text: &str) -> Answer<UnitQuaternion<f64>> {
    let refuse = |reason: String| ErrorCode::Value.failure(format!("{flag} '{text}': {reason}"));
    let names = CONVENTIONS.join(", ");
    let Some((name, values)) = text.split_once('=') else {
        return Err(refuse(format!(
            "the same three angles mean a dozen different rotations: name the convention, as in {flag} a_b_c_kuka_deg=0,0,90. There are {names}"
        )));
    };
    let name = name.trim();
    if !CONVENTIONS.contains(&name) {
        let near = nearest(name, &CONVENTIONS)
            .map_or_else(String::new, |n| format!("did you mean '{n}'? "));
        return Err(refuse(format!(
            "'{name}' is no convention known here. {near}There are {names}"
        )));
    }
    let numbers: Vec<f64> = values
        .split(',')
        .map(|v| v.trim().parse::<f64>().ok().filter(|x| x.is_finite()))
        .collect::<Option<_>>()
        .ok_or_else(|| {
            refuse("numbers with a decimal point, separated by commas, are needed".into())
        })?;
    of(name, &numbers).map_err(|fault| refuse(fault.to_string()))
}

/// Numbers are no orientation.
#[derive(Clone, Debug, thiserror::Error)]
pub(crate) enum NoOrientation {
    #[error("{needed} numbers are needed, {given} are given")]
    Count { needed: usize, given: usize },
    #[error("{message}; {help}")]
    Wrong { message: String, help: String },
}

/// The orientation that these numbers mean by a convention of [`CONVENTIONS`].
pub(crate) fn of(name: &str, numbers: &[f64]) -> Result<UnitQuaternion<f64>, NoOrientation> {
    let needed = if name.starts_with("quaternion") { 4 } else { 3 };
    if numbers.len() != needed {
        return Err(NoOrientation::Count {
            needed,
            given: numbers.len(),
        });
    }
    let mut p = Placement::default();
    if let [a, b, c, d] = numbers[..] {
        if name == "quaternion_wxyz" {
            p.quaternion_wxyz = Some([a, b, c, d]);
        } else {
            p.quaternion_xyzw = Some([a, b, c, d]);
        }
    } else if let [a, b, c] = numbers[..] {
        let slot = match name {
            "rotation_vector_deg" => &mut p.rotation_vector_deg,
            "rotation_vector_rad" => &mut p.rotation_vector_rad,
            "rotation_intrinsic_xyz_deg" => &mut p.rotation_intrinsic_xyz_deg,
            "roll_pitch_yaw_urdf_deg" => &mut p.roll_pitch_yaw_urdf_deg,
            "roll_pitch_yaw_urdf_rad" => &mut p.roll_pitch_yaw_urdf_rad,
            "a_b_c_kuka_deg" => &mut p.a_b_c_kuka_deg,
            _ => &mut p.w_p_r_fanuc_deg,
        };
        *slot = Some([a, b, c]);
    }
    p.pose()
        .map(|pose| pose.rotation)
        .map_err(|(message, help)| NoOrientation::Wrong {
            message: message.to_string(),
            help: help.to_string(),
        })
}

/// An orientation in words: the rotation vector in degrees.
pub(crate) fn description(q: &UnitQuaternion<f64>) -> String {
    let v = q.scaled_axis().map(f64::to_degrees);
    if v.norm() < 1e-9 {
        "parallel to the base".into()
    } else {
        format!(
            "turned from the base by the rotation vector {} deg",
            crate::ui::numbers::triple(v.into(), |x| crate::ui::numbers::fixed(x, 4))
        )
    }
}

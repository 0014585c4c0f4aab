//! Functions of the controller that are computed here.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::interpreter::functions::in_radians;
use crate::interpreter::value::Datum;
use crate::text::name::Name;
use crate::urscript::grammar::{FORM, MEMBERS};

/// The result of a function; none of one that is not computed here.
///
/// Source: the script manual, module `urmath`; angles are in radians.
pub(super) fn computed(name: &Name, given: &[Datum]) -> Option<Datum> {
    let name = std::str::from_utf8(name.letters()).ok()?;
    let number = |at: usize| given.get(at)?.as_number();
    let frame = |at: usize| FORM.frame_of(given.get(at)?);
    let pose_of = |frame: Isometry3<f64>| FORM.pose_of(&frame, &MEMBERS);
    let vector = |at: usize| given.get(at)?.as_numbers::<3>().map(Vector3::from);
    let list = |vector: Vector3<f64>| Datum::numbers(vector.iter().copied());
    let found = match name {
        "CEIL" => Datum::number(number(0)?.ceil()),
        "FLOOR" => Datum::number(number(0)?.floor()),
        "D2R" => Datum::number(number(0)?.to_radians()),
        "R2D" => Datum::number(number(0)?.to_degrees()),
        "ATAN2" => Datum::number(number(0)?.atan2(number(1)?)),
        "POW" => Datum::number(number(0)?.powf(number(1)?)),
        "LOG" => Datum::number(number(1)?.log(number(0)?)),
        "LENGTH" | "GET_LIST_LENGTH" if !given.first()?.parts().is_empty() => {
            Datum::number(given[0].parts().len() as f64)
        }
        "NORM" => match given.first()?.parts() {
            [] => Datum::number(number(0)?.abs()),
            parts => {
                let parts: Option<Vec<f64>> = parts.iter().map(Datum::as_number).collect();
                Datum::number(parts?.iter().map(|part| part * part).sum::<f64>().sqrt())
            }
        },
        "POSE_TRANS" => pose_of(frame(0)? * frame(1)?),
        "POSE_INV" => pose_of(frame(0)?.inverse()),
        "POSE_ADD" => {
            let [one, other] = [frame(0)?, frame(1)?];
            let place = one.translation.vector + other.translation.vector;
            pose_of(Isometry3::from_parts(
                place.into(),
                one.rotation * other.rotation,
            ))
        }
        "POINT_DIST" => {
            let away = frame(0)?.translation.vector - frame(1)?.translation.vector;
            Datum::number(1e-3 * away.norm())
        }
        "INTERPOLATE_POSE" => pose_of(frame(0)?.try_lerp_slerp(&frame(1)?, number(2)?, 1e-9)?),
        "RPY2ROTVEC" => {
            let [x, y, z] = vector(0)?.into();
            list(UnitQuaternion::from_euler_angles(x, y, z).scaled_axis())
        }
        "ROTVEC2RPY" => {
            let (x, y, z) = UnitQuaternion::from_scaled_axis(vector(0)?).euler_angles();
            Datum::numbers([x, y, z])
        }
        "SQRT" | "SIN" | "COS" | "TAN" | "ASIN" | "ACOS" | "ATAN" => {
            Datum::number(in_radians(name)?(number(0)?))
        }
        _ => return None,
    };
    // NaN and infinite values are unknown.
    let is_number = found.as_number().is_none_or(f64::is_finite);
    is_number.then_some(found)
}

//! Grammar of URScript statements and expressions, and the functions of the controller that are computed here.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::interpreter::ends::{Around, PoseForm};
use crate::interpreter::expression::Operator;
use crate::interpreter::lexing::{Marks, Words};
use crate::interpreter::operation::in_radians;
use crate::interpreter::reading::Grammar;
use crate::interpreter::tree::RoutineKind;
use crate::interpreter::value::Datum;
use crate::model::orientation::OrientationText;
use crate::text::Name;

/// Members of a pose, in the order in which `p[x,y,z,rx,ry,rz]` has them.
pub(super) const MEMBERS: [&str; 6] = ["X", "Y", "Z", "RX", "RY", "RZ"];

/// Source: the script manual, Flow of control, Threads, Scoping rules.
pub(super) const WORDS: Words = Words {
    // `$ 2 "MoveL"`: by such lines the pendant knows its nodes.
    marks: Marks {
        comment: b'#',
        aside: b'$',
    },
    routines: &[
        ("def", RoutineKind::Procedure),
        ("sec", RoutineKind::Procedure),
        ("thread", RoutineKind::Trap),
    ],
    branch: ["if", "elif", "else"],
    repeat: "while",
    end: "end",
    colon: b':',
    scopes: ["global", "local"],
    leaves: ["return", "break", "continue", "halt"],
    plain: &["run", "join", "kill", "enter_critical", "exit_critical"],
    nothing: "pass",
};

/// Source: the script manual, Numbers, variables, and types.
pub(super) const GRAMMAR: Grammar = Grammar {
    operators: &[
        ("or", Operator::Or, 0),
        ("xor", Operator::Xor, 0),
        ("and", Operator::And, 1),
        ("==", Operator::Equal, 2),
        ("!=", Operator::Unequal, 2),
        ("<=", Operator::LessOrEqual, 2),
        (">=", Operator::GreaterOrEqual, 2),
        ("<", Operator::Less, 2),
        (">", Operator::Greater, 2),
        ("+", Operator::Plus, 3),
        ("-", Operator::Minus, 3),
        ("*", Operator::Times, 4),
        ("/", Operator::Over, 4),
        ("%", Operator::Remainder, 4),
    ],
    not: 2,
    sign: 5,
    index: [b'[', b']'],
    list: Some([b'[', b']']),
    has_members: false,
    names_arguments: true,
    counts_from_one: false,
    truths: ["False", "True"],
    aggregate: Some(("p", &MEMBERS)),
    separates_comparisons: false,
};

/// Form of poses.
pub(super) const FORM: PoseForm = PoseForm {
    unit_mm: 1e3,
    orientation: OrientationText::RotationVector,
    around: Around {
        before: |_| "global ".to_owned(),
        middle: b"=",
        after: b"",
    },
    remedy: "write the end as a pose: p[x,y,z,rx,ry,rz] in metres and radians, or state what it rests on (--set NAME=VALUE)",
};

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

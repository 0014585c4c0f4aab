//! The law of a spring with two stiffnesses.

use kinetostat::{
    MotionKind,
    model::{BilinearLaw, SpringLaw},
};

use crate::elements::quantity::by_kind;
use crate::elements::quantity::{Choice, DEG, MM, ReadResult, choices};
use crate::problem::{Finding, KeyPath};
use crate::schema::Knee;

/// The law of a spring of this stiffness (SI) up to its knee.
pub(crate) fn law(
    place: &KeyPath,
    kind: MotionKind,
    stiffness: f64,
    knee: &Knee,
) -> ReadResult<SpringLaw> {
    let positive = |what: &str, lengths: &[Choice<f64>], angles: &[Choice<f64>]| {
        let keys = |choices: &[Choice<f64>]| {
            let keys: Vec<&str> = choices.iter().map(|c| c.key).collect();
            keys.join(" or ")
        };
        let right = match kind {
            MotionKind::Prismatic => keys(lengths),
            MotionKind::Revolute => keys(angles),
        };
        match by_kind(place, what, kind, lengths, angles)? {
            Some(given) if given.value > 0.0 => Ok(given.value),
            Some(given) => Err(Finding::new(
                &place.key(given.key),
                format!(
                    "the {what} is {}, a number above zero is needed",
                    given.value
                ),
                format!("correct '{}'", given.key),
            )),
            None => Err(Finding::new(
                place,
                format!("the {what} is missing"),
                format!("write {right}"),
            )),
        }
    };
    let knee_at = positive(
        "deflection at the knee",
        &choices!(knee, (at_mm, MM), (at_m, 1.0)),
        &choices!(knee, (at_deg, DEG), (at_rad, 1.0)),
    )?;
    let beyond = positive(
        "stiffness beyond the knee",
        &choices!(knee, (then_n_per_m, 1.0), (then_n_per_mm, 1.0 / MM)),
        &choices!(knee, (then_n_m_per_rad, 1.0), (then_n_mm_per_rad, MM)),
    )?;
    Ok(SpringLaw::Bilinear(BilinearLaw {
        stiffness,
        beyond,
        knee: knee_at,
    }))
}

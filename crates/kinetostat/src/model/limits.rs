//! Numbers that can be calculated with: finite, and not so large that their products are not.

use crate::error::{Error, Place, Result};
use crate::number::short;

/// Refuses a pose with a number that [`check_number`] refuses.
pub(crate) fn check_pose(place: &Place, what: &str, pose: &crate::spatial::Pose) -> Result<()> {
    let (p, r) = (pose.translation.vector, pose.rotation.coords);
    for value in [p.x, p.y, p.z, r.x, r.y, r.z, r.w] {
        check_number(place, || what.to_owned(), value)?;
    }
    Ok(())
}

/// Numbers beyond this lose themselves when they are multiplied.
pub(crate) const LARGEST: f64 = 1e60;

/// Refuses a number that is not finite, or so large that its powers are not.
pub(crate) fn check_number(place: &Place, what: impl Fn() -> String, value: f64) -> Result<()> {
    if !value.is_finite() {
        return Err(Error::NotFinite {
            place: place.clone(),
            what: what(),
            value,
        });
    }
    if value.abs() > LARGEST {
        return Err(Error::model(
            place,
            format!(
                "{} is {}, a number between -{limit} and {limit} is needed",
                what(),
                short(value),
                limit = short(LARGEST)
            ),
        ));
    }
    Ok(())
}

/// The first of some named numbers that [`check_number`] refuses, in words.
pub(crate) fn odd_number<'a>(
    numbers: impl IntoIterator<Item = (&'a str, &'a f64)>,
) -> Option<String> {
    let odd = |value: &f64| value.is_nan() || value.abs() > LARGEST;
    let (what, value) = numbers.into_iter().find(|(_, value)| odd(value))?;
    Some(match value.is_finite() {
        true => format!(
            "the {what} is {value:e}, a number between -{LARGEST:e} and {LARGEST:e} is needed"
        ),
        false => format!("the {what} is {value}, a finite number is needed"),
    })
}

pub(crate) fn check_numbers<'a>(
    place: &Place,
    what: &str,
    numbers: impl IntoIterator<Item = &'a f64>,
) -> Result<()> {
    let mut numbers = numbers.into_iter();
    numbers.try_for_each(|x| check_number(place, || what.to_owned(), *x))
}

/// Refuses what is not a positive, finite number.
pub(crate) fn positive(place: &Place, what: &str, value: f64) -> Result<()> {
    if value > 0.0 && value < LARGEST {
        return Ok(());
    }
    let reason = format!("{what} is {value:?}, a positive number below {LARGEST:e} is needed");
    Err(Error::model(place, reason))
}

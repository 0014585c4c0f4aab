//! Numbers with units: exactly one of the keys for a quantity, converted to SI once.

use kinetostat::MotionKind;
use nalgebra::Vector3;

use crate::problem::{Finding, KeyPath};

pub(crate) type ReadResult<T> = Result<T, Finding>;

pub(crate) const MM: f64 = 1e-3;
pub(crate) const DEG: f64 = std::f64::consts::PI / 180.0;

/// A value as written: its key and the factor that makes it SI.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice<T> {
    pub(crate) key: &'static str,
    pub(crate) value: Option<T>,
    pub(crate) factor: f64,
}

pub(crate) fn choice<T>(key: &'static str, value: Option<T>, factor: f64) -> Choice<T> {
    Choice { key, value, factor }
}

/// The keys of a quantity and the factors of their units, with what a table has under these keys.
macro_rules! choices {
    ($table:expr, $(($key:ident, $factor:expr)),+) => {
        [$($crate::elements::quantity::choice(stringify!($key), $table.$key, $factor)),+]
    };
}
pub(crate) use choices;

/// A value in SI and the key it was written under.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given<T> {
    pub(crate) key: &'static str,
    pub(crate) value: T,
}

/// Quantity that can be multiplied by the factor of its unit.
pub(crate) trait Scaled: Copy {
    fn scaled(self, factor: f64) -> Self;
    fn finite(self) -> bool;
}

impl Scaled for f64 {
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
    fn finite(self) -> bool {
        self.is_finite()
    }
}

impl<const N: usize> Scaled for [f64; N] {
    fn scaled(self, factor: f64) -> Self {
        self.map(|x| x * factor)
    }
    fn finite(self) -> bool {
        self.iter().all(|x| x.is_finite())
    }
}

fn keys<T>(choices: &[Choice<T>]) -> String {
    choices
        .iter()
        .map(|c| c.key)
        .collect::<Vec<_>>()
        .join(" or ")
}

/// Picks at most one of the keys.
pub(crate) fn pick<T: Scaled>(
    place: &KeyPath,
    what: &str,
    choices: &[Choice<T>],
) -> ReadResult<Option<Given<T>>> {
    let mut given = choices
        .iter()
        .filter_map(|c| Some((c.key, c.value?, c.factor)));
    let first = given.next();
    if let (Some((one, ..)), Some((other, ..))) = (first, given.next()) {
        return Err(Finding::new(
            &place.key(other),
            format!("the {what} is given twice: '{one}' and '{other}'"),
            "keep one of them",
        ));
    }
    let Some((key, value, factor)) = first else {
        return Ok(None);
    };
    let value = value.scaled(factor);
    if value.finite() {
        return Ok(Some(Given { key, value }));
    }
    Err(Finding::new(
        &place.key(key),
        format!("the {what} is too large for a number in SI units"),
        "check the figure and its unit",
    ))
}

/// Exactly one of the keys.
pub(crate) fn need<T: Scaled>(
    place: &KeyPath,
    what: &str,
    choices: &[Choice<T>],
) -> ReadResult<Given<T>> {
    pick(place, what, choices)?.ok_or_else(|| {
        Finding::new(
            place,
            format!("the {what} is missing"),
            format!("write {}", keys(choices)),
        )
    })
}

/// Exactly one of the keys, above zero.
pub(crate) fn positive(
    place: &KeyPath,
    what: &str,
    choices: &[Choice<f64>],
) -> ReadResult<Given<f64>> {
    let given = need(place, what, choices)?;
    if given.value > 0.0 {
        return Ok(given);
    }
    let written = choices
        .iter()
        .find(|c| c.key == given.key)
        .and_then(|c| c.value)
        .unwrap_or(given.value);
    Err(Finding::new(
        &place.key(given.key),
        format!("the {what} is {written}, a number above zero is needed"),
        format!("correct '{}'", given.key),
    ))
}

/// Keys of another dimension: a length where an angle is meant, and the like.
pub(crate) fn forbid<T>(
    place: &KeyPath,
    choices: &[Choice<T>],
    reason: &str,
    help: &str,
) -> ReadResult<()> {
    match choices.iter().find(|c| c.value.is_some()) {
        Some(c) => Err(Finding::new(
            &place.key(c.key),
            format!("'{}' does not fit: {reason}", c.key),
            help,
        )),
        None => Ok(()),
    }
}

/// A vector, zero where it is not given.
pub(crate) fn vector(
    place: &KeyPath,
    what: &str,
    choices: &[Choice<[f64; 3]>],
) -> ReadResult<Vector3<f64>> {
    Ok(pick(place, what, choices)?.map_or_else(Vector3::zeros, |g| Vector3::from(g.value)))
}

/// Keys for a length and for an angle: the ones of the joint's kind count, the others are refused.
pub(crate) fn by_kind<T: Scaled>(
    place: &KeyPath,
    what: &str,
    kind: MotionKind,
    lengths: &[Choice<T>],
    angles: &[Choice<T>],
) -> ReadResult<Option<Given<T>>> {
    let (right, wrong, reason) = match kind {
        MotionKind::Prismatic => (
            lengths,
            angles,
            "the joint is prismatic: it slides along its axis",
        ),
        MotionKind::Revolute => (
            angles,
            lengths,
            "the joint is revolute: it turns about its axis",
        ),
    };
    let keys: Vec<&str> = right.iter().map(|c| c.key).collect();
    forbid(
        place,
        wrong,
        reason,
        &format!("write {}", keys.join(" or ")),
    )?;
    pick(place, what, right)
}

//! Targets as aggregates of numbers: `[[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],[eax_a,...]]`.

use nalgebra::{Isometry3, Translation3, Vector3};

use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::model::target::{Configuration, PoseTarget};
use crate::rapid::expression::{Expression, Value};
use crate::rapid::tree::TokenFile;
use crate::text::number::{NumberText, Width};

/// From here on an external axis is not stated: 9E9.
const UNSTATED: f64 = 8e9;

/// The numbers of a list of so many.
fn numbers<const N: usize>(
    file: &TokenFile<'_>,
    expression: &Expression,
) -> Option<[NumberText; N]> {
    let Value::List(parts) = &expression.value else {
        return None;
    };
    let number = |part: &Expression| match part.value {
        Value::Number(value) => Some(NumberText {
            span: file.span(&part.tokens),
            value,
        }),
        _ => None,
    };
    let all: Option<Vec<NumberText>> = parts.iter().map(number).collect();
    all?.try_into().ok()
}

/// The values of a list of numbers.
pub(crate) fn values<const N: usize>(expression: &Expression) -> Option<[f64; N]> {
    let Value::List(parts) = &expression.value else {
        return None;
    };
    let value = |part: &Expression| match part.value {
        Value::Number(value) => Some(value),
        _ => None,
    };
    let all: Option<Vec<f64>> = parts.iter().map(value).collect();
    all?.try_into().ok()
}

/// A robtarget's literal and what it says, or why it is none.
pub(crate) fn target_of(
    file: &TokenFile<'_>,
    expression: &Expression,
) -> Result<(PoseText, PoseTarget), &'static str> {
    let Value::List(parts) = &expression.value else {
        return Err("the target is not written in numbers");
    };
    let [position, orientation, configuration, external] = parts.as_slice() else {
        return Err("a robtarget has four parts: place, orientation, configuration, external axes");
    };
    let position = numbers::<3>(file, position).ok_or("its place is not three numbers")?;
    let orientation =
        numbers::<4>(file, orientation).ok_or("its orientation is not four numbers")?;
    let parts = [0, 1, 2, 3].map(|part| orientation[part].value);
    let rotation = (OrientationText::Quaternion.rotation_of(&parts))
        .ok_or("its quaternion has not the length 1")?;
    let axes = numbers::<6>(file, external).ok_or("its external axes are not six numbers")?;
    let configured = (values::<4>(configuration).filter(|all| all.iter().all(is_quarter)))
        .ok_or("its configuration is not four whole numbers")?;
    let pose = PoseTarget {
        position_mm: Vector3::from([0, 1, 2].map(|axis| position[axis].value)),
        orientation: rotation,
        configuration: Configuration {
            text: String::from_utf8_lossy(file.source.part(&file.span(&configuration.tokens)))
                .into_owned(),
            numbers: configured.to_vec(),
        },
        external: external_axes(external),
    };
    let text = PoseText {
        file: file.index,
        whole: file.span(&expression.tokens),
        position,
        orientation: orientation.to_vec(),
        convention: OrientationText::Quaternion,
        external: (axes.into_iter())
            .map(|number| is_stated(number.value).then_some(number))
            .collect(),
        width: Width::Free,
    };
    Ok((text, pose))
}

/// Whether a number counts quarters of a turn, or is a sum of flags.
fn is_quarter(value: &f64) -> bool {
    value.fract() == 0.0 && value.abs() < 1e10
}

/// Whether a number is the place of an external axis, and not 9E9.
fn is_stated(value: f64) -> bool {
    value < UNSTATED
}

/// Stated external axes; empty where they are no literal.
fn external_axes(expression: &Expression) -> Vec<Option<f64>> {
    let axes = values::<6>(expression).map_or_else(Vec::new, |all| all.to_vec());
    let stated = |value: f64| is_stated(value).then_some(value);
    axes.into_iter().map(stated).collect()
}

/// A jointtarget: joints in degrees, external axes.
pub(crate) fn joints_of(expression: &Expression) -> Option<(Vec<f64>, Vec<Option<f64>>)> {
    let Value::List(parts) = &expression.value else {
        return None;
    };
    let [joints, external] = parts.as_slice() else {
        return None;
    };
    Some((values::<6>(joints)?.to_vec(), external_axes(external)))
}

/// A pose: `[[x,y,z],[q1,q2,q3,q4]]`.
pub(crate) fn frame_of(expression: &Expression) -> Option<Isometry3<f64>> {
    let Value::List(parts) = &expression.value else {
        return None;
    };
    let [place, orientation] = parts.as_slice() else {
        return None;
    };
    let rotation = OrientationText::Quaternion.rotation_of(&values::<4>(orientation)?)?;
    let place = Translation3::from(Vector3::from(values::<3>(place)?));
    Some(Isometry3::from_parts(place, rotation))
}

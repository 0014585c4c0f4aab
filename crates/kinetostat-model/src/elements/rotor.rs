//! Rotors of drives: from what is written to SI.

use std::f64::consts::TAU;

use kinetostat::MotionKind;
use kinetostat::model::DriveRotor;
use kinetostat::number::short;

use crate::elements::quantity::{MM, ReadResult, by_kind, choices};
use crate::problem::{Finding, KeyPath};
use crate::schema::RotorTable;

/// The rotor of a drive with a stiffness (N/m or N m/rad; none where it is rigid).
pub(crate) fn rotor(
    place: &KeyPath,
    kind: MotionKind,
    stiffness: Option<f64>,
    table: &RotorTable,
) -> ReadResult<DriveRotor> {
    let Some(stiffness) = stiffness else {
        return Err(Finding::new(
            place,
            "the drive is rigid, so its rotor does not move",
            "write the drive's stiffness, or leave the rotor out",
        ));
    };
    let above_zero = |key: &str, what: &str, value: f64| match value > 0.0 {
        true => Ok(value),
        false => Err(Finding::new(
            &place.key(key),
            format!("{what} is {value}, a number above zero is needed"),
            "write the figure of the motor's data sheet",
        )),
    };
    let inertia = above_zero("inertia_kg_m2", "the inertia", table.inertia_kg_m2)?;
    let leads = choices!(table, (lead_mm_per_turn, MM), (lead_m_per_turn, 1.0));
    let given = by_kind(place, "ratio", kind, &leads, &choices!(table, (ratio, 1.0)))?;
    let Some(given) = given else {
        let (reason, remedy) = match kind {
            MotionKind::Prismatic => (
                "how far the slide goes for a turn of the rotor is missing",
                "write lead_mm_per_turn",
            ),
            MotionKind::Revolute => (
                "the ratio of the transmission is missing",
                "write ratio: turns of the rotor for one turn of the joint (1 for a motor at the joint)",
            ),
        };
        return Err(Finding::new(place, reason, remedy));
    };
    // The direction of rotation does not matter.
    let value = above_zero(given.key, &format!("'{}'", given.key), given.value.abs())?;
    let ratio = match kind {
        MotionKind::Prismatic => TAU / value,
        MotionKind::Revolute => value,
    };
    let servo = by_kind(
        place,
        "stiffness of the servo",
        kind,
        &choices!(
            table,
            (servo_stiffness_n_per_m, 1.0),
            (servo_stiffness_n_per_mm, 1.0 / MM)
        ),
        &choices!(
            table,
            (servo_stiffness_n_m_per_rad, 1.0),
            (servo_stiffness_n_mm_per_rad, MM)
        ),
    )?;
    let (unit, key) = match kind {
        MotionKind::Prismatic => ("N/m", "servo_stiffness_n_per_m"),
        MotionKind::Revolute => ("N m/rad", "servo_stiffness_n_m_per_rad"),
    };
    let Some(servo) = servo else {
        return Err(Finding::new(
            place,
            "the stiffness of the servo is missing: with a motor that does not give way its rotor does not move",
            format!("write {key}, or leave the rotor out"),
        ));
    };
    if servo.value <= stiffness {
        return Err(Finding::new(
            &place.key(servo.key),
            format!(
                "the servo has {} {unit}, and the whole drive {}: servo and transmission in series are softer than either",
                short(servo.value),
                short(stiffness)
            ),
            "the drive's stiffness is that with the servo in control; write one of the servo above it",
        ));
    }
    Ok(DriveRotor {
        inertia,
        ratio,
        servo_stiffness: servo.value,
    })
}

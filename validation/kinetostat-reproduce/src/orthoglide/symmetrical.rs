//! Figure 7.2: the method of the symmetrical trajectory, on the groove of section 7.5.
//!
//! [R 7.2] draws it without numbers: a first trial is cut, the target is mirrored at the desired path, and the trial is repeated
//! with that. The machine is that of chapter 7, so that the trials can be calculated: errors of assembly and the cutting force, at
//! every angle of the circle.

use kinetostat::Mechanism;
use kinetostat::number::larger;
use kinetostat::spatial::pose_residual;
use kinetostat_report::Plot;
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::orthoglide::circle::{READINGS, Reading};
use crate::orthoglide::groove::closed_paths;
use crate::orthoglide::machine::{POINTS, cutting, target};
use crate::{Cause, Contents, Item};

/// Trials: the program as it is drawn, and mirrored three times.
const TRIALS: usize = 4;

/// Angles of the circle.
const ANGLES: u32 = 72;

/// Magnification of drawn deviations.
const DRAWN: f64 = 5.0;

/// Trials at one angle: desired place from the centre, commanded and reached place, mm.
struct Angle {
    desired: Vector3<f64>,
    trials: [(Vector3<f64>, Vector3<f64>); TRIALS],
}

impl Angle {
    /// Error of a trial, mm.
    fn off(&self, trial: usize) -> f64 {
        (self.trials[trial].1 - self.desired).norm()
    }
}

/// The trials at an angle, with a share of the cutting force.
fn trials(
    machine: &Mechanism,
    (centre, desired): (Vector3<f64>, Vector3<f64>),
    angle: f64,
    share: f64,
) -> Result<Angle, Cause> {
    let place = target((centre + desired).into());
    let wrench = cutting(angle) * share;
    let mut sent = desired;
    let mut found = [(Vector3::zeros(), Vector3::zeros()); TRIALS];
    for trial in &mut found {
        let command = target((centre + sent).into());
        let tool = machine.posture(&command)?.deflected_by(&wrench)?.tool;
        // Simulated measurement of this trial.
        let deviation = -pose_residual(&place, &tool).linear();
        *trial = (1e3 * sent, 1e3 * (desired + deviation));
        // The target of the next trial: mirrored at the desired place.
        sent -= deviation;
    }
    Ok(Angle {
        desired: 1e3 * desired,
        trials: found,
    })
}

/// The circle about Q1 through the trials.
fn circle(reading: &Reading, share: f64) -> Result<Vec<Angle>, Cause> {
    let [_, actual] = reading.machines()?;
    let centre = reading.centre(POINTS[1].1);
    (0..=ANGLES)
        .into_par_iter()
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(ANGLES);
            let desired = Vector3::new(angle.cos(), angle.sin(), 0.0) * reading.radius;
            trials(&actual, (centre, desired), angle, share)
        })
        .collect()
}

fn most(angles: &[Angle], trial: usize) -> f64 {
    let off = angles.iter().map(|angle| angle.off(trial));
    off.fold(f64::NEG_INFINITY, larger)
}

pub(crate) fn fig_7_2() -> Result<Contents, Cause> {
    let mut items = Vec::new();
    let mut plots = Vec::new();
    for reading in [&READINGS[0], &READINGS[2]] {
        let angles = circle(reading, 1.0)?;
        let letter = reading.name.split(' ').next().unwrap_or_default();
        let note = format!(
            "Q1, errors of the legs and cutting force, reading {}; the figure prints no digits",
            reading.name
        );
        let names = [
            "as drawn",
            "mirrored once",
            "mirrored twice",
            "mirrored three times",
        ];
        for (trial, name) in names.into_iter().enumerate() {
            items.push(Item::unprinted(
                format!("reading {letter}: largest error, {name}"),
                most(&angles, trial),
                "mm",
                &note,
            ));
        }
        let half = circle(reading, 0.5)?;
        items.push(Item::unprinted(
            format!("reading {letter}: error mirrored once, by that with half the force"),
            most(&angles, 1) / most(&half, 1),
            "",
            &format!(
                "{note}. With a linear machine one trial would do, as the text assumes; what it leaves is of second order: 4 of the force alone, less with errors of the legs, which stay"
            ),
        ));
        plots.push(drawn(reading, &angles));
    }
    Ok(Contents { items, plots })
}

/// The paths of the figure.
fn drawn(reading: &Reading, angles: &[Angle]) -> Plot {
    let larger = |angle: &Angle, place: Vector3<f64>| {
        let drawn = angle.desired + DRAWN * (place - angle.desired);
        (drawn.x, drawn.y)
    };
    let path = |of: &dyn Fn(&Angle) -> Vector3<f64>| -> Vec<(f64, f64)> {
        angles.iter().map(|a| larger(a, of(a))).collect()
    };
    closed_paths(
        format!(
            "Method of the symmetrical trajectory, circle about Q1, deviations {DRAWN} times; reading {}",
            reading.name
        ),
        vec![
            ("desired", path(&|a| a.desired)),
            ("obtained", path(&|a| a.trials[0].1)),
            ("mirrored target", path(&|a| a.trials[1].0)),
            ("obtained with it", path(&|a| a.trials[1].1)),
        ],
    )
}

//! A groove milled in a circle, compensated [R 7.5]: the machine, the circle and the load at every
//! angle, and what the report's figures show of it.

use kinetostat::number::larger;
use kinetostat::number::smaller;
use kinetostat::{
    Directions, Mechanism, Pose, Settings, Wrench, compensate, spatial::pose_residual,
};
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::Cause;
use crate::orthoglide::line::Sources;
use crate::orthoglide::machine::{Orthoglide, cutting, target};

/// Points of a circle.
const POINTS: u32 = 72;

/// Directions that are compensated: three drives move the tool in three directions.
pub(super) const POSITION: Directions = Directions::POSITION;

/// Reading of chapter 7, which leaves the stiffness of the drives and the place of the circles open.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub(super) name: &'static str,
    /// N/m.
    pub(super) drive: f64,
    /// m.
    pub(super) radius: f64,
    /// The circle's centre lies one radius along x and y inside the corner, not at it.
    pub(super) inside: bool,
}

/// Readings of the reference numbers, section 2.6.
pub(super) const READINGS: [Reading; 4] = [
    Reading {
        name: "A (rigid drives, 50 mm circle about the point)",
        drive: super::machine::RIGID_DRIVE,
        radius: 0.025,
        inside: false,
    },
    Reading {
        name: "A' (rigid drives, 2 mm circle about the point)",
        drive: super::machine::RIGID_DRIVE,
        radius: 0.001,
        inside: false,
    },
    Reading {
        name: "B (drives of 1000 N/mm, 50 mm circle inside the corner)",
        drive: 1.0e6,
        radius: 0.025,
        inside: true,
    },
    Reading {
        name: "B' (drives of 900 N/mm, 50 mm circle inside the corner)",
        drive: 0.9e6,
        radius: 0.025,
        inside: true,
    },
];

/// Point at one angle of a circle.
#[derive(Clone, Debug)]
pub(super) struct At {
    /// rad.
    pub(super) angle: f64,
    /// Desired place from the circle's centre, mm.
    pub(super) desired: Vector3<f64>,
    /// Displacements without compensation, mm.
    pub(super) sources: Sources,
    /// Target commanded from the desired place, mm.
    pub(super) correction: Vector3<f64>,
    /// Distance (mm) and rotation (rad) that are left when the compensated machine is loaded again.
    pub(super) left: (f64, f64),
    /// Change of the commands, mm.
    pub(super) commands: Vector3<f64>,
    /// Forces of the actuators with compensation, N.
    pub(super) forces: Vector3<f64>,
}

impl At {
    /// Radial component of a displacement (mm) in the plane of the circle: outwards positive.
    pub(super) fn outwards(&self, displacement: Vector3<f64>) -> f64 {
        (self.desired + displacement).xy().norm() - self.desired.norm()
    }
}

/// A circle in the xy plane about a point of the workspace.
#[derive(Clone, Debug)]
pub(super) struct Circle {
    pub(super) points: Vec<At>,
}

fn three(values: &[f64]) -> Vector3<f64> {
    Vector3::from_fn(|i, _| values.get(i).copied().unwrap_or(0.0))
}

impl Reading {
    /// The machine without errors of its legs, and with them.
    pub(super) fn machines(&self) -> Result<[Mechanism; 2], Cause> {
        let actual = Orthoglide {
            drive: self.drive,
            ..Orthoglide::case_b()
        };
        let perfect = Orthoglide {
            line_error: 0.0,
            ..actual
        };
        Ok([perfect.build()?, actual.build()?])
    }

    /// Centre (m) of the circle at a point of the workspace.
    pub(super) fn centre(&self, point: [f64; 3]) -> Vector3<f64> {
        let mut centre = Vector3::from(point);
        if self.inside {
            for k in 0..2 {
                if centre[k] != 0.0 {
                    centre[k] -= self.radius.copysign(centre[k]);
                }
            }
        }
        centre
    }

    /// The circle at a point of the workspace (m).
    pub(super) fn circle(&self, point: [f64; 3]) -> Result<Circle, Cause> {
        let [perfect, actual] = self.machines()?;
        let centre = self.centre(point);
        let points = (0..=POINTS)
            .into_par_iter()
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(POINTS);
                let desired = Vector3::new(angle.cos(), angle.sin(), 0.0) * self.radius;
                let place = (centre + desired).into();
                let wrench = cutting(angle);
                let sources = Sources::at(&perfect, &actual, place, &wrench)?;
                let plain = actual.posture(&target(place))?;
                let c = compensate(
                    &actual,
                    &target(place),
                    &wrench,
                    POSITION,
                    &Settings::default(),
                )?;
                let again = c.posture.deflected_by(&wrench)?;
                let left = pose_residual(&again.tool, &target(place));
                Ok(At {
                    angle,
                    desired: desired * 1e3,
                    sources,
                    correction: c.correction.linear() * 1e3,
                    left: (left.linear().norm() * 1e3, left.angular().norm()),
                    commands: (three(&c.posture.commands()) - three(&plain.commands())) * 1e3,
                    forces: three(&again.actuator_forces()),
                })
            })
            .collect::<Result<Vec<At>, Cause>>()?;
        Ok(Circle { points })
    }

    /// Steps that the report's own iteration (7.13) needs with `alpha = 1` until the tool is within
    /// 1e-9 mm of its place: the largest number at four angles of the circle.
    pub(super) fn steps(&self, point: [f64; 3]) -> Result<u32, Cause> {
        let [_, actual] = self.machines()?;
        let centre = self.centre(point);
        let mut most = 0;
        for k in 0..4 {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(k);
            let place = centre + Vector3::new(angle.cos(), angle.sin(), 0.0) * self.radius;
            most = most.max(fixed_point(
                &actual,
                &target(place.into()),
                &cutting(angle),
            )?);
        }
        Ok(most)
    }
}

/// (7.13) with `alpha = 1` for the position.
fn fixed_point(machine: &Mechanism, desired: &Pose, wrench: &Wrench) -> Result<u32, Cause> {
    let mut command = *desired;
    for step in 0..40 {
        let tool = machine.posture(&command)?.deflected_by(wrench)?.tool;
        let residual = pose_residual(desired, &tool).linear();
        if residual.norm() < 1e-12 {
            return Ok(step);
        }
        command.translation.vector += residual;
    }
    Err(Cause::Missing("the end of iteration (7.13)".to_owned()))
}

impl Circle {
    /// Largest value along the circle.
    pub(super) fn most(&self, value: impl Fn(&At) -> f64) -> f64 {
        self.points
            .iter()
            .map(value)
            .fold(f64::NEG_INFINITY, larger)
    }

    /// Largest displacement by the cutting force alone, mm.
    pub(super) fn compliance(&self) -> f64 {
        self.most(|p| p.sources.force.norm())
    }

    /// Largest change of the commands, norm of the three, mm.
    pub(super) fn commands(&self) -> f64 {
        self.most(|p| p.commands.norm())
    }

    /// Largest change of one command, mm.
    pub(super) fn one_command(&self) -> f64 {
        self.most(|p| p.commands.amax())
    }

    /// Largest force of an actuator, N.
    pub(super) fn force(&self) -> f64 {
        self.most(|p| p.forces.amax())
    }

    /// Smallest value along the circle.
    pub(super) fn least(&self, value: impl Fn(&At) -> f64) -> f64 {
        self.points.iter().map(value).fold(f64::INFINITY, smaller)
    }

    /// Mean over the circle (the last point repeats the first).
    #[allow(clippy::cast_precision_loss)] // a few dozen points
    pub(super) fn mean(&self, value: impl Fn(&At) -> Vector3<f64>) -> Vector3<f64> {
        let own = self.points.len().saturating_sub(1).max(1);
        self.points
            .iter()
            .take(own)
            .map(value)
            .sum::<Vector3<f64>>()
            / own as f64
    }
}

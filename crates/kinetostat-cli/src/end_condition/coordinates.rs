//! Coordinates of a chain: names, units, values, and the line through its joints.

use kinetostat::{Chain, MotionKind, Pose, Role};
use serde::Serialize;

use crate::machine::units::unit_of;

/// What every coordinate of a chain is, for people and for tables.
pub(crate) fn coordinates_of(chain: &Chain, commands: &[f64]) -> Vec<CoordinateName> {
    let list = chain.coordinates().iter().enumerate();
    list.map(|(i, c)| {
        let actuator = chain
            .actuators()
            .iter()
            .position(|a| a.coordinate == Some(i));
        CoordinateName {
            name: c.name.clone(),
            kind: match (c.role, actuator) {
                (Role::Passive, _) => "passive joint",
                (Role::Spring, Some(_)) => "drive",
                (Role::Spring, None) => "spring",
            },
            unit: match c.kind {
                MotionKind::Revolute => "deg",
                MotionKind::Prismatic => "mm",
            },
            command: actuator.map_or(0.0, |a| commands[a] * unit_of(c.kind)),
        }
    })
    .collect()
}

/// Values of all coordinates of a chain in their units; of a drive the joint's whole position,
/// command included.
pub(crate) fn values_of(chain: &Chain, commands: &[f64], coordinates: &[f64]) -> Vec<f64> {
    coordinates_of(chain, commands)
        .iter()
        .zip(chain.coordinates())
        .zip(coordinates)
        .map(|((name, c), x)| name.command + x * unit_of(c.kind))
        .collect()
}

/// Places along a chain at a state, base to tip, m, without repetition.
pub(crate) fn outline_of(
    chain: &Chain,
    base: &Pose,
    commands: &[f64],
    coordinates: &[f64],
) -> Vec<nalgebra::Vector3<f64>> {
    use kinetostat::Element;
    let mut pose = *base;
    let mut points = vec![pose.translation.vector];
    for element in chain.elements() {
        match element {
            Element::Rigid(offset) => pose *= offset,
            Element::Node(_) => {}
            Element::Motion(motion) => {
                let mut by = 0.0;
                if let Some(d) = motion.coordinate {
                    by += d.ratio * coordinates[d.index];
                }
                if let Some(d) = motion.command {
                    by += d.ratio * commands[d.index];
                }
                pose *= match motion.kind {
                    MotionKind::Revolute => Pose::rotation(motion.axis.into_inner() * by),
                    MotionKind::Prismatic => {
                        let t = motion.axis.into_inner() * by;
                        Pose::translation(t.x, t.y, t.z)
                    }
                };
            }
        }
        let here = pose.translation.vector;
        let last = points.last().copied().unwrap_or_default();
        if (here - last).norm() > 1e-9 * chain.scale().length {
            points.push(here);
        }
    }
    points
}

/// A coordinate of the chain.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CoordinateName {
    pub(crate) name: String,
    /// passive joint, drive or spring.
    pub(crate) kind: &'static str,
    pub(crate) unit: &'static str,
    /// Command of a drive, in its unit; 0 otherwise.
    pub(crate) command: f64,
}

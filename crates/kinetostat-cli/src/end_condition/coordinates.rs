//! Coordinates of a chain: names, units, values, and the line through its joints.

use kinetostat::model::Role;
use kinetostat::{Chain, MotionKind};
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::units::unit_of;

/// Names of all coordinates of a chain, for people and for tables.
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

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct CoordinateName {
    pub(crate) name: String,
    /// passive joint, drive or spring.
    pub(crate) kind: &'static str,
    pub(crate) unit: &'static str,
    /// Command of a drive, in its unit; 0 otherwise.
    pub(crate) command: f64,
}

pub(crate) const WRENCH_AND_PLACE: [&str; 12] = [
    "fx_n", "fy_n", "fz_n", "mx_n_m", "my_n_m", "mz_n_m", "x_mm", "y_mm", "z_mm", "rx_deg",
    "ry_deg", "rz_deg",
];

pub(crate) fn column(c: &CoordinateName) -> String {
    let name = format!("{}_{}", c.name, c.unit);
    // A spreadsheet would take it for a formula.
    if name.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{name}")
    } else {
        name
    }
}

pub(crate) fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.to_owned()
}

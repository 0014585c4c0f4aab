//! Every robot of the library: its file, inverse kinematics, home posture, and its stiffness against
//! a dense global system.

mod figures;
mod machine;
mod msa;
mod urdf;

use kinetostat::{Error, Mechanism, Posture};
use kinetostat_model::Model;
use nalgebra::Vector3;
use serde_json::{Value, json};

/// Prints a figure, which `cargo xtask figures` collects, and holds it.
#[allow(clippy::print_stdout, reason = "read by cargo xtask figures")]
pub fn figure(name: &str, measured: Value, asked: &str, unit: &str, holds: bool) {
    let figure = json!({
        "name": name, "measured": measured, "asked": asked, "unit": unit, "holds": holds,
    });
    println!("figure {figure}");
    assert!(holds, "{name} falls short: {measured}, asked {asked}");
}

/// Random numbers between -1 and 1, always the same.
pub struct Random(pub u64);

impl Random {
    /// The next one.
    pub fn number(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Three of them.
    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.number())
    }
}

/// The names of the library.
pub fn names() -> Vec<&'static str> {
    let presets = kinetostat_model::preset_names();
    presets.iter().map(|p| p.name).collect()
}

/// A machine of the library.
pub fn preset(name: &str) -> Model {
    Model::preset(name).unwrap_or_else(|e| panic!("{e}"))
}

/// The posture at a target or, where the machine cannot take it exactly (a planar machine, a tripod that
/// turns by the way), at the nearest place that it can.
pub fn posture_near<'m>(
    mechanism: &'m Mechanism,
    target: &kinetostat::Pose,
    start: &Posture<'m>,
) -> Posture<'m> {
    let mut at = *target;
    for _ in 0..20 {
        match mechanism.posture_near(&at, start) {
            Ok(posture) => return posture,
            Err(Error::Unreachable { nearest, .. }) => at = *nearest,
            Err(e) => panic!("{}: {e}", mechanism.name()),
        }
    }
    panic!("{}: no place near {at}", mechanism.name());
}

//! Every robot of the library: its file, inverse kinematics, home posture, and its stiffness against
//! a dense global system.

mod figures;
mod machine;
mod msa;
mod urdf;

use kinetostat::{Pose, Posture, PostureRequest, Wrench, model::Role, spatial::pose_residual};
use kinetostat_model::Model;
use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, DVector, Vector3};
use serde_json::{Value, json};

/// Prints a figure, which `cargo xtask figures` collects, and holds it.
#[allow(clippy::print_stdout, reason = "read by cargo xtask figures")]
pub fn figure(name: &str, measured: Value, expected: &str, unit: &str, holds: bool) {
    let figure = json!({
        "name": name, "measured": measured, "asked": expected, "unit": unit, "holds": holds,
    });
    println!("figure {figure}");
    assert!(holds, "{name} falls short: {measured}, asked {expected}");
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

/// The posture at a target or, where the machine cannot take it (a planar machine, a tripod that shifts
/// by the way), at a place near it: commands are changed until the unloaded machine stands as near
/// as it can, and inverse kinematics has to find these commands again.
pub fn posture_near(model: &Model, target: &Pose, start: &Posture) -> Posture {
    let mechanism = &model.mechanism;
    if let Ok(posture) = mechanism.posture(PostureRequest::pose(target).near(start)) {
        return posture;
    }
    let count = start.commands().len();
    if count == 0 {
        return start.clone();
    }
    let mut light = model.document.clone();
    light.mechanism.gravity_m_per_s2 = Some([0.0; 3]);
    light.limb.iter_mut().for_each(|l| l.load.clear());
    let light = Model::from_document(&light, model.name()).expect("without weights");
    let length = start.stiffness().expect("a stiffness").length;
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    // Where the machine stands, and how far its springs are deflected: redundant drives can fight.
    let stand = |change: &DVector<f64>| {
        let mut limbs = start.limbs().to_vec();
        let commands = limbs.iter_mut().flat_map(|l| l.commands.iter_mut());
        for (command, change) in commands.zip(change.iter()) {
            *command += change;
        }
        let posture = light
            .mechanism
            .posture(PostureRequest::joints(start.target(), limbs));
        let rest = posture.expect("joints").deflected_by(&Wrench::zero());
        let rest = rest.unwrap_or_else(|e| panic!("{}: {e}", model.name()));
        let limbs = light.mechanism.limbs().iter().zip(&rest.limbs);
        let springs: Vec<f64> = limbs
            .flat_map(|(limb, found)| {
                let chain = &limb.nominal;
                let own = chain.indices_of(Role::Spring).into_iter();
                own.map(|i| found.coordinates[i] - chain.coordinates()[i].home)
            })
            .collect();
        (rest.tool, springs)
    };
    // From one stand to another, springs counted a thousand times.
    let twist_between = |from: &(Pose, Vec<f64>), to: &(Pose, Vec<f64>)| {
        let tool = pose_residual(&to.0, &from.0).0;
        DVector::from_fn(6 + from.1.len(), |i, _| match i {
            0..6 => tool[i] * unit(i),
            _ => 1e3 * (to.1[i - 6] - from.1[i - 6]),
        })
    };
    let mut change = DVector::zeros(count);
    let mut inverse = DMatrix::zeros(0, 0);
    for round in 0..12 {
        let here = stand(&change);
        let still = vec![0.0; here.1.len()];
        // At last only the fight is ended.
        let wanted = (if round < 6 { *target } else { here.0 }, still);
        if round % 6 == 0 {
            let mut rates = DMatrix::zeros(6 + here.1.len(), count);
            for j in 0..count {
                let mut more = change.clone();
                more[j] += 1e-4;
                rates.set_column(j, &(twist_between(&here, &stand(&more)) / 1e-4));
            }
            inverse = {
                let own = kinetostat::linalg::SingularValues::of(&rates);
                own.pseudo_inverse(1e-6 / own.largest())
            };
        }
        let step = &inverse * twist_between(&here, &wanted);
        change += &step;
        if round >= 6 && step.largest_entry() < 1e-13 {
            break;
        }
    }
    let at = stand(&change).0;
    let posture = mechanism.posture(PostureRequest::pose(&at).near(start));
    let posture = posture.unwrap_or_else(|e| panic!("{}: {e}", model.name()));
    // Redundant drives may share the way otherwise.
    if posture.redundancy() == 0 {
        for ((found, given), change) in posture.commands().iter().zip(start.commands()).zip(&change)
        {
            assert!((found - given - change).abs() < 1e-9, "{}", model.name());
        }
    }
    posture
}

/// Whether a machine can turn its tool.
pub fn turns(posture: &Posture) -> bool {
    let motions = posture.mobility();
    motions.nrows() == 6 && motions.rows(3, 3).largest_entry() > 1e-6
}

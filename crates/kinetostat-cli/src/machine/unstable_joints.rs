//! Unstable joints, and the loads that push them: for `check` and `deflect`.

use kinetostat::{
    Mechanism, MechanismEquilibrium, MotionKind, Posture, machine::NegativeNetStiffness,
};
use kinetostat_model::Model;
use schemars::JsonSchema;
use serde::Serialize;

use crate::ui::numbers::number;

/// A joint whose spring the loads beat.
#[derive(Serialize, JsonSchema)]
pub(crate) struct UnstableJoint {
    pub(crate) limb: String,
    pub(crate) joint: String,
    /// Unit of all stiffnesses here: `N/m` or `N m/rad`.
    pub(crate) unit: &'static str,
    pub(crate) spring_stiffness: f64,
    /// Stiffness by all loads on the limb together; negative, and larger than the spring's.
    pub(crate) stiffness_by_loads: f64,
    /// The loads with a negative share, the worst first.
    pub(crate) loads: Vec<DestabilisingLoad>,
}

/// A load's share.
#[derive(Serialize, JsonSchema)]
pub(crate) struct DestabilisingLoad {
    pub(crate) name: String,
    pub(crate) stiffness: f64,
}

/// Names of the loads on every limb, in the order of the mechanism.
pub(crate) fn load_names(model: &Model) -> Vec<Vec<String>> {
    let limbs = model.document.limb.iter();
    limbs
        .map(|l| l.load.iter().map(|load| load.name().to_owned()).collect())
        .collect()
}

/// The joints that run away at an equilibrium that is not stable; none where it is.
pub(crate) fn unstable_joints(
    posture: &Posture,
    at: &MechanismEquilibrium,
    load_names: &[Vec<String>],
) -> Vec<UnstableJoint> {
    if at.stable() {
        return Vec::new();
    }
    // The equilibrium is one of this posture.
    let found = posture.negative_net_stiffnesses(at).unwrap_or_default();
    let mechanism = posture.mechanism();
    found
        .iter()
        .map(|spring| written(mechanism, spring, load_names))
        .collect()
}

fn written(
    m: &Mechanism,
    spring: &NegativeNetStiffness,
    load_names: &[Vec<String>],
) -> UnstableJoint {
    let names = load_names.get(spring.limb).map_or(&[][..], Vec::as_slice);
    let shares = names.iter().cloned().zip(spring.by_load.iter().copied());
    let weights = std::iter::once(("weight".to_owned(), spring.by_gravity));
    let mut loads: Vec<DestabilisingLoad> = shares
        .chain(weights)
        .filter(|(_, stiffness)| *stiffness < 0.0)
        .map(|(name, stiffness)| DestabilisingLoad { name, stiffness })
        .collect();
    loads.sort_by(|a, b| a.stiffness.total_cmp(&b.stiffness));
    UnstableJoint {
        limb: m.limbs()[spring.limb].name.clone(),
        joint: spring.coordinate.clone(),
        unit: match spring.kind {
            MotionKind::Prismatic => "N/m",
            MotionKind::Revolute => "N m/rad",
        },
        spring_stiffness: spring.spring,
        stiffness_by_loads: spring.by_all,
        loads,
    }
}

impl UnstableJoint {
    /// One sentence.
    pub(crate) fn description(&self) -> String {
        let mut text = format!(
            "limb '{}', joint '{}' runs away: its spring holds with {} {}, the loads take {}",
            self.limb,
            self.joint,
            number(self.spring_stiffness, 4),
            self.unit,
            number(-self.stiffness_by_loads, 4),
        );
        let named: Vec<String> = self
            .loads
            .iter()
            .map(|l| format!("'{}' {}", l.name, number(-l.stiffness, 4)))
            .collect();
        if !named.is_empty() {
            text.push_str(&format!(" ({})", named.join(", ")));
        }
        text
    }
}

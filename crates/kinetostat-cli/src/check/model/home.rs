//! A machine at home: mobility, what holds it, what its own loads do.

use kinetostat::number::larger;
use kinetostat::{Mechanism, MechanismEquilibrium, Posture, Wrench};
use kinetostat_analysis::limb_motions::{directions_held_by_limb, redundant_actuators};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::check::model::assumptions::{AssumptionsFinding, assumptions};
use crate::check::model::limbs::LimbFinding;
use crate::machine::principal_directions::{Principal, principal, uneven};
use crate::machine::unstable_joints::{UnstableJoint, unstable_joints};

#[derive(Serialize, JsonSchema)]
pub(crate) struct HomeFinding {
    pub(crate) mobility: usize,
    pub(crate) actuators: usize,
    pub(crate) degrees_of_over_constraint: usize,
    /// Sets of wrenches by which the limbs can strain each other without any load, about each
    /// limb's tip in base axes.
    pub(crate) over_constraints: Vec<String>,
    /// Independent ways in which actuators can move while the tool stays.
    pub(crate) redundant_motions: usize,
    /// Joints that move while both ends of their limb stay: `limb: joint`.
    pub(crate) redundant_actuators: Vec<String>,
    pub(crate) redundant_passive_joints: Vec<String>,
    pub(crate) correctable_directions: Vec<&'static str>,
    pub(crate) stiffness_rank: usize,
    pub(crate) principal_directions: Vec<Principal>,
    pub(crate) shift_without_load_mm: [f64; 3],
    pub(crate) rotation_without_load_deg: [f64; 3],
    pub(crate) largest_internal_force_n: f64,
    pub(crate) largest_internal_moment_n_m: f64,
    /// True if every limb keeps its shape while the tool is held.
    pub(crate) shapes_stable: bool,
    /// The tool stays where it is.
    pub(crate) platform_stable: bool,
    /// Both.
    pub(crate) stable: bool,
    /// True if it does not diverge without a potential, but may swing with growing amplitude.
    pub(crate) may_flutter: bool,
    /// Joints whose springs the loads beat; empty where it is stable.
    pub(crate) overcome_joints: Vec<UnstableJoint>,
    pub(crate) conservative: bool,
    pub(crate) largest_share_to_buckling: Option<f64>,
}

const DIRECTIONS: [&str; 6] = [
    "x",
    "y",
    "z",
    "turn about x",
    "turn about y",
    "turn about z",
];

pub(crate) fn at_home(
    m: &Mechanism,
    posture: &Posture,
    force: Option<Vector3<f64>>,
    limbs: &mut [LimbFinding],
    load_names: &[Vec<String>],
) -> kinetostat::Result<(HomeFinding, AssumptionsFinding)> {
    let stiffness = posture.stiffness()?;
    for (i, found) in limbs.iter_mut().enumerate() {
        let k = &stiffness.limbs[i];
        found
            .redundant_passive_joints
            .clone_from(&k.redundant_passive);
        found.stiffness_rank = Some(k.rank);
        found.constrained_directions = directions_held_by_limb(posture, i);
    }
    let mobility = posture.mobility().ncols();
    let correctable = posture.correctable();
    let rest = posture.deflected_by(&Wrench::zero())?;
    let over = posture.overconstraint();
    let mut assumptions = assumptions(posture, &rest, force);
    assumptions
        .warnings
        .extend(uneven(m, &stiffness.directions));
    let home = HomeFinding {
        mobility,
        actuators: m.actuator_count(),
        degrees_of_over_constraint: over.degree,
        over_constraints: over
            .stresses
            .iter()
            .map(|s| self_stress_text(&s.description(posture)))
            .collect(),
        redundant_motions: posture.redundancy(),
        redundant_actuators: (0..limbs.len())
            .flat_map(|i| {
                let limb = &m.limbs()[i];
                let names = redundant_actuators(posture, i).into_iter();
                names.map(move |a| format!("{}: {}", limb.name, limb.nominal.actuators()[a].name))
            })
            .collect(),
        redundant_passive_joints: limbs
            .iter()
            .flat_map(|l| {
                let joints = l.redundant_passive_joints.iter();
                joints.map(|j| format!("{}: {j}", l.name))
            })
            .collect(),
        correctable_directions: correctable.iter().map(|k| DIRECTIONS[k]).collect(),
        stiffness_rank: stiffness.rank(),
        principal_directions: stiffness.directions.iter().map(principal).collect(),
        shift_without_load_mm: (rest.displacement.linear() * 1e3).into(),
        rotation_without_load_deg: rest.displacement.angular().map(f64::to_degrees).into(),
        largest_internal_force_n: largest(&rest, |w| w.force().norm()),
        largest_internal_moment_n_m: largest(&rest, |w| w.moment().norm()),
        shapes_stable: rest.shapes_stable(),
        platform_stable: rest.platform.stable,
        stable: rest.stable(),
        may_flutter: rest.may_flutter(),
        overcome_joints: unstable_joints(posture, &rest, load_names),
        conservative: rest.conservative,
        largest_share_to_buckling: rest.share_to_buckling().filter(|m| m.is_finite()),
    };
    Ok((home, assumptions))
}

/// A set of wrenches in equilibrium: `leg x with a moment about x, against leg z with a moment about x`.
fn self_stress_text(words: &str) -> String {
    let limbs = words.split("; ").map(|part| match part.split_once(": ") {
        Some((limb, wrench)) => {
            let wrench = wrench
                .replace("force", "a force")
                .replace("moment", "a moment");
            format!("{limb} with {wrench}")
        }
        None => part.to_owned(),
    });
    limbs.collect::<Vec<_>>().join(", against ")
}

fn largest(e: &MechanismEquilibrium, size: impl Fn(&Wrench) -> f64) -> f64 {
    e.limbs.iter().map(|l| size(&l.wrench)).fold(0.0, larger)
}

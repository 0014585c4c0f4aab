//! The answer at one place, stable names with units.

use kinetostat::{
    DirectionKind, Mechanism, MechanismEquilibrium, MotionKind, Posture, chain::FoundBy,
};
use kinetostat_analysis::instability::InstabilityShares;
use kinetostat_machining::{NearSingular, Warning, WarningCode, folds, number as formatter};
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::displacement_warnings::not_stable;
use crate::machine::instability;
use crate::machine::principal_directions::motion_description;
use crate::machine::unstable_joints::{UnstableJoint, unstable_joints};
use crate::place::joints::JointValue;
use crate::place::query::{AnswerHead, PlaceQuery};

/// The answer at one place, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Deflection {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) displacement_mm: [f64; 3],
    pub(crate) displacement_size_mm: f64,
    /// Displacement of the tool by the load.
    pub(crate) displacement_by_load_mm: [f64; 3],
    pub(crate) displacement_by_load_size_mm: f64,
    /// Displacement of the unloaded tool from its commanded pose: by own weight, other loads of the model and its deviations.
    pub(crate) displacement_without_load_mm: [f64; 3],
    pub(crate) displacement_without_load_size_mm: f64,
    pub(crate) rotation_vector_deg: [f64; 3],
    pub(crate) rotation_size_deg: f64,
    pub(crate) actuators: Vec<ActuatorAnswer>,
    /// Displayed values of the controller, in the order of its axes; empty without a section `controller`.
    #[serde(rename = "pendant")]
    pub(crate) on_controller: Vec<JointValue>,
    pub(crate) limbs: Vec<LimbAnswer>,
    /// Stiffness in the softest direction, the tool free to turn; none if no force moves it.
    #[schemars(with = "Option<f64>")]
    pub(crate) smallest_stiffness_n_per_mm: f64,
    pub(crate) free_directions: usize,
    /// Motions by which the tool runs away by itself: `turns about z by arm: q`.
    pub(crate) negative_directions: Vec<String>,
    /// The tool stays where it is, or does not diverge at least (see `platform_may_flutter`).
    pub(crate) platform_stable: bool,
    /// True if the tool does not diverge without a potential, but may swing with growing amplitude.
    pub(crate) platform_may_flutter: bool,
    /// Share of the way to instability of the machine with its tool free, 1 at instability: never
    /// less than the largest share of its limbs. At least 1 or none if unstable; after a
    /// snap-through the share of the equilibrium reported here.
    pub(crate) share_to_instability_of_free_machine: Option<f64>,
    /// Share of the free machine, if it exceeds those of its limbs.
    #[serde(skip)]
    pub(crate) free_beyond_limbs: Option<f64>,
    /// The load cannot be reached from rest without a snap.
    #[serde(skip)]
    pub(crate) snapped: bool,
    /// True if every limb keeps its shape while the tool is held.
    pub(crate) shapes_stable: bool,
    /// Both.
    pub(crate) stable: bool,
    /// Joints whose springs the loads beat; empty where it is stable.
    pub(crate) overcome_joints: Vec<UnstableJoint>,
    /// All loads have a potential; if not, see the reasons.
    pub(crate) conservative: bool,
    pub(crate) not_conservative_because: Vec<String>,
    /// Potential energy of springs, weights and loads on limbs, without the load on the tool; none
    /// without a potential. Its zero is arbitrary.
    pub(crate) energy_j: Option<f64>,
    pub(crate) converged: bool,
    pub(crate) iterations: usize,
    /// Method by which the equilibrium was found, unless directly from the commanded posture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) found_by: Option<FoundBy>,
    /// Last correction of the iteration by the one before it; none with fewer than two.
    pub(crate) rate_observed: Option<f64>,
    /// Closure error of the loops; rotations at the machine's length.
    pub(crate) closure_mm: f64,
    /// The nearest singular posture, where one is near.
    pub(crate) near_singularity: Option<NearSingular>,
    pub(crate) warnings: Vec<Warning>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ActuatorAnswer {
    pub(crate) name: String,
    pub(crate) command: f64,
    pub(crate) command_unit: &'static str,
    pub(crate) force: f64,
    pub(crate) force_unit: &'static str,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbAnswer {
    pub(crate) name: String,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) force_without_load_n: [f64; 3],
    pub(crate) moment_without_load_n_m: [f64; 3],
    pub(crate) stable: bool,
    /// Absent without inner freedom, or if a passive motion is pushed out of line (then unstable).
    pub(crate) share_to_buckling: Option<f64>,
    pub(crate) neutral_passive_joints: Vec<String>,
    pub(crate) links: Vec<LinkAnswer>,
}

/// Axial load of a link.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LinkAnswer {
    pub(crate) name: String,
    /// Axial force of its most compressed segment; negative compresses.
    pub(crate) axial_force_n: f64,
    /// Euler load with both ends pinned, in its softer plane.
    pub(crate) euler_load_n: f64,
    /// Compression as a share of the Euler load; zero in tension.
    pub(crate) share_of_euler_load: f64,
}

pub(crate) fn answer(
    query: &PlaceQuery,
    posture: &Posture,
    loaded: &MechanismEquilibrium,
    rest: &MechanismEquilibrium,
    snapped: bool,
) -> Deflection {
    let shift = loaded.displacement.linear() * 1e3;
    let unloaded = rest.displacement.linear() * 1e3;
    let turn = loaded.displacement.angular().map(f64::to_degrees);
    let mut warnings = query.warnings.clone();
    let near_singularity = query.near_singular();
    warnings.extend(near_singularity.iter().map(NearSingular::warning));
    if loaded.platform.free > 0 {
        warnings.push(Warning::new(
            WarningCode::FreeDirection,
            format!(
                "the machine has {} without any stiffness here: see `kinetostat stiffness`",
                formatter::counted(loaded.platform.free, "direction")
            ),
        ));
    }
    let shares = InstabilityShares::of(posture, loaded);
    if !loaded.stable() {
        warnings.push(not_stable(""));
    } else if shares.is_near_buckling() {
        let said = instability::description(&shares, true);
        warnings.push(Warning::new(WarningCode::NearBuckling, said));
    }
    warnings.extend(folds(1e-3 * shift.norm(), query.mechanism.size()));
    Deflection {
        head: query.head(3),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        displacement_mm: shift.into(),
        displacement_size_mm: shift.norm(),
        displacement_by_load_mm: (shift - unloaded).into(),
        displacement_by_load_size_mm: (shift - unloaded).norm(),
        displacement_without_load_mm: unloaded.into(),
        displacement_without_load_size_mm: unloaded.norm(),
        rotation_vector_deg: turn.into(),
        rotation_size_deg: turn.norm(),
        actuators: actuators(&query.mechanism, posture, &loaded.actuator_forces()),
        on_controller: query.in_controller_coordinates(posture),
        limbs: loaded
            .limbs
            .iter()
            .zip(&rest.limbs)
            .map(|(l, r)| LimbAnswer {
                name: l.name.clone(),
                force_n: l.wrench.force().into(),
                moment_n_m: l.wrench.moment().into(),
                force_without_load_n: r.wrench.force().into(),
                moment_without_load_n_m: r.wrench.moment().into(),
                stable: l.stability.stable,
                share_to_buckling: l.stability.share_to_buckling.filter(|m| m.is_finite()),
                neutral_passive_joints: l.stability.neutral.clone(),
                links: l
                    .link_loads
                    .iter()
                    .map(|link| LinkAnswer {
                        name: link.link.clone(),
                        axial_force_n: link.axial_force,
                        euler_load_n: link.euler_load,
                        share_of_euler_load: link.share,
                    })
                    .collect(),
            })
            .collect(),
        smallest_stiffness_n_per_mm: 1e-3 * loaded.stiffness_against_force(),
        free_directions: loaded.platform.free,
        negative_directions: loaded
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Negative)
            .map(motion_description)
            .collect(),
        platform_stable: loaded.platform.stable,
        platform_may_flutter: loaded.platform.may_flutter,
        share_to_instability_of_free_machine: shares.free,
        free_beyond_limbs: shares.free_beyond_limbs(),
        snapped,
        shapes_stable: loaded.shapes_stable(),
        stable: loaded.stable(),
        overcome_joints: unstable_joints(posture, loaded, &query.load_names),
        conservative: loaded.conservative,
        not_conservative_because: not_conservative(loaded),
        energy_j: loaded.energy,
        converged: true,
        iterations: loaded.residual.iterations,
        found_by: loaded.found_by.unless_directly(),
        rate_observed: loaded.residual.rate,
        closure_mm: 1e3 * loaded.residual.closure_m,
        near_singularity,
        warnings,
    }
}

/// Reasons for which statements about energy do not hold.
fn not_conservative(e: &MechanismEquilibrium) -> Vec<String> {
    let limbs = e.limbs.iter().filter(|l| !l.conservative);
    let mut reasons: Vec<String> = limbs
        .map(|l| format!("a load on limb '{}' has no potential", l.name))
        .collect();
    if reasons.is_empty() && !e.conservative {
        reasons.push(
            "the moment on the tool keeps its direction while the tool can turn about several axes"
                .to_owned(),
        );
    }
    reasons
}

fn actuators(mechanism: &Mechanism, posture: &Posture, forces: &[f64]) -> Vec<ActuatorAnswer> {
    let kinds = mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind));
    mechanism
        .actuator_names()
        .into_iter()
        .zip(kinds)
        .zip(posture.commands())
        .zip(forces)
        .map(|(((name, kind), command), force)| {
            let (factor, command_unit, force_unit) = match kind {
                MotionKind::Prismatic => (1e3, "mm", "N"),
                MotionKind::Revolute => (1_f64.to_degrees(), "deg", "N m"),
            };
            ActuatorAnswer {
                name,
                command: factor * command,
                command_unit,
                force: *force,
                force_unit,
            }
        })
        .collect()
}

//! The answer of `stiffness`, stable names with units.

use kinetostat::{
    CartesianStiffness, ChainStiffness, Direction, DirectionKind, Posture, Wrench,
    chain::CartesianCompliance, machine::LimbStiffness,
};
use kinetostat_machining::{NearSingular, Warning, WarningCode};
use nalgebra::Matrix6;
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::principal_directions::{Principal, principal, uneven};
use crate::place::joints::{self, JointValue};
use crate::place::query::{AnswerHead, PlaceQuery};

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Stiffness {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    /// Commands of the actuators there.
    pub(crate) joints: Vec<JointValue>,
    /// Displayed values of the controller, in the order of its axes; empty without a section `controller`.
    #[serde(rename = "pendant")]
    pub(crate) on_controller: Vec<JointValue>,
    pub(crate) loaded: bool,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    /// Rows: force (N), moment (N m); columns: displacement (m), rotation (rad); null along axes that a rigid
    /// direction has a part in.
    #[schemars(with = "[[Option<f64>; 6]; 6]")]
    pub(crate) stiffness_n_m_rad: [[f64; 6]; 6],
    /// Stiffness as the terminal shows it: rows N and N m, columns per mm and per rad.
    #[schemars(with = "[[Option<f64>; 6]; 6]")]
    pub(crate) stiffness_n_n_m_per_mm_rad: [[f64; 6]; 6],
    /// Inverse, m and rad per N and N m, zero along rigid directions; none where a direction is free.
    pub(crate) compliance_m_rad_per_n: Option<[[f64; 6]; 6]>,
    /// Compliance as the terminal shows it: micrometres and microradians per N and N m.
    pub(crate) compliance_um_urad_per_n_n_m: Option<[[f64; 6]; 6]>,
    /// Compliance with free directions: the motion under a load that pushes along none of them, up to motions along them.
    pub(crate) compliance_besides_free_motions_m_rad_per_n: Option<[[f64; 6]; 6]>,
    /// Smallest stiffness against a force: in its softest direction, the tool free to turn; null if no
    /// force moves the tool. As in `map`, `deflect` and along programs.
    #[schemars(with = "Option<f64>")]
    pub(crate) smallest_stiffness_n_per_mm: f64,
    /// Loads of the model that are not in the unloaded stiffness: springs and other loads between
    /// nodes and platforms, and weight.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) left_out: Vec<String>,
    /// Figures at rest, including the loads of `left_out`: the tangent without a load on the tool.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) at_rest: Option<AtRest>,
    pub(crate) rank: usize,
    pub(crate) free_directions: usize,
    pub(crate) rigid_directions: usize,
    /// Loads on the tip (force, moment) that move nothing, one for each rigid direction.
    pub(crate) constraint_wrenches_n_n_m: Vec<[f64; 6]>,
    pub(crate) negative_directions: usize,
    pub(crate) principal_directions: Vec<Principal>,
    pub(crate) limbs: Vec<LimbShare>,
    /// The nearest singular posture, where one is near.
    pub(crate) near_singularity: Option<NearSingular>,
    pub(crate) warnings: Vec<Warning>,
}

/// Stiffness of the machine as it stands, without a load on the tool.
#[derive(Serialize, JsonSchema)]
pub(crate) struct AtRest {
    #[schemars(with = "[[Option<f64>; 6]; 6]")]
    pub(crate) stiffness_n_m_rad: [[f64; 6]; 6],
    #[schemars(with = "Option<f64>")]
    pub(crate) smallest_stiffness_n_per_mm: f64,
    pub(crate) stable: bool,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbShare {
    pub(crate) rank: usize,
    pub(crate) free: usize,
    pub(crate) rigid: usize,
    pub(crate) negative: usize,
    pub(crate) redundant_passive_joints: Vec<String>,
    /// `K_C`, `K_Cq`, `K_Ctheta` at the limb's end, and how they act at its platform.
    #[serde(flatten)]
    pub(crate) stiffness: LimbStiffness,
}

/// Directions with the participation of joints and springs in them, the stiff ones too.
pub(crate) fn with_causes(
    directions: &[Direction],
    participation: impl Fn(&Direction) -> Vec<kinetostat::chain::Share>,
) -> Vec<Direction> {
    let mut list = directions.to_vec();
    for direction in &mut list {
        if direction.kind != DirectionKind::Rigid {
            direction.participation = participation(direction);
        }
    }
    list
}

/// Names what acts in the model and is not in its unloaded stiffness, and adds the stiffness with it.
pub(crate) fn with_own_loads(answer: &mut Stiffness, query: &PlaceQuery, posture: &Posture) {
    if query.own_loads.is_empty() {
        return;
    }
    answer.left_out.clone_from(&query.own_loads);
    match posture.deflected_by(&Wrench::zero()) {
        Ok(rest) => {
            answer.at_rest = Some(AtRest {
                stiffness_n_m_rad: rows(&rest.stiffness.finite_entries(&rest.directions)),
                smallest_stiffness_n_per_mm: 1e-3 * rest.stiffness_against_force(),
                stable: rest.stable(),
            });
        }
        Err(error) => answer.warnings.push(Warning::new(
            WarningCode::NoEquilibrium,
            format!("there is no stiffness with what acts in the model besides: {error}"),
        )),
    }
}

/// Stiffness of the machine at a posture, with or without the load on the tool.
pub(crate) struct Tangent<'a> {
    pub(crate) loaded: bool,
    /// Smallest stiffness against a force, N/m.
    pub(crate) against_force: f64,
    pub(crate) cartesian: &'a CartesianStiffness,
    pub(crate) compliance: CartesianCompliance,
    pub(crate) directions: Vec<Direction>,
    pub(crate) limbs: Vec<(&'a ChainStiffness, LimbStiffness)>,
}

pub(crate) fn answer(query: &PlaceQuery, posture: &Posture, tangent: Tangent<'_>) -> Stiffness {
    let Tangent {
        loaded,
        against_force,
        cartesian,
        compliance,
        directions,
        limbs,
    } = tangent;
    let directions = directions.as_slice();
    let count = |kind| directions.iter().filter(|d| d.kind == kind).count();
    let free = count(DirectionKind::Free);
    let held = free + count(DirectionKind::Rigid) < 6;
    let near_singularity = query.near_singular();
    let mut warnings = query.warnings.clone();
    warnings.extend(near_singularity.iter().map(NearSingular::warning));
    warnings.extend(uneven(&query.mechanism, directions));
    let stiffness = rows(&cartesian.finite_entries(directions));
    Stiffness {
        head: query.head(2),
        joints: joints::of_model(&query.mechanism, &posture.commands()),
        on_controller: query.in_controller_coordinates(posture),
        loaded,
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        stiffness_n_m_rad: stiffness,
        stiffness_n_n_m_per_mm_rad: stiffness
            .map(|row| std::array::from_fn(|j| per_column(j) * row[j])),
        compliance_m_rad_per_n: (free == 0).then(|| rows(&compliance.springs)),
        compliance_um_urad_per_n_n_m: (free == 0).then(|| rows(&(MICRO * compliance.springs))),
        compliance_besides_free_motions_m_rad_per_n: (free > 0 && held)
            .then(|| rows(&compliance.springs)),
        smallest_stiffness_n_per_mm: 1e-3 * against_force,
        left_out: Vec::new(),
        at_rest: None,
        free_directions: free,
        rigid_directions: count(DirectionKind::Rigid),
        constraint_wrenches_n_n_m: (compliance.constraint_wrenches().iter())
            .map(|w| w.0.into())
            .collect(),
        negative_directions: count(DirectionKind::Negative),
        rank: directions
            .iter()
            .filter(|d| d.kind != DirectionKind::Free)
            .count(),
        principal_directions: directions.iter().map(principal).collect(),
        limbs: limbs
            .into_iter()
            .map(|(k, stiffness)| LimbShare {
                stiffness,
                rank: k.rank,
                free: k.count(DirectionKind::Free),
                rigid: k.count(DirectionKind::Rigid),
                negative: k.count(DirectionKind::Negative),
                redundant_passive_joints: k.redundant_passive.clone(),
            })
            .collect(),
        warnings,
        near_singularity,
    }
}

/// Factor from m and rad to micrometres and microradians.
pub(crate) const MICRO: f64 = 1e6;

/// Factor from per m and per rad to per mm and per rad, as stiffness is shown.
pub(crate) fn per_column(column: usize) -> f64 {
    if column < 3 { 1e-3 } else { 1.0 }
}

fn rows(m: &Matrix6<f64>) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

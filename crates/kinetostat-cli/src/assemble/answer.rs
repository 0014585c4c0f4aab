//! Assembly stress at one place: numbers with units, in every case.

use kinetostat::number::larger;
use kinetostat::{
    MechanismEquilibrium, MotionKind, Posture, Wrench,
    chain::FoundBy,
    machine::{LinearAssembly, Overconstraint},
    model::Role,
};
use kinetostat_analysis::assembled::{AssembledMachine, Cases};
use kinetostat_machining::{Warning, WarningCode};
use schemars::JsonSchema;
use serde::Serialize;

use crate::assemble::query::AssemblyQuery;
use crate::machine::units::unit_of;
use crate::place::query::AnswerHead;
use crate::ui::failure::Answer;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Assembly {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) deviations: Vec<String>,
    pub(crate) over_constraint: Directions,
    /// The limb that the deviations strain most, without load; none where they strain none.
    pub(crate) most_strained_limb: Option<String>,
    /// Platforms, the tool last.
    pub(crate) platforms: Vec<PlatformAnswer>,
    pub(crate) limbs: Vec<LimbAnswer>,
    /// The machine's natural length: what compares forces and moments.
    pub(crate) length_m: f64,
    /// Weights, loads on limbs or preloads act also without deviations.
    pub(crate) something_else_acts: bool,
    pub(crate) stable: bool,
    /// Method by which that equilibrium was found, unless directly from the commanded posture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) found_by: Option<FoundBy>,
    pub(crate) warnings: Vec<Warning>,
}

/// Number and list of the directions in which the limbs are over-constrained.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Directions {
    pub(crate) degree: usize,
    pub(crate) stresses: Vec<StressAnswer>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct StressAnswer {
    pub(crate) in_words: String,
    limbs: Vec<StressOfLimb>,
}

/// Limb's share of one self-equilibrated set of wrenches: the largest has size 1 N.
#[derive(Serialize, JsonSchema)]
struct StressOfLimb {
    name: String,
    force_n: [f64; 3],
    moment_n_m: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct PlatformAnswer {
    pub(crate) name: String,
    pub(crate) carries_the_tool: bool,
    /// Shift from its nominal place, base axes.
    pub(crate) shift_mm: Cases<[f64; 3]>,
    pub(crate) rotation_vector_deg: Cases<[f64; 3]>,
}

/// Wrench on a limb's end, about it, base axes; its joints and springs.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbAnswer {
    pub(crate) name: String,
    pub(crate) force_n: Cases<[f64; 3]>,
    pub(crate) moment_n_m: Cases<[f64; 3]>,
    /// Force and moment by the deviations without load, the moment at the machine's natural length.
    pub(crate) strain_n: f64,
    pub(crate) passive_joints: Vec<JointAnswer>,
    pub(crate) springs: Vec<SpringAnswer>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct JointAnswer {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    /// Shift of the joint from the machine as drawn, unloaded.
    pub(crate) shift: Cases<f64>,
}

/// One direction of a spring, in its own axes.
#[derive(Serialize, JsonSchema)]
pub(crate) struct SpringAnswer {
    pub(crate) spring: String,
    /// Spring and direction, as in `foot.rx`.
    pub(crate) name: String,
    pub(crate) deflection_unit: &'static str,
    pub(crate) deflection: Cases<f64>,
    pub(crate) torque_unit: &'static str,
    /// Torque of the chain on the spring.
    pub(crate) torque: Cases<f64>,
}

pub(crate) fn answer(assembly: &AssemblyQuery) -> Answer<Assembly> {
    let query = &assembly.query;
    let posture = query.posture()?;
    let drawn = match &query.followed {
        Some(_) => query.standing_in(&assembly.perfect)?,
        None => kinetostat_machining::posture_at(&assembly.perfect, &query.target)?,
    };
    let over = posture.overconstraint();
    let solved = AssembledMachine::solve(posture, &drawn, &query.wrench)?;
    let mechanism = &query.mechanism;
    let length = solved.rest[1].length;
    let limbs: Vec<LimbAnswer> = (0..mechanism.limbs().len())
        .map(|i| limb(&solved, i, length))
        .collect();
    let [perfect, built] = &solved.rest;
    let inside = |e: &MechanismEquilibrium| {
        let sizes = e.limbs.iter().map(|l| size(&l.wrench, length));
        sizes.fold(0.0, larger)
    };
    let acts = inside(perfect) > 1e-9 || perfect.displacement.0.norm() > 1e-12;
    // The first of those that are strained alike.
    let largest = limbs.iter().map(|l| l.strain_n).fold(NOTHING_N, larger);
    let most = limbs.iter().find(|l| l.strain_n > (1.0 - 1e-6) * largest);
    let ends = solved.loaded.as_ref().map_or(built, |[_, built]| built);
    let mut warnings = query.warnings.clone();
    if !ends.stable() {
        warnings.push(Warning::new(
            WarningCode::NotStable,
            "the machine is NOT STABLE in this equilibrium",
        ));
    }
    Ok(Assembly {
        head: query.head(2),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        deviations: query.deviations.clone(),
        over_constraint: directions(&over, &solved.posture),
        most_strained_limb: most.map(|l| l.name.clone()),
        platforms: platforms(&solved),
        length_m: length,
        something_else_acts: acts,
        stable: ends.stable(),
        found_by: ends.found_by.unless_directly(),
        warnings,
        limbs,
    })
}

/// Force below which a limb is not strained: rounding of machines of some hundred N/mm.
pub(crate) const NOTHING_N: f64 = 1e-6;

/// Force and moment, the moment at a length, N.
fn size(wrench: &Wrench, length: f64) -> f64 {
    wrench.force().norm().hypot(wrench.moment().norm() / length)
}

fn directions(over: &Overconstraint, posture: &Posture) -> Directions {
    let stresses = over.stresses.iter().map(|stress| StressAnswer {
        in_words: stress.description(posture),
        limbs: stress
            .wrenches
            .iter()
            .map(|(limb, wrench)| StressOfLimb {
                name: posture.mechanism().limbs()[*limb].name.clone(),
                force_n: wrench.force().into(),
                moment_n_m: wrench.moment().into(),
            })
            .collect(),
    });
    Directions {
        degree: over.degree,
        stresses: stresses.collect(),
    }
}

fn platforms(solved: &AssembledMachine) -> Vec<PlatformAnswer> {
    let mechanism = solved.posture.mechanism();
    let list = mechanism.platforms().iter().enumerate().skip(1);
    let mut list: Vec<PlatformAnswer> = list
        .map(|(p, platform)| {
            let nominal = &solved.posture.platforms()[p];
            let moved = |e: &MechanismEquilibrium| {
                kinetostat::spatial::pose_residual(&e.state.platforms[p], nominal)
            };
            let degrees = |v: nalgebra::Vector3<f64>| v.map(f64::to_degrees).into();
            PlatformAnswer {
                name: platform.name.clone(),
                carries_the_tool: p == mechanism.tool(),
                shift_mm: solved.vector(
                    |l| (l.platforms[p].linear() * 1e3).into(),
                    |e| (moved(e).linear() * 1e3).into(),
                ),
                rotation_vector_deg: solved.vector(
                    |l| degrees(l.platforms[p].angular()),
                    |e| degrees(moved(e).angular()),
                ),
            }
        })
        .collect();
    list.sort_by_key(|p| p.carries_the_tool);
    list
}

fn limb(solved: &AssembledMachine, i: usize, length: f64) -> LimbAnswer {
    let limb = &solved.posture.mechanism().limbs()[i];
    let chain = &limb.actual;
    let nominal = &solved.posture.limbs()[i].coordinates;
    let passive = chain.indices_of(Role::Passive);
    let joints = passive.iter().enumerate().map(|(k, &index)| {
        let c = &chain.coordinates()[index];
        let factor = unit_of(c.kind);
        JointAnswer {
            name: c.name.clone(),
            unit: units(c.kind).0,
            shift: solved.scalar(
                |l| factor * l.passive[i][k],
                |e| factor * (e.limbs[i].coordinates[index] - nominal[index]),
            ),
        }
    });
    let order = chain.indices_of(Role::Spring);
    let first_order = |l: &LinearAssembly, index: usize| {
        let at = order.iter().position(|&own| own == index);
        at.map_or(0.0, |k| l.springs[i][k])
    };
    let mut springs = Vec::new();
    for block in chain.springs() {
        let stiffness = block.stiffness_at(nominal);
        for j in 0..block.len() {
            let index = block.first + j;
            let c = &chain.coordinates()[index];
            let factor = unit_of(c.kind);
            let torque = |l: &LinearAssembly| -> f64 {
                let of = |k: usize| stiffness[(j, k)] * first_order(l, block.first + k);
                (0..block.len()).map(of).sum()
            };
            let (deflection_unit, torque_unit) = units(c.kind);
            springs.push(SpringAnswer {
                spring: block.name.clone(),
                name: c.name.clone(),
                deflection_unit,
                deflection: solved.scalar(
                    |l| factor * first_order(l, index),
                    |e| factor * (e.limbs[i].coordinates[index] - block.rest[j]),
                ),
                torque_unit,
                torque: solved.scalar(torque, |e| e.limbs[i].spring_torques[index]),
            });
        }
    }
    let [drawn, built] = &solved.rest;
    let own = Wrench(built.limbs[i].wrench.0 - drawn.limbs[i].wrench.0);
    LimbAnswer {
        name: limb.name.clone(),
        force_n: solved.vector(
            |l| l.wrenches[i].force().into(),
            |e| e.limbs[i].wrench.force().into(),
        ),
        moment_n_m: solved.vector(
            |l| l.wrenches[i].moment().into(),
            |e| e.limbs[i].wrench.moment().into(),
        ),
        strain_n: size(&own, length),
        passive_joints: joints.collect(),
        springs,
    }
}

/// Units of a motion and of what moves it.
fn units(kind: MotionKind) -> (&'static str, &'static str) {
    match kind {
        MotionKind::Prismatic => ("mm", "N"),
        MotionKind::Revolute => ("deg", "N m"),
    }
}

//! Two machines compared: which constant offsets make one the other.
//!
//! It takes two mechanisms of the same actuators in the same order and finds signs and offsets of the joints, a
//! base and a tool, `T_a(q) = base * T_b(s q + o) * tool`, with the differences that are left; where none are, it
//! compares the stiffnesses too.

mod fit;

use kinetostat::spatial::{shift_matrix, turn_matrix};
use kinetostat::{Mechanism, MotionKind, Pose, PostureRequest, UnloadedStiffness};
use nalgebra::Matrix6;

use crate::comparison::fit::Fit;
use crate::forward::ForwardKinematics;

pub use fit::Mapping;

/// Below this share of the machine's size two models are the same.
const SAME: f64 = 1e-7;

/// Two machines compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Mapping from `b` to `a` with the least differences that were found.
    pub mapping: Mapping,
    /// True if the machines are equal up to constant offsets.
    pub same: bool,
    /// Postures at which they were compared.
    pub postures: usize,
    /// Stiffness of equal machines; `None` where one of them is rigid or free.
    pub stiffness: Option<StiffnessComparison>,
}

/// Numbers of prismatic and revolute actuators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActuatorCounts {
    /// Number of prismatic actuators.
    pub prismatic: usize,
    /// Number of revolute actuators.
    pub revolute: usize,
}

/// Reason why two machines cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ComparisonError {
    /// There is no joint to be mapped.
    #[error("the first machine has no actuator")]
    NoActuator,
    /// Only machines of the same joints in the same order can be mapped on each other.
    #[error("the actuators differ, or their order")]
    DifferentActuators {
        /// Actuators of the first machine.
        a: ActuatorCounts,
        /// Actuators of the second machine.
        b: ActuatorCounts,
    },
    /// The loops of the first machine close at too few postures around home.
    #[error("the loops of the first machine close at too few postures around home")]
    TooFewPostures,
    /// The second machine does not stand where the first one stands with any signs of its joints.
    #[error("the second machine cannot take the posture of the first, with no sign of its joints")]
    NoMapping,
}

/// Maps `b` on `a`.
///
/// # Errors
/// See [`ComparisonError`].
pub fn compare(a: &Mechanism, b: &Mechanism) -> Result<Comparison, ComparisonError> {
    let (kinds, others) = (kinds(a), kinds(b));
    if kinds.is_empty() {
        return Err(ComparisonError::NoActuator);
    }
    if kinds != others {
        return Err(ComparisonError::DifferentActuators {
            a: counts(&kinds),
            b: counts(&others),
        });
    }
    let (of_a, of_b) = (ForwardKinematics::of(a), ForwardKinematics::of(b));
    let quick = of_a.is_plain_product() && of_b.is_plain_product();
    let length = a.size().max(1e-3);
    let (forward_a, forward_b) = (|q: &[f64]| of_a.tool(q), |q: &[f64]| of_b.tool(q));
    let count = if quick { 24 } else { 6 };
    let found: Vec<(Vec<f64>, Pose)> = postures(a, &kinds, of_a.is_plain_product(), length, count)
        .into_iter()
        .filter_map(|q| forward_a(&q).map(|pose| (q, pose)))
        .collect();
    if found.len() < 3 {
        return Err(ComparisonError::TooFewPostures);
    }
    let (postures, targets): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let fit = Fit {
        a: &forward_a,
        b: &forward_b,
        kinds: &kinds,
        postures: &postures,
        targets,
        length,
        same: SAME,
        quick,
    };
    let mapping = fit.run().ok_or(ComparisonError::NoMapping)?;
    let (distance, angle) = mapping.largest_difference;
    let same = distance.max(length * angle) < SAME * length;
    // Home may be singular, or one of the two rigid.
    let home = home(a);
    let stiffness = std::iter::once(&home)
        .chain(postures.iter().take(3))
        .filter(|_| same)
        .find_map(|q| stiffness(a, b, &mapping, q));
    Ok(Comparison {
        mapping,
        same,
        postures: postures.len(),
        stiffness,
    })
}

fn counts(kinds: &[MotionKind]) -> ActuatorCounts {
    let slides = kinds.iter().filter(|k| **k == MotionKind::Prismatic);
    let prismatic = slides.count();
    ActuatorCounts {
        prismatic,
        revolute: kinds.len() - prismatic,
    }
}

/// Commands at home, m or rad.
fn home(m: &Mechanism) -> Vec<f64> {
    let limbs = m.limbs().iter();
    limbs.flat_map(|l| l.nominal.home_commands()).collect()
}

/// Kinds of all actuators, in the order of their names.
fn kinds(m: &Mechanism) -> Vec<MotionKind> {
    let limbs = m.limbs().iter();
    limbs
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
        .collect()
}

/// Irregular postures around home: a serial arm in all its range (`wide`), a parallel machine near home.
fn postures(
    m: &Mechanism,
    kinds: &[MotionKind],
    wide: bool,
    length: f64,
    count: usize,
) -> Vec<Vec<f64>> {
    let home = home(m);
    let limits = m
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.limits));
    let limits: Vec<Option<(f64, f64)>> = limits.collect();
    (0..count)
        .map(|k| {
            (0..kinds.len())
                .map(|i| {
                    // Golden ratio's multiples, one sequence per joint.
                    let share = ((k * kinds.len() + i + 1) as f64 * 0.618_033_988_75
                        + 0.377 * i as f64)
                        .fract()
                        - 0.5;
                    let reach = match (kinds[i], wide) {
                        (MotionKind::Revolute, true) => 3.0,
                        (MotionKind::Revolute, false) => 0.2,
                        (MotionKind::Prismatic, true) => length,
                        (MotionKind::Prismatic, false) => 0.1 * length,
                    };
                    let value = home[i] + share * reach;
                    match limits[i] {
                        Some((low, high)) => value.clamp(low, high),
                        None => value,
                    }
                })
                .collect()
        })
        .collect()
}

/// Stiffnesses against a force at one posture, the tool free to turn, seen at the tool of `a`.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessComparison {
    /// Commands of `a` there, m or rad.
    pub commands: Vec<f64>,
    /// Stiffness of `a`, the softest direction first, N/mm.
    pub a_n_per_mm: [f64; 3],
    /// Stiffness of `b`, likewise.
    pub b_n_per_mm: [f64; 3],
}

/// Compares the stiffnesses; `None` where one machine is singular, free or rigid there.
pub(crate) fn stiffness(
    m: &Mechanism,
    n: &Mechanism,
    mapping: &Mapping,
    commands: &[f64],
) -> Option<StiffnessComparison> {
    let one = m.posture(PostureRequest::commands(commands)).ok()?;
    let other = n
        .posture(PostureRequest::commands(&mapping.joints(commands)))
        .ok()?;
    let compliance =
        |k: UnloadedStiffness| (k.rank() == 6).then(|| k.cartesian.compliance()).flatten();
    let a = compliance(one.stiffness().ok()?)?;
    let b = compliance(other.stiffness().ok()?)?;
    // Transforms to A's axes, then from B's tool to A's.
    let turn = turn_matrix(&mapping.base.rotation.to_rotation_matrix());
    let arm = one.target().translation.vector - (mapping.base * other.target()).translation.vector;
    let shift = shift_matrix(&arm);
    let b = shift * turn * b * turn.transpose() * shift.transpose();
    Some(StiffnessComparison {
        commands: commands.to_vec(),
        a_n_per_mm: against_force(&a)?,
        b_n_per_mm: against_force(&b)?,
    })
}

/// Inverse eigenvalues of the block of forces, N/mm; none where a direction is rigid.
fn against_force(compliance: &Matrix6<f64>) -> Option<[f64; 3]> {
    let block = compliance.fixed_view::<3, 3>(0, 0).into_owned();
    let mut values: Vec<f64> = block.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(|x, y| y.total_cmp(x));
    (values[2] > 1e-9 * values[0]).then(|| [0, 1, 2].map(|i| 1e-3 / values[i]))
}

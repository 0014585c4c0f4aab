//! Two machines compared: which constant offsets make one the other.
//!
//! It takes two mechanisms of the same actuators in the same order and finds signs and offsets of the joints, a
//! base and a tool, `T_a(q) = base * T_b(s q + o) * tool`, with the differences that are left; where none are, it
//! compares the stiffnesses too.

mod fit;
mod mapping;
mod postures;
mod stiffness;

use kinetostat::{Mechanism, MotionKind, Pose};

pub use mapping::Mapping;
pub use stiffness::StiffnessComparison;

use crate::forward::ForwardKinematics;
use fit::Fit;
use postures::{home, kinds, postures};

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
    let kinds = kinds(a);
    if kinds.is_empty() {
        return Err(ComparisonError::NoActuator);
    }
    let others = postures::kinds(b);
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
        .find_map(|q| stiffness::stiffness(a, b, &mapping, q));
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

//! Checks before a chain is frozen, and its natural units.

use crate::model::chain::{Chain, Element, Scale};
use crate::model::limits::LARGEST;
use crate::model::springs::block::{SpringBlock, scaled};
use crate::number::short;
use crate::spatial::MotionKind;

/// Finite, and so that powers are finite too.
pub(crate) fn usable(x: f64) -> bool {
    x.abs() <= LARGEST
}

/// Smallest eigenvalue of a scaled stiffness matrix that is distinct from rounding.
const SINGULAR: f64 = 1e-12;

/// Describes the fault of a spring.
pub(crate) fn spring_fault(block: &SpringBlock) -> Option<String> {
    let posture = vec![0.3; block.first + 6];
    let k = block.stiffness_at(&posture);
    if k.nrows() != block.len() || k.ncols() != block.len() {
        return Some(format!(
            "a {0} x {0} matrix is needed, {1} x {2} was given",
            block.len(),
            k.nrows(),
            k.ncols()
        ));
    }
    if let Some(fault) = block.law.fault() {
        return Some(fault.to_owned());
    }
    if k.iter().any(|x| !usable(*x)) {
        return Some("its stiffness holds a number that is not finite, or beyond 1e60".to_owned());
    }
    let scaled = scaled(&k);
    if (&scaled - scaled.transpose()).amax() > 1e-9 {
        return Some("its stiffness matrix is not symmetric".to_owned());
    }
    if let Some(i) = (0..k.nrows()).find(|&i| k[(i, i)] <= 0.0) {
        return Some(format!(
            "its stiffness {} is not positive (diagonal entry {}); a free direction is a passive joint",
            k[(i, i)],
            i + 1
        ));
    }
    // A coupling as large as the diagonal is indefinite; found here because extreme numbers can
    // keep an eigenvalue iteration busy for ever.
    if let Some((i, j)) = (0..k.nrows())
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .find(|&(i, j)| scaled[(i, j)].abs() > 1.0 + SINGULAR)
    {
        return Some(format!(
            "its stiffness matrix is not positive definite: entry ({}, {}) is too large for its diagonal",
            i + 1,
            j + 1
        ));
    }
    let least = scaled.symmetric_eigenvalues().min();
    if least < -SINGULAR {
        return Some(format!(
            "its stiffness matrix is not positive definite (smallest scaled eigenvalue {})",
            short(least)
        ));
    }
    (least <= SINGULAR).then(|| {
        format!("its stiffness matrix is not positive definite, or couples a motion so much softer than the others that numbers of 16 digits do not hold it (smallest scaled eigenvalue {}, more than {} is needed); a free direction is a passive joint, and a very soft one is held where the spring is given in its principal axes (a rotation before it, the inverse one after it) or as single springs", short(least), short(SINGULAR))
    })
}

fn is_body(chain: &Chain, node: usize) -> bool {
    chain.bodies.iter().any(|b| b.node == node)
}

/// Length: sum of the rigid offsets. Stiffness: geometric mean of the springs, rotations referred
/// to that length.
pub(crate) fn natural_scale(chain: &Chain) -> Scale {
    let mut length = 0.0;
    for (i, element) in chain.elements.iter().enumerate() {
        // A centre of mass is reached by an offset and left by its inverse: no part of the chain.
        let to_mass =
            matches!(chain.elements.get(i + 1), Some(Element::Node(n)) if is_body(chain, *n));
        let from_mass =
            i > 0 && matches!(chain.elements[i - 1], Element::Node(n) if is_body(chain, n));
        if let Element::Rigid(pose) = element
            && !to_mass
            && !from_mass
        {
            length += pose.translation.vector.norm();
        }
    }
    let length = if length > 1e-9 { length } else { 1.0 };
    let posture = chain.home_coordinates();
    let (mut sum, mut count) = (0.0, 0.0);
    for block in &chain.springs {
        let k = block.stiffness_at(&posture);
        for i in 0..block.len() {
            let unit = match chain.coordinates[block.first + i].kind {
                MotionKind::Prismatic => 1.0,
                MotionKind::Revolute => length * length,
            };
            sum += (k[(i, i)] / unit).ln();
            count += 1.0;
        }
    }
    let stiffness = if count > 0.0 {
        (sum / count).exp()
    } else {
        1.0
    };
    Scale { length, stiffness }
}

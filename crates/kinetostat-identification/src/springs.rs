//! Springs of a machine: where they are, and how their matrices change.

use kinetostat::{Mechanism, MotionKind};
use kinetostat_model::ParameterKind;
use nalgebra::DMatrix;

/// Change of the stiffness matrix of a spring of a limb by one unknown.
#[derive(Clone, Debug)]
pub(crate) struct SpringChange {
    pub limb: usize,
    /// First coordinate of the spring.
    pub first: usize,
    pub matrix: DMatrix<f64>,
}

/// Kind of the coordinate of every drive that gives way, and where it is: limb, and index among its coordinates.
pub(crate) fn drive_coordinates(
    mechanism: &Mechanism,
) -> Vec<(ParameterKind, Option<(usize, usize)>)> {
    let limbs = mechanism.limbs().iter().enumerate();
    let drives = limbs.flat_map(|(limb, own)| {
        own.actual.actuators().iter().map(move |drive| {
            let kind = match drive.kind {
                MotionKind::Prismatic => ParameterKind::Length,
                MotionKind::Revolute => ParameterKind::Angle,
            };
            (kind, drive.coordinate.map(|c| (limb, c)))
        })
    });
    drives.collect()
}

/// The changes times a factor.
pub(crate) fn scaled(springs: &[SpringChange], factor: f64) -> Vec<SpringChange> {
    let each = springs.iter();
    each.map(|s| SpringChange {
        matrix: &s.matrix * factor,
        ..s.clone()
    })
    .collect()
}

/// Springs in which two machines differ, divided by a step.
pub(crate) fn difference(more: &Mechanism, less: &Mechanism, step: f64) -> Vec<SpringChange> {
    let mut out = Vec::new();
    for (limb, (a, b)) in more.limbs().iter().zip(less.limbs()).enumerate() {
        let (a, b) = (&a.actual, &b.actual);
        let home = a.home_coordinates();
        for (one, other) in a.springs().iter().zip(b.springs()) {
            if one == other {
                continue;
            }
            let matrix = (one.stiffness_at(&home) - other.stiffness_at(&home)) / step;
            out.push(SpringChange {
                limb,
                first: one.first,
                matrix,
            });
        }
    }
    out
}

//! Axes and displacements of motions, several postures at once.

use pulp::Simd;

use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, cross, minus};
use crate::batch::plan::steps::Amount;
use crate::spatial::MotionKind;

/// Axis and place of a motion that a coordinate or a command drives, base axes.
#[derive(Clone, Copy)]
pub(crate) struct MotionAxis<S: Simd> {
    pub axis: Vec3<S>,
    pub origin: Vec3<S>,
}

impl<S: Simd> MotionAxis<S> {
    /// Twist of a body at `point` per unit of the motion, base axes.
    #[inline(always)]
    pub fn twist(&self, kind: MotionKind, point: &Vec3<S>) -> [Lanes<S>; 6] {
        let Self { axis, origin } = self;
        match kind {
            MotionKind::Revolute => {
                let v = cross(axis, &minus(point, origin));
                [v[0], v[1], v[2], axis[0], axis[1], axis[2]]
            }
            MotionKind::Prismatic => {
                let zero = axis[0].same(0.0);
                [axis[0], axis[1], axis[2], zero, zero, zero]
            }
        }
    }
}

/// `fixed + ratio * command + ratio * coordinate`.
#[inline(always)]
pub(crate) fn amount<S: Simd>(
    simd: S,
    amount: &Amount,
    commands: &[Lanes<S>],
    coordinate: Option<Lanes<S>>,
) -> Lanes<S> {
    let mut sum = Lanes::new(simd, amount.fixed);
    if let Some((index, ratio)) = amount.command {
        sum = commands[index].times_plus(sum.same(ratio), sum);
    }
    if let (Some((_, ratio)), Some(value)) = (amount.coordinate, coordinate) {
        sum = value.times_plus(sum.same(ratio), sum);
    }
    sum
}

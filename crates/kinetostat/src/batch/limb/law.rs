//! The spring laws ([`crate::model::springs`]) on several postures at once.

use pulp::Simd;

use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::wrenches::Mat6;
use crate::model::springs::bilinear::SingleLaw;
use crate::model::springs::block::{SpringLaw, if_curved, if_single};
use crate::model::springs::curved::CurvedLaw;
use crate::model::springs::parallelogram::ParallelogramLaw;

/// Compliance of a parallelogram at its inclination (rad) in the six directions, the missing one
/// rigid.
#[inline(always)]
pub(crate) fn parallelogram<S: Simd>(
    simd: S,
    law: &ParallelogramLaw,
    inclination: Lanes<S>,
) -> Symmetric<S> {
    apart!(simd, {
        let mut out = Symmetric::zero(simd);
        for (i, j, value) in law.compliance(inclination) {
            out.set(i, j, value);
        }
        out
    })
}

/// Torques of a spring of six coordinates at a deflection (m, rad; translations before rotations), and the
/// square of its rotation.
#[inline(always)]
pub(crate) fn torque<S: Simd>(law: &SpringLaw, at: &[Lanes<S>; 6]) -> ([Lanes<S>; 6], Lanes<S>) {
    if_curved!(law, own => own.torque_at(at), else (*at, at[0] * f64::NAN))
}

/// Tangent stiffness of the law.
#[inline(always)]
pub(crate) fn tangent<S: Simd>(law: &SpringLaw, at: &[Lanes<S>; 6]) -> Mat6<S> {
    apart!(at[0].simd(), {
        if_curved!(law, own => own.tangent(at), else [[at[0] * f64::NAN; 6]; 6])
    })
}

/// Geometric stiffness of the law, which its forces add to the tangent, and the inverse of the rates of its strains by
/// the six motions.
#[inline(always)]
pub(crate) fn geometric<S: Simd>(law: &SpringLaw, at: &[Lanes<S>; 6]) -> (Mat6<S>, Mat6<S>) {
    apart!(at[0].simd(), {
        let none = [[at[0] * f64::NAN; 6]; 6];
        if_curved!(law, own => own.geometric(at), else (none, none))
    })
}

/// Torque of a spring of one coordinate at a deflection (m, rad).
#[inline(always)]
pub(crate) fn single_torque<S: Simd>(law: &SpringLaw, x: Lanes<S>) -> Lanes<S> {
    if_single!(law, own => own.torque(x), else x * f64::NAN)
}

/// The deflection of a spring of one coordinate under a torque (N, N m).
#[inline(always)]
pub(crate) fn single_deflection<S: Simd>(law: &SpringLaw, torque: Lanes<S>) -> Lanes<S> {
    if_single!(law, own => own.deflection(torque), else torque * f64::NAN)
}

/// Tangent stiffness of a spring of one coordinate.
#[inline(always)]
pub(crate) fn single_tangent<S: Simd>(law: &SpringLaw, x: Lanes<S>) -> Lanes<S> {
    if_single!(law, own => own.tangent(x), else x * f64::NAN)
}

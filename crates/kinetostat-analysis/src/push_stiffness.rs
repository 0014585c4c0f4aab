//! Stiffness of the tool against a force, free to turn, and against a moment, free to move.

use kinetostat::number::smaller;
use nalgebra::{Matrix3, Matrix6};

/// Stiffnesses of a tool against pushes of both kinds; none where no push of the kind moves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushStiffnesses {
    /// Stiffness against a force, the tool free to turn, N/m.
    pub force: Option<PushStiffness>,
    /// Stiffness against a moment, the tool free to move, N m/rad.
    pub moment: Option<PushStiffness>,
}

impl PushStiffnesses {
    /// Evaluates a compliance (m and rad per N and N m) with the natural length, m.
    #[must_use]
    pub fn of(compliance: &Matrix6<f64>, length: f64) -> Self {
        let force: Matrix3<f64> = compliance.fixed_view::<3, 3>(0, 0).into_owned();
        let moment: Matrix3<f64> = compliance.fixed_view::<3, 3>(3, 3).into_owned();
        // One block beside which the other is rounding has no motion at all.
        let arm = length.powi(2);
        let nothing = NO_MOTION * force.amax().max(moment.amax() * arm);
        Self {
            force: push_stiffness(&force, nothing),
            moment: push_stiffness(&moment, nothing / arm),
        }
    }
}

/// Compliances below this share of the largest, rotations at the natural length, are rounding.
const NO_MOTION: f64 = 1e-12;

/// Response of the tool to a force or a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PushStiffness {
    /// Stiffnesses, the softest and the stiffest, N/m or N m/rad.
    Along([f64; 2]),
    /// Some push moves it the other way, so that no stiffness says how far it yields.
    Against,
}

/// Evaluates a block of a compliance along the load; parts up to `nothing` are rounding.
fn push_stiffness(block: &Matrix3<f64>, nothing: f64) -> Option<PushStiffness> {
    // The symmetric part alone acts along the push; loads without a potential leave another.
    let values = (0.5 * (block + block.transpose())).symmetric_eigenvalues();
    let nothing = nothing.max(1e-9 * values.amax());
    if values.min() < -nothing {
        return Some(PushStiffness::Against);
    }
    let moving = values.iter().copied().filter(|x| *x > nothing);
    let least = moving.fold(f64::INFINITY, smaller);
    least
        .is_finite()
        .then(|| PushStiffness::Along([1.0 / values.max(), 1.0 / least]))
}

//! Response of a limb with passive joints to a small motion of its end, as matrices.
//!
//! An iteration solves the same system with the factors of [`crate::batch::numbers::eliminate`] in every pass. The
//! inverse of their system `[C J_q; J_q^T 0]` is found once and is then a few products, without a division and without
//! a chain of results that wait for each other: those solutions were 44 % of the time in the kernels of a program. The
//! inverse costs no accuracy, because it corrects an iteration whose residuals are measured.

use pulp::Simd;

use crate::batch::numbers::eliminate::Eliminated;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::vectors::select;
use crate::batch::numbers::wrenches::Mat6;

/// Rounding of the residual between a limb and its platform, share of the natural length or rad: a few passes
/// over tens of motions.
const RESIDUAL_ROUNDING: f64 = 4e-15;

/// Change of a limb's wrench (N, N m) and of its passive joints (m, rad).
#[derive(Clone, Copy)]
pub(crate) struct Correction<S: Simd> {
    pub wrench: [Lanes<S>; 6],
    pub joints: [Lanes<S>; 6],
}

/// The inverse of `[C J_q; J_q^T 0]` of a limb, m, rad, N and N m.
#[derive(Clone)]
pub(crate) struct Corrector<S: Simd> {
    /// Wrench by motion of the end: the limb's stiffness.
    pub stiffness: Symmetric<S>,
    /// Row `k`: wrench by the torque of passive joint `k`, and motion of that joint by motion of the end.
    pub joints: Mat6<S>,
    /// Motion of passive joints by their torques.
    pub among: Mat6<S>,
    /// Passive joints.
    pub count: usize,
}

impl<S: Simd> Corrector<S> {
    /// Empty corrector of an unknown limb.
    pub fn nothing(simd: S) -> Self {
        let zero = [[Lanes::new(simd, 0.0); 6]; 6];
        Self {
            stiffness: Symmetric::zero(simd),
            joints: zero,
            among: zero,
            count: 0,
        }
    }

    /// Becomes another one in the lanes that are `wanted`.
    #[inline(always)]
    pub fn take(&mut self, wanted: Lanes<S>, other: &Self) {
        self.stiffness.take(wanted, &other.stiffness);
        self.count = other.count;
        for k in 0..self.count {
            for i in 0..6 {
                self.joints[k][i] = select(wanted, other.joints[k][i], self.joints[k][i]);
                self.among[k][i] = select(wanted, other.among[k][i], self.among[k][i]);
            }
        }
    }

    /// Builds from factors in which linear motions count as shares of `length`, with the stiffness that they give.
    #[inline(always)]
    pub fn new(
        simd: S,
        factors: &Eliminated<S>,
        balanced: &Symmetric<S>,
        length: f64,
        count: usize,
    ) -> Self {
        apart!(simd, {
            let zero = Lanes::new(simd, 0.0);
            let mut own = Self {
                stiffness: balanced.scaled(1.0 / (length * length), 1.0 / length),
                joints: [[zero; 6]; 6],
                among: [[zero; 6]; 6],
                count: count.min(6),
            };
            for k in 0..own.count {
                let mut torque = [zero; 6];
                torque[k] = Lanes::new(simd, 1.0);
                own.joints[k] = factors.answer(simd, [zero; 6], &torque, &mut own.among[k]);
                for x in &mut own.joints[k][..3] {
                    *x = *x * (1.0 / length);
                }
            }
            own
        })
    }

    /// Correction with which the limb's end moves by `motion`, the load on its passive joints unchanged.
    #[inline(always)]
    pub fn of_motion(&self, motion: &[Lanes<S>; 6]) -> Correction<S> {
        let mut joints = [motion[0] * 0.0; 6];
        for k in 0..self.count {
            let mut sum = self.joints[k][0] * motion[0];
            for i in 1..6 {
                sum = self.joints[k][i].times_plus(motion[i], sum);
            }
            joints[k] = sum;
        }
        Correction {
            wrench: self.stiffness.times(motion),
            joints,
        }
    }

    /// Adds that with which the passive joints bear `torque` more, the end where it is.
    #[inline(always)]
    pub fn add_of_torque(&self, torque: &[Lanes<S>; 6], to: &mut Correction<S>) {
        for k in 0..self.count {
            for i in 0..6 {
                to.wrench[i] = self.joints[k][i].times_plus(torque[k], to.wrench[i]);
                to.joints[i] = self.among[k][i].times_plus(torque[k], to.joints[i]);
            }
        }
    }
}

/// A limb as the platform sees it.
#[derive(Clone)]
pub(crate) struct AttachedLimb<S: Simd> {
    /// Corrector of the unloaded limb.
    pub corrector: Corrector<S>,
    /// Rounding of the limb's wrench, N m: per share of the natural length, or per radian.
    pub noise: Lanes<S>,
    /// Change in the present pass.
    pub change: Correction<S>,
    /// Squares of what the limb was off its platform in the last pass (share of the natural length, rad), and of the change of its
    /// wrench (N m).
    pub last: [Lanes<S>; 2],
}

impl<S: Simd> AttachedLimb<S> {
    /// Limb before anything is known of it.
    pub fn new(simd: S) -> Self {
        let nothing = [Lanes::new(simd, 0.0); 6];
        Self {
            corrector: Corrector::nothing(simd),
            noise: nothing[0],
            change: Correction {
                wrench: nothing,
                joints: nothing,
            },
            last: [nothing[0]; 2],
        }
    }

    /// Takes another corrector, with the largest entry of its stiffness (N m), in the lanes that are `wanted`.
    #[inline(always)]
    pub fn take(&mut self, wanted: Lanes<S>, other: &Corrector<S>, stiffest: Lanes<S>) {
        self.corrector.take(wanted, other);
        self.noise = select(wanted, stiffest * RESIDUAL_ROUNDING, self.noise);
    }
}

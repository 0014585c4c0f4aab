//! The report's iteration for the target to command [R 7.13], several postures at once:
//! `t0F <- t0F + (t_desired - f^-1(F | t0F))`.
//!
//! It contracts by as much as the deflection changes from the commanded place to the corrected one,
//! about the deflection as a share of the machine's size. Every round starts anew from the target
//! alone, so a lane that is done and keeps its target keeps its bits.

use pulp::Simd;

use super::apart::apart;
use super::group::REGULAR;
use super::lanes::Lanes;
use super::machine::Machine;
use super::reach::Target;
use super::vectors::{minus, select, turn_between, turned};
use crate::spatial::Directions;

/// Equilibria after which a lane is given up.
pub(super) const MOST_ROUNDS: usize = 12;
/// Farther off than this (share of the natural length, rad) the target is corrected again. The
/// general engine closes its loops to 1e-12.
const OFF: f64 = 3e-13;

impl<S: Simd> Machine<'_, S> {
    /// Corrects the target in the lanes that are `good` and whose tool is off the `aim` in one of the
    /// directions: one in these lanes. Rotations are corrected about all axes or none.
    #[inline(always)]
    pub fn correct(
        &mut self,
        simd: S,
        aim: &Target<S>,
        directions: Directions,
        good: Lanes<S>,
    ) -> Lanes<S> {
        apart!(simd, {
            let zero = Lanes::new(simd, 0.0);
            let mut residual = minus(&aim.point, &self.point);
            let mut most = zero;
            for k in 0..3 {
                if !directions[k] {
                    residual[k] = zero;
                }
                most = most.max(residual[k].abs() * (1.0 / self.nominal[0].length));
            }
            let mut turn = [zero; 3];
            if directions[3] {
                turn = turn_between(&aim.rotation, &self.rotation);
                for x in &turn {
                    most = most.max(x.abs());
                }
            }
            let able = (zero + REGULAR).where_less(good, zero + 1.0, zero);
            let off = (zero + OFF).where_less(most, able, zero);
            for k in 0..3 {
                let moved = self.target.point[k] + residual[k];
                self.target.point[k] = select(off, moved, self.target.point[k]);
            }
            if directions[3] {
                let rotation = turned(&turn, &self.target.rotation);
                for k in 0..9 {
                    self.target.rotation[k] = select(off, rotation[k], self.target.rotation[k]);
                }
            }
            off
        })
    }
}

//! The target to command so that the loaded tool is where it shall be, several postures at once.
//!
//! The report iterates `t0F <- t0F + (t_desired - f^-1(F | t0F))` [R 7.13]: one equilibrium per step. A serial
//! machine does so here. Where limbs hold a platform, equilibrium and target are corrected together: after every pass
//! of [`crate::batch::machine::platform`] the target is moved by what the tool is off, and the machine goes along as it is bent. What is
//! left after that is of second order, deflection times correction as a share of the machine's size, so that this takes
//! no more passes than the equilibrium alone.

use pulp::Simd;

use crate::batch::machine::loaded::Machine;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{minus, select, turn_between, turned};
use crate::spatial::Directions;

impl<S: Simd> Machine<S> {
    /// Corrects the target in the lanes that are `able` and whose tool is off its place in one of these directions
    /// (base axes `x y z rx ry rz`; rotations about all axes or none): one in these lanes. The tool is taken to go along.
    #[inline(always)]
    pub fn correct(&mut self, simd: S, directions: Directions, able: Lanes<S>) -> Lanes<S> {
        apart!(simd, {
            let zero = Lanes::new(simd, 0.0);
            let mut residual = minus(&self.place.point, &self.point);
            let mut most = zero;
            for k in 0..3 {
                if !directions[k] {
                    residual[k] = zero;
                }
                most = most.max(residual[k].abs() * (1.0 / self.nominal[0].length));
            }
            let mut turn = [zero; 3];
            if directions[3] {
                turn = turn_between(&self.place.rotation, &self.rotation);
                for x in &turn {
                    most = most.max(x.abs());
                }
            }
            let off = (zero + self.precision.tool).where_less(most, able, zero);
            for point in [&mut self.target.point, &mut self.point] {
                for k in 0..3 {
                    point[k] = select(off, point[k] + residual[k], point[k]);
                }
            }
            if directions[3] {
                for rotation in [&mut self.target.rotation, &mut self.rotation] {
                    let to = turned(&turn, rotation);
                    for k in 0..9 {
                        rotation[k] = select(off, to[k], rotation[k]);
                    }
                }
            }
            off
        })
    }

    /// Corrects the target between two passes of an equilibrium: the limbs follow, their joints by one Newton step,
    /// which is also taken where they are still `away` from the target. Returns one in the lanes that continue, and in
    /// those that are away now.
    #[inline(always)]
    pub fn correct_between_passes(
        &mut self,
        simd: S,
        directions: Directions,
        able: Lanes<S>,
        away: Lanes<S>,
    ) -> (Lanes<S>, Lanes<S>) {
        let off = self.correct(simd, directions, able);
        let away = self.reach(simd, 1, off.max(away * able));
        self.limbs_follow();
        (off.max(away), away)
    }
}

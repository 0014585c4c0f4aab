//! Extrapolation of a machine along a path: the change to the next posture equals the last one, scaled by the lengths
//! of both steps.
//!
//! Only small differences between neighbours are extrapolated: joints from joints, the target from its place, the tool
//! from the target, springs, wrenches, and passive joints from those of the unloaded limb. A start with an error of
//! second order in the step instead of first order saves passes; the result depends on it only within the accuracy of a
//! path.

use pulp::Simd;

use crate::batch::limb::reach::Target;
use crate::batch::machine::loaded::Machine;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{minus, select, turn_between, turned};
use crate::spatial::Directions;

/// Largest relative error of the load's extrapolation; beyond it the machine is not extrapolated.
const SAME_LOAD: f64 = 0.01;

/// A step of more than so many times the one before is too far to tell.
const FARTHEST: f64 = 4.0;

/// Motion from one place to another, lengths in units of `length`. It is no closure: that would be compiled for itself,
/// without the wide registers.
#[inline(always)]
fn way<S: Simd>(to: &Target<S>, from: &Target<S>, length: f64) -> [Lanes<S>; 6] {
    let [x, y, z] = minus(&to.point, &from.point);
    let [a, b, c] = turn_between(&to.rotation, &from.rotation);
    let unit = 1.0 / length;
    [x * unit, y * unit, z * unit, a, b, c]
}

impl<S: Simd> Machine<S> {
    /// Notes the posture at hand, which is `lost` where it was not found, before the machine goes on from it. The share of its last change by which it
    /// changes on the way to another place under another load; zero where that is not known.
    #[inline(always)]
    pub fn look_back(
        &mut self,
        simd: S,
        place: &Target<S>,
        load: &[Lanes<S>; 6],
        lost: Lanes<S>,
    ) -> Lanes<S> {
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let length = self.nominal[0].length;
            let next = way(place, &self.place, length);
            let before = way(&self.place, &self.trend.place, length);
            let (mut along, mut square) = (zero, zero);
            for k in 0..6 {
                along = next[k].times_plus(before[k], along);
                square = before[k].times_plus(before[k], square);
            }
            let mut share = along / square;
            let (mut off, mut size) = (zero, zero);
            for k in 0..6 {
                let unit = if k < 3 { length } else { 1.0 };
                let change = self.load[k] - self.trend.load[k];
                let away = (load[k] - change.times_plus(share, self.load[k])) * unit;
                off = away.times_plus(away, off);
                size = (load[k] * unit).times_plus(load[k] * unit, size);
            }
            share = (size * (SAME_LOAD * SAME_LOAD)).where_less(off, zero, share);
            share = share.where_less(one * FARTHEST, share, zero);
            share = zero.where_less(share, share, zero);
            share = select(self.trend.known * (one - lost), share, zero);
            self.trend.known = one - lost;
            self.trend.place = self.place;
            self.trend.load = self.load;
            self.note_all();
            share
        })
    }

    #[inline(always)]
    fn note_all(&mut self) {
        let trend = &mut self.trend;
        let mut index = 0;
        for own in &self.joints {
            trend.note(&mut index, &own.commands);
            trend.note(&mut index, &own.passive);
        }
        trend.note(&mut index, &minus(&self.target.point, &self.place.point));
        let turn = turn_between(&self.target.rotation, &self.place.rotation);
        trend.note(&mut index, &turn);
        if self.is_serial() {
            return;
        }
        let trend = &mut self.trend;
        trend.note(&mut index, &minus(&self.point, &self.target.point));
        let turn = turn_between(&self.rotation, &self.target.rotation);
        trend.note(&mut index, &turn);
        for (limb, plan) in self.limbs.iter().zip(self.actual.iter()) {
            for (own, unloaded) in plan.passive.iter().zip(&limb.unloaded) {
                trend.note(&mut index, &[limb.coordinates[*own] - *unloaded]);
            }
            trend.note(&mut index, &limb.coordinates);
            trend.note(&mut index, &limb.wrench);
        }
    }

    /// Joints, and where the target is corrected, go on by a share of their last change.
    #[inline(always)]
    pub fn joints_go_on(&mut self, share: Lanes<S>, corrected: Directions) {
        let trend = &self.trend;
        let mut from = 0;
        for own in &mut self.joints {
            trend.go_on(&mut from, share, &mut own.commands);
            trend.go_on(&mut from, share, &mut own.passive);
        }
        let mut to = self.target.point;
        trend.go_on(&mut from, share, &mut to);
        for k in 0..3 {
            if corrected[k] {
                // The tool goes along with its target.
                self.point[k] = self.point[k] + (to[k] - self.target.point[k]);
                self.target.point[k] = to[k];
            }
        }
        let mut turn = [share.same(0.0); 3];
        trend.go_on(&mut from, share, &mut turn);
        if corrected[3] {
            self.target.rotation = turned(&turn, &self.target.rotation);
            self.rotation = turned(&turn, &self.rotation);
        }
    }

    /// Tool and limbs, which follow their joints, go on by a share of their last change.
    #[inline(always)]
    pub fn limbs_go_on(&mut self, share: Lanes<S>) {
        let trend = &self.trend;
        let joints = self.joints.iter();
        let mut from = 6 + joints
            .map(|own| own.commands.len() + own.passive.len())
            .sum::<usize>();
        trend.go_on(&mut from, share, &mut self.point);
        let mut turn = [share.same(0.0); 3];
        trend.go_on(&mut from, share, &mut turn);
        self.rotation = turned(&turn, &self.rotation);
        for (limb, plan) in self.limbs.iter_mut().zip(self.actual.iter()) {
            let mut passive = from;
            from += plan.passive.len();
            let mut followed = [share.same(0.0); 6];
            for (x, own) in followed.iter_mut().zip(&plan.passive) {
                *x = limb.coordinates[*own];
            }
            trend.go_on(&mut from, share, &mut limb.coordinates);
            for (x, own) in followed.into_iter().zip(&plan.passive) {
                limb.coordinates[*own] = x;
                let own = &mut limb.coordinates[*own..=*own];
                trend.go_on(&mut passive, share, own);
            }
            trend.go_on(&mut from, share, &mut limb.wrench);
        }
    }
}

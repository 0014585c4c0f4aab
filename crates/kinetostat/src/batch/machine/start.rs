//! Start of a search for equilibria: from the unloaded machine, or along a path from the posture before.

use pulp::Simd;

use crate::batch::limb::reach::{MOST_STEPS, Target};
use crate::batch::machine::corrector::Corrector;
use crate::batch::machine::group::{Group, REGULAR, Standing};
use crate::batch::machine::loaded::{Machine, bounded};
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::vectors::{minus, product, product_transposed, select, turned};
use crate::batch::table::{Columns, Table};
use crate::spatial::Directions;

/// The unloaded machine's own compliance, which corrects the passes of an equilibrium, is found anew where the machine
/// has gone farther than this since (share of the natural length, rad): corrections that are off by so much hardly slow
/// them down.
const SAME_PLACE: f64 = 0.01;

impl<S: Simd> Machine<S> {
    /// A serial machine at these commands, unloaded: one in the lanes that can go on.
    #[inline(always)]
    pub fn start_at_joints(
        &mut self,
        simd: S,
        group: &Group,
        commands: &[f64],
        each: usize,
    ) -> Lanes<S> {
        group.commands(simd, commands, each, &mut self.joints[0].commands);
        let good = bounded(simd, &self.joints[0].commands);
        if self.is_serial() {
            return good;
        }
        let (plan, (forward, _)) = (&self.nominal[0], &mut self.passes[0]);
        forward.along(plan, false, plan.steps.len(), &self.joints[0].commands, &[]);
        self.target = Target {
            rotation: forward.rotation,
            point: forward.point,
        };
        (self.rotation, self.point) = (self.target.rotation, self.target.point);
        self.start_limbs();
        good.least_of(self.update_compliance(simd, Lanes::new(simd, 1.0)))
    }

    /// The machine commanded to a place, unloaded, its joints searched from home: one in the lanes that can go on.
    #[inline(always)]
    pub fn start_at(&mut self, simd: S, place: Target<S>) -> Lanes<S> {
        let one = Lanes::new(simd, 1.0);
        (self.place, self.target) = (place, place);
        (self.rotation, self.point) = (place.rotation, place.point);
        self.trend.forget(simd);
        for (joints, plan) in self.joints.iter_mut().zip(self.nominal.iter()) {
            joints.home(simd, plan, one);
        }
        let good = one - self.reach(simd, MOST_STEPS, one);
        if self.is_serial() {
            return good;
        }
        self.start_limbs();
        good.least_of(self.update_compliance(simd, one))
    }

    /// The machine commanded to a place, with joints that are known, unloaded or as one like it stands there under a load: one
    /// in the lanes that can go on.
    #[inline(always)]
    pub fn start_with(
        &mut self,
        simd: S,
        group: &Group,
        place: Target<S>,
        joints: &Table,
        standing: Option<(&Standing, &[f64])>,
        first: usize,
    ) -> Lanes<S> {
        let joints = joints.columns().from(first);
        let mut all = Lanes::new(simd, 0.0);
        (self.place, self.target) = (place, place);
        (self.rotation, self.point) = (place.rotation, place.point);
        let mut from = 0;
        for own in &mut self.joints {
            for numbers in [&mut own.commands, &mut own.passive] {
                group.numbers(simd, joints, from, numbers);
                from += numbers.len();
                for x in numbers.iter() {
                    all = x.times_plus(x.same(0.0), all);
                }
            }
        }
        // NaN marks a place that is not reached.
        let good = Lanes::new(simd, 1.0).least_of(all + 1.0);
        if self.is_serial() {
            return good;
        }
        self.start_limbs();
        let Some((standing, deviations)) = standing else {
            return good.least_of(self.update_compliance(simd, Lanes::new(simd, 1.0)));
        };
        self.stand(simd, group, standing, first);
        for (slope, deviation) in standing.slopes.iter().zip(deviations) {
            self.go_along(simd, group, slope.columns().from(first), *deviation);
        }
        good.least_of(self.take_correctors(simd, group, standing.correctors.columns().from(first)))
    }

    /// Goes along as a number of the machine differs.
    #[inline(always)]
    fn go_along(&mut self, simd: S, group: &Group, slope: Columns<'_>, by: f64) {
        let zero = Lanes::new(simd, 0.0);
        let mut motion = [zero; 6];
        group.numbers(simd, slope, 0, &mut motion);
        let by = zero + by;
        for k in 0..3 {
            self.point[k] = motion[k].times_plus(by, self.point[k]);
        }
        let turn = [motion[3] * by, motion[4] * by, motion[5] * by];
        self.rotation = turned(&turn, &self.rotation);
        let mut from = 6;
        let mut own = [zero];
        let limbs = &mut self.limbs;
        for x in limbs.iter_mut().flat_map(|limb| &mut limb.coordinates) {
            group.numbers(simd, slope, from, &mut own);
            *x = own[0].times_plus(by, *x);
            from += 1;
        }
        for x in limbs.iter_mut().flat_map(|limb| &mut limb.wrench) {
            group.numbers(simd, slope, from, &mut own);
            *x = own[0].times_plus(by, *x);
            from += 1;
        }
    }

    /// Started limbs and platform as those of another machine stand, in the lanes where that is known.
    #[inline(always)]
    fn stand(&mut self, simd: S, group: &Group, standing: &Standing, first: usize) {
        let [at, coordinates, wrenches] =
            [&standing.tool, &standing.coordinates, &standing.wrenches]
                .map(|table| table.columns().from(first));
        let zero = Lanes::new(simd, 0.0);
        let mut tool = [zero; 12];
        group.numbers(simd, at, 0, &mut tool);
        let mut all = zero;
        for x in &tool {
            all = x.times_plus(zero, all);
        }
        let known = zero.where_less(all + 1.0, all.same(1.0), zero);
        for k in 0..9 {
            self.rotation[k] = select(known, tool[k], self.rotation[k]);
        }
        for k in 0..3 {
            self.point[k] = select(known, tool[9 + k], self.point[k]);
        }
        let mut from = 0;
        for (i, limb) in self.limbs.iter_mut().enumerate() {
            limb.bent = true;
            let mut own = [zero];
            for x in &mut limb.coordinates {
                group.numbers(simd, coordinates, from, &mut own);
                *x = select(known, own[0], *x);
                from += 1;
            }
            let mut wrench = [zero; 6];
            group.numbers(simd, wrenches, 6 * i, &mut wrench);
            for k in 0..6 {
                limb.wrench[k] = select(known, wrench[k], limb.wrench[k]);
            }
        }
    }

    /// The machine commanded to the next place of a path: it goes there as it is bent, with the correction that it has in
    /// these directions, and as far as it changed on the way to where it is. Lanes whose posture was not found start from home. One in the lanes
    /// that can go on.
    #[inline(always)]
    pub fn go_on(
        &mut self,
        simd: S,
        place: Target<S>,
        wrench: &[Lanes<S>; 6],
        directions: Option<Directions>,
    ) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let lost = (zero + REGULAR).where_less(self.found, zero, one);
        let share = self.look_back(simd, &place, wrench, lost);
        let shift = minus(&place.point, &self.place.point);
        let turn = product_transposed(&place.rotation, &self.place.rotation);
        let rotation = product(&turn, &self.rotation);
        let target = product(&turn, &self.target.rotation);
        let corrected = directions.unwrap_or_default();
        for k in 0..3 {
            self.point[k] = select(lost, place.point[k], self.point[k] + shift[k]);
            let along = match corrected[k] {
                true => self.target.point[k] + shift[k],
                false => place.point[k],
            };
            self.target.point[k] = select(lost, place.point[k], along);
        }
        for k in 0..9 {
            self.rotation[k] = select(lost, place.rotation[k], rotation[k]);
            let along = match corrected[3] {
                true => target[k],
                false => place.rotation[k],
            };
            self.target.rotation[k] = select(lost, place.rotation[k], along);
        }
        self.place = place;
        self.joints_go_on(share, corrected);
        for (joints, plan) in self.joints.iter_mut().zip(self.nominal.iter()) {
            joints.home(simd, plan, lost);
        }
        let good = one - self.reach(simd, MOST_STEPS, one);
        if self.is_serial() {
            return good;
        }
        for (limb, plan) in self.limbs.iter_mut().zip(self.actual.iter()) {
            limb.forget(plan, lost);
        }
        self.limbs_follow();
        self.limbs_go_on(share);
        good.least_of(self.update_compliance(simd, lost))
    }

    /// Joints that lead to the target, from where they are, in at most so many steps and in the lanes where
    /// `active` is one: one in those that are not there yet.
    #[inline(always)]
    pub fn reach(&mut self, simd: S, steps: usize, active: Lanes<S>) -> Lanes<S> {
        let mut away = Lanes::new(simd, 0.0);
        let limbs = self.nominal.iter().zip(&mut self.joints);
        for ((plan, joints), (forward, _)) in limbs.zip(&mut self.passes) {
            away = away.max(joints.find(plan, forward, &self.target, steps, active));
        }
        away
    }

    /// Limbs as they are bent, where the joints lead.
    #[inline(always)]
    pub fn limbs_follow(&mut self) {
        let limbs = self.limbs.iter_mut().zip(self.actual.iter());
        for ((limb, plan), joints) in limbs.zip(&self.joints) {
            limb.follow(plan, joints);
        }
    }

    /// Limbs unloaded where the joints lead.
    #[inline(always)]
    fn start_limbs(&mut self) {
        let limbs = self.limbs.iter_mut().zip(self.actual.iter());
        for ((limb, plan), joints) in limbs.zip(&self.joints) {
            limb.start(plan, &joints.commands, &joints.passive);
        }
    }

    /// The unloaded machine's own compliance, limb by limb and of the platform, in the lanes that are `lost` or far from
    /// where it was found last: the smallest relative pivot.
    #[inline(always)]
    fn update_compliance(&mut self, simd: S, lost: Lanes<S>) -> Lanes<S> {
        let wanted = self.far(simd, lost);
        if wanted.all_less(0.5) {
            return self.regular;
        }
        let mut sum = Symmetric::zero(simd);
        let mut regular = Lanes::new(simd, 1.0);
        let limbs = self.actual.iter().zip(&self.joints);
        for (((plan, joints), (_, forward)), attached) in
            limbs.zip(&mut self.passes).zip(&mut self.attached)
        {
            let steps = plan.steps.len();
            forward.along(plan, true, steps, &joints.commands, &joints.passive);
            let factors = forward.eliminated(plan);
            let own = factors.stiffness(simd);
            regular = regular.least_of(own.regular);
            let mut most = own.matrix.get(0, 0);
            for k in 1..6 {
                most = most.max(own.matrix.get(k, k));
            }
            let count = plan.passive.len();
            let corrector = Corrector::new(simd, &factors, &own.matrix, plan.length, count);
            attached.take(wanted, &corrector, most);
            sum.add(&attached.corrector.stiffness);
        }
        let (compliance, own) = sum.inverse(simd);
        self.compliance.take(wanted, &compliance);
        self.regular = select(wanted, regular.least_of(own), self.regular);
        for k in 0..9 {
            let last = &mut self.compliance_at.rotation[k];
            *last = select(wanted, self.target.rotation[k], *last);
        }
        for k in 0..3 {
            let last = &mut self.compliance_at.point[k];
            *last = select(wanted, self.target.point[k], *last);
        }
        self.regular
    }

    /// One in the lanes that are `lost`, or that have gone far from where the compliance was found.
    #[inline(always)]
    fn far(&self, simd: S, lost: Lanes<S>) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let mut most = zero;
        let shift = minus(&self.target.point, &self.compliance_at.point);
        for x in shift {
            most = most.max(x.abs() * (1.0 / self.nominal[0].length));
        }
        for (to, from) in self
            .target
            .rotation
            .iter()
            .zip(&self.compliance_at.rotation)
        {
            most = most.max((*to - *from).abs());
        }
        // NaN counts as a new start, too.
        lost.max(most.where_less(one * SAME_PLACE, zero, one))
    }
}

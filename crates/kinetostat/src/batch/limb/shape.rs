//! Does a limb keep its shape while its end is held? The share to buckling of [`crate::chain::ShapeStability`], several
//! postures at once.
//!
//! Springs are counted in units in which their material stiffness is one, `C = M M^T`, so that the share
//! is the largest eigenvalue of the loads' Hessian among motions that leave the end where it is. A link
//! that is bent takes its geometric stiffness from that Hessian, as [`crate::chain::stability`] does. With
//! twists `T` of the springs and `P` of the passive joints, `T y + P x = 0`: reflections of `P` give `x = W y`
//! and conditions on `y` alone, reflections of these leave the motions `y` that are free. What is left
//! is made tridiagonal, and Laguerre's iteration goes down to the largest eigenvalue from above: it
//! never passes it.

use pulp::Simd;

use crate::batch::limb::law;
use crate::batch::limb::loaded::{LoadedLimb, deflection, twist, twists};
use crate::batch::limb::tangent_own_weight::{couples, sum_along};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::reflection::{reflect, reflect_apart, reflection};
use crate::batch::numbers::vectors::{Vec3, constant, cross, dot, minus};
use crate::batch::numbers::wrenches::{Mat6, inner6, outer};
use crate::batch::plan::steps::{Law, Plan, Spring, Step, Support};

/// Motions of one coordinate in the order of the limb.
struct Motion<S: Simd> {
    /// Springs first, then passive joints.
    place: usize,
    twist: [Lanes<S>; 6],
}

/// Buffers for the share to buckling of one limb.
pub(crate) struct Shape<S: Simd> {
    motions: Vec<Motion<S>>,
    /// Hessian of the loads, springs first, row by row: its lower triangle.
    h: Vec<Lanes<S>>,
    springs: usize,
    joints: usize,
    /// Rows: twists of the springs, then conditions on them.
    t: Vec<Lanes<S>>,
    w: Vec<Lanes<S>>,
    v: Vec<Lanes<S>>,
    u: Vec<Lanes<S>>,
    regular: Lanes<S>,
    simd: S,
}

impl<S: Simd> Shape<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let springs = springs(plan);
        let joints = plan.passive.len();
        let n = springs + joints;
        Self {
            motions: Vec::with_capacity(n + plan.screws.len()),
            h: vec![zero; n * n],
            springs,
            joints,
            t: vec![zero; 6 * springs],
            w: vec![zero; 6 * n],
            v: vec![zero; n],
            u: vec![zero; n],
            regular: zero,
            simd,
        }
    }

    /// The share of the way to buckling, and the smallest relative pivot on the way to it. `None` where nothing but the end
    /// can move.
    #[inline(always)]
    pub fn share_to_buckling(
        &mut self,
        plan: &Plan,
        limb: &LoadedLimb<S>,
        gravity: &[f64; 3],
    ) -> Option<(Lanes<S>, Lanes<S>)> {
        let held = 6 - self.joints.min(6);
        if self.springs <= held {
            return None;
        }
        self.regular = Lanes::new(self.simd, 1.0);
        self.hessian(plan, limb, gravity);
        self.without_joints(plan);
        for k in 0..held {
            self.hold(k, held);
        }
        let share_to_buckling = self.largest(held);
        Some((share_to_buckling, self.regular))
    }

    /// The motions of all coordinates, from the base outwards, springs in units in which their material stiffness is
    /// one.
    #[inline(always)]
    fn list_motions(&mut self, plan: &Plan, limb: &LoadedLimb<S>) {
        apart!(self.simd, {
            let simd = self.simd;
            let zero = Lanes::new(simd, 0.0);
            self.motions.clear();
            let (mut place, mut law) = (0, 0);
            for step in &plan.steps {
                match step {
                    Step::Joint(joint) => {
                        let Some((own, ratio)) = joint.amount.coordinate else {
                            continue;
                        };
                        let mut s = twist(limb, plan, joint.screw);
                        let (at, factor) = match joint.support {
                            Support::Spring(_) if joint.law.is_some() => {
                                let k = limb.joint_stiffness(joint, own, 1.0);
                                (place, ((zero + ratio * ratio) / k).sqrt() * ratio.signum())
                            }
                            Support::Spring(c) => (place, zero + ratio * c.sqrt()),
                            Support::Passive(slot) => (self.springs + slot, zero + ratio),
                            Support::Fixed => continue,
                        };
                        for x in &mut s {
                            *x = *x * factor;
                        }
                        place += usize::from(at < self.springs);
                        self.motions.push(Motion {
                            place: at,
                            twist: s,
                        });
                    }
                    Step::Spring(spring) => {
                        let (root, _) = root(simd, limb, spring, law);
                        law += usize::from(matches!(spring.law, Law::Parallelogram(..)));
                        let s = twists(simd, plan, limb, spring);
                        for k in 0..6 {
                            if spring.coordinates[k].is_none() {
                                continue;
                            }
                            let mut sum = [zero; 6];
                            for d in first_row(spring, k)..6 {
                                for r in 0..6 {
                                    sum[r] = s[d][r].times_plus(root[d][k], sum[r]);
                                }
                            }
                            self.motions.push(Motion { place, twist: sum });
                            place += 1;
                        }
                    }
                    Step::Mass { .. } | Step::Shift(_) | Step::Rotate(_) => {}
                }
            }
        })
    }

    /// The Hessian from the end inwards: `H_ij = s_i^T (G + A / 2) s_j` for `i` beyond `j`, `G` symmetric
    /// ([`crate::chain::sweep::stages`]), less the springs' geometric stiffness.
    #[inline(always)]
    fn hessian(&mut self, plan: &Plan, limb: &LoadedLimb<S>, gravity: &[f64; 3]) {
        self.list_motions(plan, limb);
        apart!(self.simd, {
            let simd = self.simd;
            let zero = Lanes::new(simd, 0.0);
            let mut law = plan.parallelograms();
            self.h.fill(zero);
            let [fx, fy, fz, mx, my, mz] = limb.wrench;
            let mut loads = Loads {
                g: [[zero; 6]; 6],
                force: [fx, fy, fz],
                moment: [mx, my, mz],
            };
            loads.node(&[fx, fy, fz], &[zero; 3]);
            let (mut mass, mut last) = (limb.masses.len(), self.motions.len());
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { mass: m, .. } => {
                        mass -= 1;
                        let arm = minus(&limb.masses[mass], &limb.point);
                        let [x, y, z] = *gravity;
                        let weight = [zero + x * m, zero + y * m, zero + z * m];
                        let own = cross(&arm, &weight);
                        for k in 0..3 {
                            loads.force[k] = loads.force[k] + weight[k];
                            loads.moment[k] = loads.moment[k] + own[k];
                        }
                        loads.node(&weight, &arm);
                    }
                    Step::Joint(joint) => {
                        if joint.amount.coordinate.is_none()
                            || matches!(joint.support, Support::Fixed)
                        {
                            continue;
                        }
                        last -= 1;
                        let own = self.couple(last, last, &loads);
                        let place = self.motions[last].place;
                        self.add(place, place, own);
                    }
                    Step::Spring(spring) => {
                        let mut end = last;
                        last -= spring.coordinates.iter().flatten().count();
                        while end > last {
                            end -= 1;
                            self.couple(end, last, &loads);
                        }
                        law -= usize::from(matches!(spring.law, Law::Parallelogram(..)));
                        let first = self.motions[last].place;
                        let root = root(simd, limb, spring, law);
                        let s = twists(simd, plan, limb, spring);
                        self.within(spring, first, (&s, &root), &loads);
                        if let Some(own) = &spring.own_weight {
                            let axes = [[s[1][0], s[1][1], s[1][2]], [s[2][0], s[2][1], s[2][2]]];
                            let g = constant(simd, gravity);
                            self.couple_own_weight(last, &couples(own, &axes, &g), &root.0);
                            loads.own_weight(&limb.lean_along(own, &axes), &g);
                        }
                    }
                    Step::Shift(_) | Step::Rotate(_) => {}
                }
            }
        })
    }

    /// Couples the six motions of a spring from `at` on with those before it by the weight of its segment: `couples` are its
    /// moments on the near end by the two turns.
    #[inline(always)]
    fn couple_own_weight(&mut self, at: usize, couples: &[Vec3<S>; 2], root: &Mat6<S>) {
        apart!(self.simd, {
            for k in 0..6 {
                let turning = sum_along(&[root[4][k], root[5][k]], couples);
                let place = self.motions[at + k].place;
                for j in 0..at {
                    let Motion {
                        place: other,
                        twist,
                    } = &self.motions[j];
                    let (other, turn) = (*other, [twist[3], twist[4], twist[5]]);
                    let value = dot(&turning, &turn);
                    self.add_both(place, other, value);
                }
            }
        });
    }

    /// Couples motion `at` with the first `count` ones; returns `s^T G s` of its own.
    #[inline(always)]
    fn couple(&mut self, at: usize, count: usize, loads: &Loads<S>) -> Lanes<S> {
        let s = self.motions[at].twist;
        let place = self.motions[at].place;
        let turned = outer(&loads.force, &loads.moment, &s);
        let mut row = s;
        for i in 0..6 {
            row[i] = inner6(&loads.g[i], &s);
        }
        let own = inner6(&row, &s);
        for i in 0..6 {
            // s^T A = -(A s)^T.
            row[i] = row[i] - turned[i] * 0.5;
        }
        for j in 0..count {
            let other = self.motions[j].place;
            let value = inner6(&row, &self.motions[j].twist);
            self.add_both(place, other, value);
        }
        own
    }

    /// Adds a value and its mirror image, of which only the lower triangle is kept; on the diagonal both are the same entry.
    #[inline(always)]
    fn add_both(&mut self, i: usize, j: usize, value: Lanes<S>) {
        match i == j {
            true => self.add(i, i, value + value),
            false => self.add(i.max(j), i.min(j), value),
        }
    }

    /// Adds to an entry of the lower triangle.
    #[inline(always)]
    fn add(&mut self, i: usize, j: usize, value: Lanes<S>) {
        let n = self.springs + self.joints;
        self.h[i * n + j] = self.h[i * n + j] + value;
    }

    /// Block of a spring of six directions: `M^T B M`.
    #[inline(always)]
    fn within(
        &mut self,
        spring: &Spring,
        first: usize,
        (s, (root, geometric)): (&Mat6<S>, &(Mat6<S>, Mat6<S>)),
        loads: &Loads<S>,
    ) {
        apart!(self.simd, {
            let zero = Lanes::new(self.simd, 0.0);
            let mut b = [[zero; 6]; 6];
            for j in 0..6 {
                let turned = outer(&loads.force, &loads.moment, &s[j]);
                let mut column = turned;
                for i in 0..6 {
                    column[i] = inner6(&loads.g[i], &s[j]);
                }
                b[j][j] = inner6(&column, &s[j]);
                for i in 0..6 {
                    column[i] = column[i] + turned[i] * 0.5;
                }
                for i in j + 1..6 {
                    b[i][j] = inner6(&column, &s[i]);
                    b[j][i] = b[i][j];
                }
            }
            if matches!(spring.law, Law::Curved(..)) {
                for i in 0..6 {
                    for j in 0..6 {
                        let own = (geometric[i][j] + geometric[j][i]) * 0.5;
                        b[i][j] = b[i][j] - own;
                    }
                }
            }
            let mut bm = [[zero; 6]; 6];
            for i in 0..6 {
                // The others meet zeros of `M^T`.
                for k in (0..6).filter(|k| i >= first_row(spring, *k)) {
                    for d in first_row(spring, k)..6 {
                        bm[i][k] = b[i][d].times_plus(root[d][k], bm[i][k]);
                    }
                }
            }
            let mut row = first;
            for i in 0..6 {
                if spring.coordinates[i].is_none() {
                    continue;
                }
                let mut column = first;
                for k in 0..=i {
                    if spring.coordinates[k].is_none() {
                        continue;
                    }
                    let mut sum = zero;
                    for d in first_row(spring, i)..6 {
                        sum = root[d][i].times_plus(bm[d][k], sum);
                    }
                    self.add(row, column, sum);
                    column += 1;
                }
                row += 1;
            }
        })
    }

    /// Passive joints follow the springs: `x = W y`, `H <- H_yy + Z W + (Z W)^T` with
    /// `Z = H_yx + W^T H_xx / 2`; what remains of the twists are conditions on `y`.
    #[inline(always)]
    fn without_joints(&mut self, plan: &Plan) {
        apart!(self.simd, {
            let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
            let (springs, joints) = (self.springs, self.joints.min(6));
            let n = springs + self.joints;
            let unit = 1.0 / plan.length;
            let mut p = [[zero; 6]; 6];
            for motion in &self.motions {
                for r in 0..6 {
                    let x = motion.twist[r] * if r < 3 { unit } else { 1.0 };
                    if motion.place < springs {
                        self.t[r * springs + motion.place] = x;
                    } else {
                        let own = &mut p[motion.place - springs][r];
                        *own = *own + x;
                    }
                }
            }
            for k in 0..joints {
                let (mut v, mut u) = (p[k], [zero; 6]);
                let image = reflection(k, &mut v, &mut u);
                self.regular = self.regular.least_of(image.share);
                p[k][k] = image.number;
                for other in &mut p[k + 1..joints] {
                    reflect(k..6, &v, &u, other);
                }
                for c in 0..springs {
                    reflect_apart(k..6, &v, &u, &mut self.t, c, springs);
                }
            }
            if joints == 0 {
                return;
            }
            // R W = -T_1.
            for c in 0..springs {
                for k in (0..joints).rev() {
                    let mut x = -self.t[k * springs + c];
                    for j in k + 1..joints {
                        x = p[j][k].times_from(self.w[j * springs + c], x);
                    }
                    self.w[k * springs + c] = x / p[k][k];
                }
            }
            for c in 0..springs {
                let mut z = [zero; 6];
                for k in 0..joints {
                    let mut sum = zero;
                    for j in 0..joints {
                        let h = self.h[(springs + j.max(k)) * n + springs + j.min(k)];
                        sum = self.w[j * springs + c].times_plus(h, sum);
                    }
                    z[k] = sum.times_plus(one * 0.5, self.h[(springs + k) * n + c]);
                }
                for j in 0..springs {
                    let mut sum = zero;
                    for k in 0..joints {
                        sum = z[k].times_plus(self.w[k * springs + j], sum);
                    }
                    self.add_both(c, j, sum);
                }
            }
        })
    }

    /// Takes the motion along condition `k` out, which a reflection makes the `k`-th: the conditions
    /// are the last `held` rows of the twists.
    #[inline(always)]
    fn hold(&mut self, k: usize, held: usize) {
        let springs = self.springs;
        let own = (6 - held + k) * springs;
        self.v[..springs].copy_from_slice(&self.t[own..own + springs]);
        let (v, u) = (&mut self.v[..springs], &mut self.u[..springs]);
        let image = reflection(k, v, u);
        self.regular = self.regular.least_of(image.share);
        for row in k + 1..held {
            let row = (6 - held + row) * springs;
            reflect(k..springs, v, u, &mut self.t[row..row + springs]);
        }
        self.reflect(k);
    }

    /// `H <- (1 - v u^T)^T H (1 - v u^T)` from row `k` on, of which the lower triangle is kept: `H - v w^T - w v^T` with `w = H u - v (u^T H u) / 2`.
    #[inline(always)]
    fn reflect(&mut self, k: usize) {
        let zero = Lanes::new(self.simd, 0.0);
        let (springs, n) = (self.springs, self.springs + self.joints);
        self.w[k..springs].fill(zero);
        for i in k..springs {
            let row = &self.h[i * n..=i * n + i];
            let u = self.u[i];
            let mut sum = row[i] * u;
            for c in k..i {
                sum = row[c].times_plus(self.u[c], sum);
                self.w[c] = row[c].times_plus(u, self.w[c]);
            }
            self.w[i] = sum;
        }
        let mut along = zero;
        for i in k..springs {
            along = self.w[i].times_plus(self.u[i], along);
        }
        let half = along * 0.5;
        for i in k..springs {
            self.w[i] = half.times_from(self.v[i], self.w[i]);
        }
        for i in k..springs {
            let row = &mut self.h[i * n..=i * n + i];
            let (v, w) = (self.v[i], self.w[i]);
            for c in k..=i {
                row[c] = v.times_from(self.w[c], w.times_from(self.v[c], row[c]));
            }
        }
    }

    /// Largest eigenvalue of the Hessian's last block, from row `first` on.
    #[inline(always)]
    fn largest(&mut self, first: usize) -> Lanes<S> {
        apart!(self.simd, {
            let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
            let (springs, n) = (self.springs, self.springs + self.joints);
            for k in first..springs.saturating_sub(2) {
                // Column k below the diagonal onto its first entry.
                for c in k + 1..springs {
                    self.v[c] = self.h[c * n + k];
                }
                let (v, u) = (&mut self.v[..springs], &mut self.u[..springs]);
                self.h[(k + 1) * n + k] = reflection(k + 1, v, u).number;
                self.reflect(k + 1);
            }
            // Squares beside the diagonal, and a bound from above, in units of the largest row.
            let mut size = one * 1e-280;
            for i in first..springs {
                size = size.max(self.row_size(i, first).0);
            }
            let scale = one / size;
            let mut x = -one;
            for i in first..springs {
                let (_, beside) = self.row_size(i, first);
                x = x.max((self.h[i * n + i] + beside) * scale);
                self.v[i] = self.h[i * n + i] * scale;
                let b = if i > first {
                    self.h[i * n + i - 1] * scale
                } else {
                    zero
                };
                self.u[i] = b * b;
            }
            #[allow(clippy::cast_precision_loss)] // some dozens
            let order = (springs - first) as f64;
            x = x + 1e-3;
            let mut active = one;
            for _ in 0..MOST_STEPS {
                // Pivots of x - H and their two derivatives, each over the pivot.
                let (mut sum, mut squares) = (zero, zero);
                let (mut q, mut q1, mut q2) = (one, zero, zero);
                let mut least = one;
                for i in first..springs {
                    let over = self.u[i] / q;
                    let p = x - self.v[i] - over;
                    least = least.least_of(p);
                    let r = one / p;
                    let p1 = over.times_plus(q1, one) * r;
                    let p2 = over * (q2 - q1 * q1 * 2.0) * r;
                    sum = sum + p1;
                    squares = p1.times_plus(p1, squares) - p2;
                    (q, q1, q2) = (p, p1, p2);
                }
                let under = (squares * order - sum * sum) * (order - 1.0);
                let step = one * order / (sum + under.max(zero).sqrt());
                // All pivots are positive from above: one that is not is rounding at the eigenvalue.
                let step = least.where_less(one * LEAST, zero, step);
                x = active.where_less(one * 0.5, x, x - step);
                active = step.where_less(one * ROUNDING, zero, active);
                if active.all_less(0.5) {
                    break;
                }
            }
            self.regular = self.regular.least_of(one - active);
            x * size
        })
    }

    /// Sum of the sizes of a row of three entries, and of those beside the diagonal.
    #[inline(always)]
    fn row_size(&self, i: usize, first: usize) -> (Lanes<S>, Lanes<S>) {
        let n = self.springs + self.joints;
        let own = self.h[i * n + i];
        let mut beside = own * 0.0;
        if i > first {
            beside = beside + self.h[i * n + i - 1].abs();
        }
        if i + 1 < self.springs {
            beside = beside + self.h[(i + 1) * n + i].abs();
        }
        (own.abs() + beside, beside)
    }
}

/// Coordinates of a limb that springs hold.
pub(crate) fn springs(plan: &Plan) -> usize {
    let mut count = 0;
    for step in &plan.steps {
        match step {
            Step::Spring(spring) => count += spring.coordinates.iter().flatten().count(),
            Step::Joint(joint) if matches!(joint.support, Support::Spring(_)) => count += 1,
            _ => {}
        }
    }
    count
}

/// Steps of Laguerre's iteration: three or four where the largest eigenvalue stands alone.
const MOST_STEPS: usize = 100;
/// A pivot that is not larger is none, in units of the largest row.
const LEAST: f64 = 1e-30;
/// A step after which the next one would be rounding, in the same units.
const ROUNDING: f64 = 1e-14;

/// Loads beyond a place, about the tip's place.
struct Loads<S: Simd> {
    /// Symmetric part of `G`.
    g: Mat6<S>,
    force: Vec3<S>,
    moment: Vec3<S>,
}

impl<S: Simd> Loads<S> {
    /// Adds the symmetric part of `[0, 0; -hat(f), hat(f) hat(arm)]` of a dead force, to whose place `arm`
    /// leads from the tip's.
    #[inline(always)]
    fn node(&mut self, force: &Vec3<S>, arm: &Vec3<S>) {
        let [x, y, z] = *force;
        let zero = x.same(0.0);
        let hat = [[zero, -z, y], [z, zero, -x], [-y, x, zero]];
        for i in 0..3 {
            for j in 0..3 {
                let half = hat[i][j] * 0.5;
                self.g[3 + i][j] = self.g[3 + i][j] - half;
                self.g[j][3 + i] = self.g[j][3 + i] - half;
            }
        }
        self.turning(force, arm);
    }

    /// Adds what the weight of a segment does besides that of its halves: the moment `c x g` turns with the near end.
    #[inline(always)]
    fn own_weight(&mut self, c: &Vec3<S>, gravity: &Vec3<S>) {
        let turning = cross(c, gravity);
        for k in 0..3 {
            self.moment[k] = self.moment[k] + turning[k];
        }
        self.turning(gravity, c);
    }

    /// Adds the rotational part: that of a pair of forces with the moment `arm x f`.
    #[inline(always)]
    fn turning(&mut self, force: &Vec3<S>, arm: &Vec3<S>) {
        let along = dot(force, arm);
        for i in 0..3 {
            for j in 0..3 {
                // hat(f) hat(arm) = arm f^T - (f . arm).
                let both = arm[i].times_plus(force[j], arm[j] * force[i]);
                self.g[3 + i][3 + j] = both.times_plus(along.same(0.5), self.g[3 + i][3 + j]);
            }
            self.g[3 + i][3 + i] = self.g[3 + i][3 + i] - along;
        }
    }
}

/// `M` of the compliance, `C = M M^T`, and the geometric stiffness; nothing where a direction does not
/// move. Lower triangular unless the spring has strains of its own.
#[inline(always)]
fn root<S: Simd>(simd: S, limb: &LoadedLimb<S>, spring: &Spring, law: usize) -> (Mat6<S>, Mat6<S>) {
    apart!(simd, {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let mut m = [[zero; 6]; 6];
        for j in 0..6 {
            if spring.coordinates[j].is_none() {
                continue;
            }
            let mut reciprocal = zero;
            for i in j..6 {
                let mut x = match &spring.law {
                    Law::Parallelogram(..) => limb.laws[law].get(i, j),
                    Law::Constant => one * spring.compliance[6 * i + j],
                    // Compliance of the strains.
                    Law::Curved(_, compliance) => one * compliance[6 * i + j],
                };
                for k in 0..j {
                    x = m[i][k].times_from(m[j][k], x);
                }
                if i == j {
                    m[j][j] = x.sqrt();
                    reciprocal = one / m[j][j];
                } else {
                    m[i][j] = x * reciprocal;
                }
            }
        }
        let Law::Curved(law, _) = &spring.law else {
            return (m, [[zero; 6]; 6]);
        };
        // Strains to motions.
        let (geometric, inverse) = law::geometric(law, &deflection(limb, spring));
        let mut motions = [[zero; 6]; 6];
        for i in 0..6 {
            for d in 0..6 {
                for k in 0..=d {
                    motions[i][k] = inverse[i][d].times_plus(m[d][k], motions[i][k]);
                }
            }
        }
        (motions, geometric)
    })
}

/// The first row of column `k` of a spring's `M` that is not zero.
#[inline(always)]
fn first_row(spring: &Spring, k: usize) -> usize {
    if matches!(spring.law, Law::Curved(..)) {
        0
    } else {
        k
    }
}

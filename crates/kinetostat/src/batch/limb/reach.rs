//! Inverse kinematics of a limb, several poses at once: Newton's iteration from home on its passive
//! joints and commands. A spherical joint at the end leaves three equations for the position of its
//! centre, then three for its own angles, which an unloaded stiffness does not need.

use pulp::Simd;

use crate::batch::limb::unloaded::ForwardPass;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{
    Mat3, Vec3, carried, column, constant, cross, dot, matrix, minus, select, turn_between,
};
use crate::batch::numbers::wrenches::Mat6;
use crate::batch::plan::steps::{Plan, Polar, Rows, Search};

/// A limb that is not there after so many steps is left to the search posture by posture.
pub(crate) const MOST_STEPS: usize = 24;
/// Nearer than this (share of the natural length), one more step of a quadratic iteration is exact.
const NEAR: f64 = 1e-8;

/// Target of the platform.
#[derive(Clone, Copy)]
pub(crate) struct Target<S: Simd> {
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
}

/// Joints of a limb.
pub(crate) struct Joints<S: Simd> {
    pub commands: Vec<Lanes<S>>,
    pub passive: Vec<Lanes<S>>,
    /// Columns of the Jacobian and factors of a step: filling them anew in every step took as long as using them.
    columns: Mat6<S>,
    factors: Mat6<S>,
}

impl<S: Simd> Joints<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        Self {
            commands: vec![zero; plan.commands],
            passive: vec![zero; plan.passive.len()],
            columns: [[zero; 6]; 6],
            factors: [[zero; 6]; 6],
        }
    }

    /// Moves to home in the lanes where `lost` is one.
    #[inline(always)]
    pub fn home(&mut self, simd: S, plan: &Plan, lost: Lanes<S>) {
        for (x, home) in self.commands.iter_mut().zip(&plan.home_commands) {
            *x = select(lost, Lanes::new(simd, *home), *x);
        }
        for (x, own) in self.passive.iter_mut().zip(&plan.passive) {
            *x = select(lost, Lanes::new(simd, plan.home[*own]), *x);
        }
    }

    /// Joints from home to the target, those of a spherical joint at the limb's end left out, and the forward pass with
    /// them there: one where that is found.
    #[inline(always)]
    pub fn reach(
        &mut self,
        simd: S,
        plan: &Plan,
        forward: &mut ForwardPass<S>,
        target: &Target<S>,
    ) -> Lanes<S> {
        let one = Lanes::new(simd, 1.0);
        self.home(simd, plan, one);
        forward.known = None;
        if let Some(polar) = &plan.polar {
            return self.point_to(simd, polar, forward, target, plan);
        }
        let search = &plan.searches[0];
        let away = self.search(plan, search, forward, target, MOST_STEPS, one);
        forward.along(plan, true, search.end, &self.commands, &self.passive);
        one - away
    }

    /// All joints, from where they are to the target, in at most so many steps and in the lanes where `active` is one:
    /// one in those that are not there yet.
    #[inline(always)]
    pub fn find(
        &mut self,
        plan: &Plan,
        forward: &mut ForwardPass<S>,
        target: &Target<S>,
        steps: usize,
        active: Lanes<S>,
    ) -> Lanes<S> {
        forward.known = None;
        let mut away = active.same(0.0);
        // One call in one place: the search is large, and every call is a copy of it.
        for search in &plan.searches {
            let own = self.search(plan, search, forward, target, steps, active);
            away = away.max(own);
        }
        away
    }

    /// Polar joints from where they lead. With `u` the direction there in the frame of the first
    /// rotation, axes `a`, `b` and `c = a x b` or `b x a`: `u_a = +-sin b`, `u_b = -+sin a cos b`,
    /// `u_c = cos a cos b`. Beyond a right angle from home the branch is the search's to find.
    #[inline(always)]
    fn point_to(
        &mut self,
        simd: S,
        polar: &Polar,
        forward: &mut ForwardPass<S>,
        target: &Target<S>,
        plan: &Plan,
    ) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let d = minus(
            &sphere_centre(simd, plan, target),
            &constant(simd, &polar.point),
        );
        let r = matrix(simd, &polar.rotation);
        let d = [
            dot(&column(&r, 0), &d),
            dot(&column(&r, 1), &d),
            dot(&column(&r, 2), &d),
        ];
        let [a, b] = polar.axes;
        let sense = if (a + 1) % 3 == b { 1.0 } else { -1.0 };
        let length = dot(&d, &d).sqrt() * polar.sign;
        let reciprocal = one / length;
        let (u, v, w) = (
            d[a] * reciprocal,
            d[b] * reciprocal,
            d[3 - a - b] * reciprocal,
        );
        let sine = u * sense;
        let home = polar.home;
        let cosine = w.times_plus(w, v * v).sqrt() * home[1].1.signum();
        let over = one / cosine;
        let first = (v * over * -sense, w * over);
        let mut reached = one;
        for ((s, c), home) in [(first, home[0]), ((sine, cosine), home[1])] {
            let near = s.times_plus(one * home.0, c * home.1);
            reached = near.where_less(one * 0.1, zero, reached);
        }
        // At zero length the direction is undefined.
        reached = reached.least_of(length.abs());
        forward.known = Some((polar.first, [first, (sine, cosine)]));
        self.commands[polar.command] = (length - polar.fixed) * (1.0 / polar.ratio);
        let end = plan.searches[0].end;
        forward.along(plan, true, end, &self.commands, &self.passive);
        reached
    }

    /// Newton's iteration in at most so many steps, in the lanes where `active` is one: one in those that it has not
    /// brought to its end.
    #[inline(always)]
    fn search(
        &mut self,
        plan: &Plan,
        search: &Search,
        forward: &mut ForwardPass<S>,
        target: &Target<S>,
        steps: usize,
        mut active: Lanes<S>,
    ) -> Lanes<S> {
        let simd = active.simd();
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let joints = search.passive.len();
            let unknowns = joints + search.commands;
            if unknowns > 6 {
                return one;
            }
            let centre = match search.rows {
                Rows::Position => sphere_centre(simd, plan, target),
                Rows::Rotation | Rows::Both => target.point,
            };
            let length = plan.length;
            for _ in 0..steps {
                if active.all_less(0.5) {
                    break;
                }
                forward.along(plan, false, search.end, &self.commands, &self.passive);
                let columns = &mut self.columns;
                columns[..unknowns].fill([zero; 6]);
                forward.columns(plan, &search.drives, columns);
                let residual = minus(&centre, &forward.point);
                let mut e = [residual[0], residual[1], residual[2], zero, zero, zero];
                if search.rows != Rows::Position {
                    let turn = turn_between(&target.rotation, &forward.rotation);
                    for k in 0..3 {
                        e[3 + k] = turn[k] * length;
                        for column in &mut columns[..unknowns] {
                            column[3 + k] = column[3 + k] * length;
                        }
                    }
                }
                let linear = dot(&residual, &residual);
                let angular = dot(&[e[3], e[4], e[5]], &[e[3], e[4], e[5]]);
                let factors = &mut self.factors;
                let (square, mut step) = match search.rows {
                    Rows::Position if unknowns == 3 => (linear, square_step(columns, &e)),
                    Rows::Position => (
                        linear,
                        least_squares_step::<S, 0, 3>(simd, unknowns, columns, factors, &e),
                    ),
                    Rows::Rotation => (
                        angular,
                        least_squares_step::<S, 3, 6>(simd, unknowns, columns, factors, &e),
                    ),
                    Rows::Both => (
                        linear + angular,
                        least_squares_step::<S, 0, 6>(simd, unknowns, columns, factors, &e),
                    ),
                };
                let (mut share, mut largest) = (one, zero);
                for k in 0..unknowns {
                    let size = step[k].abs().max(one * 1e-300);
                    share = share.least_of(one * search.most[k] / size);
                    let unit = if search.most[k] == length {
                        1.0 / length
                    } else {
                        1.0
                    };
                    largest = largest.max(size * unit);
                }
                for k in 0..unknowns {
                    step[k] = active.where_less(one * 0.5, zero, step[k] * share);
                }
                for k in 0..joints {
                    let x = &mut self.passive[search.passive.start + k];
                    *x = *x + step[k];
                }
                for k in 0..search.commands {
                    self.commands[k] = self.commands[k] + step[joints + k];
                }
                // Near a stretched limb joints go far for little: a short way that is left is no proof.
                let near = NEAR * length;
                let there = square.where_less(one * (near * near), one, zero);
                let still = largest.where_less(one * NEAR, there, zero);
                active = active * (one - still);
            }
            active
        })
    }
}

/// Target of the centre of the spherical joint at the limb's end; the platform's point without one.
#[inline(always)]
fn sphere_centre<S: Simd>(simd: S, plan: &Plan, target: &Target<S>) -> Vec3<S> {
    let [x, y, z] = match &plan.sphere {
        Some(sphere) => sphere.arm,
        None => [0.0; 3],
    };
    let arm = constant(simd, &[-x, -y, -z]);
    carried(&target.rotation, &arm, &target.point)
}

/// Three equations, three unknowns: Cramer's rule.
#[inline(always)]
fn square_step<S: Simd>(columns: &Mat6<S>, e: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
    let [a, b, c, ..] = columns;
    let (a, b, c) = ([a[0], a[1], a[2]], [b[0], b[1], b[2]], [c[0], c[1], c[2]]);
    let e = [e[0], e[1], e[2]];
    let bc = cross(&b, &c);
    let reciprocal = e[0].same(1.0) / dot(&a, &bc);
    let ae = cross(&a, &e);
    let zero = e[0].same(0.0);
    [
        dot(&e, &bc) * reciprocal,
        dot(&c, &ae) * reciprocal,
        -(dot(&b, &ae) * reciprocal),
        zero,
        zero,
        zero,
    ]
}

/// `(J^T J)^-1 J^T e` for the first `unknowns` columns and the rows from `FROM` up to `TO`; `l` takes the factors.
#[inline(always)]
fn least_squares_step<S: Simd, const FROM: usize, const TO: usize>(
    simd: S,
    unknowns: usize,
    columns: &Mat6<S>,
    l: &mut Mat6<S>,
    e: &[Lanes<S>; 6],
) -> [Lanes<S>; 6] {
    apart!(simd, {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let unknowns = unknowns.min(6);
        let mut x = [zero; 6];
        for j in 0..unknowns {
            let mut pivot = inner::<S, FROM, TO>(&columns[j], &columns[j]);
            for k in 0..j {
                pivot = l[j][k].times_from(l[j][k], pivot);
            }
            let r = one / pivot.sqrt();
            l[j][j] = r;
            for i in j + 1..unknowns {
                let mut y = inner::<S, FROM, TO>(&columns[i], &columns[j]);
                for k in 0..j {
                    y = l[i][k].times_from(l[j][k], y);
                }
                l[i][j] = y * r;
            }
            let mut y = inner::<S, FROM, TO>(&columns[j], e);
            for k in 0..j {
                y = l[j][k].times_from(x[k], y);
            }
            x[j] = y * r;
        }
        for j in (0..unknowns).rev() {
            let mut y = x[j];
            for k in j + 1..unknowns {
                y = l[k][j].times_from(x[k], y);
            }
            x[j] = y * l[j][j];
        }
        x
    })
}

#[inline(always)]
fn inner<S: Simd, const FROM: usize, const TO: usize>(
    a: &[Lanes<S>; 6],
    b: &[Lanes<S>; 6],
) -> Lanes<S> {
    let mut sum = a[FROM] * b[FROM];
    for k in FROM + 1..TO {
        sum = a[k].times_plus(b[k], sum);
    }
    sum
}

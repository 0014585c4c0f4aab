//! Inverse kinematics of a limb, several poses at once: Newton's iteration from home on its passive
//! joints and commands. A spherical joint at the end leaves three equations for the position of its
//! centre, then three for its own angles, which an unloaded stiffness does not need.

use pulp::Simd;

use super::lanes::{Lanes, Mat3, Vec3, carried, cross, dot, minus, product_transposed};
use super::plan::{Plan, Screw};
use super::unloaded::Walk;
use crate::chain::MotionKind;

/// A limb that is not there after so many steps is left to the search posture by posture.
const MOST_STEPS: usize = 24;
/// Nearer than this (share of the natural length), one more step of a quadratic iteration is exact.
const NEAR: f64 = 1e-8;

/// Where the platform shall be.
pub(super) struct Target<S: Simd> {
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
}

/// Joints of a limb; `reached` is one where the iteration has converged and zero elsewhere.
pub(super) struct Joints<S: Simd> {
    pub commands: Vec<Lanes<S>>,
    pub passive: Vec<Lanes<S>>,
    pub reached: Lanes<S>,
}

/// Which equations a search solves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rows {
    Position,
    Rotation,
    Both,
}

impl<S: Simd> Joints<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        Self {
            commands: vec![zero; plan.commands],
            passive: vec![zero; plan.passive.len()],
            reached: zero,
        }
    }

    /// Joints from home to the target. Unless `all` are asked for, the walk ends at the spherical
    /// joint at the limb's end, if it has one, and leaves its angles at home.
    #[inline(always)]
    pub fn reach(
        &mut self,
        simd: S,
        plan: &Plan,
        walk: &mut Walk<S>,
        target: &Target<S>,
        all: bool,
    ) {
        for (x, home) in self.commands.iter_mut().zip(&plan.home_commands) {
            *x = Lanes::new(simd, *home);
        }
        for (x, own) in self.passive.iter_mut().zip(&plan.passive) {
            *x = Lanes::new(simd, plan.home[*own]);
        }
        let joints = plan.passive.len();
        self.reached = Lanes::new(simd, 1.0);
        // One call in one place: the search is large, and every call is a copy of it.
        let inner = joints.saturating_sub(3);
        let (first, then) = match &plan.sphere {
            None => ((Rows::Both, 0..joints), None),
            Some(_) => {
                let own = (Rows::Rotation, inner..joints);
                ((Rows::Position, 0..inner), all.then_some(own))
            }
        };
        for (rows, free) in std::iter::once(first).chain(then) {
            self.search(simd, plan, walk, target, rows, free);
        }
    }

    /// Newton's iteration on some of the passive joints and, where positions count, the commands.
    #[inline(always)]
    fn search(
        &mut self,
        simd: S,
        plan: &Plan,
        walk: &mut Walk<S>,
        target: &Target<S>,
        rows: Rows,
        free: std::ops::Range<usize>,
    ) {
        let commanded = rows != Rows::Rotation;
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let unknowns = free.len() + if commanded { self.commands.len() } else { 0 };
        if unknowns > 6 {
            self.reached = zero;
            return;
        }
        let (end, screws) = match rows {
            Rows::Position => plan.before_sphere(),
            Rows::Rotation | Rows::Both => (plan.steps.len(), plan.screws.len()),
        };
        let centre = match (&plan.sphere, rows) {
            (Some(sphere), Rows::Position) => {
                let arm = sphere.arm.map(|x| Lanes::new(simd, -x));
                carried(&target.rotation, &arm, &target.point)
            }
            _ => target.point,
        };
        let place = |s: &Screw| -> Option<(usize, f64)> {
            match (s.command, s.coordinate) {
                (Some((index, ratio)), _) => commanded.then_some((free.len() + index, ratio)),
                (None, Some((own, ratio))) => plan
                    .slot(own)
                    .filter(|slot| free.contains(slot))
                    .map(|slot| (slot - free.start, ratio)),
                (None, None) => None,
            }
        };
        let length = plan.length;
        let mut most = [length; 6];
        for screw in &plan.screws {
            if let (Some((k, _)), MotionKind::Revolute) = (place(screw), screw.kind) {
                most[k] = 0.5;
            }
        }
        let used = match rows {
            Rows::Position => 0..3,
            Rows::Rotation => 3..6,
            Rows::Both => 0..6,
        };
        // Lanes that still search.
        let mut active = one;
        for pass in 0..=MOST_STEPS {
            // The last pass only looks where the limb is.
            let done = pass == MOST_STEPS || active.all_less(0.5);
            walk.along(plan, done, end, &self.commands, &self.passive);
            if done {
                break;
            }
            let mut columns = [[zero; 6]; 6];
            walk.columns(plan, screws, &mut columns, place);
            let miss = minus(&centre, &walk.point);
            let mut e = [miss[0], miss[1], miss[2], zero, zero, zero];
            if rows != Rows::Position {
                let turn = turn_between(&target.rotation, &walk.rotation);
                for k in 0..3 {
                    e[3 + k] = turn[k] * length;
                    for column in &mut columns {
                        column[3 + k] = column[3 + k] * length;
                    }
                }
            }
            let mut square = zero;
            for k in used.clone() {
                square = e[k].times_plus(e[k], square);
            }
            let mut step = if rows == Rows::Position && unknowns == 3 {
                square_step(&columns, &e)
            } else {
                least_squares_step(simd, unknowns, used.clone(), &columns, &e)
            };
            let mut share = one;
            for k in 0..unknowns {
                share = share.least_of(one * most[k] / step[k].abs().max(one * 1e-300));
            }
            for x in &mut step {
                *x = active.where_less(one * 0.5, zero, *x * share);
            }
            let own = self.passive[free.clone()].iter_mut();
            for (x, dx) in own.chain(&mut self.commands).zip(&step[..unknowns]) {
                *x = *x + *dx;
            }
            let near = NEAR * length;
            active = square.where_less(one * (near * near), zero, active);
        }
        self.reached = active.where_less(one * 0.5, self.reached, zero);
    }
}

/// Rotation that leads from `from` to `to` as axis times twice the tangent of half the angle, base
/// axes: the rotation vector to third order, and finite up to half a turn.
#[inline(always)]
pub(super) fn turn_between<S: Simd>(to: &Mat3<S>, from: &Mat3<S>) -> Vec3<S> {
    let r = product_transposed(to, from);
    let scale = r[0].same(2.0) / (r[0] + r[4] + r[8] + 1.0);
    [
        (r[7] - r[5]) * scale,
        (r[2] - r[6]) * scale,
        (r[3] - r[1]) * scale,
    ]
}

/// Three equations, three unknowns: Cramer's rule.
#[inline(always)]
fn square_step<S: Simd>(columns: &[[Lanes<S>; 6]; 6], e: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
    let vector = |k: usize| -> Vec3<S> { [columns[k][0], columns[k][1], columns[k][2]] };
    let (a, b, c) = (vector(0), vector(1), vector(2));
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

/// `(J^T J)^-1 J^T e` for the first `unknowns` columns and some of the rows.
#[inline(always)]
fn least_squares_step<S: Simd>(
    simd: S,
    unknowns: usize,
    rows: std::ops::Range<usize>,
    columns: &[[Lanes<S>; 6]; 6],
    e: &[Lanes<S>; 6],
) -> [Lanes<S>; 6] {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    let unknowns = unknowns.min(6);
    let inner = |a: &[Lanes<S>; 6], b: &[Lanes<S>; 6]| {
        let mut sum = zero;
        for k in rows.clone() {
            sum = a[k].times_plus(b[k], sum);
        }
        sum
    };
    let mut l = [[zero; 6]; 6];
    let mut x = [zero; 6];
    for j in 0..unknowns {
        let mut pivot = inner(&columns[j], &columns[j]);
        for k in 0..j {
            pivot = l[j][k].times_from(l[j][k], pivot);
        }
        let r = one / pivot.sqrt();
        l[j][j] = r;
        for i in j + 1..unknowns {
            let mut y = inner(&columns[i], &columns[j]);
            for k in 0..j {
                y = l[i][k].times_from(l[j][k], y);
            }
            l[i][j] = y * r;
        }
        let mut y = inner(&columns[j], e);
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
}

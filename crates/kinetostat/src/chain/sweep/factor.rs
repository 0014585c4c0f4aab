//! Elimination of a chain's coordinates from the tip inwards: a Riccati sweep.
//!
//! The step of Newton's method, `[0 J; J^T H - K]`, does not change if `J^T S` times its first block
//! row is added to the second: `x` stays, `F` becomes `F + S J x`. `M = H - K - J^T S J` is the tangent
//! of the chain with its end on a spring `S`, and such a chain is a ladder: with
//! `y = Y t + eta` the wrench that everything beyond answers to the motion `t` of a stage,
//!
//! ```text
//! D = s^T Y s + (A within the stage) - K           pivot of a stage, 1 x 1 to 6 x 6
//! Y <- Y - (Y + b A) s  D^-1  s^T (Y + a A)         a, b: factors of A below and above the diagonal
//! ```
//!
//! from `Y = -S` at the tip. With `S` of the size of the chain's own stiffness nothing is lost, and
//! passive joints, which have no spring of their own, have regular pivots. `E = -J M^-1 J^T` (6 x 6)
//! is what is left of the border: `t = e_0 + E (F + S t)`. By Sylvester's law the signs of `D` and of
//! `E` are those of the bordered matrix.

use nalgebra::{Matrix6, Vector6};

use crate::chain::sweep::stages::{Form, Sweep, column};
use crate::linalg::saddle::{Inertia, RANK_TOLERANCE};

/// A chain, its end on a spring, with all coordinates eliminated.
pub(crate) struct Factored {
    /// `D^-1`, a block per stage.
    inverse: Vec<f64>,
    /// `(Y + a A)^T s`, six numbers per coordinate.
    left: Vec<f64>,
    /// `(Y + b A) s`, six numbers per coordinate.
    right: Vec<f64>,
    /// The spring at the end.
    pub spring: Matrix6<f64>,
    /// `E`: motion of the end per wrench, its own spring included.
    pub end: Matrix6<f64>,
    /// Motion of every coordinate per wrench on the end, `-M^-1 J^T`, six numbers each.
    responses: Vec<f64>,
    /// Signs of the pivots; only of a symmetric form.
    pub inertia: Inertia,
}

/// Inverse by Gauss-Jordan with row exchanges, `None` where a pivot is below a share of the largest
/// entry.
fn inverse(matrix: &Matrix6<f64>, len: usize, least: f64) -> Option<Matrix6<f64>> {
    let (mut a, mut b) = (*matrix, Matrix6::identity());
    let size = a.view((0, 0), (len, len)).amax();
    for k in 0..len {
        let mut best = k;
        for i in k + 1..len {
            if a[(i, k)].abs() > a[(best, k)].abs() {
                best = i;
            }
        }
        let pivot = a[(best, k)];
        if !is_above(pivot.abs(), least * size) {
            return None;
        }
        if best != k {
            a.swap_rows(best, k);
            b.swap_rows(best, k);
        }
        for j in 0..len {
            a[(k, j)] /= pivot;
            b[(k, j)] /= pivot;
        }
        for i in 0..len {
            if i != k {
                let factor = a[(i, k)];
                for j in 0..len {
                    let (from_a, from_b) = (a[(k, j)], b[(k, j)]);
                    a[(i, j)] -= factor * from_a;
                    b[(i, j)] -= factor * from_b;
                }
            }
        }
    }
    for i in len..6 {
        b[(i, i)] = 0.0;
    }
    Some(b)
}

/// Negative definite: its pivots without exchanges are negative, none lost in rounding.
fn negative_definite(matrix: &Matrix6<f64>, len: usize) -> bool {
    let mut a = *matrix;
    for k in 0..len {
        let pivot = a[(k, k)];
        let regular = pivot < 0.0 && pivot < 1e-6 * matrix[(k, k)];
        if !regular {
            return false;
        }
        for i in k + 1..len {
            let factor = a[(i, k)] / pivot;
            for j in k + 1..len {
                let from = a[(k, j)];
                a[(i, j)] -= factor * from;
            }
        }
    }
    true
}

/// Signs of the eigenvalues of a symmetric block.
fn signs(matrix: &Matrix6<f64>, len: usize) -> (usize, usize) {
    if negative_definite(matrix, len) {
        return (0, len);
    }
    let block = matrix.view((0, 0), (len, len)).into_owned();
    let values = (0.5 * (&block + block.transpose())).symmetric_eigenvalues();
    let positive = values.iter().filter(|v| **v > 0.0).count();
    (positive, len - positive)
}

impl Factored {
    /// `None` where a pivot is lost in rounding: redundant passive joints, or bad luck.
    pub fn new(sweep: &Sweep, form: Form, end: EndSpring) -> Option<Self> {
        let mut spring = sweep.end_spring(end.least)? * end.share;
        if let Form::Pencil(mu) = form {
            spring *= mu.abs().max(1e-12);
        }
        let (below, above) = form.skew();
        let symmetric = !matches!(form, Form::Lagged | Form::Exact);
        // Shifts come close to eigenvalues, where a pivot is small by right.
        let least = if symmetric {
            1e-3 * RANK_TOLERANCE
        } else {
            end.pivot
        };
        let n = sweep.count();
        let blocks = sweep.stages.last().map_or(0, |s| s.block + s.len * s.len);
        let mut factored = Self {
            inverse: vec![0.0; blocks],
            left: vec![0.0; 6 * n],
            right: vec![0.0; 6 * n],
            spring,
            end: Matrix6::zeros(),
            responses: vec![0.0; 6 * n],
            inertia: Inertia::default(),
        };
        let inertia = &mut factored.inertia;
        let mut y = -spring;
        for (c, stage) in sweep.stages.iter().enumerate().rev() {
            if let Some(g) = sweep.between(form, c + 1) {
                y += g;
            }
            let outer = if below == 0.0 { None } else { sweep.outer(c) };
            if stage.len == 1 {
                let s = column(&sweep.twists, stage.first);
                let (mut right, mut left) = (y * s, y.tr_mul(&s));
                let held = sweep.held_scalar(form, stage);
                let pivot = s.dot(&right) - held;
                // The reference is the largest number that was subtracted so far.
                let size = s.abs();
                let size = held.abs() + size.dot(&((y.abs() + spring.abs()) * size));
                if !is_above(pivot.abs(), least * size) {
                    return None;
                }
                if let Some(a) = outer {
                    // A is skew.
                    let turned = a * s;
                    left -= turned * below;
                    right += turned * above;
                }
                if pivot > 0.0 {
                    inertia.positive += 1;
                } else {
                    inertia.negative += 1;
                }
                y.ger(-1.0 / pivot, &right, &left, 1.0);
                factored.inverse[stage.block] = 1.0 / pivot;
                let own = 6 * stage.first..6 * stage.first + 6;
                factored.left[own.clone()].copy_from_slice(left.as_slice());
                factored.right[own].copy_from_slice(right.as_slice());
            } else {
                let s = stage.columns(&sweep.twists);
                let (mut right, mut left) = (y * s, y.tr_mul(&s));
                let mut pivot = s.tr_mul(&right) - sweep.held(form, stage);
                if let Some(a) = outer {
                    let turned = a * s;
                    let within = s.tr_mul(&turned);
                    for i in 0..stage.len {
                        for j in 0..i {
                            pivot[(i, j)] += below * within[(i, j)];
                            pivot[(j, i)] += above * within[(j, i)];
                        }
                    }
                    left -= turned * below;
                    right += turned * above;
                }
                let inverse = inverse(&pivot, stage.len, least)?;
                if symmetric {
                    let (positive, negative) = signs(&pivot, stage.len);
                    inertia.positive += positive;
                    inertia.negative += negative;
                }
                y -= right * (inverse * left.transpose());
                stage.store_square(&inverse, &mut factored.inverse);
                stage.store_columns(&left, &mut factored.left);
                stage.store_columns(&right, &mut factored.right);
            }
            if symmetric {
                y = 0.5 * (y + y.transpose());
            }
        }
        factored.respond(sweep);
        let finite = factored.end.iter().all(|x| x.is_finite());
        finite.then_some(factored)
    }

    /// Solves `M X = -J^T`.
    fn respond(&mut self, sweep: &Sweep) {
        let mut eta = Matrix6::identity();
        for stage in sweep.stages.iter().rev() {
            if stage.len == 1 {
                let s = column(&sweep.twists, stage.first);
                let z = eta.tr_mul(&s) * self.inverse[stage.block];
                eta.ger(-1.0, &column(&self.right, stage.first), &z, 1.0);
                let own = 6 * stage.first..6 * stage.first + 6;
                self.responses[own].copy_from_slice((-z).as_slice());
            } else {
                let s = stage.columns(&sweep.twists);
                let z = stage.square(&self.inverse) * s.tr_mul(&eta);
                eta -= stage.columns(&self.right) * z;
                stage.store_columns(&-z.transpose(), &mut self.responses);
            }
        }
        let mut t = Matrix6::zeros();
        for stage in &sweep.stages {
            if stage.len == 1 {
                let s = column(&sweep.twists, stage.first);
                let more = t.tr_mul(&column(&self.left, stage.first)) * self.inverse[stage.block];
                let x = column(&self.responses, stage.first) - more;
                let own = 6 * stage.first..6 * stage.first + 6;
                self.responses[own].copy_from_slice(x.as_slice());
                t.ger(1.0, &s, &x, 1.0);
            } else {
                let s = stage.columns(&sweep.twists);
                let more = stage.square(&self.inverse) * stage.columns(&self.left).tr_mul(&t);
                let x = stage.columns(&self.responses).transpose() - more;
                t += s * x;
                stage.store_columns(&x.transpose(), &mut self.responses);
            }
        }
        self.end = t;
    }

    /// Solves `M x = right`, in place; returns `J x`.
    pub fn solve(&self, sweep: &Sweep, x: &mut [f64]) -> Vector6<f64> {
        let mut eta = Vector6::zeros();
        for stage in sweep.stages.iter().rev() {
            let own = stage.first;
            if stage.len == 1 {
                let z = (column(&sweep.twists, own).dot(&eta) - x[own]) * self.inverse[stage.block];
                eta.axpy(-z, &column(&self.right, own), 1.0);
                x[own] = -z;
            } else {
                let mut right = stage.columns(&sweep.twists).tr_mul(&eta);
                for i in 0..stage.len {
                    right[i] -= x[own + i];
                }
                let z = stage.square(&self.inverse) * right;
                eta -= stage.columns(&self.right) * z;
                for i in 0..stage.len {
                    x[own + i] = -z[i];
                }
            }
        }
        let mut t = Vector6::zeros();
        for stage in &sweep.stages {
            let own = stage.first;
            if stage.len == 1 {
                x[own] -= column(&self.left, own).dot(&t) * self.inverse[stage.block];
                t.axpy(x[own], &column(&sweep.twists, own), 1.0);
            } else {
                let more = stage.square(&self.inverse) * stage.columns(&self.left).tr_mul(&t);
                for i in 0..stage.len {
                    x[own + i] -= more[i];
                    t.axpy(x[own + i], &column(&sweep.twists, own + i), 1.0);
                }
            }
        }
        t
    }

    /// Motion of a coordinate per wrench on the end.
    pub fn response(&self, coordinate: usize) -> Vector6<f64> {
        column(&self.responses, coordinate)
    }

    /// Sign and logarithm of the size of the determinant of `M`: that of all pivots.
    pub fn determinant(&self, sweep: &Sweep) -> (f64, f64) {
        let (mut sign, mut logarithm) = (1.0, 0.0);
        for stage in &sweep.stages {
            let mut inverse = stage.square(&self.inverse);
            for i in stage.len..6 {
                inverse[(i, i)] = 1.0;
            }
            let value = inverse.determinant();
            sign *= value.signum();
            logarithm -= value.abs().max(f64::MIN_POSITIVE).ln();
        }
        (sign, logarithm)
    }

    /// Adds the motion under a wrench on the end (its own spring included).
    pub fn add_response(&self, wrench: &Vector6<f64>, x: &mut [f64]) {
        for (i, x) in x.iter_mut().enumerate() {
            *x += column(&self.responses, i).dot(wrench);
        }
    }
}

/// True if a value is above a limit; false for NaN.
fn is_above(value: f64, limit: f64) -> bool {
    value > limit
}

/// A spring at the end of a chain while its coordinates are eliminated, and what may be lost.
#[derive(Clone, Copy)]
pub struct EndSpring {
    /// Share of the chain's own stiffness.
    pub share: f64,
    /// The share of the largest compliance that the smallest one counts as.
    pub least: f64,
    /// Pivots below this share of what they come from are lost (of forms that are not symmetric).
    pub pivot: f64,
    /// A residual larger than this share of what is scaled shows that a pivot was too small.
    pub lost: f64,
}

impl EndSpring {
    /// A share of the chain's own stiffness in all directions that yield.
    const fn as_stiff(share: f64) -> Self {
        Self {
            share,
            least: 1e-7,
            pivot: 10.0 * RANK_TOLERANCE,
            lost: 1e-8,
        }
    }

    /// Soft along what hardly yields: where that is worlds stiffer than all the rest, the rest would
    /// drown in it. Good enough for a step of Newton's method, whose residual is checked.
    const fn soft(share: f64, least: f64) -> Self {
        Self {
            share,
            least,
            pivot: 1e-3 * RANK_TOLERANCE,
            lost: 1e-5,
        }
    }
}

/// Springs at the end that are tried one after the other.
pub const END_SPRINGS: [EndSpring; 3] = [
    EndSpring::as_stiff(1.0),
    EndSpring::as_stiff(0.17),
    EndSpring::as_stiff(5.3),
];

/// End springs for a step of Newton's method, whatever the ratio of the stiffnesses.
pub(crate) const STEP_SPRINGS: [EndSpring; 5] = [
    END_SPRINGS[0],
    END_SPRINGS[1],
    END_SPRINGS[2],
    EndSpring::soft(1.0, 1e-2),
    EndSpring::soft(0.03, 1e-3),
];

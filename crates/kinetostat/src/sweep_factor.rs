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

use crate::saddle::{Inertia, RANK_TOLERANCE};
use crate::sweep::{Form, Sweep};

/// What is kept of a stage.
#[derive(Clone, Copy)]
struct Kept {
    /// `D^-1`, filled up with zeros.
    inverse: Matrix6<f64>,
    /// `s^T (Y + a A)`.
    left: Matrix6<f64>,
    /// `(Y + b A) s`.
    right: Matrix6<f64>,
}

/// A chain, its end on a spring, with all coordinates eliminated.
pub(crate) struct Factored {
    kept: Vec<Kept>,
    /// The spring at the end.
    pub spring: Matrix6<f64>,
    /// `E`: motion of the end per wrench, its own spring included.
    pub end: Matrix6<f64>,
    /// Motion of the coordinates of every stage per wrench on the end, `-M^-1 J^T`.
    pub responses: Vec<Matrix6<f64>>,
    /// Signs of the pivots; only of a symmetric form.
    pub inertia: Inertia,
}

/// Inverse by Gauss-Jordan with row exchanges, `None` where a pivot is lost in rounding.
fn inverse(matrix: &Matrix6<f64>, len: usize) -> Option<Matrix6<f64>> {
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
        // Not a number is no pivot either.
        if !(pivot.abs() > 10.0 * RANK_TOLERANCE * size) {
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
        if !(pivot < 1e-6 * matrix[(k, k)] && pivot < 0.0) {
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
    pub fn new(sweep: &Sweep, form: Form) -> Option<Self> {
        let mut spring = sweep.end_spring();
        if let Form::Pencil(mu) = form {
            spring *= mu.abs().max(1e-12);
        }
        let count = sweep.stages.len();
        let (below, above) = form.skew();
        let mut kept = vec![
            Kept {
                inverse: Matrix6::zeros(),
                left: Matrix6::zeros(),
                right: Matrix6::zeros(),
            };
            count
        ];
        let mut inertia = Inertia::default();
        let mut y = -spring;
        for c in (0..count).rev() {
            if let Some(g) = sweep.between(form, c + 1) {
                y += g;
            }
            let (s, len) = (&sweep.twists[c], sweep.stages[c].len);
            let held = sweep.held(form, c);
            let outer = sweep.outer[c].filter(|_| below != 0.0);
            if len == 1 {
                let column = s.column(0).into_owned();
                let (mut right, mut left) = (y * column, y.tr_mul(&column));
                let pivot = column.dot(&right) - held[(0, 0)];
                let mut size = held[(0, 0)].abs();
                for i in 0..6 {
                    for j in 0..6 {
                        let product = (column[i] * column[j]).abs();
                        size += product * (y[(i, j)].abs() + spring[(i, j)].abs());
                    }
                }
                if !(pivot.abs() > 10.0 * RANK_TOLERANCE * size) {
                    return None;
                }
                if let Some(a) = outer {
                    // A is skew.
                    let turned = a * column;
                    left -= turned * below;
                    right += turned * above;
                }
                if pivot > 0.0 {
                    inertia.positive += 1;
                } else {
                    inertia.negative += 1;
                }
                y.ger(-1.0 / pivot, &right, &left, 1.0);
                kept[c].inverse[(0, 0)] = 1.0 / pivot;
                kept[c].left.set_row(0, &left.transpose());
                kept[c].right.set_column(0, &right);
            } else {
                let (mut right, mut left) = (y * s, s.tr_mul(&y));
                let mut pivot = s.tr_mul(&right) - held;
                if let Some(a) = outer {
                    let turned = a * s;
                    let within = s.tr_mul(&turned);
                    for i in 0..len {
                        for j in 0..i {
                            pivot[(i, j)] += below * within[(i, j)];
                            pivot[(j, i)] += above * within[(j, i)];
                        }
                    }
                    left -= (turned * below).transpose();
                    right += turned * above;
                }
                let inverse = inverse(&pivot, len)?;
                if matches!(form, Form::Pencil(_)) {
                    let (positive, negative) = signs(&pivot, len);
                    inertia.positive += positive;
                    inertia.negative += negative;
                }
                y -= right * (inverse * left);
                kept[c] = Kept {
                    inverse,
                    left,
                    right,
                };
            }
            if matches!(form, Form::Pencil(_)) {
                y = 0.5 * (y + y.transpose());
            }
        }
        let mut factored = Self {
            kept,
            spring,
            end: Matrix6::zeros(),
            responses: vec![Matrix6::zeros(); count],
            inertia,
        };
        factored.respond(sweep);
        factored
            .end
            .iter()
            .all(|x| x.is_finite())
            .then_some(factored)
    }

    /// Solves `M X = -J^T`.
    fn respond(&mut self, sweep: &Sweep) {
        let mut eta = Matrix6::identity();
        for (c, stage) in sweep.stages.iter().enumerate().rev() {
            let (s, k) = (&sweep.twists[c], &self.kept[c]);
            if stage.len == 1 {
                let z = eta.tr_mul(&s.column(0)) * k.inverse[(0, 0)];
                eta.ger(-1.0, &k.right.column(0), &z, 1.0);
                self.responses[c].set_row(0, &-z.transpose());
            } else {
                let z = k.inverse * s.tr_mul(&eta);
                eta -= k.right * z;
                self.responses[c] = -z;
            }
        }
        let mut t = Matrix6::zeros();
        for (c, stage) in sweep.stages.iter().enumerate() {
            let (s, k) = (&sweep.twists[c], &self.kept[c]);
            if stage.len == 1 {
                let more = t.tr_mul(&k.left.row(0).transpose()) * k.inverse[(0, 0)];
                let row = self.responses[c].row(0).transpose() - more;
                self.responses[c].set_row(0, &row.transpose());
                t.ger(1.0, &s.column(0), &row, 1.0);
            } else {
                let x = self.responses[c] - k.inverse * (k.left * t);
                t += s * x;
                self.responses[c] = x;
            }
        }
        self.end = t;
    }

    /// Solves `M x = right`, in place; returns `J x`.
    pub fn solve(&self, sweep: &Sweep, x: &mut [f64]) -> Vector6<f64> {
        let mut eta = Vector6::zeros();
        for (c, stage) in sweep.stages.iter().enumerate().rev() {
            let (s, k, own) = (&sweep.twists[c], &self.kept[c], stage.first);
            if stage.len == 1 {
                let z = (s.column(0).dot(&eta) - x[own]) * k.inverse[(0, 0)];
                eta.axpy(-z, &k.right.column(0), 1.0);
                x[own] = -z;
            } else {
                let mut right = s.tr_mul(&eta);
                for i in 0..stage.len {
                    right[i] -= x[own + i];
                }
                let z = k.inverse * right;
                eta -= k.right * z;
                for i in 0..stage.len {
                    x[own + i] = -z[i];
                }
            }
        }
        let mut t = Vector6::zeros();
        for (c, stage) in sweep.stages.iter().enumerate() {
            let (s, k, own) = (&sweep.twists[c], &self.kept[c], stage.first);
            if stage.len == 1 {
                x[own] -= k.left.row(0).transpose().dot(&t) * k.inverse[(0, 0)];
                t.axpy(x[own], &s.column(0), 1.0);
            } else {
                let more = k.inverse * (k.left * t);
                for i in 0..stage.len {
                    x[own + i] -= more[i];
                    t.axpy(x[own + i], &s.column(i), 1.0);
                }
            }
        }
        t
    }

    /// Adds the motion under a wrench on the end (its own spring included).
    pub fn add_response(&self, sweep: &Sweep, wrench: &Vector6<f64>, x: &mut [f64]) {
        for (stage, response) in sweep.stages.iter().zip(&self.responses) {
            for i in 0..stage.len {
                x[stage.first + i] += response.row(i).transpose().dot(wrench);
            }
        }
    }
}

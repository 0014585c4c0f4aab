//! Elimination of a chain's coordinates from the tip inwards at one shift, [`crate::swept`].
//!
//! ```text
//! D = K + s^T Y s - (loads and s M of the stage)        pivot of a stage
//! Y <- Y + near - (Y s + across) D^-1 (Y s + across)^T    from Y = spring on what is held, at the tip
//! ```
//!
//! A chain whose end is held in directions `W` has the pivots of `P + J^T W k W^T J` (nothing changes where `W^T J x = 0`)
//! and the border `W^T J P^-1 J^T W`: every negative eigenvalue of that takes a mode away.

use nalgebra::{DMatrix, DVector, Matrix6, Matrix6xX, Vector6};

use crate::swept::stages::{Stage, Stages};

/// Pivots in units of their own diagonal below this are none.
const PIVOT: f64 = 1e-14;

/// `K - H - shift M` of a chain, its end held in some directions.
pub(crate) struct Factor {
    pub shift: f64,
    stages: Vec<Eliminated>,
    /// Modes below the shift, and massless directions of negative stiffness.
    pub below: usize,
    held: Option<Border>,
}

struct Eliminated {
    inverse: DMatrix<f64>,
    /// `Y s + across`.
    across: Matrix6xX<f64>,
}

/// Contribution of the held end.
struct Border {
    /// `P^-1 J^T W`, n x r.
    moved: DMatrix<f64>,
    /// Inverse of `W^T J P^-1 J^T W`.
    inverse: DMatrix<f64>,
    /// `W`, 6 x r.
    held: Matrix6xX<f64>,
}

/// Directions of the tip that are held, columns `W` (6 x r), and a stiffness of the size of the chain's for each.
#[derive(Clone, Debug)]
pub(crate) struct HeldEnd {
    pub directions: Matrix6xX<f64>,
    pub stiffness: Vec<f64>,
}

impl Factor {
    /// `None` where a pivot is lost: a direction with neither stiffness nor mass, or a shift on an eigenvalue.
    pub fn new(chain: &Stages, held: &HeldEnd, shift: f64) -> Option<Self> {
        let form = |loads: &Matrix6<f64>, masses: &Matrix6<f64>| -loads - masses * shift;
        let mut y = Matrix6::zeros();
        for (w, k) in held.directions.column_iter().zip(&held.stiffness) {
            y.ger(*k, &w.fixed_rows::<6>(0), &w.fixed_rows::<6>(0), 1.0);
        }
        let mut stages = Vec::with_capacity(chain.stages.len());
        let mut below = 0;
        for (c, stage) in chain.stages.iter().enumerate().rev() {
            let beyond = &chain.between[c + 1];
            y += form(&beyond.loads, &beyond.masses);
            let s = &stage.twists;
            let (load, mass) = (&stage.loads, &stage.masses);
            let turned = stage.outer * s;
            let ys = y * s;
            let across = &ys + &turned - &load.across - &mass.across * shift;
            let mut pivot = &stage.spring - &load.own - &mass.own * shift + product(s, &ys);
            let within = product(s, &turned);
            for i in 0..s.ncols() {
                for j in 0..i {
                    pivot[(i, j)] -= within[(i, j)];
                    pivot[(j, i)] -= within[(i, j)];
                }
            }
            let (inverse, negative) = inverted(&pivot)?;
            below += negative;
            let back = &across * &inverse;
            let taken = Matrix6::from_fn(|i, j| back.row(i).dot(&across.row(j)));
            y += form(&load.near, &mass.near) - taken;
            y = (y + y.transpose()) * 0.5;
            stages.push(Eliminated { inverse, across });
        }
        stages.reverse();
        let mut own = Self {
            shift,
            stages,
            below,
            held: None,
        };
        own.hold(chain, held)?;
        Some(own)
    }

    fn hold(&mut self, chain: &Stages, held: &HeldEnd) -> Option<()> {
        let count = held.directions.ncols();
        if count == 0 {
            return Some(());
        }
        let mut moved = DMatrix::zeros(chain.count, count);
        for (k, w) in held.directions.column_iter().enumerate() {
            let mut force = vec![0.0; chain.count];
            for stage in &chain.stages {
                let torque = stage.twists.tr_mul(&w);
                force[stage.first..stage.first + torque.len()].copy_from_slice(torque.as_slice());
            }
            moved.set_column(k, &DVector::from_vec(self.free(chain, &force)));
        }
        let mut border = DMatrix::zeros(count, count);
        for k in 0..count {
            let tip = chain.tip(moved.column(k).into_owned().as_slice());
            for i in 0..count {
                border[(i, k)] = held.directions.column(i).dot(&tip);
            }
        }
        let border = (&border + border.transpose()) * 0.5;
        let (inverse, negative) = inverted(&border)?;
        // Inertia of the bordered matrix: that of P and of minus the border, less one negative for each condition.
        self.below = self.below.checked_sub(negative)?;
        self.held = Some(Border {
            moved,
            inverse,
            held: held.directions.clone(),
        });
        Some(())
    }

    /// `P x = b` where nothing of the end is held but by its spring.
    fn free(&self, chain: &Stages, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        let mut eta = DVector::zeros(6);
        for (stage, gone) in chain.stages.iter().zip(&self.stages).rev() {
            let right = own(stage, &x) - stage.twists.tr_mul(&eta);
            let z = &gone.inverse * right;
            eta += &gone.across * &z;
            x[stage.first..stage.first + z.len()].copy_from_slice(z.as_slice());
        }
        let mut t = DVector::zeros(6);
        for (stage, gone) in chain.stages.iter().zip(&self.stages) {
            let z = own(stage, &x) - &gone.inverse * gone.across.tr_mul(&t);
            t += &stage.twists * &z;
            x[stage.first..stage.first + z.len()].copy_from_slice(z.as_slice());
        }
        x
    }

    /// `x` of the motions that are left such that `P x = b` but for reactions.
    pub fn solve(&self, chain: &Stages, b: &[f64]) -> Vec<f64> {
        let mut x = self.free(chain, b);
        if let Some(border) = &self.held {
            for _ in 0..2 {
                let tip = chain.tip(&x);
                let off = border.held.tr_mul(&tip);
                let reaction = &border.moved * (&border.inverse * off);
                x.iter_mut().zip(reaction.iter()).for_each(|(x, r)| *x -= r);
            }
        }
        x
    }
}

fn product(a: &Matrix6xX<f64>, b: &Matrix6xX<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.ncols(), b.ncols(), |i, j| a.column(i).dot(&b.column(j)))
}

/// Inverse of a symmetric matrix and the number of its negative eigenvalues; `None` where one is lost.
fn inverted(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    let n = a.nrows();
    let units = DVector::from_fn(n, |i, _| {
        let row = a.row(i).amax();
        let size = if a[(i, i)].abs() > 1e-6 * row {
            a[(i, i)].abs()
        } else {
            row
        };
        1.0 / size.sqrt()
    });
    if units.iter().any(|u| !u.is_finite()) {
        return None;
    }
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        0.5 * (a[(i, j)] + a[(j, i)]) * units[i] * units[j]
    });
    let back = |inverse: DMatrix<f64>| {
        DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * units[i] * units[j])
    };
    if let Some(root) = scaled.clone().cholesky() {
        let diagonal = root.l_dirty().diagonal();
        if diagonal.iter().all(|d| d * d > PIVOT) {
            return Some((back(root.inverse()), 0));
        }
    }
    let eigen = scaled.symmetric_eigen();
    let most = eigen.eigenvalues.amax();
    // NaN is no pivot.
    let is_pivot = |v: &f64| v.abs() > PIVOT * most;
    if !eigen.eigenvalues.iter().all(is_pivot) {
        return None;
    }
    let v = &eigen.eigenvectors;
    let turned = v * DMatrix::from_diagonal(&eigen.eigenvalues.map(|x| 1.0 / x)) * v.transpose();
    let negative = eigen.eigenvalues.iter().filter(|x| **x < 0.0).count();
    Some((back(turned), negative))
}

/// Relative mass below which a part counts as massless, as in `modes::pencil`.
const MASSLESS: f64 = 1e-11;

impl Stages {
    /// `M x`.
    pub fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        let mut near = Vec::with_capacity(self.stages.len() + 1);
        let mut t = Vector6::zeros();
        near.push(t);
        for stage in &self.stages {
            t += &stage.twists * own(stage, x);
            near.push(t);
        }
        let mut out = vec![0.0; x.len()];
        let mut y = Vector6::zeros();
        for (c, stage) in self.stages.iter().enumerate().rev() {
            y += self.between[c + 1].masses * near[c + 1];
            let x = own(stage, x);
            let part = &stage.masses;
            let row = stage.twists.tr_mul(&y) + part.across.tr_mul(&near[c]) + &part.own * &x;
            y += part.near * near[c] + &part.across * x;
            out[stage.first..stage.first + row.len()].copy_from_slice(row.as_slice());
        }
        out
    }

    /// Number of independent motions with mass: masses alone eliminated from the tip inwards, in units of what each
    /// coordinate moves.
    pub fn with_mass(&self) -> usize {
        let (mut y, mut all, mut rank) = (Matrix6::zeros(), Matrix6::zeros(), 0);
        for (c, stage) in self.stages.iter().enumerate().rev() {
            y += self.between[c + 1].masses;
            all += self.between[c + 1].masses;
            let (s, mass) = (&stage.twists, &stage.masses);
            let n = s.ncols();
            let form = |y: &Matrix6<f64>| {
                let ys = y * s;
                DMatrix::from_fn(n, n, |i, j| {
                    s.column(i).dot(&ys.column(j)) + mass.own[(i, j)]
                })
            };
            let (pivot, whole) = (form(&y), form(&all));
            let units = nalgebra::DVector::from_fn(n, |i, _| match whole[(i, i)] > 0.0 {
                true => 1.0 / whole[(i, i)].sqrt(),
                false => 0.0,
            });
            let eigen = DMatrix::from_fn(n, n, |i, j| {
                0.5 * (pivot[(i, j)] + pivot[(j, i)]) * units[i] * units[j]
            })
            .symmetric_eigen();
            let heavy = eigen.eigenvalues.map(|x| x > MASSLESS);
            rank += heavy.iter().filter(|own| **own).count();
            let inverse = eigen
                .eigenvalues
                .zip_map(&heavy, |x, own| if own { 1.0 / x } else { 0.0 });
            let v = DMatrix::from_diagonal(&units) * eigen.eigenvectors;
            let across = (y * s + &mass.across) * v;
            y += mass.near;
            all += mass.near;
            for (column, factor) in across.column_iter().zip(inverse.iter()) {
                let own = Vector6::from_column_slice(column.as_slice());
                y.ger(-factor, &own, &own, 1.0);
            }
        }
        rank
    }

    /// Motion of the tip.
    pub fn tip(&self, x: &[f64]) -> Vector6<f64> {
        let each = self.stages.iter();
        each.map(|stage| Vector6::from_column_slice((&stage.twists * own(stage, x)).as_slice()))
            .sum()
    }

    /// Sum of the sizes of what springs do in a motion.
    pub fn turnover(&self, x: &[f64]) -> f64 {
        let each = self.stages.iter().map(|stage| {
            let x = own(stage, x).abs();
            x.dot(&(stage.spring.abs() * &x))
        });
        each.sum()
    }
}

/// The coordinates of a stage.
fn own(stage: &Stage, x: &[f64]) -> nalgebra::DVector<f64> {
    let count = stage.twists.ncols();
    nalgebra::DVector::from_column_slice(&x[stage.first..stage.first + count])
}

//! Products of the mass and stiffness matrices of a chain with motions.

use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::swept::stages::{Stage, Stages};

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
pub(crate) fn own(stage: &Stage, x: &[f64]) -> nalgebra::DVector<f64> {
    let count = stage.twists.ncols();
    nalgebra::DVector::from_column_slice(&x[stage.first..stage.first + count])
}

//! Block Lanczos for `P^-1 M` in the product of masses, every vector kept orthogonal to all others.

use nalgebra::{DMatrix, DVector};

use crate::swept::factor::Factor;
use crate::swept::stages::Stages;

/// Relative size of a vector's remainder that counts as rounding.
const EXHAUSTED: f64 = 1e-9;

/// Vectors orthonormal by mass, and the operator in them.
pub(crate) struct Krylov<'a> {
    chain: &'a Stages,
    factor: &'a Factor,
    vectors: Vec<Vector>,
    /// The operator of the first vectors, in all vectors that there were then.
    columns: Vec<Vec<f64>>,
    seed: u64,
}

struct Vector {
    x: Vec<f64>,
    /// `M x`.
    mass: Vec<f64>,
}

/// An approximate mode.
pub(crate) struct Ritz {
    /// `w^2`.
    pub squared: f64,
    /// Mass-normalised.
    pub shape: Vec<f64>,
    /// Residual as a share of the eigenvalue: the error of that is its square, by the gap to the next.
    pub residual: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<'a> Krylov<'a> {
    pub fn new(chain: &'a Stages, factor: &'a Factor) -> Self {
        Self {
            chain,
            factor,
            vectors: Vec::new(),
            columns: Vec::new(),
            seed: 1,
        }
    }

    /// Vectors that the operator has been applied to.
    pub fn done(&self) -> usize {
        self.columns.len()
    }

    /// A further start; false where there is none: all that has mass is spanned.
    pub fn start(&mut self) -> bool {
        // Numbers without a pattern, the same in every run.
        let force: Vec<f64> = (0..self.chain.count)
            .map(|_| {
                self.seed = self
                    .seed
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (self.seed >> 33) as f64 / (1u64 << 30) as f64 - 1.0
            })
            .collect();
        // Twice: what stays of the first force in directions without mass is none.
        let once = self.factor.solve(self.chain, &force);
        let x = self.factor.solve(self.chain, &self.chain.mass_times(&once));
        self.append(x, &mut Vec::new())
    }

    /// Applies the operator to the next vector; false where none is left.
    pub fn advance(&mut self) -> bool {
        let Some(next) = self.vectors.get(self.columns.len()) else {
            return false;
        };
        let x = self.factor.solve(self.chain, &next.mass);
        let mut column = Vec::new();
        self.append(x, &mut column);
        self.columns.push(column);
        true
    }

    /// Takes what of a vector is orthogonal to all others; its parts along them go into `column`.
    fn append(&mut self, mut x: Vec<f64>, column: &mut Vec<f64>) -> bool {
        let size = dot(&x, &self.chain.mass_times(&x)).max(0.0).sqrt();
        column.resize(self.vectors.len(), 0.0);
        for _ in 0..2 {
            for (own, part) in self.vectors.iter().zip(column.iter_mut()) {
                let share = dot(&x, &own.mass);
                *part += share;
                x.iter_mut().zip(&own.x).for_each(|(x, o)| *x -= share * o);
            }
        }
        let mut mass = self.chain.mass_times(&x);
        let left = dot(&x, &mass).max(0.0).sqrt();
        if left.is_nan() || left <= EXHAUSTED * size {
            return false;
        }
        x.iter_mut().chain(&mut mass).for_each(|v| *v /= left);
        column.push(left);
        self.vectors.push(Vector { x, mass });
        true
    }

    /// The lowest modes in what is spanned, at most so many.
    pub fn lowest(&self, count: usize) -> Vec<Ritz> {
        let m = self.columns.len();
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or(0.0);
        let reduced = DMatrix::from_fn(m, m, |i, j| match i <= j {
            true => entry(i, j),
            false => entry(j, i),
        });
        let eigen = reduced.symmetric_eigen();
        let mut order: Vec<usize> = (0..m).filter(|&i| eigen.eigenvalues[i] > 0.0).collect();
        order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
        order.truncate(count);
        let each = order.into_iter().map(|k| {
            let (value, y) = (eigen.eigenvalues[k], eigen.eigenvectors.column(k));
            let mut shape = DVector::zeros(self.chain.count);
            for (own, share) in self.vectors.iter().zip(y.iter()) {
                shape.axpy(*share, &DVector::from_column_slice(&own.x), 1.0);
            }
            let beyond = (m..self.vectors.len())
                .map(|i| (0..m).map(|j| entry(i, j) * y[j]).sum::<f64>().powi(2));
            Ritz {
                squared: 1.0 / value + self.factor.shift,
                residual: beyond.sum::<f64>().sqrt() / value,
                shape: shape.as_slice().to_vec(),
            }
        });
        each.collect()
    }
}

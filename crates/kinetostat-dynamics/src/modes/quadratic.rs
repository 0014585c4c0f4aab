//! `(K - H + lambda C + lambda^2 M) phi = 0`, its eigenvalues and shapes [D 6].
//!
//! The eigenvalues are found as `1 / lambda` (without damping `1 / w^2`), so that massless coordinates give zero and need
//! no treatment.

use nalgebra::linalg::Schur;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::modes::pencil::neutral_directions;

/// `1/w^2` below this share of the largest is that of a massless coordinate.
const ZERO: f64 = 1e-13;
/// Eigenvalues that differ by less share a space of shapes.
const SAME: f64 = 1e-7;

/// The quadratic pencil in natural units, neutral directions left out.
pub(crate) struct Quadratic {
    pub mass: DMatrix<f64>,
    damping: Option<DMatrix<f64>>,
    pub tangent: DMatrix<f64>,
    /// Independent coordinates by those of the pencil.
    pub back: DMatrix<f64>,
}

impl Quadratic {
    pub fn of(d: &LinearDynamics, damping: Option<&DMatrix<f64>>) -> Result<Self> {
        let n = d.len();
        if let Some(c) = damping
            && c.shape() != (n, n)
        {
            return Err(Error::Question(format!(
                "the damping matrix is {} x {}, '{}' has {n} coordinates",
                c.nrows(),
                c.ncols(),
                d.name
            )));
        }
        let u = DMatrix::from_diagonal(&DVector::from_column_slice(&d.units));
        let within = |a: &DMatrix<f64>, basis: &DMatrix<f64>| basis.tr_mul(&(a * basis));
        let (mass, tangent) = (within(&d.mass, &u), within(&d.tangent, &u));
        let (neutral, rest) = neutral_directions(&mass, &tangent);
        let mut back = match neutral.ncols() {
            0 => u,
            _ => u * rest,
        };
        // Each in the unit that makes its own stiffness one.
        let own = within(&d.tangent, &back);
        for (mut column, stiffness) in back.column_iter_mut().zip(own.diagonal().iter()) {
            if *stiffness != 0.0 {
                column /= stiffness.abs().sqrt();
            }
        }
        Ok(Self {
            mass: within(&d.mass, &back),
            damping: damping.map(|c| within(c, &back)),
            tangent: within(&d.tangent, &back),
            back,
        })
    }

    /// Finite eigenvalues by ascending size, one of every conjugate pair; without damping one of each `+-lambda`, and
    /// where `w^2` is complex the pair that grows and the one that dies away.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        let mut found = match &self.damping {
            None => self.undamped()?,
            Some(damping) => self.damped(damping)?,
        };
        let finite = found.iter().all(|v| v.re.is_finite() && v.im.is_finite());
        found.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        finite.then_some(found)
    }

    fn undamped(&self) -> Option<Vec<Complex<f64>>> {
        let values = eigenvalues(self.tangent.clone().lu().solve(&self.mass)?)?;
        let most = largest(&values);
        let with_mass = values.into_iter().filter(|v| v.norm() > ZERO * most);
        Some(with_mass.map(forward_root).collect())
    }

    fn damped(&self, damping: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
        let n = self.mass.nrows();
        let lu = self.tangent.clone().lu();
        let (mass, damping) = (lu.solve(&self.mass)?, lu.solve(damping)?);
        // [x; lambda x] by 1/lambda; time in units in which the slowest entries are alike.
        let time = mass
            .iter()
            .fold(0.0_f64, |m, x| if x.abs() > m { x.abs() } else { m })
            .sqrt();
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        a.view_mut((0, 0), (n, n)).copy_from(&(-damping / time));
        a.view_mut((0, n), (n, n))
            .copy_from(&(-mass / (time * time)));
        a.view_mut((n, 0), (n, n)).fill_with_identity();
        let values = eigenvalues(a)?;
        let most = largest(&values);
        let finite = values
            .into_iter()
            .filter(|v| v.norm() > ZERO.sqrt() * most)
            .map(|v| (v * time).inv());
        Some(finite.filter(|v| v.im >= 0.0).collect())
    }

    /// Right and left shapes of eigenvalues by the independent coordinates, largest entry one. Equal eigenvalues have
    /// shapes of their own.
    pub fn shapes(&self, values: &[Complex<f64>]) -> Vec<[DVector<Complex<f64>>; 2]> {
        let mut own: Vec<[DVector<Complex<f64>>; 2]> = Vec::with_capacity(values.len());
        for (k, value) in values.iter().enumerate() {
            let alike = |v: &&Complex<f64>| (*v - value).norm() <= SAME * value.norm();
            let before = values[..k].iter().rev().take_while(alike).count();
            let p = self.at(*value);
            let shape = |side: usize, p: DMatrix<Complex<f64>>| {
                let others: Vec<_> = own[k - before..].iter().map(|both| &both[side]).collect();
                null_vector(p, &others)
            };
            let both = [shape(0, p.clone()), shape(1, p.transpose())];
            own.push(both);
        }
        let back = self.back.map(|x| Complex::new(x, 0.0));
        own.into_iter()
            .map(|both| both.map(|shape| normalised(&back * shape)))
            .collect()
    }

    fn at(&self, value: Complex<f64>) -> DMatrix<Complex<f64>> {
        let n = self.mass.nrows();
        DMatrix::from_fn(n, n, |i, j| {
            let c = self.damping.as_ref().map_or(0.0, |c| c[(i, j)]);
            value * value * self.mass[(i, j)] + value * c + self.tangent[(i, j)]
        })
    }
}

fn largest(values: &[Complex<f64>]) -> f64 {
    values
        .iter()
        .fold(0.0_f64, |m, v| if v.norm() > m { v.norm() } else { m })
}

/// The root `lambda` of `lambda^2 = -w^2` that swings forwards, or without a swing grows, from `1/w^2`.
fn forward_root(inverse: Complex<f64>) -> Complex<f64> {
    let root = (-inverse.inv()).sqrt();
    let swings = root.im.abs() > 1e-9 * root.norm();
    match (swings && root.im < 0.0) || (!swings && root.re < 0.0) {
        true => -root,
        false => root,
    }
}

/// Null vector of a singular matrix at right angles to others: three steps of inverse iteration with its factors.
fn null_vector(
    mut p: DMatrix<Complex<f64>>,
    others: &[&DVector<Complex<f64>>],
) -> DVector<Complex<f64>> {
    let n = p.nrows();
    let size = p
        .iter()
        .fold(0.0_f64, |m, x| if x.norm() > m { x.norm() } else { m });
    for i in 0..n {
        p[(i, i)] += Complex::new(1e-14 * size, 0.0);
    }
    let lu = p.lu();
    let mut x = start(n, others.len()).map(|x| Complex::new(x, 0.0));
    for _ in 0..3 {
        if let Some(next) = lu.solve(&x) {
            x = normalised(next);
        }
        // Twice is enough to be at right angles to rounding.
        for other in others.iter().chain(others) {
            let share = other.dotc(&x) / other.norm_squared();
            x.axpy(-share, other, Complex::new(1.0, 0.0));
        }
    }
    x
}

fn normalised(x: DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let most = x.iter().fold(Complex::new(0.0, 0.0), |m: Complex<f64>, v| {
        if v.norm() > m.norm() { *v } else { m }
    });
    x.map(|v| v / most)
}

impl LinearDynamics {
    /// Error if the complex modes were not found.
    pub(crate) fn not_found(&self) -> Error {
        Error::NotSolved(format!(
            "the complex modes of '{}' were not found: a direction without stiffness, or a load at which one loses it",
            self.name
        ))
    }
}

/// Rounds of the QR iteration for each row: it needs three or four where it converges at all.
const ROUNDS: usize = 60;
/// Matrices with the same eigenvalues from which the iteration begins anew where it does not end (it has no exceptional
/// shifts, and cycles for some matrices whose eigenvalues are all apart), and what counts as rounding in each of them.
const ROUNDING: [f64; 6] = [1.0, 1.0, 1.0, 8.0, 8.0, 64.0];

/// All eigenvalues; `None` where an entry is no number, or the iteration ends from no beginning.
///
/// Rows and columns are balanced first (James, Langou and Lowery 2014): stiff directions beside soft ones leave entries
/// that are worlds apart, and an iteration that takes the largest for the size of all.
pub(crate) fn eigenvalues(mut matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    balance_parlett_reinsch(&mut matrix);
    let n = matrix.nrows();
    let rounds = ROUNDS * n.max(2);
    ROUNDING.iter().enumerate().find_map(|(begun, rounding)| {
        let schur = Schur::try_new(matrix.clone(), rounding * f64::EPSILON, rounds);
        let found = schur.map(|schur| schur.complex_eigenvalues().iter().copied().collect());
        if found.is_none() {
            // Seen in another mirror each time.
            let along = start(n, begun).normalize();
            let mirror = DMatrix::identity(n, n) - 2.0 * &along * along.transpose();
            matrix = &mirror * &matrix * &mirror;
        }
        found
    })
}

/// Vectors that no symmetry of a machine is orthogonal to: numbers without order, the same in every run.
pub(crate) fn start(size: usize, which: usize) -> DVector<f64> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(2 * which as u64 + 1);
    DVector::from_fn(size, |_, _| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

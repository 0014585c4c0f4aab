//! `K phi = w^2 M phi` where `M` may be singular and `K` indefinite [D6].
//!
//! With `B = K + s M` positive definite, `B = L L^T`, the eigenvalues of `L^-1 M L^-T` are `1 / (w^2 + s)`: a coordinate
//! without mass gives zero and needs no treatment, and the lowest modes are the largest eigenvalues, so that they keep
//! their digits beside springs that are worlds stiffer. `s = 0` serves every stable machine. A direction without mass
//! and without stiffness (neutral) makes `B` singular for every `s`: it is taken out first. A massless direction of
//! negative stiffness makes it indefinite for every `s`: massless coordinates are condensed then, by the eigenvectors of
//! `M`, and it is said how many there are.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::ends::{null_space, null_space_below};

/// Pivots of a matrix with ones on its diagonal below this are none.
const PIVOT: f64 = 1e-13;
/// Threshold of masses: a smaller ratio counts as massless.
const MASSLESS: f64 = 1e-11;

/// All finite modes of a pencil.
#[derive(Default)]
pub(crate) struct Solved {
    /// `w^2`, ascending.
    pub squared: Vec<f64>,
    /// Mass-normalised, n x k.
    pub shapes: DMatrix<f64>,
    /// Directions with stiffness and without mass.
    pub massless: usize,
    /// Directions without mass and without stiffness, n x k.
    pub neutral: DMatrix<f64>,
    /// Massless directions with negative stiffness.
    pub massless_unstable: usize,
    /// `s`: squares are known to its rounding and no better.
    pub shift: f64,
}

/// A factor of `K + s M` with rows and columns in units that make its diagonal one.
pub(crate) struct Shifted {
    pub shift: f64,
    units: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl Shifted {
    fn new(mass: &DMatrix<f64>, tangent: &DMatrix<f64>, shift: f64) -> Option<Self> {
        let n = mass.nrows();
        let mut b = tangent.clone();
        if shift != 0.0 {
            b.zip_apply(mass, |k, m| *k += shift * m);
        }
        let mut units = DVector::zeros(n);
        for i in 0..n {
            let own = b[(i, i)];
            if !(own > 0.0 && own.is_finite()) {
                return None;
            }
            units[i] = 1.0 / own.sqrt();
        }
        for j in 0..n {
            for i in 0..n {
                b[(i, j)] *= units[i] * units[j];
            }
        }
        let factor = Cholesky::new(b)?;
        let l = factor.l_dirty();
        let most = PIVOT * (n as f64);
        (0..n)
            .all(|i| l[(i, i)] * l[(i, i)] > most)
            .then_some(Self {
                shift,
                units,
                factor,
            })
    }

    /// The smallest shift of a coarse list that makes the matrix positive definite.
    pub fn find(mass: &DMatrix<f64>, tangent: &DMatrix<f64>) -> Option<Self> {
        if let Some(found) = Self::new(mass, tangent, 0.0) {
            return Some(found);
        }
        let ratios = (0..mass.nrows()).filter(|&i| mass[(i, i)] > 0.0);
        let ratios = ratios
            .map(|i| tangent[(i, i)].abs() / mass[(i, i)])
            .filter(|r| *r > 0.0 && r.is_finite());
        let (least, most) = ratios.fold((f64::INFINITY, 0.0_f64), |(l, m), r| {
            (if r < l { r } else { l }, if r > m { r } else { m })
        });
        if most <= 0.0 {
            // Masses alone: any shift will do.
            return Self::new(mass, tangent, 1.0);
        }
        // If this shift fails, so does any other.
        let last = 1e3 * most;
        let far = Self::new(mass, tangent, last)?;
        let mut shift = 1e-6 * least;
        while shift < last {
            if let Some(found) = Self::new(mass, tangent, shift) {
                return Some(found);
            }
            shift *= 30.0;
        }
        Some(far)
    }

    /// `(K + s M)^-1 b`.
    pub fn solve(&self, b: &DMatrix<f64>) -> DMatrix<f64> {
        let mut x = b.clone();
        self.scale(&mut x);
        self.factor.solve_mut(&mut x);
        self.scale(&mut x);
        x
    }

    fn scale(&self, x: &mut DMatrix<f64>) {
        for mut column in x.column_iter_mut() {
            column.component_mul_assign(&self.units);
        }
    }
}

/// Largest number of independent directions with mass: pivoted Cholesky of `M` in units of its own diagonal.
fn rank_of_mass(mass: &DMatrix<f64>) -> usize {
    let n = mass.nrows();
    let most = (0..n).fold(
        0.0_f64,
        |m, i| if mass[(i, i)] > m { mass[(i, i)] } else { m },
    );
    let own: Vec<usize> = (0..n).filter(|&i| mass[(i, i)] > 1e-15 * most).collect();
    let mut a = DMatrix::from_fn(own.len(), own.len(), |i, j| {
        mass[(own[i], own[j])] / (mass[(own[i], own[i])] * mass[(own[j], own[j])]).sqrt()
    });
    let k = own.len();
    for step in 0..k {
        let pivot = (step..k).fold(
            step,
            |best, i| if a[(i, i)] > a[(best, best)] { i } else { best },
        );
        if a[(pivot, pivot)].is_nan() || a[(pivot, pivot)] <= MASSLESS {
            return step;
        }
        a.swap_rows(step, pivot);
        a.swap_columns(step, pivot);
        let root = a[(step, step)];
        for j in step + 1..k {
            let factor = a[(j, step)] / root;
            if factor != 0.0 {
                for i in j..k {
                    let change = a[(i, step)] * factor;
                    a[(i, j)] -= change;
                }
            }
        }
        // The lower triangle is used alone; keep the upper one like it for the exchanges.
        for j in step + 1..k {
            for i in j + 1..k {
                a[(j, i)] = a[(i, j)];
            }
        }
    }
    k
}

/// Solves the pencil; matrices symmetric, in natural units.
pub(crate) fn solve(mass: &DMatrix<f64>, tangent: &DMatrix<f64>) -> Option<Solved> {
    if mass.iter().chain(tangent.iter()).any(|x| !x.is_finite()) {
        return None;
    }
    if mass.nrows() == 0 {
        // Everything is held: there is nothing that could vibrate.
        return Some(Solved {
            shapes: DMatrix::zeros(0, 0),
            neutral: DMatrix::zeros(0, 0),
            ..Solved::default()
        });
    }
    if let Some(shifted) = Shifted::find(mass, tangent) {
        return Some(by_shift(mass, &shifted));
    }
    let (neutral, rest) = neutral_directions(mass, tangent);
    if neutral.ncols() > 0 {
        let (m, k) = (within(&rest, mass), within(&rest, tangent));
        let inner = match Shifted::find(&m, &k) {
            Some(shifted) => by_shift(&m, &shifted),
            None => condensed(&m, &k)?,
        };
        return Some(Solved {
            shapes: rest * inner.shapes,
            neutral,
            ..inner
        });
    }
    condensed(mass, tangent)
}

fn within(basis: &DMatrix<f64>, a: &DMatrix<f64>) -> DMatrix<f64> {
    symmetric(basis.tr_mul(&(a * basis)))
}

pub(crate) fn symmetric(a: DMatrix<f64>) -> DMatrix<f64> {
    (&a + a.transpose()) * 0.5
}

fn by_shift(mass: &DMatrix<f64>, shifted: &Shifted) -> Solved {
    let n = mass.nrows();
    let l = shifted.factor.l();
    let mut a = mass.clone();
    for j in 0..n {
        for i in 0..n {
            a[(i, j)] *= shifted.units[i] * shifted.units[j];
        }
    }
    // L^-1 M L^-T; pivots were checked, so that the triangular solutions cannot fail.
    l.solve_lower_triangular_unchecked_mut(&mut a);
    a = a.transpose();
    l.solve_lower_triangular_unchecked_mut(&mut a);
    let eigen = symmetric(a).symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
    let kept = rank_of_mass(mass);
    order.truncate(kept);
    let mut shapes = DMatrix::zeros(n, kept);
    let mut squared = Vec::with_capacity(kept);
    for (k, &from) in order.iter().enumerate() {
        let value = eigen.eigenvalues[from];
        let mut column = eigen.eigenvectors.column(from).into_owned();
        l.tr_solve_lower_triangular_unchecked_mut(&mut column);
        column.component_mul_assign(&shifted.units);
        column /= value.sqrt();
        // The largest entry points forwards, so that shapes do not flip from posture to posture.
        let largest = column
            .iter()
            .fold(0.0_f64, |m, x| if x.abs() > m.abs() { *x } else { m });
        if largest < 0.0 {
            column.neg_mut();
        }
        squared.push(1.0 / value - shifted.shift);
        shapes.set_column(k, &column);
    }
    Solved {
        squared,
        shapes,
        massless: n - kept,
        neutral: DMatrix::zeros(n, 0),
        massless_unstable: 0,
        shift: shifted.shift,
    }
}

/// Directions without mass and without stiffness, and the rest, both orthonormal.
pub(crate) fn neutral_directions(
    mass: &DMatrix<f64>,
    tangent: &DMatrix<f64>,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = mass.nrows();
    let size = |a: &DMatrix<f64>| {
        a.iter()
            .fold(0.0_f64, |m, x| if x.abs() > m { x.abs() } else { m })
            .max(f64::MIN_POSITIVE)
    };
    let mut rows = DMatrix::zeros(2 * n, n);
    rows.rows_mut(0, n).copy_from(&(mass / size(mass)));
    rows.rows_mut(n, n).copy_from(&(tangent / size(tangent)));
    // Absolute for both: each is in units of its own largest entry, and noise of a neutral block is no stiffness.
    let (neutral, _) = null_space_below(&rows, 1e-13);
    let (rest, _) = null_space(&neutral.transpose());
    (neutral, rest)
}

/// Massless coordinates condensed by the eigenvectors of `M`; [D6].
fn condensed(mass: &DMatrix<f64>, tangent: &DMatrix<f64>) -> Option<Solved> {
    let n = mass.nrows();
    let eigen = mass.clone().symmetric_eigen();
    let most = eigen
        .eigenvalues
        .iter()
        .fold(0.0_f64, |m, x| if *x > m { *x } else { m });
    let (heavy, light): (Vec<usize>, Vec<usize>) =
        (0..n).partition(|&i| eigen.eigenvalues[i] > MASSLESS * most);
    let (um, u0) = (
        eigen.eigenvectors.select_columns(&heavy),
        eigen.eigenvectors.select_columns(&light),
    );
    let k00 = within(&u0, tangent);
    let k0m = u0.tr_mul(&(tangent * &um));
    // Relative to all of K: rounding of a block without stiffness is no stiffness.
    let size = tangent
        .iter()
        .fold(0.0_f64, |m, x| if x.abs() > m { x.abs() } else { m });
    let own = k00.symmetric_eigen();
    let least = 1e-13 * size * (n as f64);
    let follows = {
        let mut part = own.eigenvectors.tr_mul(&k0m);
        for (mut row, value) in part.row_iter_mut().zip(own.eigenvalues.iter()) {
            row *= if value.abs() > least {
                -1.0 / value
            } else {
                0.0
            };
        }
        &own.eigenvectors * part
    };
    let m = within(&um, mass);
    let k = symmetric(within(&um, tangent) + k0m.tr_mul(&follows));
    let shifted = Shifted::find(&m, &k)?;
    let inner = by_shift(&m, &shifted);
    let whole = um + &u0 * follows;
    let none = own.eigenvalues.iter().filter(|v| v.abs() <= least).count();
    let neutral: Vec<usize> = (0..own.eigenvalues.len())
        .filter(|&i| own.eigenvalues[i].abs() <= least)
        .collect();
    Some(Solved {
        shift: inner.shift,
        squared: inner.squared,
        shapes: whole * inner.shapes,
        massless: light.len() - none,
        neutral: u0 * own.eigenvectors.select_columns(&neutral),
        massless_unstable: own.eigenvalues.iter().filter(|v| **v < -least).count(),
    })
}

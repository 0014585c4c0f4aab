//! Stability of a chain's shape, its buckling margin [R 5.16-5.21], and motions in which it diverges.
//!
//! With the end held, the chain can still move along the null space `N` of its Jacobian. The shape
//! is stable iff `S_c = N^T (H - K) N` is negative definite; equivalently iff the bordered matrix
//! has as many positive eigenvalues as the Jacobian has rows. The share of the way to buckling `mu` is the largest
//! eigenvalue of `(N^T H N) v = mu (N^T K N) v`: it does not depend on coordinates, 0 is unloaded,
//! 1 is the point of buckling.
//!
//! `S_c` is symmetric even where `H` of a moment on the end is not, because null motions do not turn the
//! end. With the end free, or with moments and followers elsewhere, it need not be: `mu` is then that of
//! the symmetric part, below 1 of which nothing goes away, whatever the masses are, and beyond it
//! [`TangentMotions`] decides.

use crate::chain::directions::{names_in, passive_null_space, scaled_jacobian};
use crate::chain::graded::{MaterialUnits, material_springs, without_geometric};
use crate::chain::sweep::solve::EndMotions;
use crate::chain::sweep::stages::Sweep;
use crate::chain::system::System;
use crate::linalg::complement::{complement, complement_of_few};
use crate::linalg::saddle::{Inertia, RANK_TOLERANCE, column_space, inertia};
use crate::linalg::sparse::largest_eigenvalues;
use crate::model::chain::Chain;
use crate::number::{larger, largest_size};
use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Stability of a chain's shape while its end is held.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct ShapeStability {
    /// True if no neighbouring shape of the held chain has less energy; for loads without a potential: if it does not
    /// diverge, but see [`may_flutter`](Self::may_flutter).
    pub stable: bool,
    /// Inertia of the bordered matrix, symmetric part; with a potential stable iff `positive` equals the rank of the
    /// Jacobian.
    pub inertia: Inertia,
    /// Number of motions in which the shape goes away.
    #[cfg_attr(feature = "serde", serde(default))]
    pub unstable_modes: usize,
    /// `mu`, largest share of the way to buckling: below 1 is stable. `None` for a chain without
    /// inner freedom; infinite where a passive motion is pushed out of line. Of loads without a potential
    /// that of the tangent's symmetric part.
    pub share_to_buckling: Option<f64>,
    /// Motion of all coordinates in the most critical mode (m, rad), largest component 1; empty where
    /// nothing can buckle or numbers of 16 digits do not tell it.
    pub mode: Vec<f64>,
    /// Passive joints that can move for nothing (neutral, left out of the stability).
    pub neutral: Vec<String>,
}

/// Shares that differ from 1 by less are taken as 1: rounding of a converged equilibrium.
const AT_CRITICAL: f64 = 1e-9;

impl ShapeStability {
    /// The loads have no potential and the shape does not go away, but it may swing with growing amplitude
    /// (flutter); whether it does depends on the masses.
    #[must_use]
    pub fn may_flutter(&self) -> bool {
        self.stable
            && self
                .share_to_buckling
                .is_some_and(|mu| mu > 1.0 + AT_CRITICAL)
    }

    /// True at the critical load within rounding: some motion neither stores nor frees energy.
    pub(crate) fn is_critical(&self) -> bool {
        self.share_to_buckling
            .is_some_and(|mu| (mu - 1.0).abs() <= AT_CRITICAL)
    }
}

pub(crate) fn shape_stability(
    chain: &Chain,
    system: &System,
    scales: &[f64],
    conservative: bool,
) -> ShapeStability {
    let held = scaled_jacobian(system, scales);
    stability_within(chain, system, scales, &held, conservative)
}

/// Stability by sweeps along a long chain without redundant passive joints; `None` where they cannot. Sweeps use the
/// symmetric part of the tangent alone.
pub(crate) fn swept_stability(
    system: &System,
    sweep: &Sweep,
    scales: &[f64],
) -> Option<ShapeStability> {
    let range = column_space(&scaled_jacobian(system, scales));
    swept_stability_within(sweep, scales, &EndMotions::held(range))
}

/// Stability by sweeps while some motions of the end are held.
pub(crate) fn swept_stability_within(
    sweep: &Sweep,
    scales: &[f64],
    ends: &EndMotions,
) -> Option<ShapeStability> {
    let shape = crate::chain::sweep::solve::shape(sweep, ends)?;
    let numbers = shape.mode.iter().chain([&shape.share_to_buckling]);
    if !numbers.into_iter().all(|x| x.is_finite()) {
        return None;
    }
    let own = shape.mode.iter().zip(&scales[6..]);
    Some(ShapeStability {
        stable: shape.share_to_buckling < 1.0,
        inertia: shape.inertia,
        unstable_modes: shape.inertia.positive.saturating_sub(ends.held_count()),
        share_to_buckling: Some(shape.share_to_buckling),
        mode: largest_one(own.map(|(v, f)| v * f).collect()),
        neutral: Vec::new(),
    })
}

/// A motion scaled so that its largest component is 1; empty where its numbers are lost.
fn largest_one(mut motion: Vec<f64>) -> Vec<f64> {
    if motion.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let most = largest_size(motion.iter());
    for x in &mut motion {
        *x /= most.max(f64::MIN_POSITIVE);
    }
    motion
}

/// Stability while some motions are held: `jacobian` maps the scaled coordinates to them, one row
/// per held motion. The whole end held gives `shape_stability`. `conservative`: the loads have a
/// potential.
pub fn stability_within(
    chain: &Chain,
    system: &System,
    scales: &[f64],
    jacobian: &DMatrix<f64>,
    conservative: bool,
) -> ShapeStability {
    let n = system.spring_torque.len();
    let range = column_space(jacobian);
    let rank = range.ncols();
    let mut hessian = DMatrix::from_fn(n, n, |i, j| {
        0.5 * (system.hessian[(i, j)] + system.hessian[(j, i)]) * scales[6 + i] * scales[6 + j]
    });
    // The springs' geometric stiffness is the load's doing; what is left of them is positive definite.
    let springs = material_springs(system, scales);
    without_geometric(system, scales, &mut hessian);
    let rows = if rank == jacobian.nrows() {
        jacobian.clone()
    } else {
        range.transpose() * jacobian
    };

    let mut bordered = DMatrix::zeros(rank + n, rank + n);
    bordered
        .view_mut((rank, 0), (n, rank))
        .copy_from(&rows.transpose());
    bordered.view_mut((0, rank), (rank, n)).copy_from(&rows);
    bordered
        .view_mut((rank, rank), (n, n))
        .copy_from(&(&hessian - &springs));
    let inertia = inertia(bordered);

    // Neutral passive motions do not count for stability.
    let neutral = neutral_motions(chain, jacobian, &rows, &hessian);
    let units = MaterialUnits::of(chain, &springs);
    let mut taken_out = DMatrix::zeros(n, rank + neutral.ncols());
    taken_out.columns_mut(0, rank).copy_from(&rows.transpose());
    units.gather(&mut taken_out);
    taken_out
        .columns_mut(rank, neutral.ncols())
        .copy_from(&neutral);
    let null = complement_of_few(&taken_out);
    let stiffness = units.stiffness(springs);
    let b = null.transpose() * stiffness * &null;
    let motions = units.motions(null);
    let a = motions.transpose() * &hessian * &motions;
    let (share_to_buckling, mode) = share_to_buckling(&a, &b);
    let mut stable = share_to_buckling.is_none_or(|mu| mu < 1.0);
    let mut unstable_modes = inertia.positive.saturating_sub(rank);
    if !conservative && share_to_buckling.is_some_and(|mu| mu >= 1.0 && mu.is_finite()) {
        let turning = DMatrix::from_fn(n, n, |i, j| {
            0.5 * (system.hessian[(i, j)] - system.hessian[(j, i)])
                * (scales[6 + i] * scales[6 + j])
        });
        let turning = motions.transpose() * turning * &motions;
        unstable_modes = diverging_motions(&(b - a - turning), 0.0, TangentMotions::All);
        stable = unstable_modes == 0;
    }
    let mode = mode.map_or_else(Vec::new, |v| {
        let motion = &motions * v;
        largest_one((0..n).map(|i| motion[i] * scales[6 + i]).collect())
    });
    ShapeStability {
        stable,
        inertia,
        unstable_modes,
        share_to_buckling,
        mode,
        neutral: names_in(chain, &neutral),
    }
}

/// Orthonormal motions of passive joints alone that move nothing that is held and that the loads
/// neither hold nor push (the spin of a strut, a hinge at a loaded tip), n x k, scaled: those
/// passive null motions `v` for which `N^T H v = 0` with all null motions `N`. Others of the same
/// joints may be held or pushed and count for stability. `rows` are independent rows of `jacobian`.
pub(crate) fn neutral_motions(
    chain: &Chain,
    jacobian: &DMatrix<f64>,
    rows: &DMatrix<f64>,
    hessian: &DMatrix<f64>,
) -> DMatrix<f64> {
    let passive = passive_null_space(chain, jacobian);
    if passive.ncols() == 0 {
        return passive;
    }
    let null = complement(&rows.transpose());
    let pushed = null.transpose() * hessian * &passive;
    let gram = (pushed.transpose() * &pushed).symmetric_eigen();
    let most = NEUTRAL * hessian.amax();
    let free: Vec<usize> = (0..passive.ncols())
        .filter(|&k| gram.eigenvalues[k] <= most * most)
        .collect();
    passive * gram.eigenvectors.select_columns(&free)
}

/// Share of the largest entry of the loads' Hessian that counts as nothing.
const NEUTRAL: f64 = 1e-7;

/// Rounding of products of orthonormal columns.
const ORTHONORMAL: f64 = 1e-13;

/// Largest eigenvalue of the pencil `a v = mu b v`, `b` positive semi-definite, and its vector.
pub(crate) fn share_to_buckling(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
) -> (Option<f64>, Option<DVector<f64>>) {
    if a.nrows() == 0 {
        return (None, None);
    }
    // Without passive joints every inner motion has a material stiffness of one.
    if b.is_identity(ORTHONORMAL) {
        let (largest, modes) = largest_eigenvalues(&(0.5 * (a + a.transpose())), 1);
        return (Some(largest[0]), Some(modes.column(0).into_owned()));
    }
    // The usual case otherwise: every inner motion strains a spring.
    if let Some(factor) = b.clone().cholesky().filter(|c| {
        let d = c.l_dirty().diagonal();
        d.min() > 1e-4 * d.max()
    }) {
        let l = factor.l();
        let half = l.solve_lower_triangular(a);
        let reduced = half.and_then(|h| l.solve_lower_triangular(&h.transpose()));
        if let Some(reduced) = reduced {
            let eigen = (0.5 * (&reduced + reduced.transpose())).symmetric_eigen();
            let worst = eigen.eigenvalues.imax();
            let v = eigen.eigenvectors.column(worst).into_owned();
            let motion = l.tr_solve_lower_triangular(&v);
            return (Some(eigen.eigenvalues[worst]), motion);
        }
    }
    let eigen = b.clone().symmetric_eigen();
    let most = eigen.eigenvalues.amax();
    let soft: Vec<usize> = (0..b.nrows())
        .filter(|&i| eigen.eigenvalues[i] <= 1e3 * RANK_TOLERANCE * most)
        .collect();
    let hard: Vec<usize> = (0..b.nrows()).filter(|i| !soft.contains(i)).collect();
    // Hard directions in units where b is the identity.
    let mut y = eigen.eigenvectors.select_columns(&hard);
    for (k, &i) in hard.iter().enumerate() {
        y.column_mut(k).unscale_mut(eigen.eigenvalues[i].sqrt());
    }
    let mut reduced = y.transpose() * a * &y;
    let mut coupling = None;
    if !soft.is_empty() {
        // Purely passive motions that a load holds (negative) or pushes out of line (positive).
        let z = eigen.eigenvectors.select_columns(&soft);
        let held = z.transpose() * a * &z;
        let eigen_held = held.clone().symmetric_eigen();
        let worst = eigen_held.eigenvalues.imax();
        if eigen_held.eigenvalues[worst] >= -1e-12 * a.amax().max(f64::MIN_POSITIVE) {
            return (
                Some(f64::INFINITY),
                Some(z * eigen_held.eigenvectors.column(worst)),
            );
        }
        if let Some(inverse) = held.try_inverse() {
            let cross = z.transpose() * a * &y;
            reduced -= cross.transpose() * &inverse * &cross;
            coupling = Some(-(z * inverse * cross));
        }
    }
    if hard.is_empty() {
        return (Some(f64::NEG_INFINITY), None);
    }
    let eigen = (0.5 * (&reduced + reduced.transpose())).symmetric_eigen();
    let worst = eigen.eigenvalues.imax();
    let v = eigen.eigenvectors.column(worst).into_owned();
    let motion = match coupling {
        Some(c) => &y * &v + c * &v,
        None => &y * &v,
    };
    (Some(eigen.eigenvalues[worst]), Some(motion))
}

/// Motions of a shape that are in its tangent stiffness.
///
/// With a potential the tangent stiffness `T` is symmetric, and every negative eigenvalue is a motion that
/// frees energy. Forces that follow the chain and moments about fixed axes make `T` unsymmetric: then a
/// neighbouring equilibrium exists where `det T = 0`, not where its symmetric part is indefinite
/// (Bolotin, Nonconservative Problems of the Theory of Elastic Stability, 1963). Below the latter
/// nothing goes away, whatever the masses are; above it the count here tells what the masses cannot change. A
/// flutter is not assessed: with masses that favour it and no damping every unsymmetric `T` has one.
///
/// Let `U` span the eigenvectors of the symmetric part with negative eigenvalues and `P` the others. Among `P`
/// alone the symmetric part is positive, so that `T_PP` is regular, and
///
/// ```text
/// det T = det T_PP det R,     R = T_UU - T_UP T_PP^-1 T_PU,     det T_PP > 0
/// ```
///
/// `R`, static condensation onto the few motions in question, is singular exactly where `T` is, and its inverse is
/// `U^T T^-1 U`. Its real negative eigenvalues are counted: their number is odd exactly where `det T < 0`, and
/// then something goes away whatever the masses are. Conjugate ones may be a flutter, which depends on the masses.
///
/// Where `U` is all there is, the symmetric part being negative in every motion, nothing depends on the masses:
/// with masses `M` and `T x = w^2 M x` the real part of `w^2 = x* T x / x* M x` is negative for every `x`, so that
/// all motions grow, whether they go straight or swing. The determinant does not tell it: of two motions
/// it is positive there. Sure it is only if no motion was condensed out of `T` before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentMotions {
    /// All.
    All,
    /// Some were condensed out of it.
    Condensed,
}

impl TangentMotions {
    pub(crate) fn all_if(all: bool) -> Self {
        match all {
            true => Self::All,
            false => Self::Condensed,
        }
    }
}

/// Number of motions in which a shape of tangent stiffness `tangent` (n x n, in units in which motions
/// count alike) goes away. Eigenvalues of the symmetric part down to `-zero` count as none.
pub fn diverging_motions(tangent: &DMatrix<f64>, zero: f64, motions: TangentMotions) -> usize {
    let n = tangent.nrows();
    if n == 0 {
        return 0;
    }
    let symmetric = 0.5 * (tangent + tangent.transpose());
    let turns = (tangent - tangent.transpose()).amax() > TURNS_NOTHING * symmetric.amax();
    // Counts the eigenvalues above `zero` of the negative matrix.
    let shifted = DMatrix::from_fn(n, n, |i, j| {
        -symmetric[(i, j)] - if i == j { zero } else { 0.0 }
    });
    let unstable = inertia(shifted).positive;
    if unstable == 0 || !turns || (motions == TangentMotions::All && unstable == n) {
        return unstable;
    }
    let (_, u) = largest_eigenvalues(&-symmetric, unstable);
    // The inverse of `R` is that part of the inverse of `T`.
    let Some(moved) = tangent.clone().lu().solve(&u) else {
        return unstable;
    };
    let condensed = u.transpose() * moved;
    let Some(schur) = Schur::try_new(condensed, f64::EPSILON, 10_000) else {
        return unstable;
    };
    let all = schur.complex_eigenvalues();
    let most = all.iter().fold(0.0_f64, |m, x| larger(m, x.norm()));
    if !most.is_finite() {
        return unstable;
    }
    // Two equal ones (a round rod) part by the root of what rounding leaves.
    let real = all.iter().filter(|x| x.im.abs() <= 1e-6 * most);
    real.filter(|x| x.re < 0.0).count()
}

/// Share of a tangent's largest entry below which what is not symmetric in it is rounding.
const TURNS_NOTHING: f64 = 1e-10;

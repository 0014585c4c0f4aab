//! Virtual experiments: from the displacements of an interface under six (or more) load cases to the
//! 6 x 6 compliance and stiffness of a link \[Klimchik2013\], with what the noise leaves of it.
//!
//! Each load case is one experiment: the other end is fixed, a known wrench acts at the point `e`, and
//! the interface's nodes move. A rigid motion is fitted to each ([`crate::rigid_fit`]); the motions are
//! the columns of `D = C F` for the wrenches `F`, so `C = D F^+`. A link's compliance is symmetric, and
//! what is not is noise (or a mistake in axes and points): its share is reported, and compared with what
//! the residuals of the fits explain.

use kinetostat::number::{larger, short};
use nalgebra::{DMatrix, Matrix6, Vector3, Vector6};

use crate::error::{Error, LinkErrorKind, Result};
use crate::interface::{RigidFit, RigidRank, invert, rigid_fit, rigid_rank};
use crate::stiffness_check::DIRECTIONS;

/// One load case: what acts on the link's end, and how the interface's nodes move.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCase {
    /// Name in the file.
    pub name: String,
    /// Force and moment about the link's end, N and N m, file's axes.
    pub wrench: Vector6<f64>,
    /// Places of the nodes, m, file's axes.
    pub places: Vec<Vector3<f64>>,
    /// Displacements of the nodes, m.
    pub displacements: Vec<Vector3<f64>>,
}

/// A compliance and stiffness from experiments, with confidence figures. SI, file's axes, at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// Compliance as it came out, not symmetric.
    pub compliance: Matrix6<f64>,
    /// Standard deviations of its entries, from the residuals.
    pub compliance_deviation: Matrix6<f64>,
    /// Inverse of the symmetric part.
    pub stiffness: Matrix6<f64>,
    /// Standard deviations of the entries of `stiffness`.
    pub stiffness_deviation: Matrix6<f64>,
    /// `|C - C^T| / |C + C^T|`, scaled by the diagonal.
    pub antisymmetric_share: f64,
    /// Antisymmetric share that the residuals explain (expected root mean square).
    pub explained_share: f64,
    /// Pairs `(row, column)` of the symmetric part that are not distinguishable from zero: less than
    /// twice their standard deviation.
    pub insignificant: Vec<(usize, usize)>,
    /// Fits of the load cases, in their order.
    pub fits: Vec<RigidFit>,
    /// Rank of the interface (the smallest over the load cases).
    pub rank: RigidRank,
    /// `|D - C F| / |D|` where there are more cases than six, else 0.
    pub not_linear: f64,
    /// Doubts, in words.
    pub notices: Vec<String>,
}

/// Share of displacements that are no rigid motion above which noise is the first suspect.
const NOISY: f64 = 0.3;

/// Identifies the compliance at `end` (m, file's axes).
///
/// # Errors
///
/// Fewer than six cases, wrenches that do not span six directions, an interface that leaves a motion
/// unknown (collinear or coincident nodes), a compliance that cannot be inverted; `file` is named.
pub fn identify(file: &str, cases: &[LoadCase], end: &Vector3<f64>) -> Result<Identified> {
    let fault =
        |message: String, help: &str| Error::new(LinkErrorKind::LoadCases, file, message, help);
    if cases.len() < 6 {
        return Err(fault(
            format!("there are {} load cases", cases.len()),
            "six are needed: forces along x, y, z and moments about them",
        ));
    }
    let size = cases
        .iter()
        .flat_map(|c| &c.places)
        .map(|p| (p - end).norm())
        .fold(0.0, larger)
        .max(1e-3);
    let wrenches = DMatrix::from_fn(6, cases.len(), |i, m| cases[m].wrench[i]);
    let inverse = right_inverse(file, &wrenches, size)?;
    let (fits, rank) = fits_of(file, cases, end)?;
    let moved = DMatrix::from_fn(6, cases.len(), |i, m| fits[m].motion[i]);
    let c = &moved * &inverse;
    let compliance = Matrix6::from_fn(|i, j| c[(i, j)]);
    let left = &moved - &c * &wrenches;
    let not_linear = if cases.len() > 6 && moved.norm() > 0.0 {
        scaled_ratio(&left, &moved, size)
    } else {
        0.0
    };
    let compliance_deviation = compliance_deviation(&inverse, &fits);
    let symmetric = 0.5 * (compliance + compliance.transpose());
    let stiffness = invert(&symmetric).ok_or_else(|| singular(file, &fits))?;
    let stiffness_deviation = stiffness_deviation(&stiffness, &inverse, &fits);
    let (share, explained) = asymmetry(&compliance, &compliance_deviation);
    let insignificant = insignificant(&symmetric, &compliance_deviation);
    let mut found = Identified {
        compliance,
        compliance_deviation,
        stiffness,
        stiffness_deviation,
        antisymmetric_share: share,
        explained_share: explained,
        insignificant,
        fits,
        rank,
        not_linear,
        notices: Vec::new(),
    };
    found.notices = notices(cases, &found);
    Ok(found)
}

/// The rigid motion of the interface in each load case, and the worst conditioned of its ranks.
fn fits_of(
    file: &str,
    cases: &[LoadCase],
    end: &Vector3<f64>,
) -> Result<(Vec<RigidFit>, RigidRank)> {
    let fault =
        |message: String, help: &str| Error::new(LinkErrorKind::LoadCases, file, message, help);
    let mut fits = Vec::with_capacity(cases.len());
    let mut rank: Option<RigidRank> = None;
    for case in cases {
        let fit = rigid_fit(&case.places, &case.displacements, end).map_err(|r| {
            let words = if r.words.is_empty() {
                format!("it has {} nodes", case.places.len())
            } else {
                r.words
            };
            fault(
                format!(
                    "load case '{}': the rank of the interface's motion is {} of 6: {words}",
                    case.name, r.rank
                ),
                "take at least three nodes that are not on a line, better a whole face",
            )
        })?;
        let own = rigid_rank(&case.places);
        if rank.as_ref().is_none_or(|r| own.condition > r.condition) {
            rank = Some(own);
        }
        fits.push(fit);
    }
    Ok((fits, rank.unwrap_or_else(|| rigid_rank(&[]))))
}

/// Standard deviations of a compliance `C = D P` by those of the motions `D`; load cases are independent of each other.
fn compliance_deviation(inverse: &DMatrix<f64>, fits: &[RigidFit]) -> Matrix6<f64> {
    // C[:, b] = sum_m D[:, m] P[m, b]
    Matrix6::from_fn(|i, b| {
        let variance: f64 = fits
            .iter()
            .enumerate()
            .map(|(m, f)| inverse[(m, b)].powi(2) * f.covariance[(i, i)])
            .sum();
        variance.sqrt()
    })
}

/// Standard deviations of the stiffness, by linear propagation: an error `e` at `D[a, m]` changes `K[i, j]` by
/// `-e sum_b P[m, b] (K[i,a] K[b,j] + K[i,b] K[a,j]) / 2`.
fn stiffness_deviation(
    k: &Matrix6<f64>,
    inverse: &DMatrix<f64>,
    fits: &[RigidFit],
) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| {
        let mut variance = 0.0;
        for (m, fit) in fits.iter().enumerate() {
            let (mut at_i, mut at_j) = (0.0, 0.0);
            for b in 0..6 {
                at_i += inverse[(m, b)] * k[(i, b)];
                at_j += inverse[(m, b)] * k[(b, j)];
            }
            let v = Vector6::from_fn(|a, _| 0.5 * (k[(i, a)] * at_j + k[(a, j)] * at_i));
            variance += v.dot(&(fit.covariance * v));
        }
        variance.sqrt()
    })
}

/// Error of a compliance without an inverse: noise, or a mistake in the table.
fn singular(file: &str, fits: &[RigidFit]) -> Error {
    let worst = fits.iter().map(|f| f.not_rigid).fold(0.0, larger);
    if worst > NOISY {
        return Error::new(
            LinkErrorKind::LoadCases,
            file,
            format!(
                "the compliance that comes out is singular or has no positive diagonal: noise hides it, up to {:.0} % of the displacements of a case are no rigid motion",
                100.0 * worst
            ),
            "take larger loads, more nodes or finer measurements, write more digits, and check the unit of the displacements",
        );
    }
    Error::new(
        LinkErrorKind::LoadCases,
        file,
        "the compliance that comes out is singular or has no positive diagonal",
        "check that every case has its own displacements, that loads and displacements have the same axes, and the sign of the loads",
    )
}

impl Identified {
    /// The stiffness from a compliance whose insignificant entries are taken for zero: the filter of
    /// \[Klimchik2013\]. `None` if what is left is not positive definite.
    #[must_use]
    pub fn filtered(&self) -> Option<Matrix6<f64>> {
        let mut c = 0.5 * (self.compliance + self.compliance.transpose());
        for &(i, j) in &self.insignificant {
            c[(i, j)] = 0.0;
            c[(j, i)] = 0.0;
        }
        c.cholesky()?;
        invert(&c)
    }
}

/// `F^+` (m x 6), forces and moments compared with the size of the interface.
fn right_inverse(file: &str, wrenches: &DMatrix<f64>, size: f64) -> Result<DMatrix<f64>> {
    let mut scaled = wrenches.clone();
    for i in 3..6 {
        scaled.row_mut(i).scale_mut(1.0 / size);
    }
    // Each case counts by the directions it loads, not by the size of its load.
    let norms: Vec<f64> = scaled.column_iter().map(|c| c.norm()).collect();
    let unloaded = norms.iter().position(|n| !(n.is_finite() && *n > 0.0));
    if let Some(m) = unloaded {
        return Err(Error::new(
            LinkErrorKind::LoadCases,
            file,
            format!("load case {} has no load", m + 1),
            "give its force or moment",
        ));
    }
    for (m, n) in norms.iter().enumerate() {
        scaled.column_mut(m).scale_mut(1.0 / n);
    }
    let gram = &scaled * scaled.transpose();
    let gram = Matrix6::from_fn(|i, j| gram[(i, j)]);
    let eigen = gram.symmetric_eigen();
    if eigen.eigenvalues.min() < 1e-8 * eigen.eigenvalues.max() {
        let missing = eigen.eigenvectors.column(eigen.eigenvalues.imin()).iamax();
        return Err(Error::new(
            LinkErrorKind::LoadCases,
            file,
            format!(
                "the loads do not span six directions: nothing loads {} on its own",
                DIRECTIONS[missing]
            ),
            "add a load case: forces along x, y, z and moments about them, about the link's end",
        ));
    }
    let inverse = gram.try_inverse().ok_or_else(|| {
        Error::new(
            LinkErrorKind::LoadCases,
            file,
            "the loads do not span six directions",
            "add load cases",
        )
    })?;
    let mut right = scaled.transpose() * DMatrix::from_fn(6, 6, |i, j| inverse[(i, j)]);
    for (m, n) in norms.iter().enumerate() {
        right.row_mut(m).scale_mut(1.0 / n);
    }
    for j in 3..6 {
        right.column_mut(j).scale_mut(1.0 / size);
    }
    Ok(right)
}

fn scaled_ratio(left: &DMatrix<f64>, whole: &DMatrix<f64>, size: f64) -> f64 {
    let scale = |m: &DMatrix<f64>| {
        let mut m = m.clone();
        for i in 3..6 {
            m.row_mut(i).scale_mut(size);
        }
        m.norm()
    };
    scale(left) / scale(whole)
}

/// Found and explained anti-symmetric share of a compliance.
fn asymmetry(c: &Matrix6<f64>, deviation: &Matrix6<f64>) -> (f64, f64) {
    let unit = Vector6::from_fn(|i, _| c[(i, i)].abs().sqrt().max(f64::MIN_POSITIVE));
    let (mut odd, mut even, mut noise) = (0.0, 0.0, 0.0);
    for i in 0..6 {
        for j in 0..6 {
            let u = unit[i] * unit[j];
            odd += ((c[(i, j)] - c[(j, i)]) / u).powi(2);
            even += ((c[(i, j)] + c[(j, i)]) / u).powi(2);
            if i != j {
                noise += (deviation[(i, j)].powi(2) + deviation[(j, i)].powi(2)) / (u * u);
            }
        }
    }
    ((odd / even).sqrt(), (noise / even).sqrt())
}

fn insignificant(c: &Matrix6<f64>, deviation: &Matrix6<f64>) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for i in 0..6 {
        for j in 0..i {
            let own = 0.5 * deviation[(i, j)].hypot(deviation[(j, i)]);
            // Rounding of the table counts as noise too.
            let unit = (c[(i, i)] * c[(j, j)]).abs().sqrt();
            if c[(i, j)].abs() < (2.0 * own).max(1e-9 * unit) {
                found.push((i, j));
            }
        }
    }
    found
}

fn notices(cases: &[LoadCase], found: &Identified) -> Vec<String> {
    let mut notices = Vec::new();
    for (case, fit) in cases.iter().zip(&found.fits) {
        let turn = fit.motion.fixed_rows::<3>(3).norm();
        if turn > 0.02 {
            notices.push(format!(
                "load case '{}' turns the interface by {:.3} rad: take a smaller load, the fit is linear",
                case.name, turn
            ));
        }
        if fit.not_rigid > 0.1 {
            notices.push(format!(
                "load case '{}': {:.0} % of the displacements is no rigid motion (noise, or an interface that warps)",
                case.name,
                100.0 * fit.not_rigid
            ));
        }
    }
    let (found_share, explained) = (found.antisymmetric_share, found.explained_share);
    if found_share > 1e-3 && found_share > 3.0 * explained {
        notices.push(format!(
            "the compliance is anti-symmetric by {}, the residuals explain {}: check that loads and displacements have the same axes, and that the loads act at the stated end",
            short(found_share),
            short(explained)
        ));
    }
    if found.not_linear > 0.05 {
        notices.push(format!(
            "the load cases contradict each other by {:.1} %: the link is not linear, or a load is wrong",
            100.0 * found.not_linear
        ));
    }
    notices
}

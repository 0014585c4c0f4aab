//! Is this 6 x 6 matrix the stiffness of a link? Symmetric, positive (semi-)definite, of which rank,
//! and of a plausible size; and in words what it is not.

use kinetostat::number::{larger, setting, short, smaller};
use nalgebra::{Matrix6, Vector6};

/// Names of the six directions.
pub const DIRECTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Asymmetry (share of the scaled matrix) that rounding in a text file explains.
pub const SYMMETRIC_TO: f64 = 1e-6;
/// Eigenvalues of the scaled matrix below this are zero.
const ZERO: f64 = 1e-9;

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// The matrix is no stiffness of a link.
    Refused,
    /// The matrix holds nothing in some direction: a link has it only where a passive joint is meant.
    Loose,
    /// The matrix may be one, but something should be checked.
    Doubtful,
}

/// Something that a matrix is not, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Severity of the finding.
    pub grade: Grade,
    /// Finding in words.
    pub message: String,
    /// Remedy.
    pub help: String,
}

/// Check of a 6 x 6 matrix that should be a stiffness (N/m, N/rad, N m/m, N m/rad).
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessCheck {
    /// `|K - K^T| / |K + K^T|` (Frobenius) after balancing by the diagonal; 0 for a symmetric matrix.
    pub antisymmetric_share: f64,
    /// Eigenvalues of the symmetric part after balancing by the diagonal, ascending; no unit.
    pub eigenvalues: [f64; 6],
    /// Number of eigenvalues that are not zero.
    pub rank: usize,
    /// `sqrt(largest rotational / smallest translational diagonal entry)`, m: for a beam `L / sqrt(3)`.
    pub natural_length: f64,
    /// Properties that the matrix lacks.
    pub findings: Vec<Finding>,
}

impl StiffnessCheck {
    /// True if nothing speaks against the matrix being the stiffness of a link.
    #[must_use]
    pub fn is_stiffness(&self) -> bool {
        self.findings.iter().all(|f| f.grade != Grade::Refused)
    }

    /// True if the symmetric part has six positive eigenvalues: a link that a spring can stand for.
    #[must_use]
    pub fn is_definite(&self) -> bool {
        self.rank == 6 && self.eigenvalues[0] > 0.0
    }
}

/// Looks at a matrix in N and m, translations first. `symmetric_to`: asymmetry that is accepted
/// ([`SYMMETRIC_TO`] for text files; more where somebody has said that it is noise).
///
/// ```
/// let bar = kinetostat::BeamSection::tube(2.1e11, 8.0e10, 0.04, 0.0);
/// let checked = kinetostat_links::check_stiffness(&bar.cantilever(0.5)?, kinetostat_links::SYMMETRIC_TO);
/// assert!(checked.is_stiffness() && checked.rank == 6 && checked.findings.is_empty());
/// # Ok::<(), kinetostat::Error>(())
/// ```
#[must_use]
pub fn check_stiffness(k: &Matrix6<f64>, symmetric_to: f64) -> StiffnessCheck {
    if let Some(at) = (0..36).find(|&at| !k[(at / 6, at % 6)].is_finite()) {
        return StiffnessCheck {
            antisymmetric_share: f64::NAN,
            eigenvalues: [f64::NAN; 6],
            rank: 0,
            natural_length: f64::NAN,
            findings: vec![Finding::refused(
                format!(
                    "row {} column {} is no finite number",
                    at / 6 + 1,
                    at % 6 + 1
                ),
                "a stiffness that is infinite belongs to a rigid link: leave the link out",
            )],
        };
    }
    let mut findings = negative_diagonal(k);
    let (scaled, scale) = scaled_by_diagonal(k);
    let (sum, difference) = (scaled + scaled.transpose(), scaled - scaled.transpose());
    let share = if sum.norm() > 0.0 {
        difference.norm() / sum.norm()
    } else {
        0.0
    };
    if share > symmetric_to {
        findings.push(asymmetry(k, &difference, share));
    }
    let mut eigen: Vec<f64> = (0.5 * sum)
        .symmetric_eigenvalues()
        .iter()
        .copied()
        .collect();
    eigen.sort_by(f64::total_cmp);
    let rank = eigen.iter().filter(|e| e.abs() > ZERO).count();
    findings.extend(not_definite(k, &(0.5 * sum), &scale, eigen[0], rank));
    let natural_length = plausible(k, &mut findings);
    StiffnessCheck {
        antisymmetric_share: share,
        eigenvalues: std::array::from_fn(|i| eigen[i]),
        rank,
        natural_length,
        findings,
    }
}

impl Finding {
    fn refused(message: String, help: &str) -> Self {
        Self {
            grade: Grade::Refused,
            message,
            help: help.to_owned(),
        }
    }
}

/// Entries of the diagonal below zero: along them a motion would give energy back.
fn negative_diagonal(k: &Matrix6<f64>) -> Vec<Finding> {
    let negative = (0..6).filter(|&i| k[(i, i)] < 0.0);
    negative
        .map(|i| {
            Finding::refused(
                format!(
                    "the entry {0}, {0} is negative ({1})",
                    DIRECTIONS[i],
                    setting(k[(i, i)])
                ),
                "a motion would give energy back: check signs, and that this is not the stiffness under a load",
            )
        })
        .collect()
}

/// The largest difference of two entries that should be equal, of the scaled matrix.
fn asymmetry(k: &Matrix6<f64>, difference: &Matrix6<f64>, share: f64) -> Finding {
    let (mut worst, mut at) = (0.0, (0, 0));
    for i in 0..6 {
        for j in 0..i {
            if difference[(i, j)].abs() > worst {
                (worst, at) = (difference[(i, j)].abs(), (i, j));
            }
        }
    }
    let (i, j) = at;
    Finding::refused(
        format!(
            "the matrix is not symmetric: its anti-symmetric share is {}; row {} column {} is {}, row {} column {} is {}",
            short(share),
            DIRECTIONS[i],
            DIRECTIONS[j],
            setting(k[(i, j)]),
            DIRECTIONS[j],
            DIRECTIONS[i],
            setting(k[(j, i)])
        ),
        "a spring stores energy: if this is noise, say so (symmetrise); if not, loads and displacements are in different axes or at different points",
    )
}

/// A motion that gives energy back, or that nothing holds. `symmetric` is scaled by `scale`; `least` is its smallest
/// eigenvalue.
fn not_definite(
    k: &Matrix6<f64>,
    symmetric: &Matrix6<f64>,
    scale: &Vector6<f64>,
    least: f64,
    rank: usize,
) -> Option<Finding> {
    if least < -ZERO {
        return Some(Finding::refused(
            format!(
                "the matrix is not positive semi-definite: a motion {} has the energy {} in units of its parts",
                softest(symmetric, scale),
                short(least)
            ),
            "check signs and units of the entries off the diagonal, and the order (x, y, z, rx, ry, rz)",
        ));
    }
    if rank == 6 {
        return None;
    }
    let message = match (0..6).find(|&i| k[(i, i)] == 0.0) {
        Some(i) => format!(
            "the rank is {rank}, not 6: nothing holds the direction {}",
            DIRECTIONS[i]
        ),
        None => format!(
            "the rank is {rank}, not 6: nothing holds the motion {}",
            softest(symmetric, scale)
        ),
    };
    Some(Finding {
        grade: Grade::Loose,
        message,
        help: "a direction that nothing holds is a passive joint of the chain, or the other end was not fixed".into(),
    })
}

/// `K` with its own diagonal as unit (1 where that is not positive), and the roots of the units.
fn scaled_by_diagonal(k: &Matrix6<f64>) -> (Matrix6<f64>, Vector6<f64>) {
    let scale = Vector6::from_fn(|i, _| {
        let d = k[(i, i)];
        if d > 0.0 {
            d.sqrt()
        } else {
            // The row's own size, so that a zero diagonal with entries beside it is seen.
            k.row(i).amax().max(f64::MIN_POSITIVE).sqrt()
        }
    });
    (
        Matrix6::from_fn(|i, j| k[(i, j)] / scale[i] / scale[j]),
        scale,
    )
}

/// The motion of the lowest eigenvalue, by its largest parts.
fn softest(scaled: &Matrix6<f64>, scale: &Vector6<f64>) -> String {
    let eigen = scaled.symmetric_eigen();
    let at = eigen.eigenvalues.imin();
    let motion: Vector6<f64> = eigen.eigenvectors.column(at).component_div(scale);
    let (moves, turns) = (
        motion.fixed_rows::<3>(0).amax(),
        motion.fixed_rows::<3>(3).amax(),
    );
    let mut parts: Vec<(f64, usize)> = (0..6)
        .map(|i| (eigen.eigenvectors[(i, at)].abs(), i))
        .filter(|p| p.0 > 0.2)
        .collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let words: Vec<&str> = parts.iter().map(|p| DIRECTIONS[p.1]).collect();
    let along = words.join(", ");
    if moves > 0.0 && turns > 0.0 {
        format!("along {along} (together)")
    } else {
        format!("along {along}")
    }
}

/// Sizes that are possible but unlikely: usually a unit is wrong.
fn plausible(k: &Matrix6<f64>, findings: &mut Vec<Finding>) -> f64 {
    let largest = |from: usize| (from..from + 3).map(|i| k[(i, i)]).fold(0.0, larger);
    let (moves, turns) = (largest(0), largest(3));
    let softest = (0..3)
        .map(|i| k[(i, i)])
        .filter(|d| *d > 0.0)
        .fold(f64::INFINITY, smaller);
    let length = (turns / softest).sqrt();
    let mut doubt = |message: String| {
        findings.push(Finding {
            grade: Grade::Doubtful,
            message,
            help: "check the units: N and mm make a matrix whose rotational entries are 1e6 times those in N and m".into(),
        });
    };
    if moves > 0.0 && !(1e3..=1e12).contains(&moves) {
        doubt(format!(
            "the largest stiffness against a force is {} N/mm; links lie between 1 N/mm and 1e9 N/mm",
            short(moves * 1e-3)
        ));
    }
    if moves > 0.0 && turns > 0.0 && !(2e-3..=20.0).contains(&length) {
        doubt(format!(
            "rotational and translational entries belong to a link of the size {} m; links lie between 2 mm and 20 m",
            short(length)
        ));
    }
    length
}

/// The symmetric part `(K + K^T)/2`. It is only a link's stiffness if what is thrown away is noise:
/// say that it was done, and how much it was ([`StiffnessCheck::antisymmetric_share`]).
#[must_use]
pub fn symmetrised(k: &Matrix6<f64>) -> Matrix6<f64> {
    0.5 * (k + k.transpose())
}

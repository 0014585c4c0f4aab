//! The nodes where a link meets its neighbour: the rigid motion that fits their displacements, and
//! which motions their places leave unknown.
//!
//! A node at `p` moves by `u = d + phi x (p - e)` when the interface moves by `d` at the point `e` and
//! turns by `phi` (small). Least squares over all nodes gives `d`, `phi`; the residual is what is not
//! rigid: noise, and warping of the interface. This is the linear form of the fit in
//! \[Klimchik2013\], A. Klimchik, A. Pashkevich, D. Chablat, "CAD-based approach for identification of
//! elasto-static parameters of robotic manipulators", Finite Elements in Analysis and Design 75 (2013).

use kinetostat::number::larger;
use kinetostat::spatial::hat;
use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use crate::stiffness_check::DIRECTIONS;

/// Singular values below this share of the largest count as zero. Coordinates come with 6 or more
/// digits, so that nodes on a line leave about 1e-7.
const RANK_TO: f64 = 1e-5;

/// Rank of the rigid motions that the places of some nodes determine.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidRank {
    /// 6 if all; 5 for nodes on a line, 3 for nodes at one place.
    pub rank: usize,
    /// Singular values, descending, lengths in units of the interface's own size.
    pub singular_values: Vec<f64>,
    /// Largest over smallest singular value; infinite below rank 6.
    pub condition: f64,
    /// Radius of gyration of the nodes about their centre, m.
    pub size: f64,
    /// Unknown motions in words; empty at rank 6.
    pub words: String,
}

/// A rigid motion fitted to displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidFit {
    /// `[d; phi]` at the point requested, m and rad.
    pub motion: Vector6<f64>,
    /// Covariance of `motion`, from the residual.
    pub covariance: Matrix6<f64>,
    /// Root mean square of the residual per component, m (degrees of freedom counted).
    pub deviation: f64,
    /// Largest residual of a node, m, and its index.
    pub largest: (f64, usize),
    /// Residuals over displacements, both as norms: 0 for a rigid interface.
    pub not_rigid: f64,
}

/// `3n x 6`: `[d; phi]` at `about` -> displacements of the nodes, row after row.
#[must_use]
pub fn spider(places: &[Vector3<f64>], about: &Vector3<f64>) -> DMatrix<f64> {
    let mut map = DMatrix::zeros(3 * places.len(), 6);
    for (n, p) in places.iter().enumerate() {
        map.fixed_view_mut::<3, 3>(3 * n, 0).fill_with_identity();
        map.fixed_view_mut::<3, 3>(3 * n, 3)
            .copy_from(&-hat(&(p - about)));
    }
    map
}

/// Rank of the rigid motions of nodes at these places (m).
#[must_use]
pub fn rigid_rank(places: &[Vector3<f64>]) -> RigidRank {
    let count = places.len().max(1);
    #[allow(clippy::cast_precision_loss)]
    let share = 1.0 / count as f64;
    let centre: Vector3<f64> = places.iter().sum::<Vector3<f64>>() * share;
    let size = (places
        .iter()
        .map(|p| (p - centre).norm_squared())
        .sum::<f64>()
        * share)
        .sqrt();
    // Nodes at one place have no size; any will do, for their rotations are unknown in all.
    let reach = places.iter().map(|p| p.norm()).fold(0.0, larger);
    let unit = if size > 1e-9 * reach { size } else { 0.0 };
    let mut map = spider(places, &centre);
    for j in 3..6 {
        map.column_mut(j)
            .scale_mut(if unit > 0.0 { 1.0 / unit } else { 0.0 });
    }
    let gram: Matrix6<f64> = {
        let g = map.transpose() * &map * share;
        Matrix6::from_fn(|i, j| g[(i, j)])
    };
    let eigen = gram.symmetric_eigen();
    let mut values: Vec<(f64, usize)> = (0..6)
        .map(|i| (eigen.eigenvalues[i].max(0.0).sqrt(), i))
        .collect();
    values.sort_by(|a, b| b.0.total_cmp(&a.0));
    let largest = values[0].0;
    let rank = if places.is_empty() {
        0
    } else {
        values.iter().filter(|v| v.0 > RANK_TO * largest).count()
    };
    let words = match rank {
        6 => String::new(),
        5 => {
            let v = eigen.eigenvectors.column(values[5].1);
            format!(
                "the nodes lie on one line, so the rotation about it (direction {:.3}, {:.3}, {:.3}) is unknown",
                v[3], v[4], v[5]
            )
        }
        0 => "there are no nodes".to_owned(),
        3 => "all nodes lie at one place, so no rotation is known".to_owned(),
        _ => {
            let v = eigen.eigenvectors.column(values[5].1);
            format!(
                "{} of 6 motions are unknown, first {}",
                6 - rank,
                DIRECTIONS[v.iamax()]
            )
        }
    };
    RigidRank {
        rank,
        condition: if rank == 6 {
            largest / values[5].0
        } else {
            f64::INFINITY
        },
        singular_values: values.into_iter().map(|v| v.0).collect(),
        size,
        words,
    }
}

/// Fits a rigid motion at `about` (m) to displacements (m) of nodes at `places` (m).
///
/// # Errors
///
/// The rank, where the places leave a motion unknown.
pub fn rigid_fit(
    places: &[Vector3<f64>],
    displacements: &[Vector3<f64>],
    about: &Vector3<f64>,
) -> Result<RigidFit, RigidRank> {
    let rank = rigid_rank(places);
    let count = places.len().min(displacements.len());
    if rank.rank < 6 || count < 3 {
        return Err(rank);
    }
    let map = spider(&places[..count], about);
    let moved = DVector::from_iterator(3 * count, displacements[..count].iter().flatten().copied());
    // Rotations in units of the interface's size and the point at its middle keep the normal
    // equations as good as the places are; the factor to `about` is exact.
    #[allow(clippy::cast_precision_loss)]
    let centre: Vector3<f64> = places[..count].iter().sum::<Vector3<f64>>() / count as f64;
    let mut own = spider(&places[..count], &centre);
    for j in 3..6 {
        own.column_mut(j).scale_mut(1.0 / rank.size);
    }
    let gram = {
        let g = own.transpose() * &own;
        Matrix6::from_fn(|i, j| g[(i, j)])
    };
    let Some(inverse) = gram.try_inverse() else {
        return Err(rank);
    };
    let right = own.transpose() * &moved;
    let fitted = inverse * Vector6::from_fn(|i, _| right[i]);
    // Twist at the centre in own units -> twist at `about`.
    let mut back = kinetostat::spatial::shift_matrix(&(about - centre));
    for j in 3..6 {
        back.column_mut(j).scale_mut(1.0 / rank.size);
    }
    let motion = back * fitted;
    let left = &moved - &map * DVector::from_column_slice(motion.as_slice());
    let freedom = 3 * count - 6;
    #[allow(clippy::cast_precision_loss)]
    let variance = left.norm_squared() / freedom as f64;
    let largest = (0..count)
        .map(|n| (left.fixed_rows::<3>(3 * n).norm(), n))
        .fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
    let whole = moved.norm();
    Ok(RigidFit {
        motion,
        covariance: back * inverse * back.transpose() * variance,
        deviation: variance.sqrt(),
        largest,
        not_rigid: if whole > 0.0 {
            left.norm() / whole
        } else {
            0.0
        },
    })
}

/// Inverse after balancing by the diagonal, so that metres and radians do not decide what is singular.
pub(crate) fn invert(c: &Matrix6<f64>) -> Option<Matrix6<f64>> {
    if (0..6).any(|i| c[(i, i)] <= 0.0) {
        return None;
    }
    let scale = Matrix6::from_diagonal(&c.diagonal().map(|d| 1.0 / d.sqrt()));
    let scaled = scale * c * scale;
    let singular = kinetostat::linalg::SingularValues::of(&scaled);
    if singular.least() < 1e-12 * singular.largest() {
        return None;
    }
    Some(scale * scaled.try_inverse()? * scale)
}

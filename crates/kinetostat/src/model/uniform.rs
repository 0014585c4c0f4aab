//! Dividing a uniform beam that is given by its stiffness matrix.
//!
//! With the compliance `S` per length (strains per force and moment), the compliance of a beam of
//! length `L` about its middle is `C = L S + L^3/12 X S_rr X^T`: `S_rr` is the part of rotations, `X`
//! the arm of 1 m along x, and the terms linear in the arm vanish by symmetry. So `S` follows from
//! `C`, and a segment is the same formula with its own length; the segments together have exactly the
//! matrix that was given. Where `S` would not be a compliance, or `C` couples lateral motion with
//! bending (the halves differ), the matrix does not belong to a uniform beam.

use nalgebra::Matrix6;

/// Motions at a distance `length / 2` before the end, x along the link, per motions of the end.
pub(crate) fn to_middle(length: f64) -> Matrix6<f64> {
    let mut rates = Matrix6::identity();
    rates[(1, 5)] = -0.5 * length;
    rates[(2, 4)] = 0.5 * length;
    rates
}

/// A stiffness in the motions at a place, in the motions at a place `length / 2` farther out.
pub(crate) fn moved(stiffness: &Matrix6<f64>, length: f64) -> Matrix6<f64> {
    let rates = to_middle(length);
    rates.transpose() * stiffness * rates
}

fn is_positive(m: &Matrix6<f64>) -> bool {
    m.cholesky().is_some()
}

/// Compliance of a segment of length `h` about its middle.
pub(crate) fn segment_compliance(per_length: &Matrix6<f64>, h: f64) -> Matrix6<f64> {
    per_length * h + bending_part(per_length) * (h.powi(3) / 12.0)
}

/// `X S_rr X^T` in the translations: what rotations do at an arm of 1 m along x.
fn bending_part(per_length: &Matrix6<f64>) -> Matrix6<f64> {
    let mut part = Matrix6::zeros();
    // y moves by rz, z by -ry.
    part[(1, 1)] = per_length[(5, 5)];
    part[(2, 2)] = per_length[(4, 4)];
    part[(1, 2)] = -per_length[(5, 4)];
    part[(2, 1)] = -per_length[(4, 5)];
    part
}

/// Reason why a link has no stiffness of one segment.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NoSegment {
    #[error("its stiffness matrix is not positive definite")]
    Indefinite,
    #[error("{NO_BEAM}: it bends more in one half than in the other; take one segment")]
    Uneven,
    #[error(
        "{NO_BEAM}: its tip moves less under a force than its bending alone would make it; take one segment"
    )]
    StifferThanItsBending,
    #[error("its matrix leaves no shear strain, which a constant strain needs")]
    NoShear,
    #[error("the matrix of a segment is not positive definite")]
    IndefiniteSegment,
    #[error("{0}")]
    Section(#[from] crate::error::Error),
}

const NO_BEAM: &str =
    "only a uniform beam can be divided into segments, and its matrix is not that of one";

/// Compliance per length (strains per force and moment) of the uniform beam with a given stiffness
/// at its end.
pub(crate) fn compliance_per_length(
    end: &Matrix6<f64>,
    length: f64,
) -> Result<Matrix6<f64>, NoSegment> {
    const BEAM: f64 = 1e-6;
    let compliance = end
        .try_inverse()
        .filter(is_positive)
        .ok_or(NoSegment::Indefinite)?;
    let rates = to_middle(length);
    let middle = rates * compliance * rates.transpose();
    let size = |i: usize| middle[(i, i)].sqrt();
    for (lateral, angle) in [(1, 4), (1, 5), (2, 4), (2, 5)] {
        if middle[(lateral, angle)].abs() > BEAM * size(lateral) * size(angle) {
            return Err(NoSegment::Uneven);
        }
    }
    let mut per_length = middle / length;
    per_length -= bending_part(&per_length) * (length * length / 12.0);
    let scaled = Matrix6::from_fn(|i, j| per_length[(i, j)] * length / (size(i) * size(j)));
    if scaled.symmetric_eigenvalues().min() < -BEAM {
        return Err(NoSegment::StifferThanItsBending);
    }
    Ok(per_length)
}

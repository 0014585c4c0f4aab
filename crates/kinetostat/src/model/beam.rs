//! Stiffness of a link from its section, an Euler-Bernoulli cantilever [R 3.26], and division of a uniform beam into segments.
//!
//! Print swaps `I_y` and `I_z` in the last two diagonal entries; the correct assignment is used
//! here (errata of 3.26): the printed matrix can be indefinite.

use nalgebra::Matrix6;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::{Error, Place, Result, Whole};
use crate::model::limits::positive;

/// Section and material of a straight prismatic link along its local x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct BeamSection {
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Shear modulus, Pa.
    pub shear_modulus: f64,
    /// Area, m^2.
    pub area: f64,
    /// Second moment of area for bending that moves the tip along z (about y), m^4.
    pub second_moment_y: f64,
    /// Second moment of area for bending that moves the tip along y (about z), m^4.
    pub second_moment_z: f64,
    /// Torsion constant, m^4.
    pub torsion_constant: f64,
}

impl BeamSection {
    /// Round tube; `inner_diameter = 0` is a solid bar. Diameters in m, moduli in Pa.
    #[must_use]
    pub fn tube(youngs_modulus: f64, shear_modulus: f64, outer: f64, inner: f64) -> Self {
        let second_moment = std::f64::consts::PI / 64.0 * (outer.powi(4) - inner.powi(4));
        Self {
            youngs_modulus,
            shear_modulus,
            area: std::f64::consts::PI / 4.0 * (outer.powi(2) - inner.powi(2)),
            second_moment_y: second_moment,
            second_moment_z: second_moment,
            torsion_constant: 2.0 * second_moment,
        }
    }

    /// Stiffness at the free end of a cantilever of this section, 6 x 6 (N/m, N/rad, N m/m,
    /// N m/rad), axes of the link: x along it, root clamped.
    ///
    /// ```
    /// let bar = kinetostat::BeamSection::tube(2.1e11, 8.0e10, 0.04, 0.0);
    /// let k = bar.cantilever(0.5)?;
    /// let bending = 3.0 * 2.1e11 * bar.second_moment_z / 0.5_f64.powi(3);
    /// let compliance = k.try_inverse().ok_or("singular")?;
    /// assert!((1.0 / compliance[(1, 1)] / bending - 1.0).abs() < 1e-12); // P L^3 / 3 E I
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A length, a modulus or a value of the section that is not positive and finite (a tube inside out
    /// has negative second moments).
    pub fn cantilever(&self, length: f64) -> Result<Matrix6<f64>> {
        self.check(length)?;
        Ok(self.rigid_root(length))
    }

    /// Refuses sections and lengths that no beam has.
    fn check(&self, length: f64) -> Result<()> {
        let inside_out = self.area < 0.0 && self.second_moment_y < 0.0;
        if inside_out {
            let reason = format!(
                "its area is {} m^2, a positive number is needed: the inner diameter is larger than the outer one",
                self.area
            );
            return Err(Error::model(Place::of(Whole::Section), reason));
        }
        for (what, value) in [
            ("length (m)", length),
            ("Young's modulus (Pa)", self.youngs_modulus),
            ("shear modulus (Pa)", self.shear_modulus),
            ("area (m^2)", self.area),
            ("second moment about y (m^4)", self.second_moment_y),
            ("second moment about z (m^4)", self.second_moment_z),
            ("torsion constant (m^4)", self.torsion_constant),
        ] {
            positive(&Place::of(Whole::Section), what, value)?;
        }
        Ok(())
    }

    fn rigid_root(&self, length: f64) -> Matrix6<f64> {
        let in_y = self.youngs_modulus * self.second_moment_z;
        let in_z = self.youngs_modulus * self.second_moment_y;
        let mut k = Matrix6::zeros();
        k[(0, 0)] = self.youngs_modulus * self.area / length;
        k[(1, 1)] = 12.0 * in_y / length.powi(3);
        k[(2, 2)] = 12.0 * in_z / length.powi(3);
        k[(3, 3)] = self.shear_modulus * self.torsion_constant / length;
        k[(4, 4)] = 4.0 * in_z / length;
        k[(5, 5)] = 4.0 * in_y / length;
        k[(1, 5)] = -6.0 * in_y / length.powi(2);
        k[(5, 1)] = k[(1, 5)];
        k[(2, 4)] = 6.0 * in_z / length.powi(2);
        k[(4, 2)] = k[(2, 4)];
        k
    }
}

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
///
/// With the compliance `S` per length (strains per force and moment), the compliance of a beam of
/// length `L` about its middle is `C = L S + L^3/12 X S_rr X^T`: `S_rr` is the part of rotations, `X`
/// the arm of 1 m along x, and the terms linear in the arm vanish by symmetry. So `S` follows from
/// `C`, and a segment is the same formula with its own length; the segments together have exactly the
/// matrix that was given. Where `S` would not be a compliance, or `C` couples lateral motion with
/// bending (the halves differ), the matrix does not belong to a uniform beam.
pub(crate) fn compliance_per_length(
    end: &Matrix6<f64>,
    length: f64,
) -> std::result::Result<Matrix6<f64>, NoSegment> {
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

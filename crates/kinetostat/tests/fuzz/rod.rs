//! The rod of closed forms.

use kinetostat::BeamSection;

/// Section of a rod that bends with 1 N m2 and stretches with `axial`, N.
pub fn slender(axial: f64) -> BeamSection {
    BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: axial,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 0.8,
    }
}

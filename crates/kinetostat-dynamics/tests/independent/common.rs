//! Section and helpers of several tests.

use kinetostat::BeamSection;

/// Section S of the reference values.
pub fn section() -> BeamSection {
    BeamSection {
        youngs_modulus: 2.1e11,
        shear_modulus: 8e10,
        area: 6e-4,
        second_moment_y: 3e-8,
        second_moment_z: 7e-8,
        torsion_constant: 9e-8,
    }
}

pub const DENSITY: f64 = 7850.0;

//! Sections, chains and helpers of several tests.

use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use nalgebra::{DMatrix, Vector3};

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

/// Equilibrium of a chain and its linear dynamics.
pub fn about(problem: &ChainProblem<'_>, held: &Held) -> LinearDynamics {
    let at = solve_chain(problem, &Settings::default()).unwrap();
    LinearDynamics::of_chain(problem, &at.coordinates, &at.wrench, held).unwrap()
}

/// A beam of segments with mass that only bends in the plane x-y and stretches: other coordinates are held by springs
/// worlds stiffer would change them, so all six stay, and modes are identified by their shapes.
pub fn plane_frequencies(dynamics: &LinearDynamics, place: &str) -> Vec<f64> {
    let point = dynamics.place(place).unwrap();
    let modes = dynamics.modes().unwrap();
    let mut found = Vec::new();
    for mode in &modes.modes {
        let motion = dynamics.motions(point) * &mode.shape;
        let (across, other) = (
            motion[1].abs() + motion[5].abs(),
            motion[2].abs() + motion[4].abs() + motion[3].abs(),
        );
        if across > 1e3 * other && across > motion[0].abs() {
            found.push(mode.frequency_hz());
        }
    }
    found
}

pub fn relative(found: f64, expected: f64) -> f64 {
    found / expected - 1.0
}

/// Largest difference of two matrices in units of the geometric mean of the diagonal of `size`.
pub fn apart(found: &DMatrix<f64>, expected: &DMatrix<f64>, size: &DMatrix<f64>) -> f64 {
    let mut worst = kinetostat_testing::Worst::new();
    for i in 0..found.nrows() {
        for j in 0..found.ncols() {
            worst.add(
                (found[(i, j)] - expected[(i, j)]) / (size[(i, i)] * size[(j, j)]).abs().sqrt(),
            );
        }
    }
    worst.of(found.len())
}

/// Rows of numbers as they are printed.
pub fn rows(text: &str) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = text
        .trim()
        .lines()
        .map(|line| {
            line.split_whitespace()
                .map(|x| x.parse().unwrap())
                .collect()
        })
        .collect();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

pub fn thin_link(length: f64, segments: usize, stretch: f64) -> LinkSpec {
    // Area and density together keep the mass.
    let mut own = section();
    let mass = LinkMass::of_section(&own, DENSITY).thin();
    own.area *= stretch;
    LinkSpec::beam(own, length)
        .segments(segments)
        .with_mass(mass)
}

pub fn down() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, -9.81)
}

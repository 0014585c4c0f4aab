//! Torques and tangents of curved spring laws are derivatives of their energy.

use kinetostat::internal::spring_response;
use kinetostat::{
    BeamSection,
    model::{BowingLaw, LogarithmLaw, SpringBlock, SpringLaw},
};
use kinetostat_testing::LargestEntry;
use nalgebra::Matrix6;

#[test]
fn torque_and_tangent_are_derivatives_of_the_energy() {
    let section = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 0.4,
        area: 5.0,
        second_moment_y: 0.3,
        second_moment_z: 0.7,
        torsion_constant: 0.5,
    };
    // Every coupling that a matrix from finite elements may have.
    let matrix = section.cantilever(0.8).unwrap()
        + Matrix6::from_fn(|i, j| 0.02 * ((1 + i + j + i * j) as f64).sin());
    let laws = [
        SpringLaw::Bowing(Box::new(BowingLaw {
            matrix,
            length: 0.8,
        })),
        SpringLaw::Logarithm(Box::new(LogarithmLaw {
            matrix,
            length: 0.0,
        })),
        SpringLaw::Logarithm(Box::new(LogarithmLaw {
            matrix,
            length: 0.8,
        })),
    ];
    for law in laws {
        let block = SpringBlock {
            name: "s".into(),
            first: 0,
            rest: vec![0.01, -0.02, 0.03, 0.02, -0.01, 0.04],
            law,
            segment: None,
        };
        for x in [
            [0.1, -0.3, 0.2, 0.4, -0.6, 0.5],
            [-0.2, 0.5, 0.1, -1.0, 1.2, 0.9],
            [0.01, -0.02, 0.03, 0.02, -0.01, 0.04],
        ] {
            let (_, torque, tangent) = spring_response(&block, &x);
            assert!((&tangent - tangent.transpose()).largest_entry() < 1e-14);
            for k in 0..6 {
                let at = |s: f64| {
                    let mut moved = x;
                    moved[k] += s * 1e-3;
                    spring_response(&block, &moved)
                };
                let [a, b, c, d] = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
                let slope = (8.0 * (a.0 - b.0) - (c.0 - d.0)) / 12e-3;
                assert!(
                    (slope - torque[k]).abs() < 1e-9,
                    "{k}: {slope} {}",
                    torque[k]
                );
                for i in 0..6 {
                    let slope = (8.0 * (a.1[i] - b.1[i]) - (c.1[i] - d.1[i])) / 12e-3;
                    assert!((slope - tangent[(i, k)]).abs() < 1e-9, "{i} {k}");
                }
            }
        }
        let (energy, torque, tangent) =
            spring_response(&block, &[0.01, -0.02, 0.03, 0.02, -0.01, 0.04]);
        assert!(energy == 0.0 && torque.iter().all(|t| t.abs() < 1e-15));
        assert!((tangent - block.stiffness_at(&[])).largest_entry() < 1e-14);
    }
}

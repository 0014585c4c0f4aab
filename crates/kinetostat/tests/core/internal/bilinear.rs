//! The bilinear law: torque, tangent and energy belong together.

use kinetostat::internal::{Forward, SingleLaw};
use kinetostat::model::BilinearLaw;

const LAWS: [BilinearLaw; 2] = [
    BilinearLaw {
        stiffness: 2e5,
        beyond: 6e5,
        knee: 1e-3,
    },
    BilinearLaw {
        stiffness: 3e5,
        beyond: 1e5,
        knee: 2e-3,
    },
];

#[test]
fn torque_is_the_derivative_of_the_energy_and_the_tangent_that_of_the_torque() {
    for law in LAWS {
        for x in [-4e-3, -1.5e-3, 0.0, 0.4e-3, 0.9e-3, 2.5e-3] {
            let (h, [tangent]) = (1e-7, law.torque(Forward::variable(x, 0)).rate);
            let work = (law.energy(x + h) - law.energy(x - h)) / (2.0 * h);
            assert!(
                (work - law.torque(x)).abs() < 1e-4,
                "{work} {}",
                law.torque(x)
            );
            let slope = (law.torque(x + h) - law.torque(x - h)) / (2.0 * h);
            assert!((slope - tangent).abs() < 1e-3, "{slope} {tangent}");
            assert!((law.deflection(law.torque(x)) - x).abs() < 1e-15);
        }
    }
}

#[test]
fn the_torque_is_continuous_at_the_knee_and_odd() {
    for law in LAWS {
        let at = law.stiffness * law.knee;
        for side in [1.0 - 1e-12, 1.0, 1.0 + 1e-12] {
            assert!((law.torque(side * law.knee) - at).abs() < 1e-8 * at);
            assert_eq!(law.torque(-side * law.knee), -law.torque(side * law.knee));
        }
        assert!((law.energy(law.knee) - 0.5 * at * law.knee).abs() < 1e-12);
    }
}

//! First data rows of the reference problems P1 and P2.

use crate::regressors::{Arm, displacement, markers, tool_point, tracker_sigma};
use crate::support::Random;
use nalgebra::Vector3;

fn close(found: &[f64], expected: &[f64]) {
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= 1e-9 * e.abs(), "{f:e} instead of {e:e}");
    }
}

#[test]
fn p1_first_posture() {
    let arm = Arm::h6();
    let mut random = Random::new(11);
    let q = arm.draw(&mut random);
    let force = random.within(-2000.0, 2000.0);
    close(
        &q,
        &[
            -0.9621421088,
            -0.4977012623,
            0.4486604689,
            0.02738021238,
            -1.285568317,
            0.3082044699,
        ],
    );
    close(force.as_slice(), &[-1597.942084, 1119.928182, -638.1121946]);
    let posture = arm.at(&q);
    let regressor = posture.regressor(posture.point(tool_point()), force);
    let d = displacement(&regressor, &arm.compliances);
    close(
        &d.as_slice()[..3],
        &[-1.780226119e-3, 1.484242967e-3, 1.007066861e-3],
    );
}

#[test]
fn p2_first_row() {
    let arm = Arm::h6();
    let mut random = Random::new(12);
    let postures: Vec<(Vec<f64>, Vector3<f64>)> = (0..20)
        .map(|_| (arm.draw(&mut random), random.within(-2000.0, 2000.0)))
        .collect();
    let (q, force) = &postures[0];
    let posture = arm.at(q);
    let regressor = posture.marker_regressor(tool_point(), *force, &markers());
    let d = displacement(&regressor, &arm.compliances);
    let sigma = tracker_sigma(posture.point(markers()[0]));
    let measured: Vec<f64> = (0..3).map(|i| d[i] + sigma * random.normal()).collect();
    close(
        &measured,
        &[-2.633280373e-3, 3.933773380e-3, -2.270460842e-3],
    );
}

//! Problems shared by the tests.

use crate::regressors::{Arm, markers, tool_point};
use crate::support::Random;
use nalgebra::{DMatrix, Vector3};

/// Position rows of the three-joint arm at (0, q2, q3) in degrees, in parameters relative to their nominal values.
pub fn three_r_rows(q2: f64, q3: f64, force: Vector3<f64>) -> DMatrix<f64> {
    let arm = Arm::three_r();
    let posture = arm.at(&[0.0, q2.to_radians(), q3.to_radians()]);
    let mut rows = posture
        .regressor(posture.flange, force)
        .rows(0, 3)
        .into_owned();
    for (mut column, c) in rows.column_iter_mut().zip(&arm.compliances) {
        column *= *c;
    }
    rows
}

/// Matrix `L` of the test pose of the three-joint arm.
pub fn three_r_test_pose() -> DMatrix<f64> {
    let a = three_r_rows(40.0, 60.0, Vector3::new(-600.0, 800.0, -1500.0));
    a.tr_mul(&a)
}

/// Reference problem P9: 20 random postures.
pub fn p9() -> Vec<DMatrix<f64>> {
    let mut random = Random::new(71);
    (0..20)
        .map(|_| {
            let (q2, q3) = (random.between(-60.0, 60.0), random.between(-70.0, 80.0));
            three_r_rows(q2, q3, random.within(-1000.0, 1000.0))
        })
        .collect()
}

/// Angles q2 and q3 in degrees and axis of the force of a posture of the grid.
pub type GridPosture = (i32, i32, char);

/// Reference problem P9b: a grid of postures with a force along x, y or z.
pub fn p9b() -> (Vec<DMatrix<f64>>, Vec<GridPosture>) {
    let mut names = Vec::new();
    let mut rows = Vec::new();
    for q2 in (-60..=60).step_by(10) {
        for q3 in (-70..=80).step_by(10) {
            for (axis, direction) in
                ['x', 'y', 'z']
                    .iter()
                    .zip([Vector3::x(), Vector3::y(), Vector3::z()])
            {
                names.push((q2, q3, *axis));
                rows.push(three_r_rows(
                    f64::from(q2),
                    f64::from(q3),
                    1000.0 * direction,
                ));
            }
        }
    }
    (rows, names)
}

/// Reference problem P10: 300 postures of H6 with a weight and three markers, and the matrix `L` of `poses` test poses.
/// Parameters are the compliances 2 to 6, since a weight does not load the vertical axis 1.
pub fn p10(poses: usize) -> (Vec<DMatrix<f64>>, DMatrix<f64>) {
    let arm = Arm::h6();
    let mut random = Random::new(72);
    let weight = Vector3::new(0.0, 0.0, -2500.0);
    let candidates = (0..300)
        .map(|_| {
            let posture = arm.at(&arm.draw(&mut random));
            let rows = posture.marker_regressor(tool_point(), weight, &markers());
            rows.columns(1, 5).into_owned()
        })
        .collect();
    let force = Vector3::new(1000.0, -800.0, -1500.0);
    let mut l = DMatrix::zeros(5, 5);
    for _ in 0..poses {
        let posture = arm.at(&arm.draw(&mut random));
        let regressor = posture.regressor(posture.point(tool_point()), force);
        let rows = regressor.view((0, 1), (3, 5));
        l += rows.tr_mul(&rows) / poses as f64;
    }
    (candidates, l)
}

/// Candidates of independent uniform entries.
pub fn random_candidates(
    seed: u64,
    count: usize,
    rows: usize,
    columns: usize,
) -> Vec<DMatrix<f64>> {
    let mut random = Random::new(seed);
    let mut entry = |_: usize, _: usize| random.normal();
    (0..count)
        .map(|_| DMatrix::from_fn(rows, columns, &mut entry))
        .collect()
}

//! The strains of the logarithmic law against rotations.

use kinetostat::internal::CurvedLaw;
use kinetostat::model::LogarithmLaw;
use nalgebra::{Matrix6, Vector3, Vector6};

#[test]
fn the_logarithm_is_that_of_rotations() {
    let d = Vector6::new(0.1, -0.2, 0.3, 0.9, -0.7, 1.1);
    let (matrix, length) = (Matrix6::identity(), 0.0);
    let found = LogarithmLaw { matrix, length }.strain(&d.into());
    let axis = |k: usize| {
        nalgebra::UnitQuaternion::from_scaled_axis(Vector3::from_fn(|i, _| {
            if i == k { d[3 + k] } else { 0.0 }
        }))
    };
    let turn = axis(0) * axis(1) * axis(2);
    let w = turn.scaled_axis();
    for k in 0..3 {
        assert!((found[3 + k] - w[k]).abs() < 1e-14);
    }
    // exp back: p = V(w) rho.
    let rho = Vector3::from_fn(|i, _| found[i]);
    let t = w.norm();
    let p = rho
        + w.cross(&rho) * ((1.0 - t.cos()) / (t * t))
        + w.cross(&w.cross(&rho)) * ((t - t.sin()) / t.powi(3));
    assert!((p - Vector3::new(0.1, -0.2, 0.3)).norm() < 1e-14);
    for length in [0.0, 0.7] {
        let matrix = Matrix6::identity();
        let back = LogarithmLaw { matrix, length }.follow(&d, &Vector6::zeros());
        assert!((back - d).norm() < 1e-14, "{back}");
    }
}

//! Gravity compensator of arm H6: reference value P6.

use kinetostat_identification::{Identifiability, Knowledge, PostureRows, Start, least_squares};
use kinetostat_testing::largest_size;
use nalgebra::{DMatrix, DVector, Vector3};

use crate::regressors::{Arm, markers, tool_point};
use crate::support::{H6, Random, angles, worst};

/// Levers (m), angle between them in the zero posture (rad) and free length (m) of the compensator.
const A: f64 = 0.6969238515792096;
const L: f64 = 0.18472;
const ALPHA: f64 = 0.17785653896089795;
const FREE_LENGTH: f64 = 0.458;
const DEVIATION: f64 = 10e-6;

/// Derivatives of the stiffness of joint 2 with its compensator by `K2`, `Kc` and `Kc s0` [theory: identification, section 7].
fn stiffness_slopes(q2: f64) -> Vector3<f64> {
    let (s, c) = (ALPHA + q2).sin_cos();
    let al = A * L;
    let length = (A * A + L * L + 2.0 * al * c).sqrt();
    let g2 = al / length * (c + al / length.powi(2) * s * s);
    Vector3::new(1.0, -al * c, g2)
}

#[test]
fn stiffness_and_preload_of_a_compensator_are_hardly_told_apart() -> anyhow::Result<()> {
    let arm = Arm::h6();
    let mut random = Random::new(41);
    let postures: Vec<Vec<f64>> = (0..24).map(|_| angles(&mut random)).collect();
    // Joints 1 and 3 to 6 by their compliances, then `K2`, `Kc` and `Kc s0`.
    let mut truth: Vec<f64> = H6
        .iter()
        .copied()
        .enumerate()
        .filter(|(j, _)| *j != 1)
        .map(|(_, c)| c)
        .collect();
    truth.extend([1.0 / H6[1], 4e6, 4e6 * FREE_LENGTH]);
    let truth = DVector::from_vec(truth);
    let regressors: Vec<DMatrix<f64>> = postures
        .iter()
        .map(|q| {
            arm.at(q)
                .marker_regressor(tool_point(), random.vector(2500.0), &markers())
        })
        .collect();
    // What is shown, and its derivatives.
    let shown = |q: &[f64], regressor: &DMatrix<f64>, at: &DVector<f64>| {
        let slopes = stiffness_slopes(q[1]);
        let stiffness = slopes.dot(&at.fixed_rows::<3>(5));
        let second = regressor.column(1) / stiffness;
        let others = regressor.select_columns(&[0, 2, 3, 4, 5]);
        let values = &others * at.rows(0, 5) + &second;
        let mut rows = others.resize_horizontally(8, 0.0);
        rows.columns_mut(5, 3)
            .copy_from(&(second * slopes.transpose() / -stiffness));
        (values, rows)
    };
    let pairs = || postures.iter().zip(&regressors);
    let read: Vec<DVector<f64>> = pairs()
        .map(|(q, own)| {
            shown(q, own, &truth)
                .0
                .map(|x| x + DEVIATION * random.normal())
        })
        .collect();
    let mut estimate = truth.clone();
    let start = Start {
        from: &truth,
        sizes: &truth,
        constraints: &[],
    };
    for steps in 0.. {
        let rows = pairs().zip(&read).map(|((q, own), read)| {
            let (values, rows) = shown(q, own, &estimate);
            let values = (read - values + &rows * &estimate) / DEVIATION;
            PostureRows {
                rows: rows / DEVIATION,
                values,
            }
        });
        let rows: Vec<PostureRows> = rows.collect();
        let fit = least_squares(&rows, &start, false)?;
        let change = (&fit.estimate - &estimate).component_div(&truth);
        let change = largest_size(change.iter().copied());
        anyhow::ensure!(steps < 50, "the fit does not settle");
        estimate = fit.estimate.clone();
        if change > 1e-9 {
            continue;
        }
        let wanted = [3.232434599e6, 5.121883583e6, 3.492668835e6];
        let deviations = fit.deviations();
        // The print is not quite at the minimum: its last digits are a millionth of a standard deviation off, ours those of lstsq of numpy.
        let found = [3.232434308e6, 5.121886596e6, 3.492673464e6];
        assert!(
            worst(&estimate.as_slice()[5..], &found) < 1e-9,
            "{estimate}"
        );
        for k in 0..3 {
            let off = (estimate[5 + k] - wanted[k]).abs() / deviations[5 + k];
            assert!(off < 1.5e-6, "{off:e}: {estimate}");
        }
        assert!(worst(&[fit.chi_squared()], &[198.7537279]) < 1e-6);
        let off = worst(&deviations.as_slice()[5..], &[2.705e5, 2.650e6, 4.170e6]);
        assert!(off < 5e-4, "{off:e}: {deviations}");
        let correlation = fit.normal_inverse[(6, 7)] / (deviations[6] * deviations[7]);
        assert!((correlation - 0.99853).abs() < 1e-5, "{correlation}");
        let known = Identifiability::of(&rows, &truth);
        let known = known.knowledge(&deviations.component_div(&truth));
        assert_eq!(known[6..], [Knowledge::Weak, Knowledge::Weak]);
        break;
    }
    Ok(())
}

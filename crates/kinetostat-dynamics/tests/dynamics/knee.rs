//! D2: the knee of the reference values, whose links bend by another law than the core's: its stretch is bowed by the
//! angles of `Rx Ry Rz` themselves. The law stands here; kinematics, mass and the loads' Hessian are the crates'.

use crate::common::*;
use kinetostat::model::{Kinematics, LinkConvention, LinkMass};
use kinetostat::spatial::pose_residual;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use nalgebra::{DMatrix, DVector, Matrix6, UnitQuaternion, Vector6, vector};

fn knee() -> Chain {
    let mass = LinkMass::of_section(&section(), DENSITY);
    let link = |length| {
        LinkSpec::beam(section(), length)
            .convention(LinkConvention::TranslationsFirst)
            .with_mass(mass)
    };
    Chain::builder("knee")
        .link_with("upper", &link(0.7))
        .passive("knee", MotionKind::Revolute, nalgebra::Vector3::z(), 0.5)
        .link_with("lower", &link(0.5))
        .build()
        .unwrap()
}

/// Torque and tangent of a link: `1/2 e^T K e`, `e = (u + b(v, rz) + b(w, -ry), v, w, rx, ry, rz)`.
fn law(k: &Matrix6<f64>, h: f64, x: &[f64]) -> (Vector6<f64>, Matrix6<f64>) {
    let x = Vector6::from_column_slice(x);
    // Second derivative of both bows.
    let mut bow = Matrix6::zeros();
    for (across, turn, sign) in [(1, 5, 1.0), (2, 4, -1.0)] {
        bow[(across, across)] = 1.2 / h;
        bow[(across, turn)] = -0.1 * sign;
        bow[(turn, across)] = -0.1 * sign;
        bow[(turn, turn)] = 2.0 * h / 15.0;
    }
    let mut rates = Matrix6::identity();
    rates.set_row(0, &(rates.row(0) + (bow * x).transpose()));
    let mut strain = x;
    strain[0] += 0.5 * x.dot(&(bow * x));
    let force = k * strain;
    (
        rates.transpose() * force,
        rates.transpose() * k * rates + bow * force[0],
    )
}

struct Found {
    x: Vec<f64>,
    wrench: Wrench,
    springs: DMatrix<f64>,
    jacobian: DMatrix<f64>,
}

/// Newton's iteration on `J^T F = tau(x)`, pose(x) = target.
fn equilibrium(chain: &Chain, target: &Pose) -> Found {
    let [upper, lower] = [0.7, 0.5].map(|l| section().cantilever(l).unwrap());
    let (mut x, mut wrench) = (chain.home_coordinates(), Wrench::zero());
    loop {
        let kinematics = Kinematics::new(chain, &Pose::identity(), &x, &[]);
        let j = kinematics.jacobian(chain.tip());
        let jacobian = DMatrix::from_fn(6, 13, |r, c| j[(r, c)]);
        let (mut springs, mut torque) = (DMatrix::zeros(13, 13), DVector::zeros(13));
        for (first, k, h) in [(0, &upper, 0.7), (7, &lower, 0.5)] {
            let (t, own) = law(k, h, &x[first..first + 6]);
            torque.rows_mut(first, 6).copy_from(&t);
            springs.view_mut((first, first), (6, 6)).copy_from(&own);
        }
        let hessian = kinematics.hessian(&[(chain.tip(), wrench)]);
        let mut a = DMatrix::zeros(19, 19);
        a.view_mut((0, 6), (6, 13)).copy_from(&jacobian);
        a.view_mut((6, 0), (13, 6)).copy_from(&jacobian.transpose());
        a.view_mut((6, 6), (13, 13))
            .copy_from(&(&hessian - &springs));
        let mut b = DVector::zeros(19);
        b.rows_mut(0, 6)
            .copy_from(&pose_residual(target, &kinematics.tip_pose()).0);
        let unbalanced = &torque - jacobian.transpose() * wrench.0;
        b.rows_mut(6, 13).copy_from(&unbalanced);
        let step = a.lu().solve(&b).unwrap();
        let size = step.rows(6, 13).norm();
        if size < 1e-14 {
            return Found {
                x,
                wrench,
                springs,
                jacobian,
            };
        }
        assert!(size.is_finite());
        for k in 0..6 {
            wrench.0[k] += step[k];
        }
        for k in 0..13 {
            x[k] += step[6 + k];
        }
    }
}

#[test]
fn knee_with_the_law_of_the_reference() {
    let chain = knee();
    let rest =
        kinetostat::model::unloaded_tip(&chain, &Pose::identity(), &chain.home_coordinates(), &[]);
    let turn = UnitQuaternion::from_scaled_axis(vector![1e-3, -2e-3, 0.0]);
    let place = rest.translation.vector + vector![-2e-4, 1e-3, 5e-4];
    let found = equilibrium(
        &chain,
        &Pose::from_parts(place.into(), turn * rest.rotation),
    );
    let x = [
        -0.0000012142,
        0.0006382176,
        -0.0000878007,
        0.0003392981,
        -0.0002211312,
        0.0013677259,
        0.4998710516,
        -0.0000006975,
        -0.0002064766,
        0.0004093573,
        -0.0002753406,
        -0.001877522,
        -0.0012387698,
    ];
    for (own, expected) in found.x.iter().zip(x) {
        assert!((own - expected).abs() < 1e-10, "{own} {expected}");
    }
    let w = [
        -153.76420173,
        81.88831024,
        -36.38413731,
        12.27296278,
        -30.59682193,
        -72.83469604,
    ];
    for (own, expected) in found.wrench.0.iter().zip(w) {
        assert!((own - expected).abs() < 1e-6, "{own} {expected}");
    }
    let problem = ChainProblem::new(&chain, EndCondition::wrench(found.wrench));
    let d = LinearDynamics::of_chain(&problem, &found.x, &found.wrench, &Held::nothing()).unwrap();
    let m = [
        3.454, 3.580542, 3.58000372, 0.04578392, 0.16656714, 0.2119615, 0.19652422, 0.785,
        0.87603309, 0.87527949, 0.00013083, 0.00562284, 0.00564378,
    ];
    for (i, expected) in m.iter().enumerate() {
        assert!(
            (d.mass()[(i, i)] - expected).abs() < 6e-9,
            "{i}: {} {expected}",
            d.mass()[(i, i)]
        );
    }
    // Take the core's law out of its tangent and put that of the reference in.
    let hessian = d.elastic() - d.tangent();
    let tangent = &found.springs - &hessian;
    held_frequencies(&found, d.mass(), &tangent);
    let first_block = |z: &DMatrix<f64>| {
        let mut a = DMatrix::zeros(19, 19);
        a.view_mut((0, 6), (6, 13)).copy_from(&found.jacobian);
        a.view_mut((6, 0), (13, 6))
            .copy_from(&found.jacobian.transpose());
        a.view_mut((6, 6), (13, 13)).copy_from(&(-z));
        a.try_inverse().unwrap().view((0, 0), (6, 6)).into_owned()
    };
    let k_c = rows(K_C);
    let w = std::f64::consts::TAU * 60.0;
    let (at_rest, moving) = (
        first_block(&tangent),
        first_block(&(&tangent - d.mass() * (w * w))),
    );
    println!(
        "{:e} {:e}",
        apart(&at_rest, &k_c, &k_c),
        apart(&moving, &rows(DYNAMIC), &rows(DYNAMIC))
    );
    // Eight digits are printed: half a unit of the last of 1929930.2 is 2.6e-8 of it, of 1144729.1 4.4e-8.
    assert!(apart(&at_rest, &k_c, &k_c) < 3e-8);
    assert!(apart(&moving, &rows(DYNAMIC), &rows(DYNAMIC)) < 5e-8);
}

/// Frequencies with the tip held, by a null space of the test's own. The moments on the tip make the tangent unsymmetric
/// before closures are met, and symmetric within them.
fn held_frequencies(found: &Found, mass: &DMatrix<f64>, tangent: &DMatrix<f64>) {
    let gram = found.jacobian.tr_mul(&found.jacobian).symmetric_eigen();
    let mut order: Vec<usize> = (0..13).collect();
    order.sort_by(|a, b| gram.eigenvalues[*a].total_cmp(&gram.eigenvalues[*b]));
    let free = gram.eigenvectors.select_columns(&order[..7]);
    let m = free.tr_mul(&(mass * &free));
    let k = free.tr_mul(&(tangent * &free));
    let asymmetry = (&k - k.transpose()).norm() / k.norm();
    assert!(asymmetry < 1e-12, "{asymmetry}");
    let l = m.cholesky().unwrap().l();
    let half = l.solve_lower_triangular(&k).unwrap().transpose();
    let whole = l.solve_lower_triangular(&half).unwrap();
    let mut squared: Vec<f64> = whole.symmetric_eigenvalues().iter().copied().collect();
    squared.sort_by(f64::total_cmp);
    let f = [
        89.6123038, 345.688224, 351.327176, 627.079997, 1119.03663, 1311.34645, 2419.56557,
    ];
    for (own, expected) in squared.iter().zip(f) {
        let own = own.sqrt() / std::f64::consts::TAU;
        assert!(relative(own, expected).abs() < 1e-7, "{own} {expected}");
    }
}

const K_C: &str = "1929930.2  232460.78  660.71841  -24.191969  -539.76836  361566.48
232460.78  128233.67  73.618929  49.703796  -70.79253  -434.76278
660.71841  73.618929  45933.687  -8262.6852  25543.92  129.11362
-24.191969  49.703796  -8262.6852  7412.4548  -4495.9268  -4.6003653
-539.76836  -70.79253  25543.92  -4423.0922  19473.036  -85.271449
361566.48  -434.76278  129.11362  -35.197187  -97.544411  86992.75";

const DYNAMIC: &str = "1144729.1  -197416.13  -61.820145  -94.116143  -453.06543  367281.73
-197416.13  -321060.85  138.38576  -109.49378  107.9198  19632.055
-61.820145  138.38576  -374080.61  40214.951  -43956.703  -24.222399
-94.116143  -109.49378  40214.951  438.41313  5222.5744  25.690718
-453.06543  107.9198  -43956.703  5295.4091  5726.1626  -124.10966
367281.73  19632.055  -24.222399  -4.9061039  -136.38262  85282.929";

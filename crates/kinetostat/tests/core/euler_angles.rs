//! The same chain with Euler angles, as the report writes it: `Psi = g^T F` has a symmetric Hessian,
//! but freezes `E^T m` instead of the moment. With `B = blkdiag(I, E)` and `D = d(B^T F)/dt` at
//! frozen `F`
//!
//! ```text
//! H_spatial = H_Euler + J_E^T D J_E,      K_spatial = B^-T (K_Euler - D) B^-1
//! ```
//!
//! (errata, chapter 5: 5.10 to 5.21). Everything on the Euler side is computed here by differences.

use crate::common::{RandomChain, Recipe, Rng, random_chain};
use crate::oracle::{scaled_solve, springs};
use kinetostat::{
    ChainProblem, EndCondition, Equilibrium, Pose, Settings, Twist, Wrench, model::Kinematics,
    solve_chain, spatial::moved,
};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6};

/// Position and angles `(a, b, c)` of `R = Rz(a) Ry(b) Rx(c)`.
fn euler(pose: &Pose) -> Vector6<f64> {
    let r = pose.rotation.to_rotation_matrix();
    let p = pose.translation.vector;
    let a = r[(1, 0)].atan2(r[(0, 0)]);
    let b = (-r[(2, 0)]).asin();
    let c = r[(2, 1)].atan2(r[(2, 2)]);
    Vector6::new(p.x, p.y, p.z, a, b, c)
}

fn pose_of(t: &Vector6<f64>) -> Pose {
    let turn = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
    let r = turn(Vector3::z_axis(), t[3])
        * turn(Vector3::y_axis(), t[4])
        * turn(Vector3::x_axis(), t[5]);
    Pose::from_parts(
        Vector3::new(t[0], t[1], t[2]).into(),
        UnitQuaternion::from_rotation_matrix(&r),
    )
}

/// `B`: rates of position and angles to the spatial twist.
fn rates(t: &Vector6<f64>) -> Matrix6<f64> {
    let z = Rotation3::from_axis_angle(&Vector3::z_axis(), t[3]);
    let y = Rotation3::from_axis_angle(&Vector3::y_axis(), t[4]);
    let e = Matrix3::from_columns(&[Vector3::z(), z * Vector3::y(), z * (y * Vector3::x())]);
    let mut b = Matrix6::identity();
    b.fixed_view_mut::<3, 3>(3, 3).copy_from(&e);
    b
}

/// Fourth-order central difference.
fn slope<T>(step: f64, at: impl Fn(f64) -> T) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    let near = at(step) - at(-step);
    let far = at(2.0 * step) - at(-2.0 * step);
    (near * 8.0 - far) * (1.0 / (12.0 * step))
}

/// `D = d(B^T F)/dt` at frozen `F`.
fn d_matrix(t: &Vector6<f64>, wrench: &Wrench) -> Matrix6<f64> {
    let mut d = Matrix6::zeros();
    for k in 0..6 {
        let column = slope(1e-3, |s| {
            let mut near = *t;
            near[k] += s;
            rates(&near).transpose() * wrench.0
        });
        d.set_column(k, &column);
    }
    d
}

/// What is compared, as shares of the largest entry.
pub struct Compared {
    /// `H_spatial - (H_Euler + J_E^T D J_E)`.
    pub hessian: f64,
    /// The same without `D`.
    pub hessian_without: f64,
    /// `K_spatial - B^-T (K_Euler - D) B^-1`, `K_Euler` from the bordered system with `H_Euler`.
    pub stiffness: f64,
    /// The same with `K_Euler` from wrenches solved again at neighbouring poses.
    pub solved_again: f64,
    /// The same without `D`, and its largest entry, N m/rad.
    pub stiffness_without: (f64, f64),
    /// `H_Euler - H_Euler^T` and `H_spatial - H_spatial^T`.
    pub asymmetry: (f64, f64),
    /// End moment, N m.
    pub moment: f64,
}

fn compare(r: &RandomChain, problem: &ChainProblem<'_>, e: &Equilibrium) -> Compared {
    let chain = problem.chain;
    let n = chain.coordinate_count();
    let at = |x: &[f64]| Kinematics::new(chain, &r.base, x, &r.commands);
    let here = at(&e.coordinates);
    let t = euler(&here.tip_pose());
    let b = rates(&t);
    let d = d_matrix(&t, &e.wrench);
    let generalised = b.transpose() * e.wrench.0;

    // Second derivatives of Psi = g(x)^T F_E, two Richardson steps from second-order differences.
    let psi = |x: &[f64]| generalised.dot(&(euler(&at(x).tip_pose()) - t));
    let mut h_euler = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            let mixed = |h: f64| {
                let sum: f64 = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
                    .into_iter()
                    .map(|(si, sj)| {
                        let mut x = e.coordinates.clone();
                        x[i] += si * h;
                        x[j] += sj * h;
                        si * sj * psi(&x)
                    })
                    .sum();
                sum / (4.0 * h * h)
            };
            let [one, two, four] = [4e-3, 8e-3, 16e-3].map(mixed);
            let (fine, coarse) = ((4.0 * one - two) / 3.0, (4.0 * two - four) / 3.0);
            h_euler[(i, j)] = (16.0 * fine - coarse) / 15.0;
            h_euler[(j, i)] = h_euler[(i, j)];
        }
    }
    let mut j_euler = DMatrix::zeros(6, n);
    for i in 0..n {
        let column = slope(1e-3, |s| {
            let mut x = e.coordinates.clone();
            x[i] += s;
            euler(&at(&x).tip_pose())
        });
        j_euler.set_column(i, &column);
    }

    let all = here.hessian(&[(chain.tip(), e.wrench)]);
    let h_spatial = all.view((0, 0), (n, n)).into_owned();
    let dense = DMatrix::from_fn(6, 6, |i, j| d[(i, j)]);
    let geometric = j_euler.transpose() * &dense * &j_euler;
    let size = h_spatial.largest_entry();

    // K_Euler from the bordered system of the report, with Euler angles.
    let (_, k, _) = springs(chain, &e.coordinates, &problem.posture);
    let mut bordered = DMatrix::zeros(6 + n, 6 + n);
    bordered.view_mut((0, 6), (6, n)).copy_from(&j_euler);
    bordered
        .view_mut((6, 0), (n, 6))
        .copy_from(&j_euler.transpose());
    bordered
        .view_mut((6, 6), (n, n))
        .copy_from(&(&h_euler - &k));
    let solved = scaled_solve(&bordered, &DMatrix::identity(6 + n, 6));
    let k_euler: Matrix6<f64> = solved.fixed_view::<6, 6>(0, 0).into_owned();

    // K_Euler from the wrenches that hold neighbouring poses.
    let mut again = Matrix6::zeros();
    for i in 0..6 {
        let column = slope(2e-4, |s| {
            let mut near = t;
            near[i] += s;
            let mut p = problem.clone();
            p.end = EndCondition::pose(pose_of(&near));
            p.posture.clone_from(&e.coordinates);
            let w = solve_chain(&p, &Settings::default()).unwrap().wrench;
            rates(&near).transpose() * w.0
        });
        again.set_column(i, &column);
    }
    let inverse = b.try_inverse().unwrap();
    let spatial = |k: &Matrix6<f64>| inverse.transpose() * k * inverse;
    let own = e.stiffness.cartesian.matrix;
    // Only the rotations know of D.
    let block = |m: Matrix6<f64>| m.fixed_view::<3, 3>(3, 3).largest_entry();
    let share = |found: &Matrix6<f64>| {
        let size = |r: usize| own.fixed_view::<3, 3>(r, r).largest_entry();
        let mut worst = Worst::new();
        for r in [0, 3] {
            for c in [0, 3] {
                let off = (found - own).fixed_view::<3, 3>(r, c).largest_entry();
                worst.add(off / (size(r) * size(c)).sqrt());
            }
        }
        worst.value()
    };
    let without = spatial(&k_euler);
    Compared {
        hessian: (&h_spatial - &h_euler - &geometric).largest_entry() / size,
        hessian_without: (&h_spatial - &h_euler).largest_entry() / size,
        stiffness: share(&spatial(&(k_euler - d))),
        solved_again: share(&spatial(&(again - d))),
        stiffness_without: (share(&without), block(without - own)),
        asymmetry: (
            (&h_euler - h_euler.transpose()).largest_entry() / size,
            (&h_spatial - h_spatial.transpose()).largest_entry() / size,
        ),
        moment: e.wrench.moment().norm(),
    }
}

/// Spatial chains under end moments, not near the angles' own singularity.
pub fn compared() -> Vec<Compared> {
    (0..40)
        .filter_map(|seed| {
            let mut rng = Rng(0xe01e + seed);
            let recipe = Recipe {
                stages: 2,
                passive: 2,
                ..Recipe::default()
            };
            let r = random_chain(&mut rng, &recipe);
            let span = Twist::new(rng.axis() * 0.03, rng.axis() * 0.08);
            let problem = r.problem(EndCondition::pose(moved(&r.tip(), &span)));
            if euler(&problem.end.pose)[4].cos() < 0.4 {
                return None;
            }
            let e = solve_chain(&problem, &Settings::default()).ok()?;
            let safe =
                e.stability.stable && e.stability.share_to_buckling.is_none_or(|mu| mu < 0.8);
            safe.then(|| compare(&r, &problem, &e))
        })
        .take(6)
        .collect()
}

#[test]
fn spatial_and_euler_versions_are_related_by_d() {
    let list = compared();
    assert!(list.len() >= 4, "{}", list.len());
    for c in list {
        println!(
            "moment {:.1} N m: H {:.1e} ({:.1e} without D), K {:.1e}, solved again {:.1e} ({:.1e}, {:.1} N m/rad without D), asymmetry {:.1e} and {:.1e}",
            c.moment,
            c.hessian,
            c.hessian_without,
            c.stiffness,
            c.solved_again,
            c.stiffness_without.0,
            c.stiffness_without.1,
            c.asymmetry.0,
            c.asymmetry.1
        );
        assert!(c.hessian < 1e-9 && c.stiffness < 1e-9 && c.solved_again < 1e-8);
        assert!(c.hessian_without > 1e-2);
        assert!(c.stiffness_without.0 > 1e-2);
        assert!(c.asymmetry.0 == 0.0 && c.asymmetry.1 > 1e-2);
    }
}

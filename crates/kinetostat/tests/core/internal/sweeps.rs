//! The linear algebra of sweeps against dense matrices and against differences, on random spatial chains. (The oracle
//! of the integration tests checks the same from outside; whole problems are in `sweeps_of_whole_chains`.)

use kinetostat::{
    internal::{
        Bordered, ChainMethod, END_SPRINGS, EndRows, Form, System, scaled_jacobian, scales_of,
    },
    model::Role,
    *,
};
use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, DVector, Vector3, vector};

/// In [-1, 1).
pub struct Rng(pub u64);

impl Rng {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        vector![self.next(), self.next(), self.next()] * size
    }
    pub fn wrench(&mut self, force: f64, moment: f64) -> Wrench {
        Wrench::new(self.vector(force), self.vector(moment))
    }
    pub fn pose(&mut self, reach: f64, angle: f64) -> Pose {
        Pose::new(self.vector(reach), self.vector(angle))
    }
}

/// Off-axis chain with links in segments, drives, full springs with preload, passive joints, nodes
/// and masses.
pub fn random(rng: &mut Rng, stages: usize, passive: usize, rest: f64) -> Chain {
    let bar = BeamSection::tube(2.1e11, 8.0e10, 0.03, 0.024);
    let mut builder = Chain::builder("random");
    for k in 0..stages {
        builder = builder.rigid(rng.pose(0.1, 0.8));
        let mut drive = ActuatorSpec::new(
            if k % 2 == 0 {
                MotionKind::Revolute
            } else {
                MotionKind::Prismatic
            },
            rng.vector(1.0).normalize(),
            if k % 2 == 0 { 6e4 } else { 3e6 },
        );
        drive.rest = rest * rng.next() * if k % 2 == 0 { 0.05 } else { 1e-3 };
        builder = builder.actuator(&format!("a{k}"), drive);
        builder = builder.link_with(
            &format!("l{k}"),
            &LinkSpec::beam(bar, 0.3 + 0.1 * rng.next()).segments(1 + k % 3),
        );
        builder = builder.node(&format!("n{k}"));
        if k % 2 == 1 {
            let root = nalgebra::Matrix6::from_fn(|_, _| 0.3 * rng.next());
            let unit = |i: usize| if i < 3 { 2e3 } else { 2e2 };
            let matrix = nalgebra::Matrix6::identity() + root * root.transpose();
            let matrix = nalgebra::Matrix6::from_fn(|i, j| matrix[(i, j)] * unit(i) * unit(j));
            let preload =
                std::array::from_fn(|i| rest * rng.next() * if i < 3 { 1e-3 } else { 0.02 });
            builder = builder.spring6(&format!("s{k}"), &matrix, preload);
            builder = builder.body(
                &format!("m{k}"),
                20.0 + 10.0 * rng.next(),
                rng.vector(0.1),
                nalgebra::Matrix3::identity(),
            );
        }
        if k < passive {
            builder = builder.passive(
                &format!("q{k}"),
                if k == 1 {
                    MotionKind::Prismatic
                } else {
                    MotionKind::Revolute
                },
                rng.vector(1.0).normalize(),
                0.0,
            );
        }
    }
    builder.rigid(rng.pose(0.1, 0.5)).build().expect("chain")
}

pub fn loads(rng: &mut Rng, chain: &Chain, moments: bool) -> Vec<Load> {
    let m = if moments { 40.0 } else { 0.0 };
    let nodes = chain.nodes().len();
    let node = |rng: &mut Rng| ((rng.next() + 1.0) * 0.5 * (nodes - 1) as f64) as usize;
    let anchor = |rng: &mut Rng| Anchor::Node {
        node: node(rng),
        point: rng.vector(0.1),
    };
    vec![
        Load::gravity(vector![0.0, 0.0, -9.81]),
        Load::dead(node(rng), rng.wrench(300.0, m)),
        Load::follower(node(rng), rng.wrench(100.0, m)),
        Load::point_force(node(rng), rng.vector(0.2), rng.vector(200.0)),
        Load::spring_between(anchor(rng), Anchor::Base(rng.vector(1.0)), 2e3, 0.5),
    ]
}

/// A dense system and one of stages at the same random state.
pub fn two(rng: &mut Rng, chain: &Chain, loads: &[Load], size: f64) -> (System, System, Vec<f64>) {
    let (posture, commands) = (chain.home_coordinates(), chain.home_commands());
    let base = Pose::new(vector![0.1, -0.2, 0.3], vector![0.4, -0.3, 0.2]);
    let scales = scales_of(chain, &posture);
    let x: Vec<f64> = chain
        .coordinates()
        .iter()
        .map(|c| match (c.role, c.kind) {
            (Role::Passive, _) => 0.2 * size * rng.next(),
            (_, MotionKind::Prismatic) => 1e-4 * size * rng.next(),
            (_, MotionKind::Revolute) => 1e-2 * size * rng.next(),
        })
        .collect();
    let wrench = rng.wrench(400.0, 60.0);
    let mut systems = [ChainMethod::Dense, ChainMethod::Sweep]
        .map(|method| System::of_chain(chain, &base, &posture, &commands, &scales, Some(method)));
    for (system, method) in systems
        .iter_mut()
        .zip([ChainMethod::Dense, ChainMethod::Sweep])
    {
        assert_eq!(system.method(), method);
        system.evaluate(chain, &base, &posture, &commands, loads, &x, &wrench, 1.0);
    }
    let [dense, swept] = systems;
    (dense, swept, scales)
}

/// `H - K` scaled in one form, dense.
fn reference(system: &System, scales: &[f64], form: Form) -> DMatrix<f64> {
    let n = system.spring_torque.len();
    let f = |i: usize| scales[6 + i];
    let mut geometric = DMatrix::zeros(n, n);
    for (first, change) in &system.spring_geometric {
        for i in 0..6 {
            for j in 0..6 {
                geometric[(first + i, first + j)] = change[(i, j)];
            }
        }
    }
    DMatrix::from_fn(n, n, |i, j| {
        let (h, k) = (&system.hessian, system.spring_tangent[(i, j)]);
        let value = match form {
            Form::Lagged => -k,
            Form::Material => geometric[(i, j)] - k,
            Form::Exact => h[(i, j)] - k,
            Form::Pencil(mu) => {
                let g = geometric[(i, j)];
                0.5 * (h[(i, j)] + h[(j, i)]) - g - mu * (k - g)
            }
        };
        value * f(i) * f(j)
    })
}

const FORMS: [Form; 5] = [
    Form::Lagged,
    Form::Material,
    Form::Exact,
    Form::Pencil(1.0),
    Form::Pencil(0.3),
];

#[test]
fn products_torques_and_energy_are_those_of_dense_matrices() {
    let mut rng = Rng(1);
    for case in 0..40 {
        let chain = random(&mut rng, 3 + case % 5, case % 4, 1.0);
        let loads = loads(&mut rng, &chain, case % 2 == 0);
        let (dense, swept, scales) = two(&mut rng, &chain, &loads, 1.0);
        let n = chain.coordinate_count();
        for i in 0..n {
            let size = dense.torque[i].abs().max(1.0);
            assert!((dense.torque[i] - swept.torque[i]).abs() < 1e-11 * size);
            assert_eq!(dense.spring_torque[i], swept.spring_torque[i]);
        }
        assert_eq!(dense.energy, swept.energy);
        let sweep = swept.sweep.as_ref().expect("stages");
        assert!(sweep.serial);
        for form in FORMS {
            let matrix = reference(&dense, &scales, form);
            let x: Vec<f64> = (0..n).map(|_| rng.next()).collect();
            let expected = &matrix * DVector::from_column_slice(&x);
            let mut found = vec![0.0; n];
            sweep.product(form, &x, &mut Vec::new(), &mut found);
            let off = (DVector::from_vec(found) - &expected).largest_entry();
            assert!(
                off < 1e-12 * matrix.largest_entry() * n as f64,
                "{case} {form:?} {off:.2e}"
            );
        }
    }
}

#[test]
fn the_product_is_the_derivative_of_the_residual() {
    let mut rng = Rng(2);
    let base = Pose::new(vector![0.1, -0.2, 0.3], vector![0.4, -0.3, 0.2]);
    for case in 0..10 {
        let chain = random(&mut rng, 4, case % 4, 1.0);
        let loads = loads(&mut rng, &chain, true);
        let (posture, commands) = (chain.home_coordinates(), chain.home_commands());
        let scales = scales_of(&chain, &posture);
        let n = chain.coordinate_count();
        let wrench = rng.wrench(400.0, 60.0);
        let mut system = System::of_chain(
            &chain,
            &base,
            &posture,
            &commands,
            &scales,
            Some(ChainMethod::Sweep),
        );
        let mut residual = |x: &[f64]| {
            system.evaluate(&chain, &base, &posture, &commands, &loads, x, &wrench, 1.0);
            let scaled = (0..n).map(|i| system.unbalanced(i) * scales[6 + i]);
            DVector::from_iterator(n, scaled)
        };
        let x: Vec<f64> = (0..n).map(|_| 1e-3 * rng.next()).collect();
        let along: Vec<f64> = (0..n).map(|_| rng.next()).collect();
        let at = |step: f64| -> Vec<f64> {
            (0..n)
                .map(|i| x[i] + step * along[i] * scales[6 + i])
                .collect()
        };
        let step = 2e-3;
        let slope = (8.0 * (residual(&at(step)) - residual(&at(-step)))
            - (residual(&at(2.0 * step)) - residual(&at(-2.0 * step))))
            / (12.0 * step);
        residual(&x);
        let mut exact = vec![0.0; n];
        let sweep = system.sweep.as_ref().expect("stages");
        sweep.product(Form::Exact, &along, &mut Vec::new(), &mut exact);
        let off = (DVector::from_vec(exact) - &slope).largest_entry();
        assert!(
            off < 1e-8 * slope.largest_entry(),
            "{case}: {off:.2e} of {:.2e}",
            slope.largest_entry()
        );
    }
}

#[test]
fn bordered_systems_are_solved_as_by_dense_matrices() {
    let mut rng = Rng(3);
    for case in 0..40 {
        let chain = random(&mut rng, 3 + case % 6, case % 5, 1.0);
        let loads = loads(&mut rng, &chain, case % 2 == 0);
        let (dense, swept, scales) = two(&mut rng, &chain, &loads, 1.0);
        let sweep = swept.sweep.as_ref().expect("stages");
        let n = chain.coordinate_count();
        let jacobian = scaled_jacobian(&dense, &scales);
        for form in FORMS {
            // Some directions held, the others under a given wrench.
            let held: Vec<bool> = (0..6).map(|k| case < 10 || (k + case) % 3 > 0).collect();
            let mut rows = EndRows {
                motion: nalgebra::Matrix6::zeros(),
                wrench: nalgebra::Matrix6::zeros(),
            };
            let mut a = DMatrix::zeros(6 + n, 6 + n);
            a.view_mut((6, 0), (n, 6)).copy_from(&jacobian.transpose());
            a.view_mut((6, 6), (n, n))
                .copy_from(&reference(&dense, &scales, form));
            for k in 0..6 {
                if held[k] {
                    rows.motion[(k, k)] = 1.0;
                    a.view_mut((k, 6), (1, n)).copy_from(&jacobian.row(k));
                } else {
                    rows.wrench[(k, k)] = 1.0;
                    a[(k, k)] = 1.0;
                }
            }
            let mut b = DVector::from_fn(6 + n, |_, _| rng.next());
            let right = b.fixed_rows::<6>(0).into_owned();
            let torque = b.as_slice()[6..].to_vec();
            let bordered =
                Bordered::new(sweep.as_ref(), form, rows, END_SPRINGS[0]).expect("pivots");
            let (wrench, x) = bordered.solve(&torque, &right).expect("solution");
            let lu = a.clone().full_piv_lu();
            assert!(lu.solve_mut(&mut b));
            let found = DVector::from_iterator(6 + n, wrench.iter().chain(&x).copied());
            let (off, size) = ((&found - &b).largest_entry(), b.largest_entry());
            assert!(
                off < 1e-9 * size,
                "{case} {form:?}: {off:.2e} of {size:.2e}"
            );
        }
    }
}

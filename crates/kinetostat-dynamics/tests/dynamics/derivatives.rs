//! Mass against kinetic energy by differences of poses, `K - H` against differences of the gradient: random chains with
//! coupled coordinates, distributed masses and loads off the axes.

use crate::common::*;
use kinetostat::model::{LinkConvention, LinkMass, check_tangents};
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, Matrix3, Vector3, vector};

/// Numbers between -1 and 1 that repeat.
struct Irregular(u64);

impl Irregular {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64) / ((1u64 << 52) as f64) - 1.0
    }
    fn vector(&mut self, size: f64) -> Vector3<f64> {
        vector![self.next(), self.next(), self.next()] * size
    }
}

fn chain(seed: u64, convention: LinkConvention) -> Chain {
    let mut r = Irregular(seed);
    let mass = LinkMass::of_section(&section(), DENSITY);
    let spec = LinkSpec::beam(section(), 0.6)
        .segments(2)
        .convention(convention)
        .with_mass(mass);
    let matrix = {
        let k = section().cantilever(0.4).unwrap();
        // Shear makes it softer across: a Timoshenko beam.
        let mut c = k.try_inverse().unwrap();
        c[(1, 1)] += 0.4 / (8e10 * 5e-5);
        c[(2, 2)] += 0.4 / (8e10 * 5e-5);
        c.try_inverse().unwrap()
    };
    let stubby = LinkSpec::matrix(matrix, 0.4)
        .convention(convention)
        .with_mass(mass);
    let inertia = Matrix3::new(0.4, 0.05, -0.02, 0.05, 0.5, 0.03, -0.02, 0.03, 0.35);
    Chain::builder("irregular")
        .rigid(Pose::rotation(r.vector(0.6)))
        .spring("swivel", MotionKind::Revolute, r.vector(1.0), 3e4, 0.1)
        .translation(r.vector(0.3))
        .body("first", 5.0, r.vector(0.2), inertia)
        .link_with("bar", &spec)
        .passive("hinge", MotionKind::Revolute, r.vector(1.0), 0.3)
        .translation(r.vector(0.3))
        .body("inside", 2.0, r.vector(0.2), inertia * 0.1)
        .coupled("hinge", MotionKind::Revolute, r.vector(1.0), -0.7)
        .coupled("swivel", MotionKind::Prismatic, r.vector(1.0), 0.05)
        .rigid(Pose::rotation(r.vector(0.6)))
        .link_with("stub", &stubby)
        .body("tool", 3.0, r.vector(0.2), inertia * 0.2)
        .build()
        .unwrap()
}

const CONVENTIONS: [LinkConvention; 4] = [
    LinkConvention::Bowing,
    LinkConvention::TranslationsFirst,
    LinkConvention::RotationsFirst,
    LinkConvention::Middle,
];

/// Coordinates that are strained and turned.
fn state(chain: &Chain, r: &mut Irregular) -> Vec<f64> {
    chain
        .coordinates()
        .iter()
        .map(|c| {
            c.home
                + r.next()
                    * if c.kind == MotionKind::Prismatic {
                        0.004
                    } else {
                        0.02
                    }
        })
        .collect()
}

/// Axes and place of a body, mass, inertia.
type Frame = (Matrix3<f64>, Vector3<f64>, f64, Matrix3<f64>);

/// Kinetic energy of velocities along `y` by differences of poses of bodies and slices.
fn kinetic(chain: &Chain, x: &[f64], y: &[f64]) -> f64 {
    let at = |h: f64| -> Vec<f64> { x.iter().zip(y).map(|(x, y)| x + h * y).collect() };
    let frames = |h: f64| {
        let k = kinetostat::model::Kinematics::new(chain, &Pose::identity(), &at(h), &[]);
        let mut all = Vec::new();
        for body in chain.bodies() {
            let (r, p) = k.frame(body.node);
            all.push((r, p, body.mass, body.inertia));
        }
        for segment in chain.segment_masses() {
            let eta = segment.deflection(&k);
            let (r, p) = k.frame(segment.near);
            for slice in segment.slices() {
                let by =
                    |rows: &[nalgebra::Vector6<f64>; 3]| Vector3::from_fn(|i, _| rows[i].dot(&eta));
                let turn = by(&slice.turns);
                let place = by(&slice.translations) + Vector3::x() * (slice.place * segment.length);
                let about = |a, t| nalgebra::Rotation3::from_axis_angle(&a, t);
                let own = about(Vector3::x_axis(), turn.x)
                    * about(Vector3::y_axis(), turn.y)
                    * about(Vector3::z_axis(), turn.z);
                all.push((
                    r * own.matrix(),
                    p + r * place,
                    slice.mass,
                    Matrix3::from_diagonal(&slice.inertia),
                ));
            }
        }
        all
    };
    let h = 1e-3;
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|s| frames(s * h));
    let now = frames(0.0);
    let mut sum = 0.0;
    for k in 0..now.len() {
        let rate = |f: &dyn Fn(&Frame) -> Matrix3<f64>| {
            ((f(&c[k]) - f(&b[k])) * 8.0 - (f(&d[k]) - f(&a[k]))) / (12.0 * h)
        };
        let v = rate(&|f| Matrix3::from_columns(&[f.1, Vector3::zeros(), Vector3::zeros()]))
            .column(0)
            .into_owned();
        // Angular velocity in body axes.
        let spin = now[k].0.transpose() * rate(&|f| f.0);
        let w = vector![
            spin[(2, 1)] - spin[(1, 2)],
            spin[(0, 2)] - spin[(2, 0)],
            spin[(1, 0)] - spin[(0, 1)]
        ] * 0.5;
        sum += 0.5 * (now[k].2 * v.norm_squared() + w.dot(&(now[k].3 * w)));
    }
    sum
}

#[test]
fn mass_is_that_of_the_kinetic_energy() {
    let mut worst = Worst::new();
    for (seed, convention) in CONVENTIONS.into_iter().enumerate() {
        let chain = chain(seed as u64 + 7, convention);
        let mut r = Irregular(seed as u64 + 100);
        let x = state(&chain, &mut r);
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let d = LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap();
        for _ in 0..6 {
            let y: Vec<f64> = x.iter().map(|_| r.next()).collect();
            let v = nalgebra::DVector::from_column_slice(&y);
            let expected = kinetic(&chain, &x, &y);
            worst.add(0.5 * v.dot(&(d.mass() * &v)) / expected - 1.0);
        }
        assert!((d.mass() - d.mass().transpose()).norm() < 1e-13 * d.mass().norm());
    }
    println!("{worst}");
    assert!(worst.of(24) < 1e-8);
}

#[test]
fn weight_of_slices_changes_as_its_tangent_says() {
    let mut worst = Worst::new();
    for (seed, convention) in CONVENTIONS.into_iter().enumerate() {
        let chain = chain(seed as u64 + 7, convention);
        let x = state(&chain, &mut Irregular(seed as u64 + 5));
        let load = Load::gravity(vector![2.0, -3.0, -9.0]);
        let check = check_tangents(&chain, &Pose::identity(), &x, &[], &load).unwrap();
        worst.add(check.largest);
    }
    println!("{worst}");
    assert!(worst.of(4) < 1e-9);
}

#[test]
fn tangent_is_the_derivative_of_the_gradient() {
    let mut worst = Worst::new();
    for (seed, convention) in CONVENTIONS.into_iter().enumerate() {
        let chain = chain(seed as u64 + 7, convention);
        let n = chain.coordinate_count();
        let mut r = Irregular(seed as u64 + 50);
        let x = state(&chain, &mut r);
        let force = Wrench::new(r.vector(800.0), Vector3::zeros());
        let mut problem = ChainProblem::new(&chain, EndCondition::wrench(force));
        problem.loads.push(Load::gravity(vector![2.0, -3.0, -9.0]));
        let at = |x: &[f64]| {
            kinetostat::chain::ChainTangent::at(&problem, x, &force)
                .unwrap()
                .unbalanced
        };
        let d = LinearDynamics::of_chain(&problem, &x, &force, &Held::nothing()).unwrap();
        let h = 1e-4;
        let mut differences = DMatrix::zeros(n, n);
        for j in 0..n {
            let moved = |s: f64| {
                let mut x = x.clone();
                x[j] += s * h;
                at(&x)
            };
            let [a, b, c, e] = [-2.0, -1.0, 1.0, 2.0].map(moved);
            for i in 0..n {
                differences[(i, j)] = -(8.0 * (c[i] - b[i]) - (e[i] - a[i])) / (12.0 * h);
            }
        }
        // Gravity on slices against its energy, too: the gradient is that of the potential.
        let energy = |x: &[f64]| {
            kinetostat::chain::load_energy(&problem, x)
                .unwrap()
                .unwrap()
        };
        let k = d.tangent();
        let diagonal = DMatrix::from_fn(n, n, |i, j| {
            if i == j {
                k[(i, i)].abs().max(1e2)
            } else {
                0.0
            }
        });
        worst.add(apart(k, &differences, &diagonal));
        println!(
            "{convention:?} {:e} asymmetry {:e}",
            apart(k, &differences, &diagonal),
            d.asymmetry()
        );
        assert!(d.asymmetry() < 1e-12);
        let mut slopes = Worst::new();
        let unstrained: Vec<f64> = {
            let mut none = problem.clone();
            none.loads.clear();
            none.end.wrench = Wrench::zero();
            kinetostat::chain::ChainTangent::at(&none, &x, &Wrench::zero())
                .unwrap()
                .unbalanced
        };
        let all = at(&x);
        for j in 0..n {
            let moved = |s: f64| {
                let mut x = x.clone();
                x[j] += s * 1e-3;
                energy(&x)
            };
            let slope = (8.0 * (moved(1.0) - moved(-1.0)) - (moved(2.0) - moved(-2.0))) / 12e-3;
            slopes.add((all[j] - unstrained[j] + slope) / 800.0);
        }
        println!("energy {slopes}");
        assert!(slopes.of(n) < 1e-8);
    }
    assert!(worst.of(4) < 1e-8, "{worst}");
}

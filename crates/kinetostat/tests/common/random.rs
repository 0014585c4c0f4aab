//! Random chains from a seed: off-axis geometry, full spring matrices, coupled coordinates,
//! universal and spherical joints, both kinds of actuators, masses and nodes.

use kinetostat::{ActuatorSpec, Chain, ChainBuilder, MotionKind, Pose, Wrench};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3};
use proptest::test_runner::{Config, RngSeed};

/// The same cases in every run.
pub fn cases(count: u32) -> Config {
    Config {
        cases: count,
        failure_persistence: None,
        max_shrink_iters: 0,
        rng_seed: RngSeed::Fixed(0x5eed),
        ..Config::default()
    }
}

/// SplitMix64.
pub struct Rng(pub u64);

impl Rng {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// In [-1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.signed() + 1.0)
    }
    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }
    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::new(self.signed(), self.signed(), self.signed()) * size
    }
    pub fn axis(&mut self) -> Vector3<f64> {
        loop {
            let v = self.vector(1.0);
            if (0.3..1.0).contains(&v.norm()) {
                return v.normalize();
            }
        }
    }
    pub fn pose(&mut self, reach: f64, angle: f64) -> Pose {
        let p = self.axis() * self.between(0.3, 1.0) * reach;
        Pose::new(p, self.axis() * (angle * self.signed()))
    }
    pub fn wrench(&mut self, force: f64, moment: f64) -> Wrench {
        let f = self.axis() * force;
        Wrench::new(f, self.axis() * moment)
    }
    /// Full symmetric positive definite 6 x 6 matrix with the given translational (N/m) and
    /// rotational (N m/rad) size.
    pub fn spring_matrix(&mut self, k_t: f64, k_r: f64) -> Matrix6<f64> {
        let a = Matrix6::from_fn(|_, _| 0.35 * self.signed());
        let m = Matrix6::identity() + a * a.transpose();
        let u = |i: usize| if i < 3 { k_t.sqrt() } else { k_r.sqrt() };
        Matrix6::from_fn(|i, j| m[(i, j)] * u(i) * u(j))
    }
}

/// What a random chain may contain.
#[derive(Clone, Copy)]
pub struct Recipe {
    pub stages: usize,
    pub passive: usize,
    pub k_t: f64,
    pub k_r: f64,
    pub preload: f64,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            stages: 4,
            passive: 3,
            k_t: 2e5,
            k_r: 4e3,
            preload: 0.0,
        }
    }
}

/// A chain with a posture.
pub struct RandomChain {
    pub chain: Chain,
    pub base: Pose,
    pub commands: Vec<f64>,
    pub posture: Vec<f64>,
}

fn joint(builder: ChainBuilder, rng: &mut Rng, left: &mut usize, k: usize) -> ChainBuilder {
    match rng.below(4) {
        0 if *left >= 2 => {
            *left -= 2;
            let (a, b) = (rng.axis(), rng.axis());
            builder.passive_universal(&format!("u{k}"), a, b)
        }
        1 if *left >= 3 => {
            *left -= 3;
            builder.passive_spherical(&format!("s{k}"))
        }
        2 if *left >= 1 => {
            *left -= 1;
            builder.passive(
                &format!("p{k}"),
                MotionKind::Prismatic,
                rng.axis(),
                0.05 * rng.signed(),
            )
        }
        _ if *left >= 1 => {
            *left -= 1;
            builder.passive(
                &format!("r{k}"),
                MotionKind::Revolute,
                rng.axis(),
                0.5 * rng.signed(),
            )
        }
        _ => builder,
    }
}

pub fn random_chain(rng: &mut Rng, recipe: &Recipe) -> RandomChain {
    let mut builder = Chain::builder("random");
    let mut left = recipe.passive;
    for k in 0..recipe.stages {
        builder = builder.rigid(rng.pose(0.4, 1.0));
        let kind = if rng.below(2) == 0 {
            MotionKind::Revolute
        } else {
            MotionKind::Prismatic
        };
        let mut spec = ActuatorSpec::new(
            kind,
            rng.axis(),
            if kind == MotionKind::Revolute {
                recipe.k_r
            } else {
                recipe.k_t
            },
        );
        spec.rest = 0.3 * recipe.preload * rng.signed();
        if rng.below(4) == 0 {
            spec.stiffness = None;
        }
        builder = builder.actuator(&format!("a{k}"), spec);
        builder = builder.rigid(rng.pose(0.3, 1.0));
        let rest: [f64; 6] =
            std::array::from_fn(|i| recipe.preload * rng.signed() * if i < 3 { 0.1 } else { 1.0 });
        let matrix = rng.spring_matrix(recipe.k_t, recipe.k_r);
        builder = builder.spring6(&format!("link{k}"), &matrix, rest);
        if rng.below(2) == 0 {
            builder = builder.node(&format!("n{k}"));
        }
        if rng.below(2) == 0 {
            builder = builder.body(
                &format!("m{k}"),
                rng.between(1.0, 8.0),
                rng.vector(0.15),
                Matrix3::identity() * 0.01,
            );
        }
        builder = joint(builder, rng, &mut left, k);
        match rng.below(4) {
            0 => {
                // A coordinate that drives two motions: a parallelogram without its springs.
                let axis = rng.axis();
                builder = builder
                    .spring(
                        &format!("c{k}"),
                        MotionKind::Revolute,
                        axis,
                        recipe.k_r,
                        0.0,
                    )
                    .rigid(rng.pose(0.3, 0.5))
                    .coupled(&format!("c{k}"), MotionKind::Revolute, axis, -1.0);
            }
            1 => {
                builder = builder
                    .spring(
                        &format!("d{k}"),
                        MotionKind::Prismatic,
                        rng.axis(),
                        recipe.k_t,
                        0.0,
                    )
                    .rigid(rng.pose(0.2, 0.5))
                    .coupled(&format!("d{k}"), MotionKind::Revolute, rng.axis(), 1.7);
            }
            _ => {}
        }
    }
    let chain = builder
        .rigid(rng.pose(0.3, 1.0))
        .build()
        .expect("random chain");
    let commands = chain
        .actuators()
        .iter()
        .map(|a| match a.kind {
            MotionKind::Revolute => 0.6 * rng.signed(),
            MotionKind::Prismatic => 0.1 * rng.signed(),
        })
        .collect();
    let posture = chain.home_coordinates();
    RandomChain {
        base: rng.pose(0.5, 2.0),
        chain,
        commands,
        posture,
    }
}

impl RandomChain {
    pub fn tip(&self) -> Pose {
        kinetostat::model::unloaded_tip(&self.chain, &self.base, &self.posture, &self.commands)
    }

    pub fn problem(&self, end: kinetostat::EndCondition) -> kinetostat::ChainProblem<'_> {
        let mut problem = kinetostat::ChainProblem::new(&self.chain, end);
        problem.base = self.base;
        problem.commands.clone_from(&self.commands);
        problem.posture.clone_from(&self.posture);
        problem
    }
}

/// Dense copy.
pub fn dense<R: nalgebra::Dim, C: nalgebra::Dim, S: nalgebra::RawStorage<f64, R, C>>(
    m: &nalgebra::Matrix<f64, R, C, S>,
) -> DMatrix<f64> {
    DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)])
}

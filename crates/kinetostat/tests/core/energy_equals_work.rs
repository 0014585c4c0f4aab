//! What the springs store is what the end wrench and the dead loads did [R 4.12]: along a path of
//! prescribed poses, and for a machine loaded slowly.

use crate::common::{
    Orthoglide, Recipe, Rng, assert_chain_equilibrium, assert_equilibrium, cases, orthoglide_point,
    random_chain,
};
use kinetostat::{EndCondition, Load, Settings, Twist, Wrench, solve_chain, spatial::moved};
use nalgebra::{Vector3, vector};
use proptest::prelude::*;

/// Nodes and weights of ten-point Gauss-Legendre on [0, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_4),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

fn integral(mut f: impl FnMut(f64) -> f64) -> f64 {
    GAUSS
        .iter()
        .map(|(x, w)| 0.5 * w * (f(0.5 + 0.5 * x) + f(0.5 - 0.5 * x)))
        .sum()
}

/// Energy stored, and work of the end wrench and of the dead loads.
pub struct Balance {
    pub stored: f64,
    pub work: f64,
    pub dead: f64,
}

impl Balance {
    /// What is left over, as a share of the largest.
    pub fn error(&self) -> f64 {
        let size = self.stored.abs().max(self.work.abs()).max(self.dead.abs());
        (self.stored - self.work - self.dead).abs() / size
    }
}

/// Along a path of poses of a random chain; `None` where the path has no start.
pub fn balance_of_chain(seed: u64) -> Option<Balance> {
    let mut rng = Rng(seed);
    let recipe = Recipe {
        stages: 3,
        passive: 2,
        preload: 0.02,
        ..Recipe::default()
    };
    let r = random_chain(&mut rng, &recipe);
    let loads = vec![
        Load::Gravity(rng.axis() * 9.81),
        Load::Dead {
            node: rng.below(r.chain.nodes().len()),
            wrench: Wrench::new(rng.vector(80.0), Vector3::zeros()),
        },
    ];
    let start = r.tip();
    let span = Twist::new(rng.vector(0.02), rng.vector(0.05));
    let near = std::cell::RefCell::new(r.posture.clone());
    let solve = |s: f64| {
        let mut problem = r.problem(EndCondition::pose(moved(&start, &Twist(span.0 * s))));
        problem.loads.clone_from(&loads);
        problem.posture.clone_from(&near.borrow());
        let settings = Settings::default().with_torque(1e-12);
        let e = solve_chain(&problem, &settings)?;
        assert_chain_equilibrium(&problem, &e);
        near.borrow_mut().clone_from(&e.coordinates);
        Ok::<_, kinetostat::Error>((problem, e))
    };
    let (problem, first) = solve(0.0).ok()?;
    let work = integral(|s| span.dot(&solve(s).expect("path").1.wrench));
    let (_, last) = solve(1.0).expect("end");
    let dead = crate::common::invariants::node_wrenches(&problem)
        .iter()
        .map(|(node, w)| {
            let d = last.nodes[*node].translation.vector - first.nodes[*node].translation.vector;
            w.force().dot(&d)
        })
        .sum();
    let stored = last.energy - first.energy;
    Some(Balance { stored, work, dead })
}

/// Of the Orthoglide at a point of the report, loaded slowly with a pure force.
pub fn balance_of_machine(index: usize) -> Balance {
    let machine = Orthoglide::default().build();
    let posture = machine.posture(&orthoglide_point(index)).unwrap();
    // A pure force is dead along the whole path: its work is the integral of F ds.
    let force = vector![215.0, -60.0, 90.0];
    let at = |s: f64| {
        let e = posture
            .deflected_by(&Wrench::new(force * s, Vector3::zeros()))
            .unwrap();
        assert_equilibrium(&posture, &e);
        e
    };
    // Integration by parts: int F(s).p'(s) ds = F.p(1) - int F'.p ds, F' = force.
    let end = at(1.0);
    let work = force.dot(&end.displacement.linear())
        - integral(|s| force.dot(&at(s).displacement.linear()));
    Balance {
        stored: end.limbs.iter().map(|l| l.energy).sum(),
        work,
        dead: 0.0,
    }
}

proptest! {
    #![proptest_config(cases(16))]
    #[test]
    fn energy_equals_work_along_a_path_of_poses(seed in any::<u64>()) {
        let Some(b) = balance_of_chain(seed) else { return Ok(()); };
        prop_assert!(b.error() < 1e-7, "stored {:e}, work {:e}, dead {:e}", b.stored, b.work, b.dead);
    }
}

#[test]
fn a_slowly_loaded_machine_stores_the_work_of_its_load() {
    for index in 0..5 {
        let b = balance_of_machine(index);
        assert!(b.error() < 1e-9, "{index}: {:e} {:e}", b.stored, b.work);
    }
}

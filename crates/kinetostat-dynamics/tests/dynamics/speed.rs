//! How long a machine with loops takes: printed, never asserted; arms and links are timed by `vibrations` of `kinetostat-bench`. `cargo test -p kinetostat-dynamics --test dynamics speed -- --ignored --nocapture`

use std::time::Instant;

use crate::common::*;
use crate::orthoglide::orthoglide;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics, LongChain};
use nalgebra::{Matrix3, Vector3, vector};

#[allow(clippy::print_stdout)] // what it is for
fn time(what: &str, mut work: impl FnMut()) -> f64 {
    work();
    let mut best = f64::INFINITY;
    for _ in 0..7 {
        let start = Instant::now();
        let mut count = 0;
        while start.elapsed().as_secs_f64() < 0.03 {
            work();
            count += 1;
        }
        best = best.min(start.elapsed().as_secs_f64() / f64::from(count));
    }
    println!("{what}: {:.1} us", best * 1e6);
    best
}

/// The lowest six modes of a clamped tube under gravity and a force, along it and (to 64 segments) dense.
#[test]
#[ignore = "prints times"]
#[allow(clippy::print_stdout)] // what it is for
fn how_long_modes_take_by_segments() {
    let mut last: Option<f64> = None;
    for segments in [8, 16, 32, 64, 128, 256, 512] {
        let chain = Chain::builder("boom")
            .link_with("boom", &thin_link(2.0, segments, 1.0))
            .body(
                "head",
                5.0,
                vector![0.02, 0.0, 0.03],
                Matrix3::identity() * 0.01,
            )
            .build()
            .unwrap();
        let end = EndCondition::wrench(Wrench::new(vector![-40.0, 90.0, -60.0], Vector3::zeros()));
        let mut problem = ChainProblem::new(&chain, end);
        problem.loads.push(Load::gravity(down()));
        // Times do not depend on whether it is in equilibrium.
        let (x, w) = (chain.home_coordinates(), Wrench::zero());
        let held = Held::nothing();
        let own = time(&format!("{segments} segments, along the chain"), || {
            let long = LongChain::of_chain(&problem, &x, &w, &held)
                .unwrap()
                .unwrap();
            std::hint::black_box(long.lowest_modes(6).unwrap().unwrap());
        });
        if let Some(last) = last {
            println!("  exponent {:.2}", (own / last).log2());
        }
        last = Some(own);
        if segments <= 64 {
            time(&format!("{segments} segments, dense, all modes"), || {
                let d = LinearDynamics::of_chain(&problem, &x, &w, &held).unwrap();
                std::hint::black_box(d.modes().unwrap());
            });
        }
    }
}

#[test]
#[ignore = "prints times"]
fn how_long_it_takes() {
    let machine = orthoglide([10.0, 3.0, 1.2], down());
    let posture = machine.posture(&Pose::identity()).unwrap();
    let force = Wrench::new(vector![400.0, -300.0, 200.0], Vector3::zeros());
    let loaded = posture.deflected_by(&force).unwrap();
    time("Orthoglide: equilibrium", || {
        std::hint::black_box(posture.deflected_by(&force).unwrap());
    });
    time("Orthoglide: dynamics and modes", || {
        let d = LinearDynamics::of_machine(&posture, &loaded, &Held::nothing()).unwrap();
        std::hint::black_box(d.modes().unwrap());
    });
}

//! How long a machine with loops takes: printed, never asserted; arms and links are timed by `vibrations` of `kinetostat-bench`. `cargo test -p kinetostat-dynamics --test dynamics speed -- --ignored --nocapture`

use std::time::Instant;

use crate::common::*;
use crate::orthoglide::orthoglide;
use kinetostat::*;
use kinetostat_dynamics::{Held, LinearDynamics};
use nalgebra::{Vector3, vector};

#[allow(clippy::print_stdout)] // what it is for
fn time(what: &str, mut work: impl FnMut()) {
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

//! How long it takes: printed, never asserted. `cargo test -p kinetostat-dynamics --test dynamics speed -- --ignored --nocapture`

use std::time::Instant;

use crate::arms::arm6;
use crate::common::*;
use crate::orthoglide::orthoglide;
use kinetostat::model::LinkMass;
use kinetostat::*;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, ModalResponse, Quantity, Receptance};
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
    let chain = arm6();
    let mut problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
    problem.loads.push(Load::gravity(down()));
    let settings = Settings::default();
    let at = solve_chain(&problem, &settings).unwrap();
    time("arm6: equilibrium", || {
        std::hint::black_box(solve_chain(&problem, &settings).unwrap());
    });
    let dynamics = || {
        LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing()).unwrap()
    };
    time("arm6: linear dynamics", || {
        std::hint::black_box(dynamics());
    });
    let d = dynamics();
    time("arm6: modes and damping", || {
        let modes = d.modes().unwrap();
        std::hint::black_box(d.damping_ratios(&modes, &Damping::Ratio(0.03)).unwrap());
    });
    let modes = d.modes().unwrap();
    let response = ModalResponse::new(
        &d,
        &modes,
        &Damping::Ratio(0.03),
        d.tool(),
        d.tool(),
        usize::MAX,
    )
    .unwrap();
    let hz: Vec<f64> = (0..1000).map(|k| 0.2 * f64::from(k)).collect();
    let mut out = vec![Receptance::zeros(); 1000];
    time("arm6: 1000 points of 6 x 6 by modes", || {
        response.over_into(&hz, Quantity::Displacement, &mut out);
        std::hint::black_box(&out);
    });
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
    for segments in [4, 8, 16, 32] {
        let mass = LinkMass::of_section(&section(), DENSITY);
        let chain = Chain::builder("beam")
            .link_with(
                "beam",
                &LinkSpec::beam(section(), 1.0)
                    .segments(segments)
                    .with_mass(mass),
            )
            .build()
            .unwrap();
        let problem = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let x = chain.home_coordinates();
        time(&format!("{segments} segments: linear dynamics"), || {
            std::hint::black_box(
                LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap(),
            );
        });
        let d = LinearDynamics::of_chain(&problem, &x, &Wrench::zero(), &Held::nothing()).unwrap();
        time(&format!("{segments} segments: modes"), || {
            std::hint::black_box(d.modes().unwrap());
        });
    }
}

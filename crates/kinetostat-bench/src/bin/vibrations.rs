//! Processor time of what elasto-dynamics is asked for, with the times that are asked: modes of an arm of six axes, a
//! response by the sum of modes, a lobe diagram, and modes by the number of a link's segments. `cargo run --release -p kinetostat-bench --bin vibrations`.

#![allow(clippy::print_stdout, reason = "the table is what was asked for")]

use std::hint::black_box;
use std::time::Instant;

use anyhow::Result;
use kinetostat::model::LinkMass;
use kinetostat::{BeamSection, Chain, ChainProblem, EndCondition, LinkSpec, Load};
use kinetostat::{Posture, Settings, Wrench, solve_chain};
use kinetostat_analysis::vibration::{MachineCut, VibratingMachine};
use kinetostat_chatter as chatter;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, Quantity, Receptance};
use kinetostat_model::Model;
use nalgebra::{Matrix3, Vector3, vector};

/// The arm of the reference values, D3, as the tests of the command line have it.
const ARM: &str = include_str!("../../../kinetostat-cli/tests/cli/vibration_models/arm6.toml");

const DAMPING: Damping = Damping::Ratio(0.03);

fn arm() -> Result<Posture> {
    let machine = Model::from_toml(ARM, "arm6.toml")?.mechanism;
    let home = machine.platforms()[machine.tool()].home;
    Ok(machine.posture(&home)?)
}

fn vibrating(posture: &Posture) -> Result<VibratingMachine> {
    Ok(VibratingMachine::at(
        posture,
        &Wrench::zero(),
        &Held::nothing(),
    )?)
}

fn in_gravity(chain: &Chain) -> ChainProblem<'_> {
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
    problem.posture = chain.home_coordinates();
    problem.loads.push(Load::gravity(vector![0.0, 0.0, -9.81]));
    problem
}

/// Shortest time of a call among rounds of calls, ms. The rounds are short, so that one of them is undisturbed.
fn shortest<T>(rounds: u32, calls: u32, mut call: impl FnMut() -> Result<T>) -> Result<f64> {
    let mut best = f64::INFINITY;
    for _ in 0..rounds {
        let start = Instant::now();
        for _ in 0..calls {
            black_box(call()?);
        }
        best = best.min(1e3 * start.elapsed().as_secs_f64() / f64::from(calls));
    }
    Ok(best)
}

fn line(what: &str, found: f64, asked: &str) {
    println!("{what:<62} {found:>10.4} ms   asked {asked}");
}

fn lobes(machine: &VibratingMachine) -> Result<f64> {
    let cut = chatter::MillingCut::new(
        2,
        chatter::Arc::straight(chatter::Milled::Up, 0.5)?,
        chatter::Coefficients::new(8e8, 2.4e8, 0.0)?,
    )?;
    let regeneration = MachineCut {
        machine,
        damping: &DAMPING,
        frame: chatter::FeedFrame::vertical(0.0)?,
        cut,
        modes_up_to_hz: f64::INFINITY,
    }
    .regeneration()?;
    let request = chatter::LobeRequest::new(1000.0, 6000.0, 200, 4e-3);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    alone.install(|| shortest(2, 1, || Ok(regeneration.lobes(&request)?)))
}

fn by_segments(segments: usize) -> Result<f64> {
    let own = BeamSection::tube(2.1e11, 8.1e10, 0.08, 0.06);
    let spec = LinkSpec::beam(own, 2.0)
        .segments(segments)
        .with_mass(LinkMass::of_section(&own, 7850.0));
    let chain = Chain::builder("boom")
        .link_with("boom", &spec)
        .body("head", 20.0, Vector3::zeros(), Matrix3::identity())
        .build()?;
    let problem = in_gravity(&chain);
    let at = solve_chain(&problem, &Settings::default())?;
    shortest(5, 2, || {
        Ok(
            LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())?
                .modes()?,
        )
    })
}

fn main() -> Result<()> {
    let posture = arm()?;
    let found = shortest(50, 100, || vibrating(&posture))?;
    line(
        "arm of six axes: equilibrium, masses, modes",
        found,
        "<= 4.3 / 50 = 0.086",
    );
    let machine = vibrating(&posture)?;
    let response = machine.tool_response(&DAMPING, usize::MAX)?;
    let hz: Vec<f64> = (0..1000).map(|i| 0.13 * f64::from(i)).collect();
    let mut out = vec![Receptance::zeros(); hz.len()];
    let found = shortest(50, 20, || {
        response.over_into(&hz, Quantity::Displacement, &mut out);
        Ok(out[17][(0, 0)])
    })?;
    line(
        "arm of six axes: 6 x 6 response at 1000 frequencies by modes",
        found,
        "<= 0.1",
    );
    line(
        "arm of six axes: 200 speeds of a lobe diagram, one thread",
        lobes(&machine)?,
        "<= 2000",
    );
    for segments in [4, 8, 16, 32] {
        let found = by_segments(segments)?;
        line(
            &format!("boom of {segments} segments: masses, all modes"),
            found,
            "linear in segments",
        );
    }
    Ok(())
}

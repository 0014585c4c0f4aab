//! Time of what elasto-dynamics is asked for: modes of an arm of six axes and of a machine with loops, a response by the sum
//! of modes, a lobe diagram, and modes by the number of a link's segments. What `cargo xtask figures` shows
//! follows each. `cargo run --release -p kinetostat-analysis --example vibrations`.

#![allow(clippy::print_stdout, reason = "the table is what was asked for")]

use std::hint::black_box;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use kinetostat::model::LinkMass;
use kinetostat::{BeamSection, Chain, ChainProblem, EndCondition, LinkSpec, Load};
use kinetostat::{Pose, Posture, Settings, Wrench, solve_chain};
use kinetostat_analysis::vibration::{MachineCut, VibratingMachine};
use kinetostat_chatter as chatter;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, LongChain, Quantity, Receptance};
use kinetostat_model::Model;
use kinetostat_testing::figure::at_most;
use nalgebra::{Matrix3, Vector3, vector};

/// The arm of the reference values, D3, as the tests of the command line have it.
const ARM: &str = include_str!("../../kinetostat-cli/tests/cli/vibration_models/arm6.toml");

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

fn line(what: &str, found: f64, most: f64) {
    println!("{what:<70} {found:>10.4} ms   asked: at most {most}");
    at_most(what, found, most, "ms");
}

/// The Orthoglide with masses of its legs, off the diagonal of its workspace, under a force.
fn orthoglide() -> Result<(Posture, Wrench)> {
    let text = kinetostat_model::preset_text("orthoglide")
        .context("no preset orthoglide")?
        .to_owned();
    let with = |text: String, from: &str, to: &str| -> Result<String> {
        ensure!(text.contains(from), "the preset has no {from}");
        Ok(text.replace(from, to))
    };
    let body = |name: &str, mass: f64| {
        let inertia = 1e-3 * mass;
        format!(
            "{{ body = \"{name}\", mass_kg = {mass}, inertia_kg_m2 = [[{inertia}, 0, 0], [0, {inertia}, 0], [0, 0, {inertia}]] }},"
        )
    };
    let foot = "{ spring6 = \"foot\", name = \"foot\" },";
    let q3 = "{ passive = \"revolute\", name = \"q3\", axis = \"z\" },";
    let home = "home = { position_mm = [0, 0, 0] }";
    let text = with(
        text,
        foot,
        &format!("{} {foot} {}", body("slider", 10.0), body("foot mass", 3.0)),
    )?;
    let text = with(text, q3, &format!("{} {q3}", body("bars", 1.2)))?;
    let text = with(
        text,
        home,
        &format!("{home}\nmass_kg = 8\ninertia_kg_m2 = [[0.03, 0, 0], [0, 0.03, 0], [0, 0, 0.03]]"),
    )?;
    let named = "name = \"orthoglide\"";
    let text = with(
        text,
        named,
        &format!("{named}\ngravity_m_per_s2 = [0, 0, -9.81]"),
    )?;
    let machine = Model::from_toml(&text, "orthoglide.toml")?.mechanism;
    let posture = machine.posture(&Pose::translation(0.126, 0.126, -0.073))?;
    Ok((
        posture,
        Wrench::new(vector![400.0, -300.0, 200.0], Vector3::zeros()),
    ))
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
        swinging: chatter::Swinging::All,
    }
    .regeneration()?;
    let request = chatter::LobeRequest::new(1000.0, 6000.0, 200, 4e-3);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    alone.install(|| shortest(2, 1, || Ok(regeneration.lobes(&request)?)))
}

/// Time of the lowest modes of a boom that bends under its weight, ms.
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
        let long = LongChain::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())?;
        let modes = long.context("no long chain")?.lowest_modes(6)?;
        modes.context("the lowest modes are not found so")
    })
}

fn main() -> Result<()> {
    let posture = arm()?;
    let found = shortest(50, 100, || vibrating(&posture))?;
    line(
        "arm of six axes: equilibrium, masses, modes (numpy: 4.3 ms, a fiftieth is asked)",
        found,
        0.086,
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
        0.1,
    );
    let (posture, load) = orthoglide()?;
    let found = shortest(50, 20, || {
        let at = posture.deflected_by(&load)?;
        Ok(LinearDynamics::of_machine(&posture, &at, &Held::nothing())?.modes()?)
    })?;
    line(
        "orthoglide with masses of its legs: equilibrium, masses, all modes",
        found,
        1.0,
    );
    line(
        "arm of six axes: 200 speeds of a lobe diagram, one thread",
        lobes(&machine)?,
        2000.0,
    );
    let (few, many) = (32, 256);
    let [short, long] = [by_segments(few)?, by_segments(many)?];
    let exponent = (long / short).ln() / (many as f64 / few as f64).ln();
    println!(
        "boom of {few} segments {short:.3} ms, of {many} {long:.3} ms: exponent {exponent:.3}"
    );
    at_most(
        "cost of the six lowest modes over the segments of a link, exponent",
        exponent,
        1.15,
        "exponent",
    );
    Ok(())
}

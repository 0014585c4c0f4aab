//! Processor time of what elasto-dynamics is asked for, with the times that are asked: modes of an arm of six axes, a
//! response by the sum of modes, modes of a machine of six elastic legs, a lobe diagram, and modes by the number of a
//! link's segments. `cargo run --release -p kinetostat-bench --bin vibrations`.

#![allow(clippy::print_stdout, reason = "the table is what was asked for")]

use std::hint::black_box;
use std::time::Instant;

use anyhow::Result;
use kinetostat::model::LinkMass;
use kinetostat::{BeamSection, Chain, ChainProblem, EndCondition, LinkSpec, Load, MotionKind};
use kinetostat::{Settings, Wrench, solve_chain};
use kinetostat_chatter as chatter;
use kinetostat_dynamics::{Damping, Held, LinearDynamics, ModalResponse, Quantity, Receptance};
use nalgebra::{Matrix3, Vector3, vector};

/// Offset, axis, mass, centre, inertia, stiffness and rest of the joints of the arm of the reference values, D3.
type Joint = ([f64; 3], usize, f64, [f64; 3], [f64; 3], f64, f64);
const ARM: [Joint; 6] = [
    (
        [0.0, 0.0, 0.4],
        2,
        300.0,
        [0.1, 0.0, 0.2],
        [15.0, 18.0, 14.0],
        4.2e6,
        0.2,
    ),
    (
        [0.35, 0.0, 0.4],
        1,
        220.0,
        [0.0, 0.05, 0.55],
        [28.0, 27.0, 4.0],
        3.9e6,
        0.35,
    ),
    (
        [0.0, 0.0, 1.15],
        1,
        180.0,
        [0.35, -0.04, 0.1],
        [4.0, 14.0, 13.0],
        2.6e6,
        -0.1,
    ),
    (
        [0.6, 0.0, 0.12],
        0,
        60.0,
        [0.35, 0.0, 0.0],
        [0.8, 2.6, 2.6],
        7.5e5,
        0.3,
    ),
    (
        [0.6, 0.0, 0.0],
        1,
        30.0,
        [0.05, 0.0, 0.0],
        [0.3, 0.35, 0.3],
        6e5,
        0.9,
    ),
    (
        [0.2, 0.0, 0.0],
        0,
        45.0,
        [0.15, 0.02, -0.12],
        [0.9, 1.0, 0.5],
        3.5e5,
        -0.4,
    ),
];

fn arm() -> Result<Chain> {
    let mut chain = Chain::builder("arm");
    for (i, (offset, axis, mass, centre, inertia, stiffness, rest)) in ARM.into_iter().enumerate() {
        let mut along = Vector3::zeros();
        along[axis] = 1.0;
        let inertia = Matrix3::from_diagonal(&Vector3::from(inertia));
        let name = format!("axis {i}");
        chain = chain
            .translation(offset.into())
            .spring(&name, MotionKind::Revolute, along, stiffness, rest)
            .home(&name, rest)
            .body(&format!("body {i}"), mass, centre.into(), inertia);
    }
    Ok(chain.translation(vector![0.25, 0.0, -0.30]).build()?)
}

fn in_gravity(chain: &Chain) -> ChainProblem<'_> {
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
    problem.posture = chain.home_coordinates();
    problem.loads.push(Load::gravity(vector![0.0, 0.0, -9.81]));
    problem
}

fn about(problem: &ChainProblem<'_>) -> Result<LinearDynamics> {
    let at = solve_chain(problem, &Settings::default())?;
    Ok(LinearDynamics::of_chain(
        problem,
        &at.coordinates,
        &at.wrench,
        &Held::nothing(),
    )?)
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

fn lobes(dynamics: &LinearDynamics) -> Result<f64> {
    let modes = dynamics.modes()?;
    let tool = dynamics.tool();
    let response = ModalResponse::new(
        dynamics,
        &modes,
        &Damping::Ratio(0.03),
        tool,
        tool,
        usize::MAX,
    )?;
    let data = response.translational()?;
    let list = data.shapes.iter().zip(&data.squared).zip(&data.ratios);
    let list: Result<Vec<chatter::Mode>, _> = list
        .map(|((shape, squared), ratio)| chatter::Mode::new(*shape, *squared, *ratio))
        .collect();
    let tool = chatter::ToolResponse::new(list?)?.with_residual(data.residual)?;
    let cut = chatter::MillingCut::new(
        2,
        chatter::Arc::straight(chatter::Milled::Up, 0.5)?,
        chatter::Coefficients::new(8e8, 2.4e8, 0.0)?,
    )?;
    let frame = chatter::FeedFrame::vertical(0.0)?;
    let regeneration = chatter::Regeneration::new(tool.in_frame(&frame), cut.into())?;
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
    let chain = arm()?;
    let problem = in_gravity(&chain);
    let found = shortest(50, 100, || Ok(about(&problem)?.modes()?))?;
    line(
        "arm of six axes: equilibrium, masses, modes",
        found,
        "<= 4.3 / 50 = 0.086",
    );
    let dynamics = about(&problem)?;
    let modes = dynamics.modes()?;
    let tool = dynamics.tool();
    let response = ModalResponse::new(
        &dynamics,
        &modes,
        &Damping::Ratio(0.03),
        tool,
        tool,
        usize::MAX,
    )?;
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
        lobes(&dynamics)?,
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

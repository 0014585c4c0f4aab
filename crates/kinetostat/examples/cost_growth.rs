//! How the cost of an equilibrium grows with the number of spring coordinates of a chain and with the
//! number of platforms of a machine: tables for the book and figures for `cargo xtask figures`.
//!
//! ```sh
//! cargo run --release -p kinetostat --example cost_growth
//! ```

#![allow(
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "tables are what was asked for; nobody has 2^52 coordinates"
)]

use std::time::Instant;

use kinetostat::{
    Chain, CurveSettings, Mechanism, Parameter, Pose, PostureRequest, Settings, Twist, Wrench,
    follow, solve_chain, spatial::moved, unloaded_stiffness,
};
use kinetostat_testing::{Worst, figure::computed_s, largest};
use nalgebra::{Vector3, vector};
use serde_json::json;

#[path = "../benches/long/mod.rs"]
mod long;
#[path = "../benches/platforms/mod.rs"]
mod platforms;

/// Numbers of coordinates; a cantilever has the next multiple of six.
const SIZES: [usize; 8] = [10, 30, 60, 100, 180, 300, 1000, 3000];

/// Time of one run, s: the shortest of four batches of at least five runs.
fn shortest<T>(run: impl FnMut() -> T) -> f64 {
    of_batches(4, 5, run)
}

/// Time of one run, s: the shortest of several batches, since what disturbs only makes it longer.
/// A batch is long against the steps in which a system counts time.
fn of_batches<T>(batches: usize, least_runs: u32, mut run: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    let mut best = f64::INFINITY;
    for _ in 0..batches {
        let (before, mut runs) = (computed_s(start), 0);
        let used = loop {
            std::hint::black_box(run());
            runs += 1;
            let used = computed_s(start) - before;
            if used > 0.1 && runs >= least_runs {
                break used;
            }
        };
        best = best.min(used / f64::from(runs));
    }
    best
}

/// Costs of one chain, s.
struct Row {
    coordinates: usize,
    iterations: usize,
    iteration: f64,
    equilibrium: f64,
    stiffness: f64,
}

fn measure(chain: &Chain, asked: long::Asked) -> kinetostat::Result<Row> {
    let exact = Settings::default();
    // Stopped earlier, with the same end: the difference is iterations and nothing else.
    let rough = exact.with_closure(1e-3).with_torque(1e-2);
    let problem = long::problem(chain, asked);
    let iterations = solve_chain(&problem, &exact)?.residual.iterations;
    let fewer = solve_chain(&problem, &rough)?.residual.iterations;
    let equilibrium = shortest(|| solve_chain(&problem, &exact));
    let less = shortest(|| solve_chain(&problem, &rough));
    let x = chain.home_coordinates();
    Ok(Row {
        coordinates: chain.coordinate_count(),
        iterations,
        iteration: (equilibrium - less) / iterations.saturating_sub(fewer).max(1) as f64,
        equilibrium,
        stiffness: shortest(|| unloaded_stiffness(chain, &problem.base, &x, &problem.commands)),
    })
}

/// Slope of the straight line through `(log n, log cost)`, by least squares.
fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, t)| (n.ln(), t.ln())).collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let over: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    over / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

fn main() -> kinetostat::Result<()> {
    let mut exponents = Vec::new();
    for (name, build, asked) in [
        (
            "Cantilever in segments, force given",
            long::cantilever as fn(usize) -> Chain,
            long::Asked::Force,
        ),
        (
            "Cantilever in segments, pose given",
            long::cantilever,
            long::Asked::Pose,
        ),
        (
            "Cantilever bent far, P L^2 / EI = 10",
            long::soft_cantilever,
            long::Asked::BentFar,
        ),
        (
            "Arm of elastic joints, force given",
            long::arm,
            long::Asked::Force,
        ),
        (
            "Arm of elastic joints, two directions held",
            long::arm,
            long::Asked::Mixed,
        ),
    ] {
        println!("\n{name}:\n");
        println!(
            "| coordinates | iterations | us per iteration | us per equilibrium | us per K_C | us per equilibrium and coordinate |"
        );
        println!("|---:|---:|---:|---:|---:|---:|");
        let mut rows = Vec::new();
        for size in SIZES {
            let row = measure(&build(size), asked)?;
            println!(
                "| {} | {} | {:.1} | {:.0} | {:.1} | {:.2} |",
                row.coordinates,
                row.iterations,
                row.iteration * 1e6,
                row.equilibrium * 1e6,
                row.stiffness * 1e6,
                row.equilibrium * 1e6 / row.coordinates as f64
            );
            rows.push(row);
        }
        let beyond: Vec<&Row> = rows
            .iter()
            .filter(|r| (100..=1100).contains(&r.coordinates))
            .collect();
        let of = |cost: fn(&Row) -> f64| -> f64 {
            let points: Vec<(f64, f64)> = beyond
                .iter()
                .map(|r| (r.coordinates as f64, cost(r)))
                .collect();
            exponent(&points)
        };
        let found = [
            of(|r| r.equilibrium),
            of(|r| r.iteration.max(1e-9)),
            of(|r| r.stiffness),
        ];
        println!(
            "\nExponents from 100 to 1000 coordinates: equilibrium {:.2}, iteration {:.2}, K_C {:.2}",
            found[0], found[1], found[2]
        );
        exponents.push(found[0]);
    }
    // A timing has two digits at most.
    let measured = (largest(exponents) * 100.0).round() / 100.0;
    let figure = json!({
        "name": "cost of an equilibrium: growth exponent from 100 to 1000 coordinates, worst of five chains",
        "measured": measured,
        "asked": "at most 1",
        "unit": "exponent",
        "holds": measured <= 1.0,
    });
    println!("\nfigure {figure}");
    other_ways()?;
    many_platforms()
}

/// The cantilever bent far by other ways than its chain alone: as a machine, and along a curve of
/// load factors from rest.
fn other_ways() -> kinetostat::Result<()> {
    println!("\nThe cantilever bent far, ms per state:\n");
    println!(
        "| segments | chain | machine | against the chain | points | curve | against the chain |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|");
    let mut worst = <[Worst; 2]>::default();
    for segments in [32, 64, 100, 200] {
        let chain = long::soft_cantilever(6 * segments);
        let problem = long::problem(&chain, long::Asked::BentFar);
        let alone = shortest(|| solve_chain(&problem, &Settings::default()));
        let home = Pose::translation(1.0, 0.0, 0.0);
        let machine = Mechanism::serial(chain.clone(), home, Vector3::zeros())?;
        let posture = machine.posture(&home)?;
        let wrench = problem.end.wrench;
        let solved = shortest(|| posture.deflected_by(&wrench));
        let mut still = problem.clone();
        still.end.wrench = Wrench::zero();
        let rest = solve_chain(&still, &Settings::default())?;
        let settings = CurveSettings::within(0.0, 1.0);
        let follow = || {
            follow(
                &still,
                &Parameter::end_wrench(wrench),
                &rest,
                0.0,
                &settings,
            )
        };
        let points: usize = follow()?.branches.iter().map(|b| b.points.len()).sum();
        let state = shorter(follow) / points as f64;
        let against = [solved / alone, state / alone];
        println!(
            "| {segments} | {:.2} | {:.2} | {:.2} | {points} | {:.2} | {:.2} |",
            alone * 1e3,
            solved * 1e3,
            against[0],
            state * 1e3,
            against[1]
        );
        worst[0].add(against[0]);
        worst[1].add(against[1]);
    }
    for (way, worst) in ["a machine's equilibrium", "a point of a curve"]
        .iter()
        .zip(worst)
    {
        let measured = (worst.value() * 100.0).round() / 100.0;
        let figure = json!({
            "name": format!("cantilever of 32 to 200 segments bent far: {way} against one of its chain"),
            "measured": measured,
            "asked": "at most 2",
            "unit": "times",
            "holds": measured <= 2.0,
        });
        println!("\nfigure {figure}");
    }
    Ok(())
}

/// Time of one run, s: the shorter of two batches, of one run each where that takes long enough.
fn shorter<T>(run: impl FnMut() -> T) -> f64 {
    of_batches(2, 1, run)
}

fn many_platforms() -> kinetostat::Result<()> {
    let wrench = Wrench::new(vector![3.0, -2.0, 5.0], vector![0.4, 0.2, -0.5]);
    for (name, columns) in [
        ("Platforms in series, six legs each", 1),
        ("Platforms in a lattice six wide", 6),
    ] {
        println!("\n{name}:\n");
        println!(
            "| platforms | limbs | ms per K_C | iterations | ms per equilibrium | ms per IK |"
        );
        println!("|---:|---:|---:|---:|---:|---:|");
        let mut rows = Vec::new();
        for size in [15, 30, 60, 120, 240] {
            let machine = platforms::lattice(size / columns, columns, false)?;
            let home = machine.platforms()[machine.tool()].home;
            let posture = machine.posture(&home)?;
            let iterations = posture.deflected_by(&wrench)?.residual.iterations;
            let aside = Twist::new(vector![0.01, 0.0, 0.01], Vector3::zeros());
            let target = moved(&home, &aside);
            let times = [
                shorter(|| posture.stiffness()),
                shorter(|| posture.deflected_by(&wrench)),
                shorter(|| machine.posture(PostureRequest::pose(&target).near(&posture))),
            ];
            let [stiffness, equilibrium, search] = times.map(|t| 1e3 * t);
            let (count, limbs) = (machine.platforms().len() - 1, machine.limbs().len());
            println!(
                "| {count} | {limbs} | {stiffness:.1} | {iterations} | {equilibrium:.1} | {search:.0} |"
            );
            if count >= 30 {
                rows.push((
                    count as f64,
                    [times[0], times[1] / iterations.max(1) as f64, times[2]],
                ));
            }
        }
        let of = |k: usize| {
            let points: Vec<(f64, f64)> = rows.iter().map(|(n, t)| (*n, t[k])).collect();
            exponent(&points)
        };
        println!(
            "\nExponents from 30 to 240 platforms: K_C {:.2}, equilibrium per iteration {:.2}, IK {:.2}",
            of(0),
            of(1),
            of(2)
        );
        let measured = (of(1) * 100.0).round() / 100.0;
        let figure = json!({
            "name": format!("cost of an equilibrium per iteration, {}: growth exponent from 30 to 240", name.to_lowercase()),
            "measured": measured,
            "asked": "at most 1.5",
            "unit": "exponent",
            "holds": measured <= 1.5,
        });
        println!("\nfigure {figure}");
    }
    Ok(())
}

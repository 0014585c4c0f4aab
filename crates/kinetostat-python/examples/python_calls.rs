//! Times of the calls that `benches/python/overhead.py` times through Python, as one line of JSON.
//! The arguments: positions (m) a line on the standard input.

#![allow(clippy::print_stdout, reason = "the line is what was asked for")]

use std::hint::black_box;
use std::time::Instant;

use anyhow::{Context, Result};
use kinetostat::batch::{Batch, Details};
use kinetostat::{Pose, Posture, PostureRequest, Wrench};
use nalgebra::{Vector3, Vector6};

/// The same load as in `overhead.py`.
const WRENCH: [f64; 6] = [100.0, -20.0, -30.0, 0.0, 0.0, 0.0];

fn main() -> Result<()> {
    let machine = kinetostat_model::Model::preset("orthoglide")?.mechanism;
    let home = machine.platforms()[machine.tool()].home;
    let poses = std::io::read_to_string(std::io::stdin())?
        .lines()
        .map(|line| place(line, &home))
        .collect::<Result<Vec<Pose>>>()?;
    let load = Wrench(Vector6::from(WRENCH));
    // A small machine, beside whose time a few microseconds are seen.
    let small = kinetostat_model::Model::preset("two_link")?.mechanism;
    let at_home = small.platforms()[small.tool()].home;
    let posture: Posture = small.posture(PostureRequest::pose(&at_home))?;
    let one_stiffness = shortest(2000, || posture.stiffness());
    // The small one folds over under a load.
    let posture: Posture = machine.posture(PostureRequest::pose(&poses[0]))?;
    let one_equilibrium = shortest(500, || posture.deflected_by(&load));
    let batch = Batch::new(&machine);
    let loads = vec![load; poses.len()];
    // One thread, as there.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let (many_stiffness, many_equilibria) = alone.install(|| {
        (
            shortest(1, || batch.stiffness(&poses)),
            shortest(1, || batch.equilibrium(&poses, &loads, Details::Stability)),
        )
    });
    let each = 1.0 / poses.len() as f64;
    println!(
        "{{\"one_stiffness_us\": {one_stiffness}, \"one_equilibrium_us\": {one_equilibrium}, \"many_stiffness_us\": {}, \
         \"many_equilibria_us\": {}}}",
        many_stiffness * each,
        many_equilibria * each
    );
    Ok(())
}

fn place(line: &str, home: &Pose) -> Result<Pose> {
    let mut at = Vector3::zeros();
    for (to, word) in at.iter_mut().zip(line.split_whitespace()) {
        *to = word
            .parse()
            .with_context(|| format!("'{word}' is no number"))?;
    }
    Ok(Pose::from_parts(at.into(), home.rotation))
}

/// Shortest time of a call among several rounds, us.
fn shortest<T>(calls: u32, mut call: impl FnMut() -> T) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..7 {
        let start = Instant::now();
        for _ in 0..calls {
            black_box(call());
        }
        best = best.min(start.elapsed().as_secs_f64() * 1e6 / f64::from(calls));
    }
    best
}

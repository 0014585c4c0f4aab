//! Times the calls that `benches/python/overhead.py` times through Python. The argument: the
//! model file of the small machine. Standard input: one line with the positions (m, three
//! numbers each, parted by `;`), then a line for each timing, the call's name and how often; answered by the time of one call, us.

#![allow(clippy::print_stdout, reason = "the lines are what was asked for")]

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use kinetostat::batch::{Batch, Details};
use kinetostat::{Pose, Posture, PostureRequest, Wrench};
use nalgebra::{Vector3, Vector6};

/// The same load as in `overhead.py`.
const WRENCH: [f64; 6] = [100.0, -20.0, -30.0, 0.0, 0.0, 0.0];

fn main() -> Result<()> {
    let machine = kinetostat_model::Model::preset("orthoglide")?.mechanism;
    let home = machine.platforms()[machine.tool()].home;
    let mut asked = std::io::stdin().lines();
    let places = asked.next().context("no places")??;
    let poses = places
        .split(';')
        .map(|words| place(words, &home))
        .collect::<Result<Vec<Pose>>>()?;
    let load = Wrench(Vector6::from(WRENCH));
    let file = std::env::args_os().nth(1).context("no small machine")?;
    let small = kinetostat_model::read_model(Path::new(&file))?.mechanism;
    let at_home = small.platforms()[small.tool()].home;
    let small: Posture = small.posture(PostureRequest::pose(&at_home))?;
    let large: Posture = machine.posture(PostureRequest::pose(&poses[0]))?;
    let batch = Batch::new(&machine);
    let loads = vec![load; poses.len()];
    let each = poses.len() as f64;
    // One thread, as there.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for line in asked {
        let line = line?;
        let (what, calls) = line.split_once(' ').context("a call and how often")?;
        let calls = calls.parse()?;
        let microseconds = match what {
            "one_stiffness" => time(calls, || small.stiffness()),
            "one_equilibrium" => time(calls, || small.deflected_by(&load)),
            "one_of_orthoglide" => time(calls, || large.deflected_by(&load)),
            "many_stiffness" => alone.install(|| time(calls, || batch.stiffness(&poses)) / each),
            "many_equilibria" => alone.install(|| {
                time(calls, || {
                    batch.equilibrium(&poses, &loads, Details::Stability)
                }) / each
            }),
            other => bail!("no call '{other}'"),
        };
        println!("{microseconds}");
    }
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

/// Time of one of so many calls, us.
fn time<T>(calls: u32, mut call: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    for _ in 0..calls {
        black_box(call());
    }
    start.elapsed().as_secs_f64() * 1e6 / f64::from(calls)
}

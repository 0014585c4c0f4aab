//! One posture per call, and two threads.

use anyhow::Result;
use kinetostat_bench::Work;

use crate::machines::{ARM, HEXAPOD, Machine, PUU3};
use crate::{BLOCK, at_least, at_most, pass, shortest};

const WORKS: [(&str, Machine, Work); 5] = [
    ("W1", ARM, Work::StiffnessAndJacobian),
    ("W2", HEXAPOD, Work::Stiffness),
    ("W3", ARM, Work::Equilibrium),
    ("W3+K", ARM, Work::EquilibriumAndStiffness),
    ("W4", PUU3, Work::Equilibrium),
];

/// What one posture costs that is asked alone.
pub fn single() -> Result<()> {
    println!("One posture in each call, us");
    println!("{:<8}{:>10}{:>10}{:>8}", "work", "batch", "single", "ratio");
    let mut figures = Vec::new();
    for (name, machine, work) in &WORKS {
        let task = machine.task(*work, 1024, false)?;
        let (batch, single) = (shortest(&task, BLOCK)?, shortest(&task, 1)?);
        println!(
            "{name:<8}{batch:>10.3}{single:>10.3}{:>8.2}",
            single / batch
        );
        figures.push((format!("{name}: one posture in each call"), single / batch));
    }
    for (name, ratio) in figures {
        at_most(&name, ratio, 4.0, "times the batch");
    }
    println!();
    Ok(())
}

/// Two threads against one.
pub fn two() -> Result<()> {
    let cores = std::thread::available_parallelism()?.get();
    println!("Two threads against one, us per posture ({cores} cores here)");
    println!("{:<8}{:>10}{:>10}{:>8}", "work", "one", "two", "ratio");
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = (pool(1)?, pool(2)?);
    let mut figures = Vec::new();
    for (name, machine, work) in &WORKS {
        let task = machine.task(*work, 32 * BLOCK, false)?;
        // Interleaved; the best of each.
        let (mut one, mut two) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..40 {
            one = one.min(pools.0.install(|| pass(&task, task.len()))?);
            two = two.min(pools.1.install(|| pass(&task, task.len()))?);
        }
        let us = |seconds: f64| seconds / task.len() as f64 * 1e6;
        println!(
            "{name:<8}{:>10.3}{:>10.3}{:>8.2}",
            us(one),
            us(two),
            one / two
        );
        figures.push((format!("{name}: two threads"), one / two));
    }
    for (name, ratio) in figures {
        at_least(&name, ratio, 1.9, "times one thread");
    }
    println!();
    Ok(())
}

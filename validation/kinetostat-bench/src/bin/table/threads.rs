//! One posture per call, and two threads.

use std::time::Instant;

use anyhow::Result;
use kinetostat_bench::{BenchQuantity, Results};

use crate::{BLOCK, median, pass};
use kinetostat_bench::figure::{at_least, at_most};
use kinetostat_bench::machines::{ARM, BenchMachine, HEXAPOD, LinkLaw, PUU3};

/// Approximate time of a call for two threads, us: long against waking a thread, short enough that other programs
/// leave both cores alone now and then.
const PASS: f64 = 4000.0;

const CASES: [(&str, BenchMachine, BenchQuantity); 5] = [
    ("W1", ARM, BenchQuantity::StiffnessAndJacobian),
    ("W2", HEXAPOD, BenchQuantity::Stiffness),
    ("W3", ARM, BenchQuantity::Equilibrium),
    ("W3+K", ARM, BenchQuantity::EquilibriumAndStiffness),
    ("W4", PUU3, BenchQuantity::Equilibrium),
];

/// Cost of one posture that is solved by itself.
pub fn single() -> Result<()> {
    println!("One posture in each call, us");
    println!("{:<8}{:>10}{:>10}{:>8}", "work", "batch", "single", "ratio");
    let mut figures = Vec::new();
    for (name, machine, quantity) in &CASES {
        let batch = median(&machine.task(*quantity, 2 * BLOCK, LinkLaw::Plain)?, BLOCK)?;
        let single = median(&machine.task(*quantity, 64, LinkLaw::Plain)?, 1)?;
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

/// Results of many postures at once, of two threads against one.
pub fn two() -> Result<()> {
    let cores = std::thread::available_parallelism()?.get();
    println!("Two threads against one, many postures in each call, us each ({cores} cores here)");
    println!(
        "{:<8}{:>10}{:>10}{:>10}{:>8}",
        "work", "postures", "one", "two", "ratio"
    );
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = (pool(1)?, pool(2)?);
    let mut figures = Vec::new();
    for (name, machine, quantity) in &CASES {
        let each = median(&machine.task(*quantity, BLOCK, LinkLaw::Plain)?, BLOCK)?;
        let many = ((PASS / each / BLOCK as f64) as usize).clamp(4, 32) * BLOCK;
        let task = machine.task(*quantity, many, LinkLaw::Plain)?;
        let mut results = Results::default();
        // Interleaved, and the best of each: both cores are seldom free at once.
        let (mut one, mut two) = (f64::INFINITY, f64::INFINITY);
        let start = Instant::now();
        while start.elapsed().as_secs_f64() < 3.0 {
            one = one.min(pools.0.install(|| pass(&task, many, &mut results))?);
            two = two.min(pools.1.install(|| pass(&task, many, &mut results))?);
        }
        let us = |seconds: f64| seconds / task.len() as f64 * 1e6;
        println!(
            "{name:<8}{many:>10}{:>10.3}{:>10.3}{:>8.2}",
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

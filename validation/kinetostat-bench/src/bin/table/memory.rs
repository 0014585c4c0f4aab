//! Memory of a million postures that are streamed.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use kinetostat::Wrench;
use kinetostat::batch::Batch;
use kinetostat_bench::sample;
use nalgebra::Vector6;

use kinetostat_bench::figure::at_most;
use kinetostat_bench::machines::path;

const MANY: usize = 1_000_000;

/// Goes through a million postures block by block; for a process of its own.
pub fn stream() -> Result<()> {
    let model = kinetostat_model::read_model(&path("arm"))?;
    let batch = Batch::new(&model.mechanism);
    let mut sum = 0.0;
    for from in (0..MANY).step_by(1000) {
        let items = from..from + 1000;
        let joints = sample::joints(items.clone(), 6, 1.0);
        let numbers = sample::wrenches(items, 2000.0, 300.0);
        let wrenches: Vec<Wrench> = numbers
            .chunks(6)
            .map(|row| Wrench(Vector6::from_column_slice(row)))
            .collect();
        let answer = batch.equilibrium_at_joints(
            &joints,
            &wrenches,
            kinetostat::batch::Details::Stiffness,
        )?;
        for i in 0..answer.tool.len() {
            sum += answer.tool.get(i, 9);
        }
    }
    ensure!(sum.is_finite(), "a posture has no equilibrium");
    let status = std::fs::read_to_string("/proc/self/status")
        .context("this system does not tell what memory a process had")?;
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    println!("{}", most.context("no VmHWM")?.trim());
    Ok(())
}

/// Peak memory of such a process.
pub fn table() -> Result<()> {
    let output = Command::new(std::env::current_exe()?)
        .arg("million")
        .output()?;
    if !cfg!(target_os = "linux") {
        println!("peak memory of 1e6 postures: only Linux tells");
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "a million postures failed: {said}");
    let text = String::from_utf8_lossy(&output.stdout);
    let number = text
        .split_whitespace()
        .next()
        .and_then(|w| w.parse::<f64>().ok());
    ensure!(number.is_some(), "no number in '{text}'");
    let megabytes = number.unwrap_or(f64::NAN) / 1024.0;
    println!("peak memory of 1e6 postures streamed, equilibrium and K_C: {megabytes:.0} MB");
    at_most("peak memory of 1e6 postures", megabytes, 200.0, "MB");
    Ok(())
}

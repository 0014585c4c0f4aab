//! Machines of different shapes in one table, with plain and with bowing links.

use anyhow::{Result, ensure};
use kinetostat_bench::BenchQuantity;

use crate::{BLOCK, median};
use kinetostat_bench::machines::{ALL, LinkLaw};

const POSTURES: usize = 1024;
/// A machine whose postures are solved one by one gets fewer of them.
const FEW: usize = 16;

pub fn table() -> Result<()> {
    println!(
        "One thread, blocks of {BLOCK} postures; us of processor time per posture, and ns per posture and spring"
    );
    println!(
        "{:<34}{:>8}{:>12}{:>8}{:>14}{:>8}{:>16}{:>8}  scalar",
        "machine (and with bowing links)",
        "springs",
        "K_C (and J)",
        "each",
        "equilibrium",
        "each",
        "equil. and K_C",
        "each"
    );
    for machine in &ALL {
        for links in [LinkLaw::Plain, LinkLaw::Bowing] {
            let name = match links {
                LinkLaw::Plain => machine.what,
                LinkLaw::Bowing => "  bowing",
            };
            print!("{name:<34}{:>8}", machine.springs);
            let quantities = [
                machine.unloaded(),
                BenchQuantity::Equilibrium,
                BenchQuantity::EquilibriumAndStiffness,
            ];
            let mut scalar_counts = Vec::new();
            for (quantity, width) in quantities.into_iter().zip([12, 14, 16]) {
                let mostly_scalar =
                    machine.task(quantity, FEW, links)?.not_vectorised(BLOCK)?.0 > FEW / 2;
                let count = if mostly_scalar { FEW } else { POSTURES };
                let task = machine.task(quantity, count, links)?;
                let time = median(&task, BLOCK)?;
                let each = time * 1e3 / machine.springs as f64;
                print!("{time:>width$.3}{each:>8.1}");
                let (scalar, not_found) = task.not_vectorised(BLOCK)?;
                ensure!(
                    not_found == 0,
                    "{not_found} postures of {name} are not found"
                );
                scalar_counts.push(format!("{scalar}/{count}"));
            }
            println!("  {}", scalar_counts.join(" "));
        }
    }
    println!();
    Ok(())
}

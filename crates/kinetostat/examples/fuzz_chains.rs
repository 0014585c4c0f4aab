//! Random chains under random loads through every query, struts, stiffness ratios and stiff links with
//! known answers, for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_chains MINUTES SEED [COUNT]`, or `fuzz_chains case SEED` to repeat one case and show it.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::needless_range_loop,
    dead_code,
    reason = "a tool for developers; modules are shared with the tests"
)]

#[path = "../tests/fuzz/mod.rs"]
mod fuzz;
#[path = "../tests/oracle/mod.rs"]
mod oracle;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Coordinates of the largest chains.
const LARGEST: usize = 40;
/// A case that takes longer is reported as a fault.
const PATIENCE: Duration = Duration::from_secs(60);

fn main() -> std::process::ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [first, seed] = words.as_slice()
        && first == "case"
    {
        let seed = seed.parse().unwrap();
        println!("{}", fuzz::describe(seed, LARGEST));
        println!("{:?}", fuzz::run(seed, LARGEST));
        return std::process::ExitCode::SUCCESS;
    }
    let number = |i: usize, otherwise: f64| {
        let word = words.get(i).and_then(|w| w.parse::<f64>().ok());
        word.unwrap_or(otherwise)
    };
    let minutes = number(0, 10.0);
    let first = number(1, 1.0) as u64;
    let most = number(2, f64::INFINITY);
    // Panics are caught, reported with their seed, and not printed twice.
    std::panic::set_hook(Box::new(|_| {}));
    let now = Arc::new(AtomicU64::new(first));
    watch(&now);
    let start = Instant::now();
    let (mut seed, mut cases, mut faults) = (first, 0_u64, Vec::new());
    let mut all = fuzz::Outcome::default();
    while start.elapsed().as_secs_f64() < 60.0 * minutes && (cases as f64) < most {
        now.store(seed, Ordering::Relaxed);
        match fuzz::run(seed, LARGEST) {
            Ok(outcome) => all.add(outcome),
            Err(fault) => {
                println!("fault: {fault}");
                faults.push(seed);
            }
        }
        (seed, cases) = (seed + 1, cases + 1);
    }
    let spent = start.elapsed().as_secs_f64() / 60.0;
    println!("{all:?}");
    println!(
        "{cases} cases from seed {first} in {spent:.2} minutes ({:.0} per minute), faults: {} {faults:?}",
        cases as f64 / spent,
        faults.len()
    );
    println!(
        "figure {{\"name\":\"fuzz: random chains without panic or NaN\",\"measured\":{cases},\"asked\":\"no fault\",\"unit\":\"chains to {LARGEST} coordinates, {} faults\",\"holds\":{}}}",
        faults.len(),
        faults.is_empty()
    );
    if faults.is_empty() {
        std::process::ExitCode::SUCCESS
    } else {
        std::process::ExitCode::FAILURE
    }
}

/// Ends the program with the seed where one case takes too long.
fn watch(now: &Arc<AtomicU64>) {
    let now = Arc::clone(now);
    std::thread::spawn(move || {
        let (mut seed, mut since) = (now.load(Ordering::Relaxed), Instant::now());
        loop {
            std::thread::sleep(Duration::from_millis(500));
            let present = now.load(Ordering::Relaxed);
            if present != seed {
                (seed, since) = (present, Instant::now());
            } else if since.elapsed() > PATIENCE {
                println!("fault: seed {seed} takes longer than {PATIENCE:?}");
                std::process::exit(2);
            }
        }
    });
}

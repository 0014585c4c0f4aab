//! `cargo xtask long`: programs of millions of blocks, their memory and growth, killed and gone on with. A soak, not for CI.
//! `cargo xtask figures --long` measures rates and files of shorter ones.

use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::figures::{Figure, data};
use crate::{cargo, root, step};

/// `--blocks N` (5 000 000) and `--kills K` (20).
///
/// # Errors
/// A run that fails, other bytes after a kill, memory or growth beyond what is asked.
#[allow(clippy::print_stdout)] // figures are the output that was requested
pub fn run(options: &[&str]) -> Result<()> {
    let (mut blocks, mut kills) = (5_000_000_usize, 20_u64);
    for pair in options.chunks(2) {
        match pair {
            ["--blocks", count] => blocks = count.parse().context("--blocks")?,
            ["--kills", count] => kills = count.parse().context("--kills")?,
            _ => bail!("cargo xtask long [--blocks N] [--kills K]"),
        }
    }
    let build = ["build", "--release", "-p", "kinetostat-cli"];
    step("long: release build", cargo().args(build))?;
    let here = root().join("target/long");
    fs::create_dir_all(&here)?;
    let mut times = Vec::new();
    for share in [100, 10, 1] {
        let count = blocks / share;
        surface(&here.join(format!("{count}.ngc")), count)?;
        eprintln!("== long: {count} blocks");
        let used = run_once(&here, &question(&here, count, "whole.ngc", MACHINE, 1))?;
        let (seconds, memory_mb) = (used.user_s, used.memory_mb);
        println!(
            r#"figure {{"name": "long program: memory with {count} blocks", "measured": {memory_mb:.0}, "asked": 300, "unit": "MB", "holds": {}}}"#,
            memory_mb < 300.0
        );
        times.push((count as f64, seconds));
    }
    let ((a, first), (b, last)) = (times[0], times[2]);
    let growth = (last / first).ln() / (b / a).ln();
    println!(
        r#"figure {{"name": "long program: growth of the time", "measured": {growth:.3}, "asked": 1.03, "unit": "exponent", "holds": {}}}"#,
        (growth - 1.0).abs() <= 0.03
    );
    rate("orthoglide", b / last, 1e5);
    killed(&here, blocks, kills, times[2].1)?;
    let count = blocks / 10;
    let used = run_once(&here, &question(&here, count, "whole.ngc", ARM, 1))?;
    rate("heavy_6r", count as f64 / used.user_s, 3e4);
    Ok(())
}

/// Blocks of the programs whose rates are measured without the soak.
const BLOCKS: usize = 1_000_000;

/// Runs of which the median counts.
const RUNS: usize = 5;

/// Two threads are to be so many times as fast as one: nearly twice.
const TWO_THREADS: f64 = 1.8;

/// A value of the table of points takes at most this, bytes.
const CELL: f64 = 25.0;

/// Rates, memory and the table of points of a surface, and the processor time of a pocket.
///
/// # Errors
/// A run that fails.
pub fn measured(figures: &mut Vec<Figure>) -> Result<()> {
    let here = root().join("target/long");
    fs::create_dir_all(&here)?;
    surface(&here.join(format!("{BLOCKS}.ngc")), BLOCKS)?;
    for (model, machine, asked) in [("orthoglide", MACHINE, 1e5), ("heavy_6r", ARM, 3e4)] {
        let run = |threads: usize| {
            let words = question(&here, BLOCKS, "whole.ngc", machine, threads);
            run_once(&here, &words)
        };
        let (two, used) = (run(2)?, run(1)?);
        let name = format!("surface of {BLOCKS} blocks on {model}, one core");
        let rate = BLOCKS as f64 / used.processor_s();
        let blocks = format!("{name}: blocks a second");
        figures.push(Figure::at_least(blocks, rate, asked, "1/s"));
        let name_of_two = format!("surface of {BLOCKS} blocks on {model}: two threads");
        let times = used.wall_s / two.wall_s;
        figures.push(Figure::at_least(
            name_of_two,
            times,
            TWO_THREADS,
            "times one thread",
        ));
        let memory = format!("{name}: peak memory");
        figures.push(Figure::at_most(memory, used.memory_mb, 300.0, "MB"));
        let table = fs::read_to_string(here.join("whole.csv"))?;
        let cells = table.bytes().filter(|b| matches!(b, b',' | b'\n')).count();
        let cell = table.len() as f64 / cells as f64;
        let value = format!("{name}: a value of the table of points");
        figures.push(Figure::at_most(value, cell, CELL, "bytes"));
    }
    let Some(data) = data() else {
        eprintln!(
            "skipped: no ../shared/data, so the processor time of tball-pocket is not measured"
        );
        return Ok(());
    };
    let words = "compensate --model orthoglide --tool-length-mm 100 --part-origin-mm -60 70 100 --milling 215 -10 -25 --force-overwrite";
    let mut all: Vec<String> = words.split(' ').map(str::to_owned).collect();
    for (option, path) in [
        ("--program", data.join("tball-pocket.gcode")),
        ("--out", here.join("pocket.ngc")),
    ] {
        all.extend([option.to_owned(), path.display().to_string()]);
    }
    let runs = (0..RUNS).map(|_| run_once(&here, &all));
    let runs: Result<Vec<Used>> = runs.collect();
    let mut times: Vec<f64> = runs?.iter().map(Used::processor_s).collect();
    times.sort_by(f64::total_cmp);
    let name = format!("tball-pocket with milling load: processor time, median of {RUNS}");
    figures.push(Figure::at_most(name, times[RUNS / 2], 1.5, "s"));
    Ok(())
}

/// Resources used by a run.
struct Used {
    user_s: f64,
    system_s: f64,
    memory_mb: f64,
    wall_s: f64,
}

impl Used {
    fn processor_s(&self) -> f64 {
        self.user_s + self.system_s
    }
}

/// Blocks read, corrected, solved again and written in a second of one core.
#[allow(clippy::print_stdout)]
fn rate(model: &str, measured: f64, asked: f64) {
    println!(
        r#"figure {{"name": "long program on {model}: blocks a second on one core", "measured": {measured:.0}, "asked": {asked:.0}, "unit": "1/s", "holds": {}}}"#,
        measured >= asked
    );
}

/// A surface in zigzag of so many blocks.
fn surface(path: &Path, blocks: usize) -> Result<()> {
    let mut file = BufWriter::new(fs::File::create(path)?);
    writeln!(file, "G21 G90 G17\nG0 X-20 Y-20 Z5\nG1 Z0 F300")?;
    let row = 2000;
    let rows = blocks.div_ceil(row) as f64;
    for block in 0..blocks {
        let (line, at) = (block / row, block % row);
        let x = -20.0
            + 40.0
                * (if line.is_multiple_of(2) {
                    at
                } else {
                    row - 1 - at
                }) as f64
                / row as f64;
        let y = -20.0 + 40.0 * line as f64 / rows;
        let z = 2.0 * (0.2 * x).sin() * (0.15 * y).cos();
        writeln!(file, "G1 X{x:.4} Y{y:.4} Z{z:.4} F1200")?;
    }
    writeln!(file, "G0 Z5\nM2")?;
    file.flush()?;
    Ok(())
}

/// The machine that is killed, and an arm.
const MACHINE: &str =
    "--model orthoglide --tool-length-mm 100 --part-origin-mm 0 0 100 --tolerance-um 5";
const ARM: &str =
    "--model heavy_6r --tool-length-mm 200 --part-origin-mm 1450 70 500 --tolerance-um 20";

fn question(here: &Path, blocks: usize, out: &str, machine: &str, threads: usize) -> Vec<String> {
    let program = here.join(format!("{blocks}.ngc"));
    let out = here.join(out);
    let words =
        format!("compensate {machine} --milling 100 -10 -25 --threads {threads} --force-overwrite");
    let mut all: Vec<String> = words.split(' ').map(str::to_owned).collect();
    for (option, path) in [
        ("--program", &program),
        ("--out", &out),
        ("--points", &out.with_extension("csv")),
    ] {
        all.extend([option.to_owned(), path.display().to_string()]);
    }
    all
}

fn binary() -> std::path::PathBuf {
    root().join("target/release/kinetostat")
}

/// The processor time and the peak memory of a run that is not interrupted.
fn run_once(here: &Path, words: &[String]) -> Result<Used> {
    for end in ["ngc", "csv"] {
        let _ = fs::remove_file(here.join(format!("whole.{end}")));
    }
    let done = Command::new("/usr/bin/time")
        .args(["-f", "figures %U %S %M %e"])
        .arg(binary())
        .args(words)
        .stdout(Stdio::null())
        .output()
        .context("/usr/bin/time")?;
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    let figures = said.lines().find_map(|line| line.strip_prefix("figures "));
    let numbers = figures.map(|line| {
        line.split(' ')
            .map(str::parse::<f64>)
            .collect::<Result<Vec<_>, _>>()
    });
    match numbers {
        Some(Ok(found)) if done.status.success() && found.len() == 4 => Ok(Used {
            user_s: found[0],
            system_s: found[1],
            memory_mb: found[2] / 1024.0,
            wall_s: found[3],
        }),
        _ => bail!("{said}"),
    }
}

/// A run that is killed works on parts side by side; the one that it is compared with does not.
const KILLED_THREADS: usize = 2;

/// Killed at moments over the length of a run, and gone on with.
#[allow(clippy::print_stdout)] // figures are the output that was requested
fn killed(here: &Path, blocks: usize, kills: u64, seconds: f64) -> Result<()> {
    eprintln!("== long: killed {kills} times");
    for end in ["ngc", "csv"] {
        let _ = fs::remove_file(here.join(format!("killed.{end}")));
    }
    let began = Instant::now();
    let mut done = 0;
    for kill in 0..=kills {
        let mut child = Command::new(binary())
            .args(question(
                here,
                blocks,
                "killed.ngc",
                MACHINE,
                KILLED_THREADS,
            ))
            .stdout(Stdio::null())
            .spawn()?;
        if kill < kills {
            // Moments without a pattern: golden section.
            let part = (0.618_034 * (kill + 1) as f64).fract();
            std::thread::sleep(Duration::from_secs_f64(2.0 * part * seconds / kills as f64));
            child.kill()?;
            done += u64::from(!child.wait()?.success());
        } else if !child.wait()?.success() {
            bail!("the run that goes on failed");
        }
    }
    let same = ["ngc", "csv"].iter().all(|end| {
        let read = |name: &str| fs::read(here.join(format!("{name}.{end}"))).ok();
        read("whole").is_some() && read("whole") == read("killed")
    });
    println!(
        r#"figure {{"name": "long program: kills after which the bytes are the same", "measured": {}, "asked": {kills}, "unit": "kills", "holds": {same}}}"#,
        if same { done } else { 0 }
    );
    eprintln!("== long: {:.0} s", began.elapsed().as_secs_f64());
    match same {
        true => Ok(()),
        false => bail!("other bytes after kills"),
    }
}

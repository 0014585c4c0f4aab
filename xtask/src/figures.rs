//! `cargo xtask figures`: every number that the issues ask for, measured now. Nothing is stored:
//! programs are run, and the golden tests print what they reached.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{bench, builds, cargo, counts, cutting, long, programs, python, root, step};

/// One number.
#[derive(Debug, Serialize, Deserialize)]
pub struct Figure {
    name: String,
    measured: Value,
    asked: String,
    unit: String,
    holds: bool,
}

impl Figure {
    pub fn at_most(name: impl Into<String>, measured: f64, most: f64, unit: &str) -> Self {
        Self {
            name: name.into(),
            measured: measured.into(),
            asked: format!("at most {most}"),
            unit: unit.into(),
            holds: measured <= most,
        }
    }

    pub fn at_least(name: impl Into<String>, measured: f64, least: f64, unit: &str) -> Self {
        Self {
            name: name.into(),
            measured: measured.into(),
            asked: format!("at least {least}"),
            unit: unit.into(),
            holds: measured >= least,
        }
    }

    pub fn yes(name: impl Into<String>, holds: bool) -> Self {
        Self {
            name: name.into(),
            measured: holds.into(),
            asked: "yes".into(),
            unit: "yes or no".into(),
            holds,
        }
    }
}

/// A folder that goes away with the value.
pub struct Scratch(pub PathBuf);

impl Scratch {
    pub fn new(name: &str) -> Result<Self> {
        let path =
            std::env::temp_dir().join(format!("kinetostat-figures-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).with_context(|| format!("cannot make {}", path.display()))?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Resources used by a finished command, and its output.
pub struct Used {
    pub seconds: f64,
    /// Largest resident memory, MB, where the system tells.
    memory_mb: Option<f64>,
    pub success: bool,
    pub stdout: String,
    pub stderr: String,
}

fn program() -> PathBuf {
    let folder =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    folder.join("release").join("kinetostat")
}

pub fn measure(folder: &Path, arguments: &[&str]) -> Result<Used> {
    let start = Instant::now();
    let mut child = Command::new(program())
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .context("cannot start kinetostat")?;
    let status = PathBuf::from(format!("/proc/{}/status", child.id()));
    let mut memory_mb: Option<f64> = None;
    let (mut out, mut err) = (child.stdout.take(), child.stderr.take());
    let read = |pipe: Option<Box<dyn std::io::Read + Send>>| {
        std::thread::spawn(move || {
            let mut text = String::new();
            if let Some(mut pipe) = pipe {
                let _ = std::io::Read::read_to_string(&mut pipe, &mut text);
            }
            text
        })
    };
    let stdout = read(out.take().map(|p| Box::new(p) as _));
    let stderr = read(err.take().map(|p| Box::new(p) as _));
    let exit = loop {
        if let Ok(text) = fs::read_to_string(&status)
            && let Some(line) = text.lines().find(|l| l.starts_with("VmHWM:"))
            && let Some(kilobytes) = line
                .split_whitespace()
                .nth(1)
                .and_then(|w| w.parse::<f64>().ok())
        {
            memory_mb = Some(memory_mb.unwrap_or(0.0).max(kilobytes / 1024.0));
        }
        if let Some(exit) = child.try_wait()? {
            break exit;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    Ok(Used {
        seconds: start.elapsed().as_secs_f64(),
        memory_mb,
        success: exit.success(),
        stdout: stdout.join().unwrap_or_default(),
        stderr: stderr.join().unwrap_or_default(),
    })
}

/// Adds the figures of a part.
type Measure = fn(&mut Vec<Figure>) -> Result<()>;

/// Measures everything and prints it.
#[allow(clippy::print_stdout)] // this is the output that was requested
pub fn run(options: &[&str]) -> Result<()> {
    let (mut json, mut quick, mut only) = (false, false, None);
    for option in options {
        match *option {
            "--json" => json = true,
            "--quick" => quick = true,
            "--builds" => only = Some(builds::measured as Measure),
            "--long" => only = Some(long::measured as Measure),
            "--cutting" => only = Some(cutting::measured as Measure),
            "--python" => only = Some(python::measured as Measure),
            "--programs" => only = Some(programs::measured as Measure),
            other => bail!(
                "figures: unknown option {other}; there are --json, --quick, --builds, --cutting, --long, --programs and --python"
            ),
        }
    }
    let all: [Measure; 12] = [
        demo,
        pocket,
        long::measured,
        maps,
        real_programs,
        |figures| golden(figures, &GOLDEN),
        cutting::measured,
        programs::measured,
        python::measured,
        cost_growth,
        speed,
        vibrations,
    ];
    let mut parts: Vec<Measure> = only.map_or_else(|| all.to_vec(), |part| vec![part]);
    if only.is_none() && !quick {
        parts.push(clean_clone);
    }
    step(
        "build",
        cargo().args(["build", "--release", "--quiet", "-p", "kinetostat-cli"]),
    )?;
    let mut figures = Vec::new();
    for part in parts {
        let known = figures.len();
        part(&mut figures)?;
        // All of them take half an hour: what is measured is shown.
        if !json {
            print(&figures[known..]);
        }
    }
    if json {
        println!("{}", serde_json::to_string_pretty(&figures)?);
    }
    Ok(())
}

#[allow(clippy::print_stdout)] // this is the output that was requested
fn print(figures: &[Figure]) {
    for f in figures {
        let measured = match &f.measured {
            Value::Number(n) => n
                .as_f64()
                .map_or_else(|| n.to_string(), |x| format!("{x:.4e}")),
            other => other.to_string(),
        };
        let mark = if f.holds { "holds" } else { "FALLS SHORT" };
        println!(
            "{:<11} {:<58} {:>12} {:<10} asked: {}",
            mark, f.name, measured, f.unit, f.asked
        );
    }
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or(f64::NAN)
}

fn demo(figures: &mut Vec<Figure>) -> Result<()> {
    let scratch = Scratch::new("demo")?;
    let used = measure(&scratch.0, &["demo"])?;
    if !used.success {
        bail!("the demo failed: {}", used.stderr);
    }
    let folder = scratch.0.join("kinetostat-demo");
    let result: Value = serde_json::from_str(&fs::read_to_string(folder.join("result.json"))?)?;
    let summary = &result["summary"];
    figures.push(Figure::at_most("demo: time", used.seconds, 10.0, "s"));
    figures.push(Figure::at_least(
        "demo: largest position error before",
        number(summary, "max_position_error_before_mm"),
        0.05,
        "mm",
    ));
    figures.push(Figure::at_most(
        "demo: largest position error of the written program",
        number(summary, "max_position_error_after_mm"),
        0.001,
        "mm",
    ));
    figures.push(Figure::at_most(
        "demo: speed along the part, deviation",
        number(summary, "max_speed_deviation_percent"),
        0.1,
        "%",
    ));
    for key in ["converged", "stable"] {
        figures.push(Figure::yes(
            format!("demo: {key}"),
            summary[key] == Value::Bool(true),
        ));
    }
    let files = [
        "original.ngc",
        "compensated.ngc",
        "result.json",
        "points.csv",
        "report.html",
    ];
    let there = files.iter().filter(|f| folder.join(f).is_file()).count();
    figures.push(Figure::at_least(
        "demo: files written",
        there as f64,
        files.len() as f64,
        "files",
    ));
    Ok(())
}

/// Folder of real programs beside the project, where this checkout has one.
pub fn data() -> Option<PathBuf> {
    let folder = root().join("../shared/data/gcode");
    folder.is_dir().then_some(folder)
}

const JOB: &str = r#"schema = 1
model = "orthoglide"
program = "PROGRAM"

[placement]
part_origin_mm = [-60, 70, 100]

[tool]
length_mm = 100

[load]
LOAD

[output]
program = "out.ngc"
json = "result.json"
"#;
const CONSTANT: &str = "force_n = [215, -10, -25]\naxes = \"base\"";
const MILLING: &str = "milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }";

fn pocket_run(
    folder: &Path,
    program: &str,
    load: &str,
    threads: &str,
) -> Result<(Used, Value, Vec<u8>)> {
    for output in ["out.ngc", "result.json"] {
        let _ = fs::remove_file(folder.join(output));
    }
    fs::write(
        folder.join("job.toml"),
        JOB.replace("PROGRAM", program).replace("LOAD", load),
    )?;
    let used = measure(folder, &["compensate", "job.toml", "--threads", threads])?;
    if !used.success {
        bail!(
            "compensate {program} failed: {}{}",
            used.stdout,
            used.stderr
        );
    }
    let result = serde_json::from_str(&fs::read_to_string(folder.join("result.json"))?)?;
    let bytes = fs::read(folder.join("out.ngc"))?;
    Ok((used, result, bytes))
}

fn pocket(figures: &mut Vec<Figure>) -> Result<()> {
    let Some(data) = data() else {
        eprintln!("skipped: no ../shared/data, so the figures of tball-pocket are not measured");
        return Ok(());
    };
    let scratch = Scratch::new("pocket")?;
    let folder = &scratch.0;
    let once = fs::read(data.join("tball-pocket.gcode"))?;
    fs::write(folder.join("once.ngc"), &once)?;
    // The end of the program stands once, at the end.
    let text = String::from_utf8_lossy(&once);
    let open: String = text
        .split_inclusive('\n')
        .filter(|line| !["M2", "M02", "M30"].iter().any(|end| line.trim() == *end))
        .collect();
    fs::write(folder.join("twice.ngc"), open.clone() + &open)?;
    let (used, result, bytes) = pocket_run(folder, "once.ngc", CONSTANT, "2")?;
    let name = "tball-pocket, 40 266 motion blocks on orthoglide";
    figures.push(Figure::at_most(
        format!("{name}: time"),
        used.seconds,
        20.0,
        "s",
    ));
    if let Some(memory) = used.memory_mb {
        figures.push(Figure::at_most(
            format!("{name}: peak memory"),
            memory,
            600.0,
            "MB",
        ));
    }
    let after = number(&result["summary"], "max_position_error_after_mm");
    figures.push(Figure::at_most(
        format!("{name}: residual"),
        after,
        0.001,
        "mm",
    ));
    let (_, turned, _) = pocket_run(folder, "once.ngc", MILLING, "2")?;
    figures.push(Figure::at_most(
        "tball-pocket with a force that turns with the feed: residual",
        number(&turned["summary"], "max_position_error_after_mm"),
        0.001,
        "mm",
    ));
    let (single, _, same) = pocket_run(folder, "once.ngc", CONSTANT, "1")?;
    figures.push(Figure::yes(
        "tball-pocket: one thread and two give the same bytes",
        bytes == same,
    ));
    eprintln!(
        "   one thread {:.1} s, two {:.1} s",
        single.seconds, used.seconds
    );
    let (again, _, _) = pocket_run(folder, "twice.ngc", CONSTANT, "2")?;
    figures.push(Figure::at_most(
        "twice the blocks: time ratio",
        again.seconds / used.seconds,
        2.2,
        "times",
    ));
    Ok(())
}

/// A million postures through the command, unloaded.
fn maps(figures: &mut Vec<Figure>) -> Result<()> {
    let scratch = Scratch::new("map")?;
    let name = "map of 1e6 postures on orthoglide, written to a table";
    let mut tables = Vec::new();
    for threads in ["1", "2"] {
        let arguments = [
            "map",
            "orthoglide",
            "--x",
            "-70",
            "70",
            "100",
            "--y",
            "-70",
            "70",
            "100",
            "--z",
            "-60",
            "60",
            "100",
            "--csv",
            threads,
            "--threads",
            threads,
        ];
        let used = measure(&scratch.0, &arguments)?;
        if !used.success {
            bail!("map failed: {}{}", used.stdout, used.stderr);
        }
        if let Some(memory) = used.memory_mb {
            let name = format!("{name}, threads {threads}: peak memory");
            figures.push(Figure::at_most(name, memory, 200.0, "MB"));
        }
        eprintln!(
            "   a map of 1e6 postures, threads {threads}: {:.1} s",
            used.seconds
        );
        tables.push(fs::read(scratch.0.join(threads))?);
    }
    let same = tables[0] == tables[1];
    figures.push(Figure::yes(
        format!("{name}: one thread and two give the same bytes"),
        same,
    ));
    Ok(())
}

fn real_programs(figures: &mut Vec<Figure>) -> Result<()> {
    let Some(data) = data() else {
        return Ok(());
    };
    let scratch = Scratch::new("programs")?;
    let (mut readable, mut same) = (0, 0);
    let mut names: Vec<PathBuf> = fs::read_dir(&data)?
        .map(|e| Ok(e?.path()))
        .collect::<Result<_>>()?;
    names.sort();
    for path in names
        .iter()
        .filter(|p| p.extension().is_some_and(|e| e == "gcode"))
    {
        if path.ends_with("371373P.gcode") {
            continue;
        }
        readable += 1;
        let out = scratch.0.join(format!("{readable}.ngc"));
        let (from, to) = (path.display().to_string(), out.display().to_string());
        let used = measure(
            &scratch.0,
            &[
                "compensate",
                "--program",
                &from,
                "--no-compensation",
                "--out",
                &to,
            ],
        )?;
        same += usize::from(used.success && fs::read(path)? == fs::read(&out).unwrap_or_default());
    }
    figures.push(Figure::at_least(
        "real programs returned byte for byte without compensation",
        same as f64,
        readable as f64,
        "programs",
    ));
    let refused = |name: &str, words: &[&str]| -> Result<bool> {
        let path = data.join(name).display().to_string();
        let arguments = [
            "compensate",
            "--model",
            "orthoglide",
            "--program",
            &path,
            "--force",
            "215",
            "0",
            "0",
            "--out",
            "x.ngc",
        ];
        let used = measure(&scratch.0, &arguments)?;
        let explained = words.iter().all(|w| used.stderr.contains(w));
        Ok(!used.success && explained && !scratch.0.join("x.ngc").exists())
    };
    figures.push(Figure::yes(
        "371373P.gcode is refused with line and construct",
        refused("371373P.gcode", &["line 5", "G22"])?,
    ));
    figures.push(Figure::yes(
        "Circle_Diamond_Square_Calibration.gcode is refused at its first invalid arc with both radii",
        refused("Circle_Diamond_Square_Calibration.gcode", &["N624", "radius"])?,
    ));
    Ok(())
}

/// Crates whose tests print figures, but for that of the cut, which has figures of its own.
const GOLDEN: [&str; 8] = [
    "kinetostat",
    "kinetostat-cli",
    "kinetostat-model",
    "kinetostat-reproduce",
    "kinetostat-import",
    "kinetostat-links",
    "kinetostat-mirror",
    "kinetostat-analysis",
];

/// Golden and property tests print `figure {json}` for every number that they reached.
pub fn golden(figures: &mut Vec<Figure>, crates: &[&str]) -> Result<()> {
    let output = cargo()
        .args(["test", "--release", "--quiet"])
        .args(crates.iter().flat_map(|name| ["-p", *name]))
        .args(["--", "--nocapture", "--test-threads=2", "figure"])
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .context("cannot run the golden tests")?;
    let mut found = printed(&String::from_utf8_lossy(&output.stdout))?;
    // Tests run side by side: their order is not the same in every run.
    found.sort_by(|a, b| a.name.cmp(&b.name));
    figures.append(&mut found);
    if !output.status.success() {
        figures.push(Figure::yes("golden tests pass", false));
    }
    Ok(())
}

/// The figures in what a test, an example or a script printed.
pub fn printed(text: &str) -> Result<Vec<Figure>> {
    let lines = text.lines().filter_map(|line| {
        let at = line.find("figure {")?;
        let figure = serde_json::from_str(&line[at + 7..])
            .with_context(|| format!("a test printed a figure that cannot be read: {line}"));
        Some(figure)
    });
    lines.collect()
}

/// Growth of the cost of a chain's equilibrium with its length. The tables go to stderr.
fn cost_growth(figures: &mut Vec<Figure>) -> Result<()> {
    tables(figures, &["kinetostat", "--example", "cost_growth"])
}

/// Many postures: beside numpy, one at a time, with two threads, in growing numbers.
fn speed(figures: &mut Vec<Figure>) -> Result<()> {
    if let Err(error) = bench::python() {
        eprintln!("skipped: {error:#}, so speed is not compared with numpy");
    } else {
        for (row, (case, least)) in bench::measured()?.iter().zip(bench::CASES) {
            let name = format!("{case}: times faster than numpy");
            figures.push(Figure::at_least(name, row.ratio, least, "times"));
            let name = format!("{case}: largest relative difference to numpy");
            let apart = row.max_relative_difference;
            figures.push(Figure::at_most(name, apart, 1e-9, "1"));
        }
    }
    if let Some(worst) = counts::worst()? {
        let name = "instructions of a work above their committed baseline, at worst";
        figures.push(Figure::at_most(name, worst, counts::SLACK, "%"));
    }
    tables(
        figures,
        &["kinetostat-bench", "--bin", "table", "--", "--figures"],
    )
}

/// Modes, responses and lobes, and a map of the first frequency.
fn vibrations(figures: &mut Vec<Figure>) -> Result<()> {
    tables(figures, &["kinetostat-analysis", "--example", "vibrations"])?;
    let scratch = Scratch::new("frequencies")?;
    let words = "map heavy_6r --x 1200 1600 50 --y -200 200 50 --z 400 800 40 --force 0 0 0 --show f1 --plot f1.svg";
    let words: Vec<&str> = words.split(' ').collect();
    let used = measure(&scratch.0, &words)?;
    figures.push(Figure::yes(
        "a map of f1 of heavy_6r over 1e5 postures is drawn",
        used.success,
    ));
    let name = "a map of f1 of heavy_6r over 1e5 postures, time";
    figures.push(Figure::at_most(name, used.seconds, 60.0, "s"));
    Ok(())
}

/// A program of a crate that prints tables, which go to stderr, and figures.
pub fn tables(figures: &mut Vec<Figure>, program: &[&str]) -> Result<()> {
    let name = program.get(2).unwrap_or(&"");
    let output = cargo()
        .args(["run", "--release", "--quiet", "-p"])
        .args(program)
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("cannot run {name}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        bail!("{name} failed: {text}");
    }
    take_printed(figures, &text)
}

/// Takes the figures that a program printed, and says what else it printed.
pub fn take_printed(figures: &mut Vec<Figure>, text: &str) -> Result<()> {
    for line in text.lines().filter(|line| !line.starts_with("figure {")) {
        eprintln!("{line}");
    }
    figures.append(&mut printed(text)?);
    Ok(())
}

/// The README's first command from a clean clone with an empty registry cache.
fn clean_clone(figures: &mut Vec<Figure>) -> Result<()> {
    let scratch = Scratch::new("clone")?;
    let clone = scratch.0.join("kinetostat");
    let from = root().display().to_string();
    let to = clone.display().to_string();
    step(
        "clean clone",
        Command::new("git").args(["clone", "--quiet", &from, &to]),
    )?;
    let home = scratch.0.join("cargo-home");
    fs::create_dir_all(&home)?;
    // The cache is emptied, the user's settings of the registry client stay.
    if let Some(own) = std::env::var_os("CARGO_HOME")
        .map(PathBuf::from)
        .or_else(|| std::env::var_os("HOME").map(|h| PathBuf::from(h).join(".cargo")))
    {
        for name in ["config.toml", "config"] {
            if own.join(name).is_file() {
                fs::copy(own.join(name), home.join(name))?;
            }
        }
    }
    let start = Instant::now();
    let status = cargo()
        .args(["run", "--release", "--quiet", "--", "demo"])
        .current_dir(&clone)
        .env("CARGO_HOME", &home)
        .env_remove("CARGO_TARGET_DIR")
        .stdout(Stdio::null())
        .status()?;
    let minutes = start.elapsed().as_secs_f64() / 60.0;
    figures.push(Figure::yes(
        "clean clone: the README's first command succeeds",
        status.success(),
    ));
    figures.push(Figure::at_most(
        "clean clone, empty registry cache: the README's first command",
        minutes,
        6.0,
        "min",
    ));
    Ok(())
}

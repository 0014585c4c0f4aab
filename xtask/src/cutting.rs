//! `cargo xtask figures --cutting`: forces from the cut. Accuracy as the tests print it, speed and memory as the examples
//! measure them, and what a stock adds to the time of a compensation.

use std::fs;
use std::path::Path;

use anyhow::{Result, bail};

use crate::figures::{Figure, Scratch, Used, data, golden, measure, tables};

/// Head of both jobs: a pocket in small moves on the small Orthoglide.
const JOB: &str = r#"schema = 1
model = "orthoglide"
program = "pocket.ngc"

[placement]
part_origin_mm = [-70, 70, 100]

[output]
program = "out.ngc"
"#;
/// A force as somebody would type it.
const TYPED: &str = "
[load]
milling = { radial_n = 60, tangential_n = -10, axial_n = -25 }
";
/// Job for the same pocket cut out of a block of aluminium.
const FROM_CUT: &str = r#"
[tool]
cutter = { shape = "flat", diameter_mm = 6, teeth = 2, helix_deg = 30 }

[material]
name = "AlMg4.5Mn"

[stock]
block_mm = [[-5, -140, -12], [140, 5, 0]]

[spindle]
rpm = 12000
rotation = "clockwise"
"#;

/// Measures all of it; needs the release build of the program.
///
/// # Errors
/// A test, an example or a compensation that cannot be run.
pub fn measured(figures: &mut Vec<Figure>) -> Result<()> {
    golden(figures, &["kinetostat-cutting"])?;
    let example = |name| ["kinetostat-cutting", "--example", name];
    tables(figures, &example("force_speed"))?;
    tables(figures, &example("stock_speed"))?;
    let Some(data) = data() else {
        eprintln!("skipped: no ../shared/data, so the cut along tball-pocket is not measured");
        return Ok(());
    };
    let program = data.join("tball-pocket.gcode");
    let path = program.display().to_string();
    let along = [
        "kinetostat-machining",
        "--example",
        "cut_along",
        "--",
        &path,
    ];
    tables(figures, &along)?;
    compensations(figures, &program)
}

/// The least of two times each, in turns: what disturbs only makes them longer.
fn compensations(figures: &mut Vec<Figure>, program: &Path) -> Result<()> {
    let scratch = Scratch::new("cut")?;
    fs::copy(program, scratch.0.join("pocket.ngc"))?;
    fs::write(scratch.0.join("typed.toml"), JOB.to_owned() + TYPED)?;
    fs::write(scratch.0.join("cut.toml"), JOB.to_owned() + FROM_CUT)?;
    let run = |job: &str| -> Result<Used> {
        let _ = fs::remove_file(scratch.0.join("out.ngc"));
        let used = measure(&scratch.0, &["compensate", job, "--threads", "2"])?;
        if !used.success {
            bail!("compensate {job} failed: {}{}", used.stdout, used.stderr);
        }
        Ok(used)
    };
    let (mut typed, mut cut) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..2 {
        typed = typed.min(run("typed.toml")?.seconds);
        cut = cut.min(run("cut.toml")?.seconds);
    }
    eprintln!("   tball-pocket: typed force {typed:.1} s, force from the cut {cut:.1} s");
    figures.push(Figure::at_most(
        "tball-pocket with material and stock: time, as that with a typed force",
        cut / typed,
        1.5,
        "times",
    ));
    Ok(())
}

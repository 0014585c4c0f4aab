//! Figures of programs of robots and machines: which are read, what they come to, how fast they are read and written.

use std::fs;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::figures::{Figure, Scratch, golden, measure, tables, take_printed};
use crate::root;

/// Figures of the tests' programs, of LinuxCNC's interpreter, of the demonstration's groove, and the speed of every
/// language.
pub fn measured(figures: &mut Vec<Figure>) -> Result<()> {
    let crates = [
        "kinetostat-program",
        "kinetostat-formats",
        "kinetostat-machining",
    ];
    golden(figures, &crates)?;
    linuxcnc(figures)?;
    groove(figures)?;
    tables(figures, &["kinetostat-formats", "--example", "speed"])
}

/// LinuxCNC's own programs through its interpreter, as they are and run flat. The script says what it leaves out.
fn linuxcnc(figures: &mut Vec<Figure>) -> Result<()> {
    let script = "validation/scripts/nc_files_with_linuxcnc.py";
    let output = Command::new("python3")
        .arg(script)
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("cannot run {script}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    take_printed(figures, &text)?;
    if !output.status.success() {
        figures.push(Figure::yes(format!("{script} finds no difference"), false));
    }
    Ok(())
}

/// Blocks and residual of the demonstration's groove, with arcs and with straight pieces.
fn groove(figures: &mut Vec<Figure>) -> Result<()> {
    let scratch = Scratch::new("arcs")?;
    let used = measure(&scratch.0, &["demo", "--out", "demo"])?;
    if !used.success {
        bail!("the demo failed: {}", used.stderr);
    }
    for (arcs, most) in [("fit", 2.0), ("lines", f64::INFINITY)] {
        let words = [
            "compensate",
            "demo/job.toml",
            "--arcs",
            arcs,
            "--out",
            "groove.ngc",
            "--report",
            "groove.html",
            "--points",
            "groove.csv",
            "--json",
            "groove.json",
            "--force-overwrite",
        ];
        let used = measure(&scratch.0, &words)?;
        if !used.success {
            bail!("the groove with arcs as {arcs} failed: {}", used.stderr);
        }
        let result: Value =
            serde_json::from_str(&fs::read_to_string(scratch.0.join("groove.json"))?)?;
        let of = |key: &str| result["summary"][key].as_f64().unwrap_or(f64::NAN);
        if most.is_finite() {
            figures.push(Figure::at_most(
                format!("demo, arcs as {arcs}: blocks by those of the program"),
                of("blocks_out") / of("blocks"),
                most,
                "1",
            ));
        }
        figures.push(Figure::at_most(
            format!("demo, arcs as {arcs}: largest position error of the written program"),
            of("max_position_error_after_mm"),
            0.001,
            "mm",
        ));
    }
    Ok(())
}

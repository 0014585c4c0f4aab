//! Figures of programs of robots and machines: how fast they are read and written, and what becomes of arcs.

use std::fs;

use anyhow::{Result, bail};
use serde_json::Value;

use crate::figures::{Figure, Scratch, measure, tables};

/// Blocks and residual of the demonstration's groove, with arcs and with straight pieces, and the speed of every language.
pub fn measured(figures: &mut Vec<Figure>) -> Result<()> {
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
    tables(figures, &["kinetostat-formats", "--example", "speed"])
}

//! URDF import: what comes out, against independent kinematics and statics; and what is refused.
#![allow(
    clippy::print_stdout,
    reason = "figures, and tests that say that they were skipped"
)]
#![allow(clippy::unwrap_used, reason = "tests")]

mod agreement;
mod broken;
mod loops;
mod masses;
mod oracle;
mod placeholders;
mod robots;
mod shapes;

use std::path::PathBuf;

use kinetostat_import::{Imported, UrdfOptions, import_urdf};

/// Imports a text that must be right.
pub fn import(urdf: &str, options: &UrdfOptions) -> Imported {
    import_urdf(urdf, "robot.urdf", options).unwrap_or_else(|e| panic!("{e}"))
}

/// Base and tip.
pub fn between(base: &str, tip: &str) -> UrdfOptions {
    let mut options = UrdfOptions::default();
    options.base = Some(base.into());
    options.tip = Some(tip.into());
    options
}

/// All notices in one text, with the warnings of the model that was made.
pub fn notices(imported: &Imported) -> String {
    let all = imported.notices.iter().chain(&imported.model.warnings);
    all.map(|n| format!("{n}\n")).collect()
}

/// Real robots, where they are: the files belong to others and are not part of the project.
pub fn data() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/urdf");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: there is no ../shared/data/urdf");
    None
}

/// Numbers in [-1, 1] from a seed.
pub struct Random(u64);

impl Random {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next one.
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        2.0 * ((z >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
    }
}

/// Prints a count for `cargo xtask figures` and holds it.
pub fn figure_at_least(name: &str, measured: usize, least: usize) {
    let holds = measured >= least;
    let figure = serde_json::json!({
        "name": name, "measured": measured, "asked": format!("at least {least}"),
        "unit": "files", "holds": holds,
    });
    println!("figure {figure}");
    assert!(holds, "{figure}");
}

/// Prints a number for `cargo xtask figures` and holds it.
pub fn figure_at_most(name: &str, measured: f64, most: f64, unit: &str) {
    let holds = measured <= most;
    let figure = serde_json::json!({
        "name": name, "measured": measured, "asked": format!("at most {most:e}"),
        "unit": unit, "holds": holds,
    });
    println!("figure {figure}");
    assert!(holds, "{figure}");
}

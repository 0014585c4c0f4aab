//! Lines that `cargo xtask figures` reads: printed with `--figures` only, tables are for people.

use kinetostat_testing::figure;

fn wanted() -> bool {
    std::env::args().any(|word| word == "--figures")
}

/// A number that may be at most as large.
pub fn at_most(name: &str, measured: f64, most: f64, unit: &str) {
    if wanted() {
        figure::at_most(name, measured, most, unit);
    }
}

/// A number that must be at least as large.
pub fn at_least(name: &str, measured: f64, least: f64, unit: &str) {
    if wanted() {
        figure::at_least(name, measured, least, unit);
    }
}

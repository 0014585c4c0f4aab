//! Links from other programs, by what they come as. Every number that the issue asks for is printed as
//! a `figure` line for `cargo xtask figures`.

#![allow(clippy::print_stdout)] // figures

mod figures;
mod internal;
mod matrices;

use kinetostat_links::Text;
use kinetostat_testing::Worst;
use nalgebra::Matrix6;

/// A text that is not on disk.
fn text(name: &str, body: &str) -> Text {
    Text::new(name, body).expect("text")
}

/// Largest difference of two stiffnesses, entries in units of the geometric mean of their diagonals.
fn apart(found: &Matrix6<f64>, wanted: &Matrix6<f64>) -> f64 {
    let mut worst = Worst::new();
    worst.matrix(found, wanted, wanted);
    worst.of(36)
}

/// Prints a figure and holds it.
fn at_most(name: &str, measured: f64, most: f64, unit: &str) {
    let figure = serde_json::json!({
        "name": format!("links: {name}"), "measured": measured, "asked": format!("at most {most}"),
        "unit": unit, "holds": measured <= most,
    });
    println!("figure {figure}");
    assert!(
        measured <= most,
        "{name}: {measured} instead of at most {most}"
    );
}

/// Prints a count and holds it.
fn at_least(name: &str, measured: usize, least: usize, unit: &str) {
    let figure = serde_json::json!({
        "name": format!("links: {name}"), "measured": measured, "asked": format!("at least {least}"),
        "unit": unit, "holds": measured >= least,
    });
    println!("figure {figure}");
    assert!(
        measured >= least,
        "{name}: {measured} instead of at least {least}"
    );
}

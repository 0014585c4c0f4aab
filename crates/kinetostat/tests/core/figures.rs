//! What the issues ask of the theory, as numbers: every test here measures the worst deviation over
//! all rows of its source and prints it as `figure {json}`, which `cargo xtask figures` collects.
//!
//! Where an issue names no tolerance, the tolerance is that of the test of the same claim, and the
//! unit says so.

mod graphs;
mod orthoglide;
mod properties;
mod report;
mod screws;
mod shapes;
mod structure;
mod theory;

use nalgebra::Matrix6;
use serde_json::{Value, json};

/// Largest of a set of deviations. Not a number counts as the largest, and no deviation at all
/// is not a measurement.
struct Worst(Option<f64>);

impl Worst {
    fn new() -> Self {
        Self(None)
    }

    fn add(&mut self, deviation: f64) {
        let d = deviation.abs();
        if self.0.is_none_or(|worst| d.is_nan() || d > worst) {
            self.0 = Some(d);
        }
    }

    fn apart(&mut self, found: f64, expected: f64) {
        self.add(found - expected);
    }

    fn all_apart(&mut self, found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(expected) {
            self.apart(*a, *b);
        }
    }

    /// Every entry as a share of the geometric mean of its two diagonal entries in `size`.
    fn matrix(&mut self, found: &Matrix6<f64>, expected: &Matrix6<f64>, size: &Matrix6<f64>) {
        for i in 0..6 {
            for j in 0..6 {
                let unit = (size[(i, i)] * size[(j, j)]).sqrt();
                self.add((found[(i, j)] - expected[(i, j)]) / unit);
            }
        }
    }

    /// In units of the last of `digits` significant digits.
    fn printed(&mut self, found: f64, expected: f64, digits: i32) {
        let unit = 10_f64.powi(expected.abs().log10().floor() as i32 + 1 - digits);
        self.add((found - expected) / unit);
    }
}

/// Prints figures as they come and fails at the end, so that one that falls short hides no other.
struct Figures {
    short: Vec<String>,
}

impl Figures {
    fn new() -> Self {
        Self { short: Vec::new() }
    }

    #[allow(clippy::print_stdout, reason = "read by cargo xtask figures")]
    fn print(&mut self, name: &str, measured: Value, asked: &str, unit: &str, holds: bool) {
        let figure = json!({
            "name": name, "measured": measured, "asked": asked, "unit": unit, "holds": holds,
        });
        println!("figure {figure}");
        if !holds {
            self.short.push(figure.to_string());
        }
    }

    fn at_most(&mut self, name: &str, measured: &Worst, most: f64, unit: &str) {
        let holds = measured.0.is_some_and(|worst| worst <= most);
        let asked = format!("at most {most:e}");
        self.print(name, json!(measured.0), &asked, unit, holds);
    }

    fn at_least(&mut self, name: &str, measured: usize, least: usize, unit: &str) {
        let asked = format!("at least {least}");
        self.print(name, json!(measured), &asked, unit, measured >= least);
    }

    /// The same whole number in every row.
    fn exactly(&mut self, name: &str, measured: &[usize], asked: usize, unit: &str) {
        let odd = measured.iter().find(|m| **m != asked);
        let shown = odd.or(measured.first());
        let holds = odd.is_none() && !measured.is_empty();
        self.print(name, json!(shown), &format!("exactly {asked}"), unit, holds);
    }

    fn finish(self) {
        assert!(self.short.is_empty(), "fall short: {:#?}", self.short);
    }
}

#[test]
fn what_is_no_number_or_never_measured_falls_short() {
    let mut worst = Worst::new();
    let holds = |worst: &Worst| worst.0.is_some_and(|w| w <= 1.0);
    assert!(!holds(&worst));
    worst.add(-0.5);
    assert!(holds(&worst));
    worst.add(f64::NAN);
    worst.add(0.1);
    assert!(!holds(&worst));
    worst = Worst::new();
    worst.printed(-0.000_617_541_7, -0.000_617_541_4, 7);
    assert!((worst.0.unwrap() - 3.0).abs() < 1e-6);
}

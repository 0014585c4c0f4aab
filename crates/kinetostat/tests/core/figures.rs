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

use kinetostat_testing::Worst;
use serde_json::{Value, json};

/// Prints figures as they come and fails at the end, so that one that falls short hides no other.
struct Figures {
    short: Vec<String>,
    /// What a figure begins with: those of a test of the figures themselves are not collected.
    word: &'static str,
}

#[allow(clippy::print_stdout, reason = "read by cargo xtask figures")]
fn shown(
    word: &str,
    name: &str,
    measured: &Value,
    (expected, unit): (&str, &str),
    holds: bool,
) -> String {
    let figure = json!({
        "name": name, "measured": measured, "asked": expected, "unit": unit, "holds": holds,
    });
    println!("{word} {figure}");
    figure.to_string()
}

impl Figures {
    fn new() -> Self {
        Self {
            short: Vec::new(),
            word: "figure",
        }
    }

    /// Prints a figure, which is kept if it falls short.
    fn print(&mut self, name: &str, measured: Value, expected: &str, unit: &str, holds: bool) {
        let figure = shown(self.word, name, &measured, (expected, unit), holds);
        if !holds {
            self.short.push(figure);
        }
    }

    /// A time, which says so where it is too long and fails nothing: a busy machine is no fault of the program.
    fn time(name: &str, seconds: f64, most: f64) {
        let expected = format!("at most {most} on a quiet machine");
        shown(
            "figure",
            name,
            &json!(seconds),
            (&expected, "s"),
            seconds <= most,
        );
    }

    fn at_most(&mut self, name: &str, measured: &Worst, most: f64, unit: &str) {
        let holds = measured.holds(most);
        let expected = format!("at most {most:e}");
        self.print(name, json!(measured.measured()), &expected, unit, holds);
    }

    fn at_least(&mut self, name: &str, measured: usize, least: usize, unit: &str) {
        let expected = format!("at least {least}");
        self.print(name, json!(measured), &expected, unit, measured >= least);
    }

    /// The same whole number in every row.
    fn exactly(&mut self, name: &str, measured: &[usize], expected: usize, unit: &str) {
        let odd = measured.iter().find(|m| **m != expected);
        let shown = odd.or(measured.first());
        let holds = odd.is_none() && !measured.is_empty();
        self.print(
            name,
            json!(shown),
            &format!("exactly {expected}"),
            unit,
            holds,
        );
    }

    fn finish(self) {
        assert!(self.short.is_empty(), "fall short: {:#?}", self.short);
    }
}

#[test]
fn what_is_no_number_or_never_measured_falls_short() {
    let mut f = Figures {
        word: "tried",
        ..Figures::new()
    };
    let mut worst = Worst::new();
    f.at_most("nothing", &worst, 1.0, "1");
    assert_eq!(f.short.len(), 1);
    worst.add(-0.5);
    f.at_most("a half", &worst, 1.0, "1");
    assert_eq!(f.short.len(), 1);
    worst.add(f64::NAN);
    worst.add(0.1);
    f.at_most("NaN", &worst, 1.0, "1");
    assert_eq!(f.short.len(), 2);
}

//! The `[stiffness.NAME]` table of a model file.

use std::fmt::Write;

use nalgebra::Matrix6;

/// N/mm, N/rad, N mm/mm, N mm/rad from N/m, N/rad, N m/m, N m/rad.
#[must_use]
pub fn in_n_mm(k: &Matrix6<f64>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| {
        let lengths = i32::from(i >= 3) + i32::from(j >= 3) - 1;
        k[(i, j)] * 1e3_f64.powi(lengths)
    })
}

/// Twelve digits, as TOML reads them.
fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    if rounded == 0.0 {
        "0.0".into()
    } else {
        format!("{rounded:?}")
    }
}

/// A basic string of TOML: quotes, backslashes and control characters escaped.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// The table for a model file: `k` in SI, symmetric; entries below `1e-12` of their diagonals become 0.
#[must_use]
pub fn stiffness_table(
    name: &str,
    k: &Matrix6<f64>,
    source: &str,
    assumption: Option<&str>,
) -> String {
    let k = in_n_mm(k);
    let name = if !name.is_empty()
        && name
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
    {
        name.to_owned()
    } else {
        quoted(name)
    };
    let mut out = format!("[stiffness.{name}]\nmatrix_n_mm_rad = [\n");
    for i in 0..6 {
        let row: Vec<String> = (0..6)
            .map(|j| {
                let unit = (k[(i, i)] * k[(j, j)]).abs().sqrt();
                // The upper half decides, so that both halves have the same digits.
                let x = k[(i.min(j), i.max(j))];
                digits(if x.abs() < 1e-12 * unit { 0.0 } else { x })
            })
            .collect();
        let _ = writeln!(out, "    [{}],", row.join(", "));
    }
    let _ = write!(out, "]\nsource = {}\n", quoted(source));
    if let Some(assumption) = assumption {
        let _ = writeln!(out, "assumption = {}", quoted(assumption));
    }
    out
}

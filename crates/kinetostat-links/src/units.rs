//! Units of a matrix that comes without any, or with them in its key as in the `[stiffness.NAME]` table of a model file.

use std::fmt::Write;

use nalgebra::Matrix6;

/// Unit of force and of length; rotations are in radians, moments in force times length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Name as in keys and options: `n_mm`.
    pub name: &'static str,
    /// Newtons in one unit of force.
    pub force_n: f64,
    /// Metres in one unit of length.
    pub length_m: f64,
}

/// The units that are known.
pub const UNITS: [Units; 5] = [
    Units {
        name: "n_mm",
        force_n: 1.0,
        length_m: 1e-3,
    },
    Units {
        name: "n_m",
        force_n: 1.0,
        length_m: 1.0,
    },
    Units {
        name: "kn_mm",
        force_n: 1e3,
        length_m: 1e-3,
    },
    Units {
        name: "kn_m",
        force_n: 1e3,
        length_m: 1.0,
    },
    Units {
        name: "lbf_in",
        force_n: 4.448_221_615_260_5, // NIST SP 811, exact
        length_m: 0.0254,
    },
];

impl Units {
    /// The units of that name (`n_mm`, `n-mm`, `N_mm`), if there are such.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let name = name.trim().to_lowercase().replace('-', "_");
        UNITS.into_iter().find(|u| u.name == name)
    }

    /// The names, for a message.
    #[must_use]
    pub fn names() -> String {
        UNITS.map(|u| u.name).join(", ")
    }

    /// A stiffness (translations first) in N and m from one in these units.
    #[must_use]
    pub fn stiffness_to_si(&self, k: &Matrix6<f64>) -> Matrix6<f64> {
        Matrix6::from_fn(|i, j| {
            let lengths = i32::from(i >= 3) + i32::from(j >= 3) - 1;
            k[(i, j)] * self.force_n * self.length_m.powi(lengths)
        })
    }

    /// A compliance in N and m from one in these units.
    #[must_use]
    pub fn compliance_to_si(&self, c: &Matrix6<f64>) -> Matrix6<f64> {
        Matrix6::from_fn(|i, j| {
            let lengths = 1 - i32::from(i >= 3) - i32::from(j >= 3);
            c[(i, j)] * self.length_m.powi(lengths) / self.force_n
        })
    }
}

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

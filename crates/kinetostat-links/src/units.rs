//! Units of a matrix that comes without any, or with them in its key.

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

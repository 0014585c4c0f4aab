//! Test that a superelement without supports can be moved as a rigid body.

use nalgebra::{DMatrix, Vector3};

use crate::files::nodes::Nodes;
use crate::superelement::Superelement;
use crate::units::Units;

/// Does a superelement without supports let itself be moved as a rigid body?
#[derive(Clone, Debug, PartialEq)]
pub struct FreeTest {
    /// `|K r| / (|K| |r|)` for the rigid motions x, y, z, rx, ry, rz: 0 for a body that nothing holds;
    /// `None` where the places of nodes are unknown (rotations) .
    pub resistance: [Option<f64>; 6],
    /// Number of eigenvalues that are zero, of the matrix scaled by its diagonal; `None` for matrices
    /// of more than 600 rows.
    pub zero_modes: Option<usize>,
    /// Number of negative ones.
    pub negative_modes: Option<usize>,
}

/// Resistance that is zero within the digits of a file: these have 9 to 13.
const FREE_TO: f64 = 1e-6;

impl FreeTest {
    /// True if the six rigid motions (those that could be tried) meet no resistance.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.resistance.iter().flatten().all(|r| *r < FREE_TO)
    }

    /// A sentence that says whether the body is free or along which rigid motions it is held, with the numbers of its
    /// zero and negative modes.
    #[must_use]
    pub fn words(&self) -> String {
        let held: Vec<&str> = (0..6)
            .filter(|&i| self.resistance[i].is_some_and(|r| r >= FREE_TO))
            .map(|i| crate::stiffness_check::DIRECTIONS[i])
            .collect();
        let modes = self
            .zero_modes
            .map_or_else(String::new, |n| format!("; {n} zero modes"));
        let negative = match self.negative_modes {
            Some(n) if n > 0 => {
                format!("; {n} negative modes, so this is no stiffness of a body without load")
            }
            _ => String::new(),
        };
        let tried = self.resistance.iter().flatten().count();
        if held.is_empty() {
            format!(
                "the body is free: {tried} of 6 rigid motions tried, none meets resistance{modes}{negative}"
            )
        } else {
            format!(
                "the body is held: the rigid motion along {} meets resistance{modes}{negative}",
                held.join(", ")
            )
        }
    }
}

/// The rigid-body test of a superelement; `units` are those of its file.
#[must_use]
pub fn free_test(element: &Superelement, nodes: &Nodes, units: Units) -> FreeTest {
    let n = element.dofs.len();
    let placed = element
        .dofs
        .iter()
        .all(|d| nodes.places.contains_key(&d.node));
    #[allow(clippy::cast_precision_loss)]
    let centre = if placed {
        element
            .dofs
            .iter()
            .filter_map(|d| nodes.places.get(&d.node))
            .sum::<Vector3<f64>>()
            / n.max(1) as f64
    } else {
        Vector3::zeros()
    };
    let resistance = std::array::from_fn(|m| {
        if m >= 3 && !placed {
            return None;
        }
        let motion: Vec<f64> = element
            .dofs
            .iter()
            .map(|d| {
                let turn = Vector3::from_fn(|i, _| f64::from(u8::from(i + 3 == m)));
                let place = nodes.places.get(&d.node).copied().unwrap_or_default();
                let move_ = if m < 3 {
                    Vector3::from_fn(|i, _| f64::from(u8::from(i == m)))
                } else {
                    turn.cross(&(place - centre)) / units.length_m
                };
                match d.direction {
                    0 => 0.0,
                    d @ 1..=3 => move_[usize::from(d) - 1],
                    d => turn[usize::from(d) - 4],
                }
            })
            .collect();
        let (mut force, mut size) = (vec![0.0; n], vec![0.0; n]);
        for &(i, j, value) in &element.entries {
            let (i, j) = (i as usize, j as usize);
            let mut add = |to: usize, from: usize| {
                force[to] += value * motion[from];
                size[to] += (value * motion[from]).abs();
            };
            add(i, j);
            if i != j {
                add(j, i);
            }
        }
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let whole = norm(&size);
        Some(if whole > 0.0 {
            norm(&force) / whole
        } else {
            0.0
        })
    });
    let (mut zero_modes, mut negative_modes) = (None, None);
    if n <= 600 {
        let mut dense = DMatrix::zeros(n, n);
        for &(i, j, value) in &element.entries {
            dense[(i as usize, j as usize)] = value;
            dense[(j as usize, i as usize)] = value;
        }
        let unit: Vec<f64> = (0..n)
            .map(|i| {
                let d: f64 = dense[(i, i)];
                if d > 0.0 {
                    d.sqrt()
                } else {
                    dense.row(i).amax().max(f64::MIN_POSITIVE).sqrt()
                }
            })
            .collect();
        let scaled = DMatrix::from_fn(n, n, |i, j| dense[(i, j)] / unit[i] / unit[j]);
        let eigen = scaled.symmetric_eigenvalues();
        let largest = eigen.amax();
        zero_modes = Some(eigen.iter().filter(|e| e.abs() < 1e-7 * largest).count());
        negative_modes = Some(eigen.iter().filter(|e| **e < -1e-7 * largest).count());
    }
    FreeTest {
        resistance,
        zero_modes,
        negative_modes,
    }
}

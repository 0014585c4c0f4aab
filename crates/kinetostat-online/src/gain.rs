//! Static loop gain of force feedback, and the share of the measured force that keeps it at 0.7.
//!
//! With `C` the compliance of the tool and `K_e` the process stiffness, a correction `-C f` of the measured force closes
//! a loop of POSITIVE feedback, `L = C K_e (I + C K_e)^-1` (theory note, on-line, section 4). Its eigenvalues are
//! `lambda / (1 + lambda)`, `lambda` those of `K_e C`, which with `K_e = R^2` are those of the symmetric `R C R = Y Lambda Y^T`. In
//! the directions `u = R y` of force above the limit, the measured force is taken by a share `beta`:
//!
//! ```text
//! G = I - sum (1 - beta_i) u_i (C u_i)^T / (u_i . C u_i),      beta_i = 0.7 (1 + lambda_i) / lambda_i
//! ```

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Largest static loop gain.
pub const LARGEST_LOOP_GAIN: f64 = 0.7;
/// Iterations of the eigenvalues of a 3 x 3 matrix at most; they need about six.
const ITERATIONS: usize = 60;

/// Gain on measured forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ForceGain {
    pub matrix: Matrix3<f64>,
    /// Largest loop gain without it.
    pub loop_gain: f64,
    /// True if some direction is scaled.
    pub is_scaled: bool,
}

/// Ratios `lambda` of process stiffness to the machine's and their directions of force, for a compliance of the tool's position.
pub(crate) fn stiffness_ratios(
    compliance: &Matrix3<f64>,
    process: &Vector3<f64>,
) -> Option<([f64; 3], [Vector3<f64>; 3])> {
    let root = process.map(f64::sqrt);
    let symmetric = 0.5 * (compliance + compliance.transpose());
    let loaded = Matrix3::from_fn(|i, j| root[i] * symmetric[(i, j)] * root[j]);
    if !loaded.iter().all(|x| x.is_finite()) {
        return None;
    }
    let found = SymmetricEigen::try_new(loaded, f64::EPSILON, ITERATIONS)?;
    let ratios = std::array::from_fn(|k| found.eigenvalues[k].max(0.0));
    let forces = std::array::from_fn(|k| root.component_mul(&found.eigenvectors.column(k)));
    Some((ratios, forces))
}

impl ForceGain {
    /// Gain for a compliance of the tool's position (m/N) and a process stiffness (N/m, diagonal); nothing where there are no
    /// numbers to decide by.
    pub(crate) fn new(compliance: &Matrix3<f64>, process: &Vector3<f64>) -> Option<Self> {
        let (ratios, forces) = stiffness_ratios(compliance, process)?;
        let mut gain = Self {
            matrix: Matrix3::identity(),
            loop_gain: 0.0,
            is_scaled: false,
        };
        for (ratio, force) in ratios.iter().zip(&forces) {
            let own = ratio / (1.0 + ratio);
            gain.loop_gain = kinetostat::number::larger(gain.loop_gain, own);
            if own > LARGEST_LOOP_GAIN {
                let moved = compliance * force;
                let share = 1.0 - LARGEST_LOOP_GAIN / own;
                gain.matrix -= force * moved.transpose() * (share / force.dot(&moved));
                gain.is_scaled = true;
            }
        }
        gain.matrix.iter().all(|x| x.is_finite()).then_some(gain)
    }
}

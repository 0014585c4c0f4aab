//! The stiffness of a bar parallelogram as one link.

use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};

/// A bar parallelogram of width `d` seen as one link: five spring coordinates at the distal end
/// of the bar, `x, y, rx, ry, rz` in the bar's frame (u along the bars, then the axis of the
/// parallelogram's pivots, then the direction across); the sixth, `z`, is the parallelogram's own
/// free motion and belongs to the passive coordinate `inclination` (q2).
///
/// With the bar's matrix `K` and `c = cos q2, s = sin q2` (reference: Orthoglide literature, with
/// the sign of the (4,6) entry for this sense of q2):
/// `2 [K11; K22, K26; K44 + d^2 c^2 K22/4, d^2 sin(2 q2) K22/8; d^2 c^2 K11/4; K66 + d^2 s^2 K22/4]`.
/// `q2` is the one of the commanded posture: the block's matrix is constant while the machine
/// bends about that posture.
///
/// Unloaded the link is its two bars exactly. Displaced, it lacks the part of the bars' geometric
/// stiffness that tells two bars from one: they incline by different angles when the far beam turns
/// (by `-+ psi d sin(q2) / (2 L)` for a turn `psi` about the pivots' axis, which under a tension `N`
/// stiffens that turn by `N d^2 sin^2(q2) / (4 L)`), and carry different axial forces on ends that
/// turn differently. So the difference of wrenches grows with the square of the displacement, that of
/// stiffnesses with the load; where it matters, write the two bars as limbs between platforms. The
/// test `a_loaded_parallelogram_differs_by_the_geometric_stiffness_of_its_bars` holds that there is
/// nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParallelogramLaw {
    /// Stiffness of one bar at its distal end, 6 x 6, cantilever (N/m, N/rad, N m/rad).
    pub bar: Matrix6<f64>,
    /// Distance of the two bars, m.
    pub width: f64,
    /// Index of the passive coordinate that inclines the parallelogram.
    pub inclination: usize,
}

impl ParallelogramLaw {
    /// The 5 x 5 matrix at inclination `q2` (rad), order `x, y, rx, ry, rz`.
    #[must_use]
    pub fn matrix(&self, q2: f64) -> nalgebra::Matrix5<f64> {
        let (s, c) = q2.sin_cos();
        let k = &self.bar;
        let d2 = self.width * self.width;
        let mut m = nalgebra::Matrix5::zeros();
        m[(0, 0)] = k[(0, 0)];
        m[(1, 1)] = k[(1, 1)];
        m[(1, 4)] = k[(1, 5)];
        m[(2, 2)] = k[(3, 3)] + d2 * c * c * k[(1, 1)] / 4.0;
        m[(2, 4)] = d2 * (2.0 * q2).sin() * k[(1, 1)] / 8.0;
        m[(3, 3)] = d2 * c * c * k[(0, 0)] / 4.0;
        m[(4, 4)] = k[(5, 5)] + d2 * s * s * k[(1, 1)] / 4.0;
        m.fill_lower_triangle_with_upper_triangle();
        2.0 * m
    }
}

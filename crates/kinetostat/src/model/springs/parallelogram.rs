//! The stiffness of a bar parallelogram as one link.

use nalgebra::Matrix6;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::linalg::derivatives::Number;

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
/// Unloaded the link is its two bars exactly. Displaced, it is without the part of the bars' geometric
/// stiffness that tells two bars from one: they incline by different angles when the far beam turns
/// (by `-+ psi d sin(q2) / (2 L)` for a turn `psi` about the pivots' axis, which under a tension `N`
/// stiffens that turn by `N d^2 sin^2(q2) / (4 L)`), and carry different axial forces on ends that
/// turn differently. So the difference of wrenches grows with the square of the displacement, that of
/// stiffnesses with the load; where it matters, write the two bars as limbs between platforms. The
/// test `a_loaded_parallelogram_differs_by_the_geometric_stiffness_of_its_bars` holds that there is
/// nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
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
        let k = self.pair(q2);
        let mut m = nalgebra::Matrix5::zeros();
        (m[(0, 0)], m[(1, 1)], m[(1, 4)]) = (k.x, k.y, k.y_rz);
        (m[(2, 2)], m[(2, 4)], m[(3, 3)], m[(4, 4)]) = (k.rx, k.rx_rz, k.ry, k.rz);
        m.fill_lower_triangle_with_upper_triangle();
        m
    }

    /// Entries of the matrix.
    #[inline(always)]
    pub(crate) fn pair<N: Number>(&self, q2: N) -> Pair<N> {
        let (k, square) = (&self.bar, self.width * self.width);
        let (s, c) = q2.sin_cos();
        let one = q2.same(1.0);
        Pair {
            x: one * (2.0 * k[(0, 0)]),
            y: one * (2.0 * k[(1, 1)]),
            y_rz: one * (2.0 * k[(1, 5)]),
            rx: (c * c).times_plus(one * (square * k[(1, 1)] / 2.0), one * (2.0 * k[(3, 3)])),
            rx_rz: s * c * (square * k[(1, 1)] / 2.0),
            ry: c * c * (square * k[(0, 0)] / 2.0),
            rz: (s * s).times_plus(one * (square * k[(1, 1)] / 2.0), one * (2.0 * k[(5, 5)])),
        }
    }

    /// Compliance at inclination `q2` in the six directions, rows and columns of what is not zero:
    /// the missing one, `z`, is rigid.
    #[inline(always)]
    pub(crate) fn compliance<N: Number>(&self, q2: N) -> [(usize, usize, N); 8] {
        let one = q2.same(1.0);
        let Pair {
            x,
            y,
            y_rz,
            rx,
            rx_rz,
            ry,
            rz,
        } = self.pair(q2);
        // Inverse of [y, 0, y_rz; 0, rx, rx_rz; y_rz, rx_rz, rz] by elimination of y and rx.
        let (a, b) = (y_rz / y, rx_rz / rx);
        let last = one / rx_rz.times_from(b, y_rz.times_from(a, rz));
        [
            (0, 0, one / x),
            (4, 4, one / ry),
            (5, 5, last),
            (1, 5, -(a * last)),
            (3, 5, -(b * last)),
            (1, 3, a * b * last),
            (1, 1, (a * a).times_plus(last, one / y)),
            (3, 3, (b * b).times_plus(last, one / rx)),
        ]
    }
}

/// Entries of the stiffness of two bars: `x` and `ry` alone, `y` and `rx` with `rz`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<N> {
    x: N,
    y: N,
    y_rz: N,
    rx: N,
    rx_rz: N,
    ry: N,
    rz: N,
}

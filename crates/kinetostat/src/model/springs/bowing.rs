//! A beam that bends also shortens: the default energy of a link's segment (book: Conventions, Links that bend).
//!
//! The spring sits at the far end of a segment of length `h`; `x y z rx ry rz` are its motions,
//! translations first. A cubic deflection `w(s)` with `w(h) = w`, `w'(h) = p` takes the length
//!
//! ```text
//! b(w, p) = 1/2 int_0^h w'(s)^2 ds = 1/2 (6/5 w^2/h - 1/5 w p + 2/15 h p^2)
//! ```
//!
//! away from the axis, in each plane of bending: `b_y(y, fz)` and `b_z(z, -fy)`, for `fz = dy/dx` and
//! `fy = -dz/dx`. What stretches the axis is therefore `x + b_y + b_z`, and with
//! `e = (x + b_y + b_z, y, z, fx, fy, fz)` the energy is `1/2 e^T K e`. For a matrix that does not
//! couple `x` with the rest this is `1/2 (EA/h) (x + b_y + b_z)^2` plus the energy of bending and
//! torsion; couplings of `x` (an eccentric axis, a matrix from finite elements) see the same stretch.
//! `f` is the rotation vector of `Rx(rx) Ry(ry) Rz(rz)`: in a plane the angle itself, and in space
//! free of their order, which would turn second-order convergence under torsion into first-order.
//!
//! There is one potential, so torques are integrable and the tangent symmetric; at rest the matrix
//! is `K`, exactly. An axial force `N` adds `N d2b` to the tangent, the consistent geometric stiffness
//! of a beam: pinned columns buckle at the Euler load with an error that falls with the fourth power
//! of the number of segments, and tension never buckles anything (translations alone, "TR", do not
//! know it: their columns are too stiff and fail in tension). Bending of a segment must stay
//! moderate (`p` well below one): that is what the segments are for. Torsion under bending (lateral
//! buckling) comes from the segments too.

use nalgebra::{Matrix6, Vector6};
use serde::{Deserialize, Serialize};

use crate::model::springs::jet::{Jet, quadratic};
use crate::model::springs::logarithm::{angles, with_rotation_vector};
use crate::model::springs::response::Response;

/// Energy of a beam segment that shortens as it bends; see [`crate::LinkConvention::Bowing`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BowingLaw {
    /// Stiffness at the far end with the root clamped, 6 x 6 (N/m, N/rad, N m/m, N m/rad).
    pub matrix: Matrix6<f64>,
    /// Length of the segment along local x, m.
    pub length: f64,
}

/// Lateral and angular coordinate of each plane of bending and the sign of the slope `p` in the
/// angle: `p = rz` for motions along y, `p = -ry` for motions along z.
const PLANES: [(usize, usize, f64); 2] = [(1, 5, 1.0), (2, 4, -1.0)];

impl BowingLaw {
    /// Deflection with rotations as a vector and the stretch of the axis as first entry.
    fn strain(&self, deflection: &Vector6<f64>) -> [Jet; 6] {
        let h = self.length;
        let mut strain = with_rotation_vector(deflection);
        for (lateral, angle, sign) in PLANES {
            let (w, p) = (strain[lateral], strain[angle]);
            let own = (w * w).scaled(0.6 / h) + (p * p).scaled(h / 15.0);
            strain[0] = strain[0] + own - (w * p).scaled(0.1 * sign);
        }
        strain
    }

    /// The deflection (m, rad) whose strain is that of `deflection` plus the linearised change by
    /// `step`: a stiff axis would otherwise answer every step of bending by a huge force.
    pub(crate) fn follow(&self, deflection: &Vector6<f64>, step: &Vector6<f64>) -> Vector6<f64> {
        let strain = self.strain(deflection);
        let next = Vector6::from_fn(|i, _| strain[i].value + strain[i].gradient.dot(step));
        let angles = angles(&next.fixed_rows::<3>(3).into_owned());
        let mut found = Vector6::new(0.0, next[1], next[2], angles.x, angles.y, angles.z);
        found[0] = next[0] - self.strain(&found)[0].value;
        found
    }

    /// Energy (J), torques and tangent at a deflection (m, rad).
    pub(crate) fn respond(&self, deflection: &Vector6<f64>) -> Response {
        quadratic(&self.matrix, &self.strain(deflection))
    }
}

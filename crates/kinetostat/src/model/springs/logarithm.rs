//! Energies of a segment in exponential coordinates (book: Conventions, Links that bend).
//!
//! An energy is a function of the relative pose of a segment's ends; the coordinates in which that
//! pose is written do not matter. The chain keeps the six motions "translations first", whose pose
//! is `T = (p, R)` with `p = (x, y, z)` and `R = Rx(rx) Ry(ry) Rz(rz)`, and the law takes
//!
//! ```text
//! e = log(Tx(a) T) - (a, 0, 0, 0, 0, 0),     E = 1/2 e^T K e
//! log (p, R) = (p - 1/2 f x p + c f x (f x p), f),   f = log R,   c = (1 - |f|/2 cot(|f|/2)) / |f|^2
//! ```
//!
//! With `a = 0` these are exponential coordinates of the spring, the same at the end as in the
//! middle of the segment, because `Tx exp(e) Tx^-1 = exp(Ad e)` and `K` moves with it. With `a` the
//! segment's length, `e / a` is the change of a strain that is constant along the segment. The
//! derivatives are exact: every quantity carries its gradient and second derivative.

use nalgebra::{Matrix6, Rotation3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::model::springs::jet::{Jet, angle_per_sine, cross, logarithm_factor, quadratic, square};
use crate::model::springs::response::Response;
use crate::model::uniform::to_middle;

/// Energy in exponential coordinates; see [`crate::LinkConvention::Exponential`] and
/// [`crate::LinkConvention::ConstantStrain`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogarithmLaw {
    /// 6 x 6 (N/m, N/rad, N m/m, N m/rad) in the exponential coordinates.
    pub matrix: Matrix6<f64>,
    /// Length `a` along local x over which the logarithm is taken, m: zero for the spring alone.
    pub length: f64,
}

impl LogarithmLaw {
    /// Stiffness at rest in the six motions "translations first".
    pub(crate) fn at_rest(&self) -> Matrix6<f64> {
        let rates = to_middle(self.length);
        rates.transpose() * self.matrix * rates
    }

    /// The deflection (m, rad) whose strain is that of `deflection` plus the linearised change by
    /// `step`: the exponential of that strain.
    pub(crate) fn follow(&self, deflection: &Vector6<f64>, step: &Vector6<f64>) -> Vector6<f64> {
        let strain = logarithm(deflection, self.length);
        let next = Vector6::from_fn(|i, _| strain[i].value + strain[i].gradient.dot(step));
        let rho = Vector3::new(next[0] + self.length, next[1], next[2]);
        let turn = Vector3::new(next[3], next[4], next[5]);
        let t = turn.norm();
        let (a, b) = if t > 1e-4 {
            ((1.0 - t.cos()) / (t * t), (t - t.sin()) / t.powi(3))
        } else {
            (0.5, 1.0 / 6.0)
        };
        let once = turn.cross(&rho);
        // The length is never added to what is moved: a stiff axis would feel the digits that it takes.
        let p = next.fixed_rows::<3>(0) + once * a + turn.cross(&once) * b;
        let angles = angles(&turn);
        Vector6::new(p.x, p.y, p.z, angles.x, angles.y, angles.z)
    }

    /// Energy (J), torques and tangent at a deflection (m, rad).
    pub(crate) fn respond(&self, deflection: &Vector6<f64>) -> Response {
        quadratic(&self.matrix, &logarithm(deflection, self.length))
    }
}

/// Rotation vector of `Rx(rx) Ry(ry) Rz(rz)` with derivatives.
fn turn(deflection: &Vector6<f64>) -> [Jet; 3] {
    let half = |k: usize| {
        let angle = Jet::coordinate(deflection[k], k);
        let (s, c) = (0.5 * deflection[k]).sin_cos();
        [
            angle.map([c, -0.5 * s, -0.25 * c]),
            angle.map([s, 0.5 * c, -0.25 * s]),
        ]
    };
    let ([ca, sa], [cb, sb], [cc, sc]) = (half(3), half(4), half(5));
    let scalar = ca * cb * cc - sa * sb * sc;
    let side = if scalar.value < 0.0 { -1.0 } else { 1.0 };
    let vector = [
        (sa * cb * cc + ca * sb * sc).scaled(side),
        (ca * sb * cc - sa * cb * sc).scaled(side),
        (ca * cb * sc + sa * sb * cc).scaled(side),
    ];
    let s = square(&vector);
    let ratio = s.map(angle_per_sine(s.value)).scaled(2.0);
    vector.map(|v| ratio * v)
}

/// The six motions with their rotations as a rotation vector, with derivatives.
pub(crate) fn with_rotation_vector(deflection: &Vector6<f64>) -> [Jet; 6] {
    let [a, b, c] = turn(deflection);
    let [x, y, z] = std::array::from_fn(|i| Jet::coordinate(deflection[i], i));
    [x, y, z, a, b, c]
}

/// Angles of `Rx(rx) Ry(ry) Rz(rz)` with a given rotation vector.
pub(crate) fn angles(turn: &Vector3<f64>) -> Vector3<f64> {
    let r = Rotation3::from_scaled_axis(*turn);
    Vector3::new(
        (-r[(1, 2)]).atan2(r[(2, 2)]),
        r[(0, 2)].clamp(-1.0, 1.0).asin(),
        (-r[(0, 1)]).atan2(r[(0, 0)]),
    )
}

/// `log(Tx(length) T) - (length, 0, 0, 0, 0, 0)` with derivatives.
fn logarithm(deflection: &Vector6<f64>, length: f64) -> [Jet; 6] {
    let turn = turn(deflection);
    let t = square(&turn);
    let factor = t.map(logarithm_factor(t.value));
    let moved: [Jet; 3] = std::array::from_fn(|i| Jet::coordinate(deflection[i], i));
    let mut point = moved;
    point[0].value += length;
    let once = cross(&turn, &point);
    let twice = cross(&turn, &once);
    // As in `follow`, the length is not added to what is moved.
    let linear: [Jet; 3] =
        std::array::from_fn(|i| moved[i] - once[i].scaled(0.5) + factor * twice[i]);
    let ([x, y, z], [a, b, c]) = (linear, turn);
    [x, y, z, a, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logarithm_is_that_of_rotations() {
        let d = Vector6::new(0.1, -0.2, 0.3, 0.9, -0.7, 1.1);
        let found = logarithm(&d, 0.0);
        let axis = |k: usize| {
            nalgebra::UnitQuaternion::from_scaled_axis(Vector3::from_fn(|i, _| {
                if i == k { d[3 + k] } else { 0.0 }
            }))
        };
        let turn = axis(0) * axis(1) * axis(2);
        let w = turn.scaled_axis();
        for k in 0..3 {
            assert!((found[3 + k].value - w[k]).abs() < 1e-14);
        }
        // exp back: p = V(w) rho.
        let rho = Vector3::from_fn(|i, _| found[i].value);
        let t = w.norm();
        let p = rho
            + w.cross(&rho) * ((1.0 - t.cos()) / (t * t))
            + w.cross(&w.cross(&rho)) * ((t - t.sin()) / t.powi(3));
        assert!((p - Vector3::new(0.1, -0.2, 0.3)).norm() < 1e-14);
        for length in [0.0, 0.7] {
            let matrix = Matrix6::identity();
            let back = LogarithmLaw { matrix, length }.follow(&d, &Vector6::zeros());
            assert!((back - d).norm() < 1e-14, "{back}");
        }
    }
}

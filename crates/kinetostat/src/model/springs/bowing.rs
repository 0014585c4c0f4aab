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

//!
//! Everything below is written once, for every number ([`crate::linalg::derivatives`]): the general engine and the
//! vectorised kernels evaluate the same formulas.

use crate::linalg::derivatives::{Forward, Number, Real};
use crate::model::springs::curved::{CurvedLaw, Six, times};
use crate::model::springs::logarithm::{angles, rotation_vector, torque_on_turns};
use nalgebra::{Matrix6, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Energy of a beam segment that shortens as it bends; see [`crate::model::LinkConvention::Bowing`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct BowingLaw {
    /// Stiffness at the far end with the root clamped, 6 x 6 (N/m, N/rad, N m/m, N m/rad).
    pub matrix: Matrix6<f64>,
    /// Length of the segment along local x, m.
    pub length: f64,
}

/// Shortening of the axis by a plane of bending, `b(w, p)`.
#[inline(always)]
fn bow<N: Number>(h: f64, w: N, p: N, sign: f64) -> N {
    (w * w) * (0.6 / h) + (p * p) * (h / 15.0) - (w * p) * (0.1 * sign)
}

impl BowingLaw {
    /// Rates of the axis' stretch by the motions across it and by the rotation vector.
    #[inline(always)]
    fn stretches<N: Number>(&self, strain: &[N; 6]) -> ([N; 2], [N; 2]) {
        let [_, y, z, _, fy, fz] = *strain;
        let (h, slope) = (self.length, 1.2 / self.length);
        let across = [y * slope - fz * 0.1, z * slope + fy * 0.1];
        let turning = [
            fy * (2.0 * h / 15.0) + z * 0.1,
            fz * (2.0 * h / 15.0) - y * 0.1,
        ];
        (across, turning)
    }

    /// A deflection with its rates by the three turns.
    #[inline(always)]
    fn by_turns<R: Real>(at: &[R; 6]) -> [Forward<R, 3>; 6] {
        let mut along = [Forward::constant(at[0]); 6];
        for k in 0..3 {
            along[k] = Forward::constant(at[k]);
            along[3 + k] = Forward::variable(at[3 + k], k);
        }
        along
    }

    /// A symmetric matrix from torques with their rates by the three turns; entries among translations are
    /// left zero.
    #[inline(always)]
    fn symmetric<R: Real>(torque: &[Forward<R, 3>; 6]) -> Six<R> {
        let mut out = [[torque[0].value.same(0.0); 6]; 6];
        for i in 0..6 {
            for j in 0..3 {
                out[i][3 + j] = torque[i].rate[j];
                if i < 3 {
                    out[3 + j][i] = torque[i].rate[j];
                }
            }
        }
        out
    }
}

impl CurvedLaw for BowingLaw {
    fn matrix(&self) -> &Matrix6<f64> {
        &self.matrix
    }

    fn at_rest(&self) -> Matrix6<f64> {
        self.matrix
    }

    fn fault(&self) -> Option<&'static str> {
        let fits = self.length.is_finite() && self.length >= f64::MIN_POSITIVE;
        (!fits).then_some("the length of its segment is not a positive number of metres")
    }

    #[inline(always)]
    fn strain<N: Number>(&self, at: &[N; 6]) -> [N; 6] {
        let [x, y, z, ..] = *at;
        let [fx, fy, fz] = rotation_vector(&[at[3], at[4], at[5]]);
        let stretch = x + bow(self.length, y, fz, 1.0) + bow(self.length, z, fy, -1.0);
        [stretch, y, z, fx, fy, fz]
    }

    #[inline(always)]
    fn torque<N: Number>(&self, at: &[N; 6], strain: &[N; 6], square: N, force: &[N; 6]) -> [N; 6] {
        let n = force[0];
        let (across, turning) = self.stretches(strain);
        let m = [
            force[3],
            n.times_plus(turning[0], force[4]),
            n.times_plus(turning[1], force[5]),
        ];
        let f = [strain[3], strain[4], strain[5]];
        let [a, b, c] = torque_on_turns(&[at[3], at[4], at[5]], &f, square, &m);
        [
            n,
            n.times_plus(across[0], force[1]),
            n.times_plus(across[1], force[2]),
            a,
            b,
            c,
        ]
    }

    /// Derivatives by the turns are carried along; those by the translations are written out, and the rest
    /// follows since a potential has a symmetric tangent.
    #[inline(always)]
    fn tangent<R: Real>(&self, at: &[R; 6]) -> Six<R> {
        let along = Self::by_turns(at);
        let (strain, square) = self.strain_and_square(&along);
        let force = times(&self.matrix, &strain);
        let mut out = Self::symmetric(&self.torque(&along, &strain, square, &force));
        // Derivatives of the axis' strain by x, y and z.
        let ([y, z], _) = self.stretches(&strain);
        let first = [at[0].same(1.0), y.value, z.value];
        let k = |i: usize, j: usize| at[0].same(self.matrix[(i, j)]);
        for i in 0..3 {
            for j in 0..3 {
                let mut sum = first[i] * first[j] * self.matrix[(0, 0)];
                if j > 0 {
                    sum = sum + first[i] * self.matrix[(0, j)];
                }
                if i > 0 {
                    sum = sum + first[j] * self.matrix[(i, 0)];
                }
                if i > 0 && j > 0 {
                    sum = sum + k(i, j);
                }
                if i > 0 && i == j {
                    sum = sum + force[0].value * (1.2 / self.length);
                }
                out[i][j] = sum;
            }
        }
        out
    }

    #[inline(always)]
    fn geometric<R: Real>(&self, at: &[R; 6]) -> (Six<R>, Six<R>) {
        let (zero, one) = (at[0].same(0.0), at[0].same(1.0));
        let along = Self::by_turns(at);
        let (strain, square) = self.strain_and_square(&along);
        let held = times(&self.matrix, &strain).map(|force| Forward::constant(force.value));
        let mut geometric = Self::symmetric(&self.torque(&along, &strain, square, &held));
        for i in 1..3 {
            geometric[i][i] = held[0].value * (1.2 / self.length);
        }
        let (across, turning) = self.stretches(&strain);
        let r: [[R; 3]; 3] = std::array::from_fn(|i| strain[3 + i].rate);
        let minor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            r[a][c] * r[b][d] - r[a][d] * r[b][c]
        };
        let whole = r[0][0] * minor(0, 0) + r[0][1] * minor(0, 1) + r[0][2] * minor(0, 2);
        let per = one / whole;
        let mut inverse = [[zero; 6]; 6];
        for i in 0..3 {
            inverse[i][i] = one;
            for j in 0..3 {
                inverse[3 + i][3 + j] = minor(j, i) * per;
            }
        }
        for k in 0..2 {
            inverse[0][1 + k] = -across[k].value;
            inverse[0][4 + k] = -turning[k].value;
        }
        (geometric, inverse)
    }

    /// A stiff axis would otherwise answer every step of bending by a huge force.
    fn with_strain(&self, strain: &Vector6<f64>) -> Vector6<f64> {
        let angles = angles(&strain.fixed_rows::<3>(3).into_owned());
        let mut found = [0.0, strain[1], strain[2], angles.x, angles.y, angles.z];
        found[0] = strain[0] - self.strain(&found)[0];
        found.into()
    }
}

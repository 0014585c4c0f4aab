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
//! segment's length, `e / a` is the change of a strain that is constant along the segment. With `g` the forces
//! and `m` the moments of the strains, `P = p + (a, 0, 0)` and `c' = dc / d|f|^2`, the transposed rates of `e` give
//!
//! ```text
//! on p:  g + f x g / 2 + c f x (f x g)
//! on f:  m - P x g / 2 + c ((f x P) x g + P x (g x f)) + 2 c' (g . f x (f x P)) f
//! ```
//!
//! and the moment on `f` turns the three angles as [`torque_on_turns`] says.

use nalgebra::{Matrix6, Rotation3, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::linalg::derivatives::{Number, inner, outer};
use crate::model::beam::to_middle;
use crate::model::springs::curved::CurvedLaw;

/// Energy in exponential coordinates; see [`crate::model::LinkConvention::Exponential`] and
/// [`crate::model::LinkConvention::ConstantStrain`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct LogarithmLaw {
    /// 6 x 6 (N/m, N/rad, N m/m, N m/rad) in the exponential coordinates.
    pub matrix: Matrix6<f64>,
    /// Length `a` along local x over which the logarithm is taken, m: zero for the spring alone.
    pub length: f64,
}

impl LogarithmLaw {
    /// Moved point, from the near end of the segment: `P`.
    #[inline(always)]
    fn point<N: Number>(&self, at: &[N; 6]) -> [N; 3] {
        [at[0] + at[0].same(self.length), at[1], at[2]]
    }
}

impl CurvedLaw for LogarithmLaw {
    fn matrix(&self) -> &Matrix6<f64> {
        &self.matrix
    }

    fn at_rest(&self) -> Matrix6<f64> {
        let rates = to_middle(self.length);
        rates.transpose() * self.matrix * rates
    }

    fn fault(&self) -> Option<&'static str> {
        let fits = self.length.is_finite() && self.length >= 0.0;
        (!fits).then_some("the length of its segment is not a positive number of metres")
    }

    #[inline(always)]
    fn strain<N: Number>(&self, at: &[N; 6]) -> [N; 6] {
        let f = rotation_vector(&[at[3], at[4], at[5]]);
        let [c, _] = inner(&f, &f).logarithm_factor();
        let once = outer(&f, &self.point(at));
        let twice = outer(&f, &once);
        // The length is never added to what is moved: a stiff axis would feel the digits that it takes.
        let mut moved = [at[0], at[1], at[2]];
        for k in 0..3 {
            moved[k] = c.times_plus(twice[k], moved[k] - once[k] * 0.5);
        }
        [moved[0], moved[1], moved[2], f[0], f[1], f[2]]
    }

    #[inline(always)]
    fn torque<N: Number>(&self, at: &[N; 6], strain: &[N; 6], square: N, force: &[N; 6]) -> [N; 6] {
        let f = [strain[3], strain[4], strain[5]];
        let (g, m) = (
            [force[0], force[1], force[2]],
            [force[3], force[4], force[5]],
        );
        let p = self.point(at);
        let [c, rate] = square.logarithm_factor();
        let (fg, fp) = (outer(&f, &g), outer(&f, &p));
        let (ffg, ffp, pg) = (outer(&f, &fg), outer(&f, &fp), outer(&p, &g));
        let (a, b) = (outer(&fp, &g), outer(&p, &fg));
        let along = rate * inner(&g, &ffp) * 2.0;
        let (mut on_point, mut on_turn) = (g, m);
        for k in 0..3 {
            on_point[k] = c.times_plus(ffg[k], g[k] + fg[k] * 0.5);
            let own = c.times_plus(a[k] - b[k], m[k] - pg[k] * 0.5);
            on_turn[k] = along.times_plus(f[k], own);
        }
        let [ta, tb, tc] = torque_on_turns(&[at[3], at[4], at[5]], &f, square, &on_turn);
        let [x, y, z] = on_point;
        [x, y, z, ta, tb, tc]
    }

    /// The exponential of the strain.
    fn with_strain(&self, strain: &Vector6<f64>) -> Vector6<f64> {
        let rho = Vector3::new(strain[0] + self.length, strain[1], strain[2]);
        let turn = Vector3::new(strain[3], strain[4], strain[5]);
        let t = turn.norm();
        let (a, b) = if t > 1e-4 {
            ((1.0 - t.cos()) / (t * t), (t - t.sin()) / t.powi(3))
        } else {
            (0.5, 1.0 / 6.0)
        };
        let once = turn.cross(&rho);
        // The length is not added to the moved point, as in `strain`.
        let p = strain.fixed_rows::<3>(0) + once * a + turn.cross(&once) * b;
        let angles = angles(&turn);
        Vector6::new(p.x, p.y, p.z, angles.x, angles.y, angles.z)
    }
}

/// Rotation vector of `Rx(a) Ry(b) Rz(c)`, from half angles.
#[inline(always)]
pub(crate) fn rotation_vector<N: Number>(turns: &[N; 3]) -> [N; 3] {
    let (sa, ca) = (turns[0] * 0.5).sin_cos_of_spring();
    let (sb, cb) = (turns[1] * 0.5).sin_cos_of_spring();
    let (sc, cc) = (turns[2] * 0.5).sin_cos_of_spring();
    let mut v = [
        (sa * cb).times_plus(cc, ca * sb * sc),
        (ca * sb).times_plus(cc, -(sa * cb * sc)),
        (ca * cb).times_plus(sc, sa * sb * cc),
    ];
    // The shorter one of the two vectors of a rotation.
    if (ca * cb * cc - sa * sb * sc).is_negative() {
        v = [-v[0], -v[1], -v[2]];
    }
    let ratio = inner(&v, &v).angle_per_sine() * 2.0;
    [v[0] * ratio, v[1] * ratio, v[2] * ratio]
}

/// Torques in the three turns from those (`m`) by the rotation vector (`f`, of the given square): the transposed
/// rate of the logarithm, `m + f x m / 2 + c f x (f x m)`, on the three axes of the turns.
#[inline(always)]
pub(crate) fn torque_on_turns<N: Number>(
    turns: &[N; 3],
    f: &[N; 3],
    square: N,
    m: &[N; 3],
) -> [N; 3] {
    let [c, _] = square.logarithm_factor();
    let once = outer(f, m);
    let twice = outer(f, &once);
    let mut about = *m;
    for k in 0..3 {
        about[k] = c.times_plus(twice[k], m[k] + once[k] * 0.5);
    }
    let ((sx, cx), (sy, cy)) = (turns[0].sin_cos_of_spring(), turns[1].sin_cos_of_spring());
    let third = [sy, -(sx * cy), cx * cy];
    [
        about[0],
        cx.times_plus(about[1], sx * about[2]),
        inner(&third, &about),
    ]
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

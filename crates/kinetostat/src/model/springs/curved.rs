//! Laws of six coordinates whose strains are not linear in them: `E = 1/2 e^T K e` with `e = e(x)`.
//!
//! With `J = de/dx` and `s = K e`, torques are `J^T s` and the tangent has two parts: `J^T K J`, material, and what
//! `J` changes under `s`, geometric. A law gives its strains and the product `J^T s`; everything else follows by
//! forward-mode derivatives, or is overridden where a law knows a shorter way.

use nalgebra::{Matrix6, Vector6};

use crate::linalg::derivatives::{Forward, Number, Real, inner};

/// A 6 x 6 matrix by rows.
pub(crate) type Six<N> = [[N; 6]; 6];

/// A law of the six motions of a spring (m, rad; translations before rotations).
pub trait CurvedLaw {
    /// Stiffness `K` of the strains.
    fn matrix(&self) -> &Matrix6<f64>;

    /// Stiffness of the six motions at rest.
    fn at_rest(&self) -> Matrix6<f64>;

    /// Describes the fault of its numbers, the stiffness excepted.
    fn fault(&self) -> Option<&'static str>;

    /// Strains; the last three are the rotation vector.
    fn strain<N: Number>(&self, at: &[N; 6]) -> [N; 6];

    /// `J^T s` for any `s`; `square` is that of the rotation vector.
    fn torque<N: Number>(&self, at: &[N; 6], strain: &[N; 6], square: N, force: &[N; 6]) -> [N; 6];

    /// The deflection with these strains.
    fn with_strain(&self, strain: &Vector6<f64>) -> Vector6<f64>;

    /// Strains and the square of the rotation vector.
    #[inline(always)]
    fn strain_and_square<N: Number>(&self, at: &[N; 6]) -> ([N; 6], N) {
        let strain = self.strain(at);
        let f = [strain[3], strain[4], strain[5]];
        (strain, inner(&f, &f))
    }

    /// Torques at a deflection, and the square of the rotation.
    #[inline(always)]
    fn torque_at<N: Number>(&self, at: &[N; 6]) -> ([N; 6], N) {
        let (strain, square) = self.strain_and_square(at);
        let force = times(self.matrix(), &strain);
        (self.torque(at, &strain, square, &force), square)
    }

    /// Everything to first order.
    #[inline(always)]
    fn linearised<R: Real>(&self, at: &[R; 6]) -> Linearised<R> {
        let along = Forward::variables(at);
        let (strain, square) = self.strain_and_square(&along);
        let values = strain.map(|e| e.value);
        let force = times(self.matrix(), &values);
        let held = force.map(Forward::constant);
        let torque = self.torque(&along, &strain, square, &held);
        let mut geometric = torque.map(|t| t.rate);
        for i in 0..6 {
            for j in 0..i {
                let mean = (geometric[i][j] + geometric[j][i]) * 0.5;
                (geometric[i][j], geometric[j][i]) = (mean, mean);
            }
        }
        Linearised {
            strain: values,
            force,
            torque: torque.map(|t| t.value),
            rates: strain.map(|e| e.rate),
            geometric,
        }
    }

    /// Tangent stiffness.
    #[inline(always)]
    fn tangent<R: Real>(&self, at: &[R; 6]) -> Six<R> {
        let own = self.linearised(at);
        let mut out = own.geometric;
        let bent: Six<R> = std::array::from_fn(|j| {
            times(self.matrix(), &std::array::from_fn(|i| own.rates[i][j]))
        });
        for i in 0..6 {
            for j in 0..6 {
                for k in 0..6 {
                    out[i][j] = own.rates[k][i].times_plus(bent[j][k], out[i][j]);
                }
            }
        }
        out
    }

    /// Geometric stiffness, and the inverse of the rates of the strains by the six motions.
    #[inline(always)]
    fn geometric<R: Real>(&self, at: &[R; 6]) -> (Six<R>, Six<R>) {
        let own = self.linearised(at);
        (own.geometric, inverse(own.rates))
    }

    /// The deflection whose strain is that of `deflection` plus the linearised change by `step`.
    fn follow(&self, deflection: &Vector6<f64>, step: &Vector6<f64>) -> Vector6<f64> {
        let at: [f64; 6] = (*deflection).into();
        let strain = self.strain(&Forward::variables(&at));
        self.with_strain(&Vector6::from_fn(|i, _| {
            strain[i].value + Vector6::from(strain[i].rate).dot(step)
        }))
    }

    /// Response at a deflection, for the general engine.
    fn respond(&self, deflection: &Vector6<f64>) -> Response {
        let own = self.linearised(&(*deflection).into());
        let rates = Matrix6::from_fn(|i, j| own.rates[i][j]);
        Response {
            energy: 0.5 * Vector6::from(own.strain).dot(&Vector6::from(own.force)),
            torque: own.torque.into(),
            material: rates.transpose() * self.matrix() * rates,
            geometric: Matrix6::from_fn(|i, j| own.geometric[i][j]),
        }
    }
}

/// A law to first order about a deflection.
pub struct Linearised<N> {
    strain: [N; 6],
    /// Forces of the strains.
    force: [N; 6],
    torque: [N; 6],
    /// Strains by motions.
    rates: Six<N>,
    geometric: Six<N>,
}

/// `K e` for a constant matrix.
#[inline(always)]
pub(crate) fn times<N: Number>(matrix: &Matrix6<f64>, e: &[N; 6]) -> [N; 6] {
    let mut out = [e[0] * 0.0; 6];
    for i in 0..6 {
        for j in 0..6 {
            out[i] = out[i] + e[j] * matrix[(i, j)];
        }
    }
    out
}

/// Inverse of a matrix near the identity, without pivoting.
#[inline(always)]
fn inverse<N: Number>(mut m: Six<N>) -> Six<N> {
    let (zero, one) = (m[0][0].same(0.0), m[0][0].same(1.0));
    let mut x = [[zero; 6]; 6];
    for k in 0..6 {
        x[k][k] = one;
    }
    for k in 0..6 {
        let reciprocal = one / m[k][k];
        for j in 0..6 {
            m[k][j] = m[k][j] * reciprocal;
            x[k][j] = x[k][j] * reciprocal;
        }
        for i in 0..6 {
            let l = m[i][k];
            if i == k {
                continue;
            }
            for j in 0..6 {
                m[i][j] = l.times_from(m[k][j], m[i][j]);
                x[i][j] = l.times_from(x[k][j], x[i][j]);
            }
        }
    }
    x
}

/// Response of a six-dimensional law to a deflection.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// J.
    pub energy: f64,
    /// Gradient of the energy, N or N m.
    pub torque: Vector6<f64>,
    /// Second derivative that the strains' rates make: positive definite as the matrix of the law is.
    pub material: Matrix6<f64>,
    /// Second derivative that a curvature of the strains adds under load: the geometric stiffness.
    pub geometric: Matrix6<f64>,
}

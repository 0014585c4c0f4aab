//! The conditions of equilibrium of a long chain along a curve, eliminated by a sweep.
//!
//! With the end on a spring `S` ([`crate::chain::sweep::factor`]) the coordinates are regular at limit points
//! and bifurcations too: `x = X_0 + R (F + S t) - X_l lambda`. What is left are thirteen equations for
//! wrench `F` and motion `t` of the end and for the parameter,
//!
//! ```text
//! -E F + (1 - E S) t + t_l lambda = t_0                    compliance of the chain
//! motion t + wrench F + along lambda = right               what holds the end, or acts on it
//! (R^T n + n_F) F + S R^T n t + (n_l - n X_l) lambda = s - n X_0      the closing row (n, n_F, n_l)
//! ```
//!
//! The determinant of the whole matrix is that of the sweep's pivots times that of these thirteen.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use crate::chain::sweep::factor::{Factored, STEP_SPRINGS};
use crate::chain::sweep::solve::EndRows;
use crate::chain::sweep::stages::{Form, Sweep, column};
use crate::continuation::linear::tangent::{Tangent, determinant};
use crate::linalg::complement::complement;
use crate::linalg::saddle::Saddle;
use crate::number::larger;

/// A state of a curve, its chain swept.
pub(crate) struct CurveSweep {
    sweep: Box<Sweep>,
    factored: Factored,
    /// Share of a residual that shows that a pivot was too small.
    lost: f64,
    /// Directions of the reactions, 6 x r.
    range: DMatrix<f64>,
    rows: EndRows,
    /// `dG/dlambda`: of the reactions' r conditions, then of the coordinates'.
    pub gradient: DVector<f64>,
    /// `X_l` and `t_l`.
    by_parameter: (Vec<f64>, Vector6<f64>),
    /// Largest entry of `E`.
    size: f64,
    /// Sign and logarithm of the pivots' determinant.
    pivots: (f64, f64),
}

/// Sweep with its closing row.
pub(crate) struct Closed<'s> {
    own: &'s CurveSweep,
    normal: DVector<f64>,
    matrix: DMatrix<f64>,
    end: Saddle,
}

/// Reactions or wrench and motion of the end, coordinates, parameter.
struct Unknowns {
    wrench: Vector6<f64>,
    x: Vec<f64>,
    lambda: f64,
}

/// Solutions beyond this size per unit show that the matrix may have a second null direction.
const NEARLY_SINGULAR: f64 = 1e6;

impl CurveSweep {
    /// `turned` maps the motion of the end to the change of its residual. `None` where the sweep
    /// loses a pivot.
    pub fn new(
        sweep: &Sweep,
        range: &DMatrix<f64>,
        turned: &Matrix6<f64>,
        gradient: DVector<f64>,
    ) -> Option<Self> {
        if !sweep.serial {
            return None;
        }
        let mut rows = EndRows::held(range);
        rows.motion *= turned;
        let r = range.ncols();
        let own: Vec<f64> = gradient.rows_range(r..).iter().copied().collect();
        let (factored, lost) = STEP_SPRINGS.into_iter().find_map(|spring| {
            let factored = Factored::new(sweep, Form::Exact, spring)?;
            Some((factored, spring.lost))
        })?;
        let mut by_parameter = own;
        let moved = factored.solve(sweep, &mut by_parameter);
        let mut basis = range.clone().resize_horizontally(6, 0.0);
        if r < 6 {
            basis.columns_mut(r, 6 - r).copy_from(&complement(range));
        }
        let (sign, logarithm) = factored.determinant(sweep);
        Some(Self {
            size: factored.end.amax().max(f64::MIN_POSITIVE),
            sweep: Box::new(sweep.clone()),
            factored,
            lost,
            range: range.clone(),
            rows,
            gradient,
            by_parameter: (by_parameter, moved),
            pivots: (sign * basis.determinant().signum(), logarithm),
        })
    }

    /// Adds a further row over reactions, coordinates and parameter.
    pub fn closed_by(&self, normal: &DVector<f64>) -> Closed<'_> {
        let (r, n) = (self.range.ncols(), self.sweep.count());
        let (end, spring) = (self.factored.end, self.factored.spring);
        let mut pulled = Vector6::zeros();
        let mut along = normal[r + n];
        for i in 0..n {
            pulled += self.factored.response(i) * normal[r + i];
            along -= normal[r + i] * self.by_parameter.0[i];
        }
        let of_wrench = &self.range * normal.rows(0, r);
        let mut a = DMatrix::zeros(13, 13);
        let held = Matrix6::identity() - end * spring;
        a.view_mut((0, 0), (6, 6)).copy_from(&(-end / self.size));
        a.view_mut((0, 6), (6, 6)).copy_from(&held);
        a.view_mut((0, 12), (6, 1)).copy_from(&self.by_parameter.1);
        for k in 0..6 {
            let unit = self.rows.unit(k, self.size);
            for j in 0..6 {
                a[(6 + k, j)] = self.rows.wrench[(k, j)] * unit / self.size;
                a[(6 + k, 6 + j)] = self.rows.motion[(k, j)] * unit;
            }
            if k < r {
                a[(6 + k, 12)] = self.gradient[k] * unit;
            }
        }
        let moved = spring.tr_mul(&pulled);
        for j in 0..6 {
            a[(12, j)] = (pulled[j] + of_wrench[j]) / self.size;
            a[(12, 6 + j)] = moved[j];
        }
        a[(12, 12)] = along;
        Closed {
            own: self,
            normal: normal.clone(),
            end: Saddle::new(a.clone(), &[1.0; 13], &[1.0; 13]),
            matrix: a,
        }
    }

    /// See [`crate::continuation::linear::curve_matrix::CurveMatrix::only_direction`].
    pub fn only_direction(&self) -> Option<DVector<f64>> {
        let m = self.gradient.len();
        let mut normal = DVector::zeros(m + 1);
        normal[m] = 1.0;
        let tangent = self.closed_by(&normal).tangent()?.direction;
        // Steps of inverse iteration show a small singular value.
        let closed = self.closed_by(&tangent);
        #[allow(clippy::cast_precision_loss)]
        let mut right =
            DVector::from_fn(m, |i, _| (i as f64 * 0.618_033_988_749_895).fract() - 0.4);
        for _ in 0..3 {
            right /= right.norm();
            let answer = closed.solve(&right, 0.0)?;
            if answer.norm() > NEARLY_SINGULAR {
                return None;
            }
            right = answer.rows(0, m).into_owned();
        }
        Some(tangent)
    }
}

impl Closed<'_> {
    fn once(&self, torque: &[f64], right: &Vector6<f64>, last: f64) -> Unknowns {
        let own = self.own;
        let r = own.range.ncols();
        let mut x = torque.to_vec();
        let start = own.factored.solve(&own.sweep, &mut x);
        let through: f64 = x
            .iter()
            .zip(self.normal.iter().skip(r))
            .map(|(x, n)| x * n)
            .sum();
        let mut b = DMatrix::zeros(13, 1);
        for k in 0..6 {
            b[(k, 0)] = start[k];
            b[(6 + k, 0)] = right[k] * own.rows.unit(k, own.size);
        }
        b[(12, 0)] = last - through;
        self.end.solve(&mut b);
        let wrench = Vector6::from_fn(|i, _| b[(i, 0)] / own.size);
        let motion = Vector6::from_fn(|i, _| b[(6 + i, 0)]);
        let lambda = b[(12, 0)];
        own.factored
            .add_response(&(wrench + own.factored.spring * motion), &mut x);
        for (x, by) in x.iter_mut().zip(&own.by_parameter.0) {
            *x -= lambda * by;
        }
        Unknowns { wrench, x, lambda }
    }

    /// Solves `[matrix; normal^T] z = (right, last)`; corrected by what is left over, if it matters.
    /// `None` if that does not help.
    pub fn solve(&self, right: &DVector<f64>, last: f64) -> Option<DVector<f64>> {
        let own = self.own;
        let (r, n) = (own.range.ncols(), own.sweep.count());
        let torque: Vec<f64> = right.iter().skip(r).copied().collect();
        let closure = Vector6::from_fn(|k, _| if k < r { right[k] } else { 0.0 });
        let mut z = self.once(&torque, &closure, last);
        let (mut motions, mut left) = (Vec::new(), vec![0.0; n]);
        for attempt in 0..3 {
            let tip = own
                .sweep
                .product(Form::Exact, &z.x, &mut motions, &mut left);
            let (mut worst, mut size) = (0.0_f64, f64::MIN_POSITIVE);
            for i in 0..n {
                let pull = column(&own.sweep.twists, i).dot(&z.wrench);
                let grown = own.gradient[r + i] * z.lambda;
                size = [pull, grown, torque[i], left[i]]
                    .iter()
                    .fold(size, |s, v| larger(s, v.abs()));
                left[i] = torque[i] - pull - grown - left[i];
                worst = larger(worst, left[i].abs());
            }
            if !worst.is_finite() {
                return None;
            }
            if worst <= 1e-14 * size {
                break;
            }
            if attempt == 2 {
                if worst > own.lost * size {
                    return None;
                }
                break;
            }
            let mut rest = closure - own.rows.motion * tip - own.rows.wrench * z.wrench;
            for k in 0..r {
                rest[k] -= own.gradient[k] * z.lambda;
            }
            let reached = self.normal.dot(&self.state(&z));
            let more = self.once(&left, &rest, last - reached);
            z.wrench += more.wrench;
            z.lambda += more.lambda;
            for (x, d) in z.x.iter_mut().zip(more.x) {
                *x += d;
            }
        }
        let z = self.state(&z);
        z.iter().all(|v| v.is_finite()).then_some(z)
    }

    /// Reactions, coordinates and parameter.
    fn state(&self, z: &Unknowns) -> DVector<f64> {
        let r = self.own.range.ncols();
        let reactions = self.own.range.tr_mul(&z.wrench);
        let all = reactions.iter().chain(&z.x).copied();
        DVector::from_iterator(r + z.x.len() + 1, all.chain([z.lambda]))
    }

    /// See [`crate::continuation::linear::curve_matrix::CurveMatrix::tangent`].
    pub fn tangent(&self) -> Option<Tangent> {
        let own = self.own;
        let m = own.gradient.len();
        let solution = self.solve(&DVector::zeros(m), 1.0)?;
        let (sign, logarithm) = determinant(&self.matrix.clone().lu());
        #[allow(clippy::cast_precision_loss)]
        let scaled = own.range.ncols() as f64 * own.size.ln();
        Tangent::new(
            &solution,
            sign * own.pivots.0,
            logarithm + own.pivots.1 + scaled,
        )
    }
}

//! Response by solving `(K - H + i w C + i eta K_e - w^2 M) x = B^T f` at every frequency, for any damping and any loads, and static
//! flexibility.

use nalgebra::{Complex, DMatrix, Matrix6};

use crate::damping::Damping;
use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::places::Point;
use crate::modes::Modes;
use crate::modes::pencil::{neutral_directions, symmetric};
use crate::response::{Quantity, Receptance};

/// A machine's dynamic stiffness matrix at any frequency, with the damping put in.
pub struct DirectResponse<'d> {
    dynamics: &'d LinearDynamics,
    damping: DMatrix<f64>,
    /// Loss factor times material stiffness.
    loss: DMatrix<f64>,
    /// The coordinates that matter: neutral directions left out.
    rest: Option<DMatrix<f64>>,
}

impl LinearDynamics {
    /// Ready for responses by direct solution.
    ///
    /// # Errors
    /// [`Error::Damping`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3};
    /// # use kinetostat::*;
    /// # use kinetostat_dynamics::*;
    /// # let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 4e6);
    /// # let table = Chain::builder("table").actuator("slide", slide).body("table", 40.0, Vector3::zeros(), Matrix3::zeros()).build()?;
    /// # let problem = ChainProblem::new(&table, EndCondition::wrench(Wrench::zero()));
    /// # let dynamics = LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing())?;
    /// let modes = dynamics.modes()?;
    /// let damper = Damping::Viscous(vec![("slide".to_owned(), 250.0)]); // N s/m
    /// let tool = dynamics.tool();
    /// let hz = 30.0;
    /// let found = dynamics.direct(&modes, &damper)?.at_hz(tool, tool, hz)?[(0, 0)];
    /// let w = hz * std::f64::consts::TAU;
    /// let expected = nalgebra::Complex::new(4e6 - 40.0 * w * w, 250.0 * w).inv();
    /// assert!((found - expected).norm() < 1e-12 * expected.norm());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn direct(&self, modes: &Modes, damping: &Damping) -> Result<DirectResponse<'_>> {
        let loss = match damping {
            Damping::Structural { loss_factor } => &self.elastic * *loss_factor,
            _ => DMatrix::zeros(self.len(), self.len()),
        };
        let rest = (modes.counts.neutral > 0).then(|| {
            let u = &self.units;
            let scaled = |a: &DMatrix<f64>| {
                DMatrix::from_fn(self.len(), self.len(), |i, j| a[(i, j)] * u[i] * u[j])
            };
            let mut rest =
                neutral_directions(&scaled(&self.mass), &symmetric(scaled(&self.tangent))).1;
            for (mut row, unit) in rest.row_iter_mut().zip(u) {
                row *= *unit;
            }
            rest
        });
        Ok(DirectResponse {
            dynamics: self,
            damping: self.damping_matrix(modes, damping)?,
            loss,
            rest,
        })
    }
}

impl DirectResponse<'_> {
    /// `K - H + i w C + i eta K_e - w^2 M` at `w` (rad/s).
    fn stiffness(&self, w: f64) -> DMatrix<Complex<f64>> {
        let d = self.dynamics;
        let whole = DMatrix::from_fn(d.len(), d.len(), |i, j| {
            Complex::new(
                d.tangent[(i, j)] - w * w * d.mass[(i, j)],
                w * self.damping[(i, j)] + self.loss[(i, j)],
            )
        });
        match &self.rest {
            Some(rest) => {
                let rest = rest.map(|x| Complex::new(x, 0.0));
                rest.transpose() * whole * &rest
            }
            None => whole,
        }
    }

    fn within(&self, motions: DMatrix<f64>) -> DMatrix<Complex<f64>> {
        let own = match &self.rest {
            Some(rest) => motions * rest,
            None => motions,
        };
        own.map(|x| Complex::new(x, 0.0))
    }

    /// Receptance: motion of `at` by what acts on `from`.
    ///
    /// # Errors
    /// [`Error::NotSolved`] exactly at an undamped resonance.
    pub fn at_hz(&self, at: Point, from: Point, hz: f64) -> Result<Receptance> {
        Ok(self.over(at, from, &[hz], Quantity::Displacement)?[0])
    }

    /// Receptances at many frequencies, Hz.
    ///
    /// # Errors
    /// See [`Self::at_hz`].
    pub fn over(
        &self,
        at: Point,
        from: Point,
        hz: &[f64],
        quantity: Quantity,
    ) -> Result<Vec<Receptance>> {
        let (b_at, b_from) = (
            self.within(self.dynamics.motions(at)),
            self.within(self.dynamics.motions(from)),
        );
        let right = b_from.transpose();
        hz.iter()
            .map(|hz| {
                let w = hz * std::f64::consts::TAU;
                let x = solved(self.stiffness(w), &right).ok_or_else(|| self.resonance(*hz))?;
                let moved = &b_at * x;
                let by = quantity.factor(w);
                let value = Matrix6::from_fn(|i, j| moved[(i, j)] * by);
                match value.iter().all(|x| x.re.is_finite() && x.im.is_finite()) {
                    true => Ok(value),
                    false => Err(self.resonance(*hz)),
                }
            })
            .collect()
    }

    fn resonance(&self, hz: f64) -> Error {
        Error::NotSolved(format!(
            "'{}' has no finite response at {hz} Hz: an undamped mode or a free direction is there",
            self.dynamics.name
        ))
    }
}

/// `Z^-1 b` with rows and columns in units of the diagonal.
fn solved(
    mut z: DMatrix<Complex<f64>>,
    b: &DMatrix<Complex<f64>>,
) -> Option<DMatrix<Complex<f64>>> {
    let n = z.nrows();
    let units: Vec<f64> = (0..n)
        .map(|i| {
            let own = z[(i, i)].norm();
            if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
        })
        .collect();
    for j in 0..n {
        for i in 0..n {
            z[(i, j)] *= units[i] * units[j];
        }
    }
    let mut right = DMatrix::from_fn(n, b.ncols(), |i, j| b[(i, j)] * units[i]);
    if !z.lu().solve_mut(&mut right) {
        return None;
    }
    for (mut row, unit) in right.row_iter_mut().zip(&units) {
        row *= Complex::new(*unit, 0.0);
    }
    Some(right)
}

impl LinearDynamics {
    pub(crate) fn no_flexibility(&self) -> Error {
        Error::NotSolved(format!(
            "'{}' has a massless direction without stiffness that its loads couple with others: its flexibility at rest is not defined",
            self.name
        ))
    }

    /// `(K - H + s M)^-1 b` by the independent coordinates; neutral directions take no part.
    pub(crate) fn solved_with_shift(
        &self,
        shift: f64,
        b: &DMatrix<f64>,
        neutral: bool,
    ) -> Result<DMatrix<f64>> {
        let n = self.len();
        let u = &self.units;
        let scaled = |a: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| a[(i, j)] * u[i] * u[j]);
        let (mass, tangent) = (scaled(&self.mass), scaled(&self.tangent));
        let mut right = DMatrix::from_fn(n, b.ncols(), |i, j| b[(i, j)] * u[i]);
        let basis = neutral.then(|| neutral_directions(&mass, &symmetric(tangent.clone())).1);
        let mut a = tangent + mass * shift;
        if let Some(rest) = &basis {
            a = rest.tr_mul(&(a * rest));
            right = rest.tr_mul(&right);
        }
        let mut x = solve_scaled(a, right).ok_or_else(|| self.no_flexibility())?;
        if let Some(rest) = &basis {
            x = rest * x;
        }
        Ok(DMatrix::from_fn(n, b.ncols(), |i, j| x[(i, j)] * u[i]))
    }
}

/// `A^-1 b` with rows and columns in units of the diagonal.
fn solve_scaled(mut a: DMatrix<f64>, mut b: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let units: Vec<f64> = (0..n)
        .map(|i| {
            let own = a[(i, i)].abs();
            if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
        })
        .collect();
    for j in 0..n {
        for i in 0..n {
            a[(i, j)] *= units[i] * units[j];
        }
    }
    for (mut row, unit) in b.row_iter_mut().zip(&units) {
        row *= *unit;
    }
    let mut x = a.lu().solve(&b)?;
    for (mut row, unit) in x.row_iter_mut().zip(&units) {
        row *= *unit;
    }
    Some(x)
}

//! Reduction of a limb to the motions of its end and a few vibrations with the end held [Craig & Bampton 1968, D 8].
//!
//! The constraint modes are the columns `dx / d(motion of the end)` of the bordered inverse of the statics [R 4.28], the
//! others are modes with the end held. In this basis the stiffness is `blkdiag(K_C, w_f^2)`.

use nalgebra::{DMatrix, DVector};

use crate::ends::null_space;
use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::places::Point;
use crate::modes::pencil::{self, Shifted, symmetric};

/// A limb by six motions of one point and a few vibrations.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ReducedLimb {
    /// Mass by six motions of the point (base axes, about it) and the amplitudes of vibrations, (6 + k) square.
    pub mass: DMatrix<f64>,
    /// Stiffness: `K_C` and the squares of the frequencies with the point held.
    pub stiffness: DMatrix<f64>,
    /// Independent coordinates by the reduced ones, n x (6 + k).
    pub basis: DMatrix<f64>,
    /// Frequencies of the vibrations with the point held that were kept, Hz.
    pub kept_hz: Vec<f64>,
    /// The lowest one that was left out, Hz; none where all were kept. Trust the reduction well below it.
    pub left_out_hz: Option<f64>,
}

/// A frequency of a reduced limb with what it may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundedFrequency {
    /// Hz, never below the exact one of the same number.
    pub hz: f64,
    /// A frequency of the whole limb is not farther away than this share of it; a bound, mostly far from sharp.
    pub relative_bound: f64,
}

impl LinearDynamics {
    /// Keeps six motions of a point and the `kept` lowest vibrations with the point held.
    ///
    /// # Errors
    /// [`Error::Question`] where the point cannot move in six directions, or loads have no potential;
    /// [`Error::NotSolved`] where modes were not found.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3};
    /// # use kinetostat::*;
    /// # use kinetostat_dynamics::*;
    /// use kinetostat::model::LinkMass;
    ///
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03); // Pa, m
    /// let spec = LinkSpec::beam(bar, 0.8).segments(4).with_mass(LinkMass::of_section(&bar, 7850.0));
    /// let boom = Chain::builder("boom").link_with("bar", &spec).build()?;
    /// let problem = ChainProblem::new(&boom, EndCondition::wrench(Wrench::zero()));
    /// let at = solve_chain(&problem, &Settings::default())?;
    /// let whole = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())?;
    /// let reduced = whole.reduced(whole.tool(), 6)?;
    /// assert_eq!(reduced.mass.nrows(), 12);
    /// let (exact, found) = (whole.modes()?.modes[0].frequency_hz(), reduced.frequencies(&whole)?[0]);
    /// assert!(found.hz >= exact * (1.0 - 1e-12) && found.hz / exact - 1.0 < found.relative_bound + 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn reduced(&self, point: Point, kept: usize) -> Result<ReducedLimb> {
        if self.is_circulatory() {
            return Err(Error::Question(format!(
                "loads on '{}' have no potential: left and right modes differ, and no reduction by one set of them is right",
                self.name
            )));
        }
        let n = self.len();
        let u = &self.units;
        let scaled =
            |a: &DMatrix<f64>| symmetric(DMatrix::from_fn(n, n, |i, j| a[(i, j)] * u[i] * u[j]));
        let (mass, tangent) = (scaled(&self.mass), scaled(&self.tangent));
        let motions = self.motions(point);
        let rows = DMatrix::from_fn(6, n, |k, j| {
            motions[(k, j)] * u[j] * if k < 3 { 1.0 / self.length } else { 1.0 }
        });
        let (free, rank) = null_space(&rows);
        if rank < 6 {
            return Err(Error::Question(format!(
                "the point of '{}' moves in {rank} directions alone, six are needed",
                self.name
            )));
        }
        // Modes with the point held: those in the null space.
        let within = |a: &DMatrix<f64>| symmetric(free.tr_mul(&(a * &free)));
        let held = pencil::solve(&within(&mass), &within(&tangent)).ok_or_else(|| {
            Error::NotSolved(format!(
                "modes of '{}' with its end held were not found",
                self.name
            ))
        })?;
        let count = kept.min(held.squared.len());
        let vibrations = &free * held.shapes.columns(0, count);
        // Unit motions of the point: [0 J; J^T -K].
        let mut a = DMatrix::zeros(6 + n, 6 + n);
        a.view_mut((0, 6), (6, n)).copy_from(&rows);
        a.view_mut((6, 0), (n, 6)).copy_from(&rows.transpose());
        let size = tangent.diagonal().abs().max().max(f64::MIN_POSITIVE);
        a.view_mut((6, 6), (n, n)).copy_from(&(-&tangent / size));
        let mut right = DMatrix::zeros(6 + n, 6);
        for k in 0..6 {
            right[(k, k)] = if k < 3 { 1.0 / self.length } else { 1.0 };
        }
        let solved = a.lu().solve(&right).ok_or_else(|| {
            Error::NotSolved(format!(
                "'{}' with its end held has a motion without stiffness",
                self.name
            ))
        })?;
        let mut basis = DMatrix::zeros(n, 6 + count);
        basis.view_mut((0, 0), (n, 6)).copy_from(&solved.rows(6, n));
        basis.view_mut((0, 6), (n, count)).copy_from(&vibrations);
        for (mut row, unit) in basis.row_iter_mut().zip(u) {
            row *= *unit;
        }
        let by = |m: &DMatrix<f64>| symmetric(basis.tr_mul(&(m * &basis)));
        let hertz = |w2: &f64| w2.abs().sqrt().copysign(*w2) / std::f64::consts::TAU;
        Ok(ReducedLimb {
            mass: by(&self.mass),
            stiffness: by(&self.tangent),
            kept_hz: held.squared[..count].iter().map(hertz).collect(),
            left_out_hz: held.squared.get(count).map(hertz),
            basis,
        })
    }
}

impl ReducedLimb {
    /// Signed frequencies with a bound of what they are off, by one solution of the whole for each: with `v` a reduced mode
    /// and `theta` its `w^2`, some `1/w^2` of the whole lies within `|K^-1 M v - v / theta|_K / sqrt(theta)` of `1/theta`.
    ///
    /// # Errors
    /// [`Error::NotSolved`] where the whole is not stable: there is no such bound then.
    pub fn frequencies(&self, whole: &LinearDynamics) -> Result<Vec<BoundedFrequency>> {
        let none = || {
            Error::NotSolved(format!(
                "'{}' is not stable: reduced frequencies have no bound",
                whole.name
            ))
        };
        let n = self.mass.nrows();
        let length = whole.length;
        let unit = |i: usize| if i < 3 { length } else { 1.0 };
        let scaled =
            |a: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| a[(i, j)] * unit(i) * unit(j));
        let own = pencil::solve(&scaled(&self.mass), &scaled(&self.stiffness)).ok_or_else(none)?;
        let factor = Shifted::find(
            &symmetric(whole.mass.clone()),
            &symmetric(whole.tangent.clone()),
        )
        .filter(|f| f.shift == 0.0)
        .ok_or_else(none)?;
        let mut list = Vec::with_capacity(own.squared.len());
        for (k, &theta) in own.squared.iter().enumerate() {
            let y = DVector::from_fn(n, |i, _| own.shapes[(i, k)] * unit(i));
            let v = &self.basis * y;
            let moved = factor.solve(&DMatrix::from_column_slice(
                v.len(),
                1,
                (&whole.mass * &v).as_slice(),
            ));
            let off = moved.column(0) - &v / theta;
            let distance = (off.dot(&(&whole.tangent * &off)).max(0.0) / theta).sqrt() * theta;
            let relative_bound = if distance < 1.0 {
                (1.0 - distance).powf(-0.5) - 1.0
            } else {
                f64::INFINITY
            };
            list.push(BoundedFrequency {
                hz: theta.sqrt() / std::f64::consts::TAU,
                relative_bound,
            });
        }
        Ok(list)
    }
}

//! Complex modes: loads without a potential (dead moments, follower forces) and any damping [D 6].
//!
//! `(K - H + lambda C + lambda^2 M) phi = 0`. The eigenvalues are found as `1 / lambda` (without damping `1 / w^2`), so
//! that massless coordinates give zero and need no treatment.

use nalgebra::{Complex, DMatrix, DVector};

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::modes::pencil::neutral_directions;

/// A mode of a machine with loads without a potential, or with damping.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ComplexMode {
    /// `lambda`, 1/s: the imaginary part is the angular frequency, a positive real part grows.
    pub eigenvalue: Complex<f64>,
    /// Its shape by independent coordinates, largest entry one.
    pub right: DVector<Complex<f64>>,
    /// Left shape: by which forces it is driven.
    pub left: DVector<Complex<f64>>,
}

impl ComplexMode {
    /// Frequency of its swing, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.eigenvalue.im.abs() / std::f64::consts::TAU
    }

    /// Share of critical damping; negative where it grows.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        -self.eigenvalue.re / self.eigenvalue.norm()
    }

    /// `-lambda^2`, (rad/s)^2: `w^2` of an undamped mode.
    #[must_use]
    pub fn squared(&self) -> Complex<f64> {
        -(self.eigenvalue * self.eigenvalue)
    }
}

/// What becomes of a small disturbance.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Verdict {
    /// It dies away, or (without damping) stays as small.
    Stable,
    /// It swings with growing amplitude.
    Flutter,
    /// It goes away without swinging.
    Divergence,
    /// Loads without a potential on links of one segment: what a coarse link says of them depends on its convention, and
    /// so it is not judged. Give these links two segments and more.
    NotJudged {
        /// Names of the links.
        links: Vec<String>,
    },
}

/// Complex modes and what they say.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ComplexModes {
    /// One of every pair, by ascending `|lambda|`.
    pub modes: Vec<ComplexMode>,
    /// What becomes of a small disturbance.
    pub verdict: Verdict,
    /// Largest `|Im w^2| / |w^2|` of the undamped machine: how far loads without a potential make modes complex. Zero with
    /// damping, which is looked at by its ratios.
    pub complexity: f64,
}

/// Imaginary parts below this share are those of a double root within rounding.
const REAL: f64 = 1e-6;

impl LinearDynamics {
    /// Complex modes, with a damping matrix ([`Self::damping_matrix`]) or without (`None`); the lowest `count` of them.
    ///
    /// # Errors
    /// [`Error::NotSolved`] where `K - H` is singular (a free direction, or exactly at a critical load), or where the
    /// eigenvalues were not found.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3};
    /// # use kinetostat::*;
    /// # use kinetostat_dynamics::*;
    /// # let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 4e6);
    /// # let table = Chain::builder("table").actuator("slide", slide).body("table", 40.0, Vector3::zeros(), Matrix3::zeros()).build()?;
    /// # let problem = ChainProblem::new(&table, EndCondition::wrench(Wrench::zero()));
    /// # let dynamics = LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing())?;
    /// let damper = Damping::Viscous(vec![("slide".to_owned(), 250.0)]); // N s/m
    /// let damping = dynamics.damping_matrix(&dynamics.modes()?, &damper)?;
    /// let found = dynamics.complex_modes(Some(&damping), 1)?;
    /// assert_eq!(found.verdict, Verdict::Stable);
    /// let ratio = 250.0 / (2.0 * (4e6_f64 * 40.0).sqrt());
    /// assert!((found.modes[0].damping_ratio() - ratio).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn complex_modes(
        &self,
        damping: Option<&DMatrix<f64>>,
        count: usize,
    ) -> Result<ComplexModes> {
        let pencil = Quadratic::of(self, damping)?;
        let mut values = pencil.eigenvalues().ok_or_else(|| self.not_found())?;
        values.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        let finite = values.iter().all(|v| v.re.is_finite() && v.im.is_finite());
        if !finite {
            return Err(self.not_found());
        }
        let complexity = match damping {
            Some(_) => 0.0,
            None => values
                .iter()
                .map(|v| -(v * v))
                .map(|s| s.im.abs() / s.norm())
                .fold(0.0, kinetostat::number::larger),
        };
        let verdict = self.verdict(&values, damping.is_some());
        values.truncate(count);
        let modes = values.into_iter().map(|value| pencil.mode(value));
        Ok(ComplexModes {
            modes: modes.collect(),
            verdict,
            complexity,
        })
    }

    fn not_found(&self) -> Error {
        Error::NotSolved(format!(
            "the complex modes of '{}' were not found: a direction without stiffness, or a load at which one loses it",
            self.name
        ))
    }

    fn verdict(&self, values: &[Complex<f64>], damped: bool) -> Verdict {
        let circulatory = self.is_circulatory();
        if circulatory && !self.coarse_links.is_empty() {
            return Verdict::NotJudged {
                links: self.coarse_links.clone(),
            };
        }
        let grows = |v: &&Complex<f64>| v.re > REAL * v.norm();
        match values.iter().find(grows) {
            None => Verdict::Stable,
            Some(v) if v.im.abs() > REAL * v.norm() => Verdict::Flutter,
            Some(_)
                if !damped
                    || values
                        .iter()
                        .filter(grows)
                        .all(|v| v.im.abs() <= REAL * v.norm()) =>
            {
                Verdict::Divergence
            }
            Some(_) => Verdict::Flutter,
        }
    }
}

/// The quadratic pencil in natural units, neutral directions left out.
struct Quadratic {
    mass: DMatrix<f64>,
    damping: Option<DMatrix<f64>>,
    tangent: DMatrix<f64>,
    /// Independent coordinates by those of the pencil.
    back: DMatrix<f64>,
}

impl Quadratic {
    fn of(d: &LinearDynamics, damping: Option<&DMatrix<f64>>) -> Result<Self> {
        let n = d.len();
        if let Some(c) = damping
            && c.shape() != (n, n)
        {
            return Err(Error::Question(format!(
                "the damping matrix is {} x {}, '{}' has {n} coordinates",
                c.nrows(),
                c.ncols(),
                d.name
            )));
        }
        let u = DMatrix::from_diagonal(&DVector::from_column_slice(&d.units));
        let within = |a: &DMatrix<f64>, basis: &DMatrix<f64>| basis.tr_mul(&(a * basis));
        let (mass, tangent) = (within(&d.mass, &u), within(&d.tangent, &u));
        let (neutral, rest) = neutral_directions(&mass, &tangent);
        let back = match neutral.ncols() {
            0 => u,
            _ => u * rest,
        };
        Ok(Self {
            mass: within(&d.mass, &back),
            damping: damping.map(|c| within(c, &back)),
            tangent: within(&d.tangent, &back),
            back,
        })
    }

    /// Finite eigenvalues, one of every conjugate pair (or of `+-lambda` without damping).
    fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        let n = self.mass.nrows();
        let units: Vec<f64> = (0..n)
            .map(|i| {
                let own = self.tangent[(i, i)].abs();
                if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
            })
            .collect();
        let scaled =
            |a: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| a[(i, j)] * units[i] * units[j]);
        let lu = scaled(&self.tangent).lu();
        let mass = lu.solve(&scaled(&self.mass))?;
        let Some(damping) = &self.damping else {
            let values = eigenvalues_of(mass)?;
            let most = largest(&values);
            return Some(
                values
                    .into_iter()
                    .filter(|v| v.norm() > ZERO * most)
                    .map(growing_root)
                    .collect(),
            );
        };
        let damping = lu.solve(&scaled(damping))?;
        // [x; lambda x] by 1/lambda; time in units in which the fastest entries are alike.
        let time = mass
            .iter()
            .fold(0.0_f64, |m, x| if x.abs() > m { x.abs() } else { m })
            .sqrt();
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        a.view_mut((0, 0), (n, n)).copy_from(&(-damping / time));
        a.view_mut((0, n), (n, n))
            .copy_from(&(-mass / (time * time)));
        a.view_mut((n, 0), (n, n)).fill_with_identity();
        let values = eigenvalues_of(a)?;
        let most = largest(&values);
        let finite = values
            .into_iter()
            .filter(|v| v.norm() > ZERO.sqrt() * most)
            .map(|v| (v * time).inv());
        Some(finite.filter(|v| v.im >= 0.0).collect())
    }

    fn mode(&self, value: Complex<f64>) -> ComplexMode {
        let n = self.mass.nrows();
        let p = DMatrix::from_fn(n, n, |i, j| {
            let c = self.damping.as_ref().map_or(0.0, |c| c[(i, j)]);
            value * value * self.mass[(i, j)] + value * c + self.tangent[(i, j)]
        });
        let back = self.back.map(|x| Complex::new(x, 0.0));
        let shape = |p: DMatrix<Complex<f64>>| normalised(&back * null_vector(p));
        ComplexMode {
            eigenvalue: value,
            left: shape(p.transpose()),
            right: shape(p),
        }
    }
}

/// `1/w^2` below this share of the largest is that of a massless coordinate.
const ZERO: f64 = 1e-13;

fn largest(values: &[Complex<f64>]) -> f64 {
    values
        .iter()
        .fold(0.0_f64, |m, v| if v.norm() > m { v.norm() } else { m })
}

/// The root `lambda` of `lambda^2 = -w^2` that grows, or swings forwards, from `1/w^2`.
fn growing_root(inverse: Complex<f64>) -> Complex<f64> {
    let root = (-inverse.inv()).sqrt();
    if root.re < -1e-9 * root.norm() || (root.re.abs() <= 1e-9 * root.norm() && root.im < 0.0) {
        -root
    } else {
        root
    }
}

fn eigenvalues_of(a: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let schur = nalgebra::linalg::Schur::try_new(a, f64::EPSILON, 10_000)?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Null vector of a singular matrix: two steps of inverse iteration with its factors.
fn null_vector(mut p: DMatrix<Complex<f64>>) -> DVector<Complex<f64>> {
    let n = p.nrows();
    let size = p
        .iter()
        .fold(0.0_f64, |m, x| if x.norm() > m { x.norm() } else { m });
    for i in 0..n {
        p[(i, i)] += Complex::new(1e-14 * size, 0.0);
    }
    let lu = p.lu();
    // A start that no symmetry of a machine is orthogonal to.
    let mut x = DVector::from_fn(n, |i, _| {
        Complex::new(1.0 + 0.37 * ((i * i + 3 * i) % 7) as f64, 0.0)
    });
    for _ in 0..3 {
        if let Some(next) = lu.solve(&x) {
            x = normalised(next);
        }
    }
    x
}

fn normalised(x: DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let most = x.iter().fold(Complex::new(0.0, 0.0), |m: Complex<f64>, v| {
        if v.norm() > m.norm() { *v } else { m }
    });
    x.map(|v| v / most)
}

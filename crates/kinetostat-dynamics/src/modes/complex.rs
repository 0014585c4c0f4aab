//! Complex modes and their shapes: loads without a potential (dead moments, follower forces) and any damping [D 6].
//!
//! `(K - H + lambda C + lambda^2 M) phi = 0`.

use nalgebra::{Complex, DMatrix, DVector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::linear::LinearDynamics;
use crate::modes::mode::{EnergyShare, Mode, ModeKind};
use crate::modes::quadratic::Quadratic;

/// A mode of a machine with loads without a potential, or with damping.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ComplexMode {
    /// `lambda`, 1/s: the imaginary part is the angular frequency, a positive real part grows.
    pub eigenvalue: Complex<f64>,
    /// Right eigenvector by independent coordinates, largest entry one.
    pub right: DVector<Complex<f64>>,
    /// Left shape: forces that drive it.
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

    /// True if a disturbance in this mode grows, beyond rounding.
    #[must_use]
    pub fn grows(&self) -> bool {
        grows(self.eigenvalue)
    }

    /// True if the mode oscillates.
    #[must_use]
    pub fn swings(&self) -> bool {
        swings(self.eigenvalue)
    }

    /// `-lambda^2`, (rad/s)^2: `w^2` of an undamped mode.
    #[must_use]
    pub fn squared(&self) -> Complex<f64> {
        -(self.eigenvalue * self.eigenvalue)
    }
}

/// Stability of small disturbances.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Verdict {
    /// Disturbances decay, or (without damping) stay as small.
    Stable,
    /// Disturbances oscillate with growing amplitude.
    Flutter,
    /// Disturbances grow without oscillating.
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
    /// One mode of every pair, by ascending `|lambda|`; where a pair grows without damping, also its decaying
    /// counterpart.
    pub modes: Vec<ComplexMode>,
    /// Number of all modes.
    pub count: usize,
    /// Eigenvalues of all of them that grow, the fastest first.
    pub growing: Vec<Complex<f64>>,
    /// Stability of small disturbances.
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
    /// [`crate::Error::NotSolved`] where `K - H` is singular (a free direction, or exactly at a critical load), or where the
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
        let values = pencil.eigenvalues().ok_or_else(|| self.not_found())?;
        let complexity = match damping {
            Some(_) => 0.0,
            None => complexity_of(&values),
        };
        Ok(ComplexModes {
            count: values.len(),
            growing: growing(&values),
            verdict: self.verdict(&values),
            complexity,
            modes: modes_of(
                &pencil,
                values.iter().copied().zip(values.iter().copied()),
                count,
            ),
        })
    }

    pub(crate) fn verdict(&self, values: &[Complex<f64>]) -> Verdict {
        if self.is_circulatory() && !self.coarse_links.is_empty() {
            return Verdict::NotJudged {
                links: self.coarse_links.clone(),
            };
        }
        let growing = growing(values);
        match growing.iter().any(|value| swings(*value)) {
            true => Verdict::Flutter,
            false if growing.is_empty() => Verdict::Stable,
            false => Verdict::Divergence,
        }
    }
}

/// Growing eigenvalues, the fastest first.
pub(crate) fn growing(values: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let mut own: Vec<_> = values.iter().copied().filter(|v| grows(*v)).collect();
    own.sort_by(|a, b| b.re.total_cmp(&a.re));
    own
}

fn grows(value: Complex<f64>) -> bool {
    value.re > REAL * value.norm()
}

fn swings(value: Complex<f64>) -> bool {
    value.im.abs() > REAL * value.norm()
}

fn complexity_of(values: &[Complex<f64>]) -> f64 {
    let squares = values.iter().map(|value| value * value);
    squares
        .map(|s| s.im.abs() / s.norm())
        .fold(0.0, kinetostat::number::larger)
}

/// The lowest modes, by the eigenvalues of the pencil and what they become.
pub(crate) fn modes_of(
    pencil: &Quadratic,
    values: impl Iterator<Item = (Complex<f64>, Complex<f64>)>,
    count: usize,
) -> Vec<ComplexMode> {
    let (own, damped): (Vec<_>, Vec<_>) = values.take(count).unzip();
    (pencil.shapes(&own).into_iter().zip(damped))
        .map(|([right, left], eigenvalue)| ComplexMode {
            eigenvalue,
            right,
            left,
        })
        .collect()
}

impl LinearDynamics {
    /// A complex pair at the instant at which the tool moves farthest, and a quarter of a period later. Both together are
    /// normalised by mass (`phi^H M phi = 1`); `squared` is the real part of `-lambda^2`. The second is zero where all parts
    /// swing in step, as without a pair that grows and without damping.
    #[must_use]
    pub fn shapes_of_pair(&self, pair: &ComplexMode) -> [Mode; 2] {
        let own = |shape: &DVector<f64>| shape.dot(&(&self.mass * shape));
        let parts = |turn: Complex<f64>| {
            let turned = pair.right.map(|x| x * turn);
            [turned.map(|x| x.re), turned.map(|x| x.im)]
        };
        let one = Complex::new(1.0, 0.0);
        let size = parts(one).iter().map(own).sum::<f64>().sqrt();
        let size = if size > 0.0 { size } else { 1.0 };
        // The phase in which the sum of squares of the tool's motions is largest; without any, that of all coordinates.
        let [re, im] = parts(one).map(|shape| self.motion_at(self.tool, &shape));
        let tool: Complex<f64> = (0..6)
            .map(|k| {
                let length = if k < 3 { 1.0 / self.length } else { 1.0 };
                let motion = Complex::new(re[k], im[k]) * length;
                motion * motion
            })
            .sum();
        let all: Complex<f64> = (pair.right.iter().zip(&self.units))
            .map(|(x, unit)| x * x / (unit * unit))
            .sum();
        let phase = if tool.norm() > 1e-18 * all.norm() {
            tool
        } else {
            all
        };
        let turn = Complex::from_polar(1.0 / size, -0.5 * phase.arg());
        let [first, second] = parts(turn);
        // The largest entry points forwards, so that shapes do not flip from posture to posture.
        let largest = first
            .iter()
            .fold(0.0_f64, |m, x| if x.abs() > m.abs() { *x } else { m });
        let sign = if largest < 0.0 { -1.0 } else { 1.0 };
        let kind = match pair.grows() {
            true => ModeKind::Unstable,
            false => ModeKind::Vibration,
        };
        [first * sign, second * sign].map(|shape| Mode {
            squared: pair.squared().re,
            kind,
            tool: self.motion_at(self.tool, &shape),
            shape,
        })
    }

    /// Mean kinetic energy of a complex pair by bodies, links and platforms, as [`Self::kinetic_shares`].
    #[must_use]
    pub fn kinetic_shares_of_pair(&self, pair: &ComplexMode) -> Vec<EnergyShare> {
        self.kinetic_of(&self.shapes_of_pair(pair).each_ref().map(|mode| &mode.shape))
    }

    /// Mean elastic energy of a complex pair by springs, as [`Self::elastic_shares`].
    #[must_use]
    pub fn elastic_shares_of_pair(&self, pair: &ComplexMode) -> Vec<EnergyShare> {
        self.elastic_of(&self.shapes_of_pair(pair).each_ref().map(|mode| &mode.shape))
    }
}

//! Damping, by name: each result says which it was.

use kinetostat::number::larger;
use nalgebra::{Complex, DMatrix};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::modes::complex::{ComplexModes, growing, modes_of};
use crate::modes::quadratic::{Quadratic, start};
use crate::modes::{ModeKind, Modes};

/// Law of damping.
///
/// ```
/// use kinetostat_dynamics::Damping;
///
/// assert!(Damping::Ratio(0.03).check().is_ok()); // 3 % in every mode
/// assert!(Damping::Ratio(3.0).check().is_err(), "per cent are no ratio");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Damping {
    /// No damping.
    #[default]
    Undamped,
    /// Equal ratio `zeta` in every vibration about the loaded equilibrium: typical robots have 0.01 to 0.04. If loads
    /// have no potential, it applies to every complex pair: `q'' + 2 zeta |lambda| q' - lambda^2 q = 0` for a pair with
    /// the undamped eigenvalue `lambda`.
    Ratio(f64),
    /// Ratios of the lowest vibrations, as measured; the last one counts for all above.
    Ratios(Vec<f64>),
    /// `C = a M + b K`, `K` the material stiffness of the springs.
    Rayleigh {
        /// `a`, 1/s.
        mass_per_s: f64,
        /// `b`, s.
        stiffness_s: f64,
    },
    /// Loss factor `eta` of the material: `K (1 + i eta)`, not of the loads' tangent. In the frequency domain alone.
    Structural {
        /// `eta`.
        loss_factor: f64,
    },
    /// Viscous dampers on joints and springs by name, N s/m or N m s/rad.
    Viscous(Vec<(String, f64)>),
}

impl Damping {
    /// Name of the law, for results.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Undamped => "undamped",
            Self::Ratio(_) | Self::Ratios(_) => "modal",
            Self::Rayleigh { .. } => "Rayleigh",
            Self::Structural { .. } => "structural",
            Self::Viscous(_) => "viscous joints",
        }
    }

    /// Refuses numbers that no damping has.
    ///
    /// # Errors
    /// [`Error::Damping`]: negative, not finite, a ratio of 1 and above.
    pub fn check(&self) -> Result<()> {
        let refuse = |text: String| Err(Error::Damping(text));
        let ratio = |z: &f64| match *z {
            z if !(z.is_finite() && z >= 0.0) => refuse(format!(
                "the ratio is {z}, a number not below zero is needed"
            )),
            z if z >= 1.0 => refuse(format!(
                "the ratio is {z}: critical damping is 1, and nothing vibrates then (3 % is 0.03)"
            )),
            _ => Ok(()),
        };
        let positive = |what: &str, x: f64| match x.is_finite() && x >= 0.0 {
            true => Ok(()),
            false => refuse(format!("{what} is {x}, a number not below zero is needed")),
        };
        match self {
            Self::Undamped => Ok(()),
            Self::Ratio(z) => ratio(z),
            Self::Ratios(list) if list.is_empty() => refuse("no ratio is given".to_owned()),
            Self::Ratios(list) => list.iter().try_for_each(ratio),
            Self::Rayleigh {
                mass_per_s,
                stiffness_s,
            } => {
                positive("the share of the mass", *mass_per_s)?;
                positive("the share of the stiffness", *stiffness_s)
            }
            Self::Structural { loss_factor } => positive("the loss factor", *loss_factor),
            Self::Viscous(list) => list
                .iter()
                .try_for_each(|(name, c)| positive(&format!("the damper of '{name}'"), *c)),
        }
    }
}

/// Damping of one mode: a ratio to critical damping, and a loss factor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ModalDamping {
    pub ratio: f64,
    pub loss: f64,
}

/// Relative rounding: smaller changes of the springs' stiffness by loads and bowing are ignored.
const SAME: f64 = 1e-10;

impl LinearDynamics {
    /// True if damping couples the modes, so that a sum of modes with their own ratios is no longer exact: by dampers
    /// at joints, and, where loads or bowing change the stiffness, by Rayleigh's and structural damping, which use the
    /// stiffness of the springs alone (`K` is not diagonal in the modes of `K - H`).
    #[must_use]
    pub fn modes_are_coupled_by(&self, damping: &Damping) -> bool {
        match damping {
            Damping::Undamped | Damping::Ratio(_) | Damping::Ratios(_) => false,
            Damping::Viscous(_) => true,
            Damping::Rayleigh {
                stiffness_s: 0.0, ..
            }
            | Damping::Structural { loss_factor: 0.0 } => false,
            Damping::Rayleigh { .. } | Damping::Structural { .. } => self.differs_from_springs(),
        }
    }

    /// True if `K - H` differs from `K`.
    fn differs_from_springs(&self) -> bool {
        let (k, e) = (&self.tangent, &self.elastic);
        let size = |i: usize| larger(k[(i, i)].abs(), e[(i, i)].abs());
        (0..self.len()).any(|i| {
            (0..=i).any(|j| {
                let off = larger((k[(i, j)] - e[(i, j)]).abs(), (k[(j, i)] - e[(j, i)]).abs());
                off > SAME * (size(i) * size(j)).sqrt()
            })
        })
    }

    /// Damping matrix `C` by independent coordinates, for modal, Rayleigh and viscous damping; zero for structural. Of ratios
    /// it is that of the modes, and where loads have no potential that of the complex pairs.
    ///
    /// # Errors
    /// As [`Damping::check`]; a joint that does not exist; with ratios as [`Self::complex_modes`] where loads have no
    /// potential.
    pub fn damping_matrix(&self, modes: &Modes, damping: &Damping) -> Result<DMatrix<f64>> {
        damping.check()?;
        let n = self.len();
        let mut matrix = DMatrix::zeros(n, n);
        match damping {
            Damping::Undamped | Damping::Structural { .. } => {}
            Damping::Ratio(ratio) if self.is_circulatory() => {
                matrix = self.damping_of_pairs(std::slice::from_ref(ratio))?;
            }
            Damping::Ratios(list) if self.is_circulatory() => {
                matrix = self.damping_of_pairs(list)?;
            }
            Damping::Ratio(_) | Damping::Ratios(_) => {
                // C = sum M phi 2 zeta w phi^T M: nothing on massless coordinates.
                for (mode, own) in modes.modes.iter().zip(self.modal_damping(modes, damping)?) {
                    let force = &self.mass * &mode.shape;
                    let factor = 2.0 * own.ratio * mode.squared.abs().sqrt();
                    matrix.ger(factor, &force, &force, 1.0);
                }
            }
            Damping::Rayleigh {
                mass_per_s,
                stiffness_s,
            } => {
                matrix += &self.mass * *mass_per_s + &self.elastic * *stiffness_s;
            }
            Damping::Viscous(list) => {
                for (name, c) in list {
                    let row = self.motion_of_coordinate(name)?;
                    matrix.ger(*c, &row, &row, 1.0);
                }
            }
        }
        Ok(matrix)
    }

    /// Motion of a joint or spring coordinate by the independent ones.
    pub(crate) fn motion_of_coordinate(&self, name: &str) -> Result<nalgebra::DVector<f64>> {
        let found = self.coordinates.iter().find(|c| c.name == name);
        let found = found.ok_or_else(|| Error::UnknownName {
            what: "joint or spring",
            name: name.to_owned(),
            known: self
                .coordinates
                .iter()
                .map(|c| c.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        })?;
        Ok(match &self.basis {
            Some(basis) => basis.row(found.index).transpose(),
            None => {
                nalgebra::DVector::from_fn(self.len(), |i, _| f64::from(u8::from(i == found.index)))
            }
        })
    }

    /// Share of critical damping of every mode: given, or what Rayleigh's damping, the material or dampers on joints do
    /// in it (couplings between modes are left out: the direct response has them). Free and unstable modes have none of
    /// those that go by ratio.
    ///
    /// # Errors
    /// As [`Self::damping_matrix`].
    pub fn damping_ratios(&self, modes: &Modes, damping: &Damping) -> Result<Vec<f64>> {
        let own = self.modal_damping(modes, damping)?;
        Ok(own.iter().map(|d| larger(d.ratio, 0.5 * d.loss)).collect())
    }

    pub(crate) fn modal_damping(
        &self,
        modes: &Modes,
        damping: &Damping,
    ) -> Result<Vec<ModalDamping>> {
        damping.check()?;
        let vibrations = modes.modes.iter().scan(0, |count, mode| {
            let own = (mode.kind == ModeKind::Vibration).then_some(*count);
            *count += usize::from(own.is_some());
            Some(own)
        });
        let by_list = |list: &[f64]| -> Vec<ModalDamping> {
            vibrations
                .clone()
                .map(|own| own.map_or(0.0, |k| list[k.min(list.len() - 1)]))
                .map(|ratio| ModalDamping { ratio, loss: 0.0 })
                .collect()
        };
        Ok(match damping {
            Damping::Undamped => vec![ModalDamping::default(); modes.modes.len()],
            Damping::Ratio(ratio) => by_list(&[*ratio]),
            Damping::Ratios(list) => by_list(list),
            Damping::Structural { loss_factor } => modes
                .modes
                .iter()
                .map(|mode| {
                    let elastic = mode.shape.dot(&(&self.elastic * &mode.shape));
                    let loss = if mode.squared == 0.0 {
                        0.0
                    } else {
                        loss_factor * elastic / mode.squared.abs()
                    };
                    ModalDamping { ratio: 0.0, loss }
                })
                .collect(),
            Damping::Rayleigh { .. } | Damping::Viscous(_) => {
                let matrix = self.damping_matrix(modes, damping)?;
                let own = modes.modes.iter().map(|mode| {
                    let rate = mode.shape.dot(&(&matrix * &mode.shape));
                    let ratio = if mode.squared == 0.0 {
                        0.0
                    } else {
                        0.5 * rate / mode.squared.abs().sqrt()
                    };
                    ModalDamping { ratio, loss: 0.0 }
                });
                own.collect()
            }
        })
    }
}

impl LinearDynamics {
    /// Complex modes with a law of damping, the lowest `count` of them, as [`Self::complex_modes`]; ratios are those of the
    /// complex pairs. Structural damping is left out: it is defined for a steady vibration, and of what grows or dies away
    /// it says nothing.
    ///
    /// # Errors
    /// As [`Self::complex_modes`] and [`Self::damping_matrix`].
    pub fn complex_modes_damped(
        &self,
        modes: &Modes,
        damping: &Damping,
        count: usize,
    ) -> Result<ComplexModes> {
        damping.check()?;
        let ratios = match damping {
            Damping::Undamped | Damping::Structural { .. } => {
                return self.complex_modes(None, count);
            }
            Damping::Ratio(ratio) => std::slice::from_ref(ratio),
            Damping::Ratios(list) => list,
            law => return self.complex_modes(Some(&self.damping_matrix(modes, law)?), count),
        };
        // Ratios couple no pairs: shapes stay, and each eigenvalue has its own damping.
        let pencil = Quadratic::of(self, None)?;
        let undamped = pencil.eigenvalues().ok_or_else(|| self.not_found())?;
        let all: Vec<_> = (undamped.iter().enumerate())
            .map(|(k, value)| damped(*value, ratio_of(ratios, k)))
            .collect();
        Ok(ComplexModes {
            count: all.len(),
            growing: growing(&all),
            verdict: self.verdict(&all),
            complexity: 0.0,
            modes: modes_of(&pencil, undamped.into_iter().zip(all), count),
        })
    }
}

/// Pairs whose `w^2` differ by a smaller share are damped as one: near flutter their shapes are nearly the same.
const CLOSE: f64 = 1e-5;
/// Relative offset of the shift in inverse iteration, so that all eigenvectors of a cluster grow alike.
const BESIDE: f64 = 1e-9;

/// Damped eigenvalue from an undamped one.
///
/// Real modes are no modes of such a machine: ratios are those of its complex pairs. A pair that swings undamped as
/// `lambda0` (its coordinate obeys `q'' = lambda0^2 q`) is damped by `zeta` as a single mass is,
///
/// ```text
/// q'' + 2 zeta |lambda0| q' - lambda0^2 q = 0
/// C = sum M r 2 zeta |lambda0| l^T M / (l^T M r)         r, l its right and left shapes
/// ```
///
/// so that `lambda0 = i w` becomes `-zeta w + i w sqrt(1 - zeta^2)`, what grows by less than `zeta |lambda0|` dies away,
/// and what goes away without swinging still does. Couplings between pairs there are none.
pub(crate) fn damped(value: Complex<f64>, ratio: f64) -> Complex<f64> {
    let rate = ratio * value.norm();
    let root = (value * value + rate * rate).sqrt();
    // Picks the root on the side of the undamped eigenvalue.
    let root = match (root * value.conj()).re < 0.0 {
        true => -root,
        false => root,
    };
    root - rate
}

/// The ratio of a pair, counted from the lowest: the last counts for all above.
pub(crate) fn ratio_of(ratios: &[f64], pair: usize) -> f64 {
    let own = ratios.get(pair).or(ratios.last());
    own.copied().unwrap_or(0.0)
}

impl LinearDynamics {
    /// `C` of ratios of the complex pairs.
    pub(crate) fn damping_of_pairs(&self, ratios: &[f64]) -> Result<DMatrix<f64>> {
        let pencil = Quadratic::of(self, None)?;
        let values = pencil.eigenvalues().ok_or_else(|| self.not_found())?;
        let n = pencil.mass.nrows();
        let mut sum = DMatrix::zeros(n, n);
        let mut done = vec![false; values.len()];
        for k in 0..values.len() {
            if done[k] {
                continue;
            }
            let squared = -(values[k] * values[k]);
            let near = |s: Complex<f64>| (s - squared).norm() <= CLOSE * squared.norm();
            let own: Vec<usize> = (k..values.len())
                .filter(|&i| !done[i] && near(-(values[i] * values[i])))
                .collect();
            own.iter().for_each(|&i| done[i] = true);
            let mean = own.iter().map(|&i| -(values[i] * values[i]));
            let mean = mean.sum::<Complex<f64>>() / own.len() as f64;
            let rate = 2.0 * ratio_of(ratios, k) * mean.norm().sqrt();
            sum += projector(&pencil, mean, own.len()).map(|x| x.re) * rate;
        }
        // Transforms from coordinates of the pencil: r = back x, and l^T M r is the same in both.
        let mass = &self.mass * &pencil.back;
        Ok(&mass * sum * mass.transpose())
    }
}

/// `R (L^T M R)^-1 L^T` of the `count` pairs near a `w^2`, in coordinates of the pencil.
fn projector(pencil: &Quadratic, squared: Complex<f64>, count: usize) -> DMatrix<Complex<f64>> {
    let n = pencil.mass.nrows();
    let shift = squared * (1.0 + BESIDE);
    let p = DMatrix::from_fn(n, n, |i, j| {
        pencil.tangent[(i, j)] - shift * pencil.mass[(i, j)]
    });
    let mass = pencil.mass.map(|x| Complex::new(x, 0.0));
    let space = |p: DMatrix<Complex<f64>>| {
        let lu = p.lu();
        let columns: Vec<_> = (0..count).map(|k| start(n, k)).collect();
        let mut x = DMatrix::from_columns(&columns).map(|x| Complex::new(x, 0.0));
        for _ in 0..4 {
            if let Some(next) = lu.solve(&(&mass * &x)) {
                x = next.qr().q();
            }
        }
        x
    };
    let (right, left) = (space(p.clone()), space(p.transpose()));
    let product = left.transpose() * &mass * &right;
    match product.lu().solve(&left.transpose()) {
        Some(rows) => right * rows,
        // Exactly where two pairs meet: no damping by ratios is defined.
        None => DMatrix::zeros(n, n),
    }
}

//! Response by the sum of modes with residual flexibility: what modes that are left out, and massless coordinates, do at
//! rest [D 8; MacNeal 1971, Rubin 1975]. At 0 Hz it is the loaded compliance exactly, however few modes are kept.

use nalgebra::{Complex, DMatrix, DVector, Matrix6, Vector6};

use crate::damping::{Damping, ModalDamping};
use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::places::Point;
use crate::modes::{ModeKind, Modes};
use crate::response::coupled::{CoupledDamping, TranslationalModes};
use crate::response::{Quantity, Receptance};

/// One mode as two points see it.
#[derive(Clone, Debug)]
struct Term {
    squared: f64,
    damping: ModalDamping,
    /// Motion of the point looked at, base axes, and its products with those of the point pushed.
    at: Vector6<f64>,
    product: Matrix6<f64>,
}

impl Term {
    /// `1 / (w_k^2 (1 + i eta) - w^2 + 2 i zeta w_k w)`.
    fn factor(&self, w: f64) -> Complex<f64> {
        let own = self.squared.abs().sqrt();
        let imaginary = self.damping.loss * self.squared.abs() + 2.0 * self.damping.ratio * own * w;
        Complex::new(self.squared - w * w, imaginary).inv()
    }
}

/// Response between two points by a sum of modes.
///
/// ```
/// # use kinetostat::nalgebra::{Matrix3, Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat_dynamics::{Damping, Held, LinearDynamics, ModalResponse, Quantity};
///
/// let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 4e6); // N/m
/// let table = Chain::builder("table").actuator("slide", slide).body("table", 40.0, Vector3::zeros(), Matrix3::zeros()).build()?;
/// let problem = ChainProblem::new(&table, EndCondition::wrench(Wrench::zero()));
/// let at = solve_chain(&problem, &Settings::default())?;
/// let dynamics = LinearDynamics::of_chain(&problem, &at.coordinates, &at.wrench, &Held::nothing())?;
/// let modes = dynamics.modes()?;
/// let tool = dynamics.tool();
/// let response = ModalResponse::new(&dynamics, &modes, &Damping::Ratio(0.02), tool, tool, usize::MAX)?;
/// assert!((response.at_hz(0.0)[(0, 0)].re * 4e6 - 1.0).abs() < 1e-12, "at rest the spring alone");
/// let resonance = modes.modes[0].frequency_hz();
/// assert!((response.at_hz(resonance)[(0, 0)].norm() * 4e6 * 2.0 * 0.02 - 1.0).abs() < 1e-9);
/// let curve = response.over(&[10.0, 20.0, 40.0], Quantity::Acceleration); // what an accelerometer shows
/// assert_eq!(curve.len(), 3);
/// // What lobes need:
/// let data = response.translational()?;
/// assert!((data.shapes[0].x.powi(2) - 1.0 / 40.0).abs() < 1e-12 && data.ratios == [0.02]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ModalResponse {
    terms: Vec<Term>,
    residual: Matrix6<f64>,
    same: bool,
    damping: Damping,
    coupling: Option<CoupledDamping>,
}

impl ModalResponse {
    /// Motion of `at` by what acts on `from`; the lowest `kept` modes swing, the others follow as at rest.
    ///
    /// # Errors
    /// [`Error::Damping`]; [`Error::Question`] where loads have no potential (modes are complex then: ask
    /// [`LinearDynamics::direct`]); [`Error::NotSolved`] where a massless direction has no stiffness left.
    pub fn new(
        dynamics: &LinearDynamics,
        modes: &Modes,
        damping: &Damping,
        at: Point,
        from: Point,
        kept: usize,
    ) -> Result<Self> {
        if dynamics.is_circulatory() {
            return Err(Error::Question(format!(
                "loads on '{}' have no potential (dead moments or followers): its modes are complex and no sum of real ones is its response (a direct solution at each frequency is)",
                dynamics.name
            )));
        }
        let (b_at, b_from) = (dynamics.motions(at), dynamics.motions(from));
        let own = dynamics.modal_damping(modes, damping)?;
        let six = |b: &DMatrix<f64>, shape: &DVector<f64>| {
            Vector6::from_column_slice((b * shape).as_slice())
        };
        let mut terms = Vec::with_capacity(modes.modes.len());
        for (mode, damping) in modes.modes.iter().zip(own) {
            let (at, from) = (six(&b_at, &mode.shape), six(&b_from, &mode.shape));
            terms.push(Term {
                squared: mode.squared,
                damping,
                at,
                product: at * from.transpose(),
            });
        }
        let residual = dynamics.flexibility(modes, &b_at, &b_from, &terms, kept)?;
        terms.truncate(kept.max(modes.counts.free + modes.counts.unstable));
        let coupling = dynamics.coupled_damping(modes, damping, &b_at, terms.len())?;
        Ok(Self {
            terms,
            residual,
            same: at == from,
            damping: damping.clone(),
            coupling,
        })
    }

    /// Receptance at a frequency, Hz.
    #[must_use]
    pub fn at_hz(&self, hz: f64) -> Receptance {
        self.over(&[hz], Quantity::Displacement)[0]
    }

    /// Response at many frequencies, Hz.
    #[must_use]
    pub fn over(&self, hz: &[f64], quantity: Quantity) -> Vec<Receptance> {
        let mut out = vec![Receptance::zeros(); hz.len()];
        self.over_into(hz, quantity, &mut out);
        out
    }

    /// Writes the receptances into an existing list; the shorter of both lists limits the number.
    pub fn over_into(&self, hz: &[f64], quantity: Quantity, out: &mut [Receptance]) {
        let mut factors = vec![Complex::default(); self.terms.len()];
        for (hz, into) in hz.iter().zip(out) {
            let w = hz * std::f64::consts::TAU;
            for (factor, term) in factors.iter_mut().zip(&self.terms) {
                *factor = term.factor(w);
            }
            for column in 0..6 {
                self.column_into(column, &factors, into);
            }
            if quantity != Quantity::Displacement {
                *into *= quantity.factor(w);
            }
        }
    }

    /// One column of the receptance: its twelve numbers stay in registers while the modes are summed.
    fn column_into(&self, column: usize, factors: &[Complex<f64>], into: &mut Receptance) {
        let of = |matrix: &Matrix6<f64>| <[f64; 6]>::from(matrix.column(column).into_owned());
        let (mut re, mut im) = (of(&self.residual), [0.0; 6]);
        for (factor, term) in factors.iter().zip(&self.terms) {
            let product = of(&term.product);
            for k in 0..6 {
                re[k] += factor.re * product[k];
                im[k] += factor.im * product[k];
            }
        }
        for k in 0..6 {
            into[(k, column)] = Complex::new(re[k], im[k]);
        }
    }

    /// Residual flexibility: what is not in the sum of modes, 6 x 6.
    #[must_use]
    pub fn residual(&self) -> &Matrix6<f64> {
        &self.residual
    }

    /// Damping that it has.
    #[must_use]
    pub fn damping(&self) -> &Damping {
        &self.damping
    }

    /// Modal data of the translations, of a point that is pushed where it is looked at.
    ///
    /// # Errors
    /// [`Error::Question`] for two points.
    pub fn translational(&self) -> Result<TranslationalModes> {
        if !self.same {
            return Err(Error::Question(
                "modal data of a cut are those of one point, pushed where it is looked at"
                    .to_owned(),
            ));
        }
        Ok(TranslationalModes {
            shapes: self
                .terms
                .iter()
                .map(|t| t.at.fixed_rows::<3>(0).into_owned())
                .collect(),
            squared: self.terms.iter().map(|t| t.squared).collect(),
            ratios: self
                .terms
                .iter()
                .map(|t| {
                    if t.damping.loss > 0.0 {
                        0.5 * t.damping.loss
                    } else {
                        t.damping.ratio
                    }
                })
                .collect(),
            residual: self.residual.fixed_view::<3, 3>(0, 0).into_owned(),
            coupling: self.coupling.clone(),
        })
    }
}

impl LinearDynamics {
    /// `B (K - H)^-1 B^T` less the `kept` lowest modes at rest. Free modes are left out of both.
    fn flexibility(
        &self,
        modes: &Modes,
        at: &DMatrix<f64>,
        from: &DMatrix<f64>,
        terms: &[Term],
        kept: usize,
    ) -> Result<Matrix6<f64>> {
        let kept = kept.max(modes.counts.free + modes.counts.unstable);
        // Free directions have no static flexibility: with s M all have one, and modes are taken out by theirs.
        let shift = match modes.counts.free {
            0 => 0.0,
            _ => modes
                .modes
                .iter()
                .filter(|m| m.kind == ModeKind::Vibration)
                .map(|m| m.squared)
                .next()
                .unwrap_or(1.0),
        };
        let moved = self.solved_with_shift(shift, &from.transpose(), modes.counts.neutral > 0)?;
        let mut sum = Matrix6::zeros();
        let all = at * moved;
        sum.copy_from(&all);
        for (k, term) in terms.iter().enumerate() {
            let with_shift = term.squared + shift;
            let of_mode = match (shift == 0.0, k < kept) {
                (true, true) => 1.0 / with_shift,
                (true, false) => 0.0,
                (false, true) => 1.0 / with_shift,
                (false, false) => 1.0 / with_shift - 1.0 / term.squared,
            };
            sum -= term.product * of_mode;
        }
        match sum.iter().all(|x| x.is_finite()) {
            true => Ok(sum),
            false => Err(self.no_flexibility()),
        }
    }
}

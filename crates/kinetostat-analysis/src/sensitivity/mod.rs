//! Sensitivity to every number of a model file: derivatives of deflection, compliance, stiffness and margin.
//!
//! By the implicit function theorem at the equilibrium `R(z, p) = 0`, the state moves by `dz/dp = -A^-1 dR/dp`, with
//! the machine's own tangent `A`, factorised once for all parameters; no equilibrium is solved again, and no iteration
//! is differentiated. The explicit derivatives - of the residual at a fixed state, of stiffness and margin along the
//! moving state - are central differences of three steps, extrapolated (sixth order); their disagreement is given as
//! the error. Commands follow the parameter: the tool is commanded to the same place, as a controller that knows the
//! machine does. The margin is that of the limb nearest to buckling, also where another one overtakes it within a step;
//! figures that are the largest of equal ones are marked ([`Sharp`]).
//!
//! Derivatives of the tool's pose and of the stiffness matrix by numbers of the model file, the commands being held.
//!
//! Central differences of three steps, extrapolated (sixth order), of the machine that is solved anew; the difference to fourth
//! order is the error.
//!
//! Figures without a derivative: the largest or least of several that are equal here.
//!
//! The share of the way to buckling is that of the limb, and of its shape, which is nearest to it; the stiffness against a force is that
//! of the softest direction. Where two of them are equal, a number that changes one and not the other changes the figure in another way
//! to each side, as `|x|` at zero. The difference of the two slopes is what `(f(h) + f(-h) - 2 f(0)) / h` tends to for small steps.

mod values;

use kinetostat::machine::{LinearisedMachine, MachineResidual, MechanismState};
use kinetostat::spatial::pose_residual;
use kinetostat::{Error, Mechanism, MechanismEquilibrium, Pose, Posture, Wrench};
use kinetostat_model::{Model, Parameter, ParametricModel};
use nalgebra::{Matrix6, Vector6};
use rayon::prelude::*;

use crate::sensitivity::values::{STEPS, WEIGHTS, step_of};

pub use self::values::Values;
pub use crate::sensitivity::values::{CommandedPlace, SensitivityError};

/// Definition of a sensitivity analysis.
#[derive(Clone, Debug)]
pub struct SensitivityTask<'a> {
    /// The model whose numbers are changed.
    pub model: &'a Model,
    /// Flange from tool.
    pub tool: Pose,
    /// Commanded place of the tool.
    pub place: CommandedPlace,
    /// Load on the tool, about its origin, base axes.
    pub wrench: Wrench,
    /// Unit force or moment: the direction in which deflection and compliance are counted.
    pub direction: Wrench,
}

/// Derivatives by one number of the file, per its unit.
#[derive(Clone, Debug)]
pub struct Sensitivity {
    /// The number.
    pub parameter: Parameter,
    /// Derivatives, none where there are none.
    pub derivatives: Result<Values, String>,
    /// Disagreement of the extrapolated differences of the explicit terms, in the same quantities.
    pub errors: Option<Values>,
    /// Figures that have no derivative by this number: theirs above is the mean of those to both sides.
    pub sharp: Sharp,
}

impl Sensitivity {
    /// Change of the deflection (m or rad) by 1 % more of the number.
    #[must_use]
    pub fn deflection_by_percent(&self) -> f64 {
        self.of_percent(|d| d.deflection)
    }

    /// Relative change of the stiffness along the direction by 1 % more of the number, of a stiffness `now`.
    #[must_use]
    pub fn stiffness_by_percent(&self, now: f64) -> f64 {
        self.of_percent(|d| d.stiffness) / now
    }

    fn of_percent(&self, what: impl Fn(&Values) -> f64) -> f64 {
        let own = self.derivatives.as_ref().map_or(f64::NAN, what);
        0.01 * self.parameter.value * own
    }
}

/// The answer.
#[derive(Clone, Debug)]
pub struct Sensitivities {
    /// Values at the equilibrium.
    pub values: Values,
    /// Sensitivities to every number, in the order of the file.
    pub list: Vec<Sensitivity>,
}

/// Derivatives by the numbers of these paths; by all of the file where there are none.
///
/// # Errors
/// Where the machine has no equilibrium there, and for paths that name nothing. A number that cannot be differentiated (an
/// integer-like choice, one beyond which the file would be refused) is in the list with the reason.
pub fn sensitivities(
    task: &SensitivityTask<'_>,
    paths: &[&str],
) -> Result<Sensitivities, SensitivityError> {
    let all = task.model.parameters();
    let named: Vec<&str> = match paths {
        [] => all.iter().map(|p| p.path.as_str()).collect(),
        some => some.to_vec(),
    };
    let mechanism = task.model.mechanism.with_tool(&task.tool);
    let posture = task.place.posture(&mechanism, None)?;
    let found = posture.deflected_by(&task.wrench)?;
    let values = Values::of(&found, &task.direction);
    let nearest = nearest_to_buckling(&found);
    // Every thread has the tangent of its own, for all of its parameters.
    let tangent = || {
        Ok(Tangent {
            task,
            posture: &posture,
            state: &found.state,
            now: values,
            nearest,
            tangent: posture.linearised(&found)?,
        })
    };
    let list = named
        .par_iter()
        .map_init(tangent, |tangent, path| match tangent {
            Ok(tangent) => tangent.by(path),
            Err(error) => Err(SensitivityError::Machine(Error::clone(error))),
        })
        .collect::<Result<Vec<_>, SensitivityError>>()?;
    Ok(Sensitivities { values, list })
}

/// Shares of the way to buckling that differ by less, relatively, are equal.
const EQUAL: f64 = 1e-9;

/// The limb that is nearest to buckling; none where there is none, or several are equally near.
fn nearest_to_buckling(found: &MechanismEquilibrium) -> Option<usize> {
    let largest = found.share_to_buckling()?;
    let shares = found.limbs.iter().map(|l| l.stability.share_to_buckling);
    let near = |share: Option<f64>| share.is_some_and(|s| largest - s <= EQUAL * largest.abs());
    let mut nearest = (shares.enumerate()).filter_map(|(limb, share)| near(share).then_some(limb));
    nearest.next().filter(|_| nearest.next().is_none())
}

struct Tangent<'a> {
    task: &'a SensitivityTask<'a>,
    posture: &'a Posture,
    state: &'a MechanismState,
    now: Values,
    /// The limb that is nearest to buckling, where it is one alone.
    nearest: Option<usize>,
    tangent: LinearisedMachine<'a>,
}

impl Tangent<'_> {
    fn by(&mut self, path: &str) -> Result<Sensitivity, SensitivityError> {
        let parametric = self.task.model.parametric(&[path])?;
        let parameter = parametric.parameters()[0].clone();
        let (derivatives, errors, sharp) = match self.derivatives(&parametric, &parameter) {
            Ok((values, errors, sharp)) => (Ok(values), Some(errors), sharp),
            Err(reason) => (Err(reason), None, Sharp::default()),
        };
        Ok(Sensitivity {
            parameter,
            derivatives,
            errors,
            sharp,
        })
    }

    fn derivatives(
        &mut self,
        parametric: &ParametricModel,
        parameter: &Parameter,
    ) -> Result<(Values, Values, Sharp), String> {
        let step = step_of(parameter);
        // The machine with the number changed, commanded for the same place.
        let at = |h: f64| -> Result<Posture, String> {
            let mechanism: Mechanism = parametric
                .mechanism(&[parameter.value + h])
                .map_err(|e| e.to_string())?
                .with_tool(&self.task.tool);
            self.task
                .place
                .posture(&mechanism, Some(self.posture))
                .map_err(|e| e.to_string())
        };
        let steps = STEPS.map(|share| share * step);
        let mut postures = Vec::with_capacity(steps.len());
        for h in steps {
            postures.push((at(h)?, at(-h)?));
        }
        let mut residuals = Vec::new();
        for (plus, minus) in &postures {
            for posture in [plus, minus] {
                let own = posture.residual_at(self.state, &self.task.wrench);
                residuals.push(own.map_err(|e| e.to_string())?);
            }
        }
        let weights = WEIGHTS.iter().zip(steps);
        let parts: Vec<(f64, &MachineResidual)> = weights
            .flat_map(|(w, h)| [0.5 * w / h, -0.5 * w / h])
            .zip(&residuals)
            .collect();
        let residual = MachineResidual::combined(&parts).ok_or("no residual")?;
        let motion = self.tangent.removing(&residual);
        let motion = motion.ok_or("the tangent of the machine is singular here")?;
        // Steps along the tangent of the path of equilibria.
        let at_step = |k: usize| -> Result<Sides, String> {
            let one = |posture: &Posture, h: f64| {
                let state = self.state.moved_by(&motion, h);
                let found = posture.as_if_in_equilibrium(&state, &self.task.wrench);
                found
                    .map(|e| Values::of_limb(&e, &self.task.direction, self.nearest))
                    .map_err(|e| e.to_string())
            };
            let (plus, minus) = &postures[k];
            Ok(Sides {
                step: steps[k],
                plus: one(plus, steps[k])?,
                minus: one(minus, -steps[k])?,
            })
        };
        let sides = [at_step(0)?, at_step(1)?, at_step(2)?];
        let central = sides
            .each_ref()
            .map(|s| s.plus.combined(&s.minus, |x, y| 0.5 * (x - y) / s.step));
        let (best, errors) = extrapolated(&central);
        let sharp = Sharp::of(&self.now, &sides, &best);
        Ok((best, errors, sharp))
    }
}

/// The derivative of sixth order, and how far that of fourth order is from it.
fn extrapolated(sides: &[Values]) -> (Values, Values) {
    let sum = |weights: [f64; 3]| {
        let mut sum = sides[0].combined(&sides[0], |x, _| weights[0] * x);
        for (side, w) in sides.iter().zip(weights).skip(1) {
            sum = sum.combined(side, |x, y| x + w * y);
        }
        sum
    };
    let best = sum(WEIGHTS);
    let fourth = sum([0.0, -1.0 / 3.0, 4.0 / 3.0]);
    let error = best.combined(&fourth, |x, y| (x - y).abs());
    (best, error)
}

/// Difference of the pose of the commanded machine from that of the posture above which the commands lead elsewhere, m and rad.
const ELSEWHERE: f64 = 1e-6;

/// Pose and stiffness of the tool as functions of the model.
#[derive(Clone, Debug)]
pub struct GradientTask<'a> {
    /// The model whose numbers are changed.
    pub model: &'a Model,
    /// Flange from tool.
    pub tool: Pose,
    /// The posture whose commands are held.
    pub posture: &'a Posture,
    /// Load on the tool; none for the unloaded machine as drawn.
    pub wrench: Option<Wrench>,
}

/// Derivatives by one number, per its unit.
#[derive(Clone, Debug)]
pub struct Gradient {
    /// The number.
    pub parameter: Parameter,
    /// Derivatives with their estimated errors, or the reason why there are none.
    pub derivatives: Result<[Value; 2], String>,
}

/// Motion of the tool from its pose in the model as it is, and the stiffness there.
pub type Value = (Vector6<f64>, Matrix6<f64>);

/// Derivatives by the numbers of these paths, by all of the file where there are none.
///
/// # Errors
/// Paths that name nothing, a machine without an answer, and commands that alone do not lead to the posture.
pub fn gradients(
    task: &GradientTask<'_>,
    paths: &[&str],
) -> Result<Vec<Gradient>, SensitivityError> {
    let all = task.model.parameters();
    let named: Vec<&str> = match paths {
        [] => all.iter().map(|p| p.path.as_str()).collect(),
        some => some.to_vec(),
    };
    let place = CommandedPlace::Commands(task.posture.commands());
    let now = place.posture(task.posture.mechanism(), None)?;
    if pose_residual(now.target(), task.posture.target()).0.amax() > ELSEWHERE {
        return Err(SensitivityError::Elsewhere);
    }
    let (pose, _) = task.at(task.posture)?;
    let each = named.par_iter().map(|path| {
        let parametric = task.model.parametric(&[path])?;
        let parameter = parametric.parameters()[0].clone();
        let derivatives = task.by(&parametric, &parameter, &place, &pose);
        Ok(Gradient {
            parameter,
            derivatives,
        })
    });
    each.collect()
}

impl GradientTask<'_> {
    /// Pose of the tool, and the stiffness there.
    fn at(&self, posture: &Posture) -> kinetostat::Result<(Pose, Matrix6<f64>)> {
        Ok(match &self.wrench {
            None => (*posture.target(), posture.stiffness()?.cartesian.matrix),
            Some(wrench) => {
                let found = posture.deflected_by(wrench)?;
                (found.tool, found.stiffness.matrix)
            }
        })
    }

    fn by(
        &self,
        parametric: &ParametricModel,
        parameter: &Parameter,
        place: &CommandedPlace,
        pose: &Pose,
    ) -> Result<[Value; 2], String> {
        let at = |h: f64| -> Result<Value, String> {
            let mechanism = parametric.mechanism(&[parameter.value + h]);
            let mechanism = mechanism.map_err(|e| e.to_string())?.with_tool(&self.tool);
            let posture = place.posture(&mechanism, None).map_err(|e| e.to_string())?;
            let (tool, stiffness) = self.at(&posture).map_err(|e| e.to_string())?;
            Ok((pose_residual(&tool, pose).0, stiffness))
        };
        let mut best = (Vector6::zeros(), Matrix6::zeros());
        let mut fourth = best;
        for ((share, sixth), other) in STEPS.iter().zip(WEIGHTS).zip([0.0, -1.0 / 3.0, 4.0 / 3.0]) {
            let h = share * step_of(parameter);
            let (plus, minus) = (at(h)?, at(-h)?);
            let slope = (
                (plus.0 - minus.0) / (2.0 * h),
                (plus.1 - minus.1) / (2.0 * h),
            );
            best = (best.0 + slope.0 * sixth, best.1 + slope.1 * sixth);
            fourth = (fourth.0 + slope.0 * other, fourth.1 + slope.1 * other);
        }
        let error = ((best.0 - fourth.0).abs(), (best.1 - fourth.1).abs());
        Ok([best, error])
    }
}

/// Figures without a derivative by a number: both one-sided derivatives differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sharp {
    /// Two limbs, or two shapes of a limb, are equally near to buckling.
    pub share_to_buckling: bool,
    /// Two directions are equally soft.
    pub stiffness_against_force: bool,
}

/// The figures at a step to either side.
pub(crate) struct Sides {
    pub step: f64,
    pub plus: Values,
    pub minus: Values,
}

/// Threshold of the difference of the slopes over a step relative to the figure: above rounding.
const OF_FIGURE: f64 = 1e-7;
/// Threshold of the difference of the slopes relative to the derivative.
const OF_DERIVATIVE: f64 = 1e-5;

impl Sharp {
    /// True if any of them has no derivative.
    #[must_use]
    pub fn any(&self) -> bool {
        self.share_to_buckling || self.stiffness_against_force
    }

    /// Detects kinks from the figures now and at steps `h`, `h / 2` and `h / 4`, with the derivatives by central
    /// differences.
    pub(crate) fn of(now: &Values, sides: &[Sides; 3], derivatives: &Values) -> Self {
        let is_sharp = |of: fn(&Values) -> f64| {
            let middle = of(now);
            let [a, b, c] = sides
                .each_ref()
                .map(|s| (of(&s.plus) + of(&s.minus) - 2.0 * middle) / s.step);
            // Removes the terms of first and third order in the step, which smooth figures have.
            let slopes = ((a - 10.0 * b + 16.0 * c) / 7.0).abs();
            slopes * sides[0].step > OF_FIGURE * middle.abs()
                && slopes > OF_DERIVATIVE * of(derivatives).abs()
        };
        Self {
            share_to_buckling: is_sharp(|v| v.share_to_buckling.unwrap_or(0.0)),
            stiffness_against_force: is_sharp(|v| v.stiffness_against_force),
        }
    }
}

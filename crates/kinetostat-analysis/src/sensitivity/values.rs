//! Figures that are differentiated, and steps and weights of central differences.

use kinetostat::number::larger;
use kinetostat::{
    Error, Mechanism, MechanismEquilibrium, Pose, Posture, PostureRequest, Result, Wrench,
};
use kinetostat_model::{ModelError, Parameter, ParameterKind};
use nalgebra::{UnitQuaternion, Vector3};

/// Relative rounding error of the differentiated figures.
const RELATIVE_ROUNDING: f64 = 1e-9;

/// Figures of an equilibrium, or their derivatives by a number, or their errors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Values {
    /// Motion from the commanded to the loaded pose of the tool: m and rad, base axes.
    pub displacement: [f64; 6],
    /// Component of the displacement in the direction, m or rad.
    pub deflection: f64,
    /// Tangent compliance in the direction, m/N or rad/(N m).
    pub compliance: f64,
    /// Inverse of the compliance in the direction, N/m or N m/rad.
    pub stiffness: f64,
    /// Stiffness against a force in the softest direction, the tool free to turn, N/m.
    pub stiffness_against_force: f64,
    /// Largest share of the way to buckling of all limbs, 1 is buckling; none where nothing is on it.
    pub share_to_buckling: Option<f64>,
}

impl Values {
    /// Takes the values of an equilibrium; `direction` is a unit force or moment.
    #[must_use]
    pub fn of(found: &MechanismEquilibrium, direction: &Wrench) -> Self {
        let compliance = direction.0.dot(&(found.compliance().springs * direction.0));
        Self {
            displacement: found.displacement.0.into(),
            deflection: direction.0.dot(&found.displacement.0),
            compliance,
            stiffness: 1.0 / compliance,
            stiffness_against_force: found.stiffness_against_force(),
            share_to_buckling: found.share_to_buckling(),
        }
    }

    /// Figures with the load factor of one limb alone, if one is named.
    pub(crate) fn of_limb(
        found: &MechanismEquilibrium,
        direction: &Wrench,
        limb: Option<usize>,
    ) -> Self {
        let mut values = Self::of(found, direction);
        if let Some(limb) = limb.and_then(|limb| found.limbs.get(limb)) {
            values.share_to_buckling = limb.stability.share_to_buckling;
        }
        values
    }

    /// True if these derivatives by a number of this size are below rounding of all figures.
    #[must_use]
    pub fn is_nothing(&self, size: f64, figures: &Self) -> bool {
        let below = |derivative: f64, figure: f64| {
            derivative.abs() * size <= RELATIVE_ROUNDING * figure.abs()
        };
        // One scale for all six, with 1 m to the rad: what a tool that keeps its orientation turns by is rounding.
        let displacement = figures.displacement.iter();
        let largest = displacement.map(|d| d.abs()).fold(0.0, larger);
        let margin = self.share_to_buckling.zip(figures.share_to_buckling);
        self.displacement.iter().all(|d| below(*d, largest))
            && below(self.stiffness, figures.stiffness)
            && below(
                self.stiffness_against_force,
                figures.stiffness_against_force,
            )
            && margin.is_none_or(|(derivative, share)| below(derivative, share))
    }

    /// Combines both, figure by figure.
    #[must_use]
    pub fn combined(&self, other: &Self, with: impl Fn(f64, f64) -> f64) -> Self {
        let pair = self.share_to_buckling.zip(other.share_to_buckling);
        Self {
            displacement: std::array::from_fn(|k| {
                with(self.displacement[k], other.displacement[k])
            }),
            deflection: with(self.deflection, other.deflection),
            compliance: with(self.compliance, other.compliance),
            stiffness: with(self.stiffness, other.stiffness),
            stiffness_against_force: with(
                self.stiffness_against_force,
                other.stiffness_against_force,
            ),
            share_to_buckling: pair.map(|(a, b)| with(a, b)),
        }
    }
}

/// Shares of the largest step.
pub(crate) const STEPS: [f64; 3] = [1.0, 0.5, 0.25];
/// Weights of central differences with these steps in the derivative of sixth order.
pub(crate) const WEIGHTS: [f64; 3] = [1.0 / 45.0, -20.0 / 45.0, 64.0 / 45.0];

/// A step that is small beside what the number does, in its unit.
pub(crate) fn step_of(parameter: &Parameter) -> f64 {
    let least = match parameter.kind {
        ParameterKind::Length => 1e-3,
        ParameterKind::Angle | ParameterKind::Direction => 4e-3,
        ParameterKind::Mass | ParameterKind::Inertia | ParameterKind::Acceleration => 1e-2,
        ParameterKind::Force | ParameterKind::Moment => 1.0,
        ParameterKind::Ratio | ParameterKind::PoissonsRatio | ParameterKind::Factor => 1e-3,
        _ => 0.0,
    };
    let least = least / parameter.in_si;
    let step = (4e-3 * parameter.value.abs()).max(least);
    // An entry of a matrix that is zero: as one of its unit.
    if step > 0.0 { step } else { 1.0 }
}

/// Reason why there are no derivatives at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SensitivityError {
    /// No equilibrium.
    #[error(transparent)]
    Machine(#[from] Error),
    /// A path names nothing.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Another posture has the same commands.
    #[error(
        "the commands of this posture lead to another pose of the tool; take a posture that its commands alone determine"
    )]
    Elsewhere,
}

/// A place that a changed machine is commanded for again.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum CommandedPlace {
    /// A pose of the tool, base from tool.
    Pose(Pose),
    /// A position (m) whose orientation follows, nearest to this one.
    Position(Vector3<f64>, UnitQuaternion<f64>),
    /// Commands, m or rad.
    Commands(Vec<f64>),
}

impl CommandedPlace {
    /// The machine commanded for it, next to a posture where there is one.
    ///
    /// # Errors
    /// As [`Mechanism::posture`].
    pub fn posture(&self, machine: &Mechanism, near: Option<&Posture>) -> Result<Posture> {
        let request = match self {
            Self::Pose(pose) => PostureRequest::pose(pose),
            Self::Position(position, wanted) => PostureRequest::position(position, wanted),
            Self::Commands(commands) => PostureRequest::commands(commands),
        };
        match near {
            Some(near) => machine.posture(request.near(near)),
            None => machine.posture(request),
        }
    }
}

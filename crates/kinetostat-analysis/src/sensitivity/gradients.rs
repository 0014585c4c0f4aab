//! Derivatives of the tool's pose and of the stiffness matrix by numbers of the model file, the commands being held.
//!
//! Central differences of three steps, extrapolated (sixth order), of the machine that is solved anew; the difference to fourth
//! order is the error.

use kinetostat::spatial::pose_residual;
use kinetostat::{Pose, Posture, Wrench};
use kinetostat_model::{Model, Parameter, ParametricModel};
use nalgebra::{Matrix6, Vector6};
use rayon::prelude::*;

use super::differences::{STEPS, WEIGHTS, step_of};
use super::error::SensitivityError;
use super::place::CommandedPlace;

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

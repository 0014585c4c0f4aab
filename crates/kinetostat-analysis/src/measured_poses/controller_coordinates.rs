//! Controller coordinates, and the tool pose of the model at them.

use kinetostat::{MotionKind, Pose, PostureRequest};
use kinetostat_model::Model;

use crate::forward::ForwardKinematics;
use crate::measured_poses::explanation::Axis;
use crate::measured_poses::search::Effort;

/// The controller of a model: the axes of its controller, or else its actuators.
#[derive(Clone, Copy, Debug)]
pub struct ControllerCoordinates<'m> {
    model: &'m Model,
    forward: ForwardKinematics<'m>,
}

/// Reason why the model has no pose at given controller coordinates.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ControllerPoseError {
    /// Number of values that differs from the number of axes.
    #[error("the number of joints does not fit")]
    JointCount,
    /// The machine cannot stand there.
    #[error(transparent)]
    Posture(#[from] kinetostat::Error),
}

impl<'m> ControllerCoordinates<'m> {
    /// Without a declared controller every actuator is an axis of its own, with ratio 1 and no offset.
    #[must_use]
    pub fn of(model: &'m Model) -> Self {
        Self {
            model,
            forward: ForwardKinematics::of(&model.mechanism),
        }
    }

    /// Effort that the search for explanations can afford.
    #[must_use]
    pub fn effort(&self) -> Effort {
        match self.forward.is_plain_product() {
            true => Effort::Thousands,
            false => Effort::Few,
        }
    }

    /// Axes as the model declares them; `kinds` are their motions.
    #[must_use]
    pub fn axes(&self, kinds: &[MotionKind]) -> Vec<Axis> {
        let turns = |i: usize| kinds[i] == MotionKind::Revolute;
        let Some(controller) = &self.model.controller else {
            let plain = |i| Axis {
                turns: turns(i),
                zero: 0.0,
                ratio: 1.0,
                coupled: Vec::new(),
            };
            return (0..kinds.len()).map(plain).collect();
        };
        let (axes, map) = (controller.axes(), controller.map());
        let zeros = controller
            .coordinates(&vec![0.0; axes.len()])
            .unwrap_or_else(|| vec![0.0; axes.len()]);
        let plain = |i: usize| (0..axes.len()).all(|j| j == axes[i].joint || map[(i, j)] == 0.0);
        let declared = axes.iter().enumerate().map(|(i, axis)| Axis {
            turns: turns(i),
            zero: zeros[i] * axis.unit.in_si(),
            ratio: map[(i, axis.joint)],
            coupled: (0..axes.len())
                .filter(|&j| j != i && plain(j) && map[(i, axes[j].joint)] != 0.0)
                .map(|j| (j, map[(i, axes[j].joint)]))
                .collect(),
        });
        declared.collect()
    }

    /// Commands of the model, m or rad, for what the controller shows, m or rad.
    fn commands(&self, shown: &[f64]) -> Option<Vec<f64>> {
        match &self.model.controller {
            None => Some(shown.to_vec()),
            Some(controller) => {
                let in_units = shown.iter().zip(controller.axes());
                let shown: Vec<f64> = in_units.map(|(x, a)| x / a.unit.in_si()).collect();
                controller.joints(&shown)
            }
        }
    }

    /// The tool in the base for what the controller shows, m or rad.
    ///
    /// # Errors
    /// The number of values is another one, or the machine cannot stand there.
    pub fn pose(&self, shown: &[f64]) -> Result<Pose, ControllerPoseError> {
        let commands = self
            .commands(shown)
            .ok_or(ControllerPoseError::JointCount)?;
        Ok(*self
            .model
            .mechanism
            .posture(PostureRequest::commands(&commands))?
            .target())
    }

    /// Tool pose as by [`Self::pose`], computed as fast as possible.
    #[must_use]
    pub fn tool(&self, shown: &[f64]) -> Option<Pose> {
        self.forward.tool(&self.commands(shown)?)
    }
}

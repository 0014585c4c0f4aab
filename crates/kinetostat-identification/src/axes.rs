//! The axes of a machine as its operator reads them: those of the controller, or the actuators.

use kinetostat::MotionKind;
use kinetostat_model::Model;

use crate::body::Body;

/// Axes of a model, in the order of its controller or of its actuators.
#[derive(Clone, Debug)]
pub struct Axes<'m> {
    model: &'m Model,
    /// Name of every axis, and whether it slides or turns.
    names: Vec<(String, MotionKind)>,
}

impl<'m> Axes<'m> {
    /// The axes of the model's controller; without one, its actuators.
    #[must_use]
    pub fn of(model: &'m Model) -> Self {
        let limbs = model.mechanism.limbs().iter();
        let kinds: Vec<MotionKind> = limbs
            .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
            .collect();
        let names = match &model.controller {
            Some(controller) => controller
                .axes()
                .iter()
                .map(|axis| (axis.name.clone(), kinds[axis.joint]))
                .collect(),
            None => model
                .mechanism
                .actuator_names()
                .into_iter()
                .zip(kinds)
                .collect(),
        };
        Self { model, names }
    }

    /// Name of every axis, and whether it slides or turns.
    #[must_use]
    pub fn names(&self) -> &[(String, MotionKind)] {
        &self.names
    }

    /// The body of a name, as [`Body::named`].
    ///
    /// # Errors
    /// No such node, or several.
    pub fn body(&self, name: &str) -> Result<Body, String> {
        Body::named(&self.model.mechanism, name)
    }

    /// Commands of the actuators (m or rad) for what the axes show (m or rad). None if there are not as many values as axes.
    #[must_use]
    pub fn commands(&self, shown: &[f64]) -> Option<Vec<f64>> {
        match &self.model.controller {
            None => (shown.len() == self.names.len()).then(|| shown.to_vec()),
            Some(controller) => {
                let in_units = shown.iter().zip(controller.axes());
                let shown: Vec<f64> = in_units.map(|(x, axis)| x / axis.unit.in_si()).collect();
                controller.joints(&shown)
            }
        }
    }

    /// What the axes show (m or rad) for commands of the actuators (m or rad).
    #[must_use]
    pub fn shown(&self, commands: &[f64]) -> Option<Vec<f64>> {
        match &self.model.controller {
            None => (commands.len() == self.names.len()).then(|| commands.to_vec()),
            Some(controller) => {
                let shown = controller.coordinates(commands)?;
                Some(
                    shown
                        .iter()
                        .zip(controller.axes())
                        .map(|(x, axis)| x * axis.unit.in_si())
                        .collect(),
                )
            }
        }
    }

    /// What is wrong with commands outside the limits of their actuators, one message for each.
    #[must_use]
    pub fn beyond_limits(&self, commands: &[f64]) -> Vec<String> {
        let mechanism = &self.model.mechanism;
        let actuators = mechanism.limbs().iter().flat_map(|l| l.nominal.actuators());
        let each = actuators.zip(mechanism.actuator_names()).zip(commands);
        each.filter_map(|((actuator, name), command)| {
            let (low, high) = actuator.limits?;
            let (unit, size) = match actuator.kind {
                MotionKind::Prismatic => ("mm", 1e-3),
                MotionKind::Revolute => ("deg", std::f64::consts::PI / 180.0),
            };
            let out = *command < low || *command > high;
            out.then(|| {
                format!(
                    "joint {name} would be at {:.3} {unit}; its limits in the model are {:.3} to {:.3} {unit}",
                    command / size,
                    low / size,
                    high / size
                )
            })
        })
        .collect()
    }
}

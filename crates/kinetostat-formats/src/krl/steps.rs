//! Ends that go on from where the tool is: `LIN_REL {X 10,Z -5}`.

use nalgebra::Vector3;

use crate::interpreter::run::Reason;
use crate::krl::position::Position;
use crate::model::target::{Configuration, Target};

/// The remedy for a step that is not followed.
pub(crate) const WRITE_END: &str = "write the end with LIN, or PTP, and all its numbers";

/// A step from where the tool is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Step {
    /// Along the axes of the base, or of the tool, mm.
    Along {
        step_mm: Vector3<f64>,
        in_tool: bool,
    },
    /// Step of the joints, degrees.
    Joints([f64; 6]),
}

impl Step {
    /// The target behind it; none where what it goes on from does not say it.
    pub(crate) fn from(self, before: &Target) -> Option<Target> {
        match (self, before) {
            (Self::Along { step_mm, in_tool }, Target::Pose(before)) => {
                let mut pose = before.clone();
                // The arm configuration at the end of a step is not stated.
                pose.configuration = Configuration::default();
                pose.position_mm += match in_tool {
                    true => before.orientation * step_mm,
                    false => step_mm,
                };
                Some(Target::Pose(pose))
            }
            (Self::Joints(by), Target::Joints { values_deg }) if values_deg.len() == by.len() => {
                let values = values_deg.iter().zip(by).map(|(value, by)| value + by);
                Some(Target::Joints {
                    values_deg: values.collect(),
                })
            }
            _ => None,
        }
    }
}

/// The step that a position is (`{X 10,Z -5}`), which turns nothing; that of joints (`is_joint`) may be `{A1 10}`.
pub(crate) fn step_of(position: &Position, is_joint: bool, in_tool: bool) -> Result<Step, Reason> {
    let values = position.coordinates().map(Option::unwrap_or_default);
    let turns = values[3..].iter().any(|angle| *angle != 0.0);
    let external = position.external.iter().flatten();
    let moves_external = external.into_iter().any(|step| step.value != 0.0);
    let has_axes = position.axes.iter().any(Option::is_some);
    let is_of_axes = is_joint && position.numbers.iter().all(Option::is_none);
    match turns || moves_external || (has_axes && !is_of_axes) {
        true => Err((
            "it goes on from where the tool is, and turns it or moves axes".to_owned(),
            WRITE_END,
        )),
        false if has_axes => Ok(Step::Joints(position.axes.map(Option::unwrap_or_default))),
        false => Ok(Step::Along {
            step_mm: Vector3::new(values[0], values[1], values[2]),
            in_tool,
        }),
    }
}

//! Ends that go on from where the tool is: `LIN_REL {X 10,Z -5}`.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::krl::aggregate::position_of;
use crate::krl::lex::TokenFile;
use crate::krl::targets::End;
use crate::krl::values::Reason;
use crate::model::site::TargetSite;
use crate::model::target::{PoseTarget, Target};

/// `{X 10,Z -5}`: a step along the axes of the base that turns nothing.
pub(crate) fn step_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Result<Vector3<f64>, Reason> {
    let remedy = "write the end with LIN and all its numbers";
    let position =
        position_of(file, tokens).map_err(|reason| (format!("its step: {reason}"), remedy))?;
    let values = position.values().map(Option::unwrap_or_default);
    let turns = values[3..].iter().any(|angle| *angle != 0.0);
    let moves_others = position
        .external
        .iter()
        .flatten()
        .any(|step| step.value != 0.0)
        || position.axes.iter().any(Option::is_some);
    match turns || moves_others {
        true => Err((
            "it goes on from where the tool is, and turns it or moves axes".to_owned(),
            remedy,
        )),
        false => Ok(Vector3::new(values[0], values[1], values[2])),
    }
}

/// The end of a step before the pose that it goes on from is known.
pub(crate) fn by_step() -> End {
    End {
        target: Target::Pose(PoseTarget {
            orientation: UnitQuaternion::identity(),
            ..PoseTarget::default()
        }),
        site: TargetSite::Fixed("it goes on from where the tool is"),
        open: None,
        external: Vec::new(),
    }
}

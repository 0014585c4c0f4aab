//! Rows of joint values with other numbers.

use nalgebra::{Isometry3, UnitQuaternion};

use crate::model::site::JointsText;
use crate::text::edits::Edits;
use crate::text::number::Width;
use crate::text::source::SourceFile;
use crate::writing::literal::{Wanted, put};

/// Minimum decimals of a changed joint value in degrees or mm: 2e-8 rad are 0.05 micrometres at the end of a long arm.
const DECIMALS: f64 = 6.0;

/// Puts the joint values of a pose in place of those of a row; `own` is the orientation at its end. None where the arm does not get
/// there.
pub(crate) fn put_joints(
    file: &SourceFile,
    text: &JointsText,
    (wanted, own): (&Wanted<'_>, UnitQuaternion<f64>),
    edits: &mut Edits,
) -> Option<()> {
    let rotation = wanted.orientation.unwrap_or(own);
    let pose = Isometry3::from_parts(wanted.position_mm.into(), rotation);
    let joints = text.arm.arm.joints_near(&pose, &text.joints())?;
    for ((number, unit), joint) in text.numbers.iter().zip(joints) {
        // Equal resolution in radians and in metres.
        let more = unit.log10().ceil();
        let decimals = (DECIMALS + more) as usize;
        put(file, number, joint / unit, decimals, Width::Free, edits);
    }
    Some(())
}

/// The whole row with the joint values of a pose.
pub(crate) fn row_of_joints(
    file: &SourceFile,
    text: &JointsText,
    pose: (&Wanted<'_>, UnitQuaternion<f64>),
) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    put_joints(file, text, pose, &mut edits)?;
    edits.applied_to_part(file.bytes(), &text.whole)
}

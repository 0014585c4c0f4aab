//! Pose literals with other numbers.

use nalgebra::{UnitQuaternion, Vector3};

use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::text::number::{NumberText, Width, printed};
use crate::text::source::SourceFile;

/// A pose that is wanted: its place, and its orientation where that changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted<'a> {
    pub position_mm: Vector3<f64>,
    pub orientation: Option<UnitQuaternion<f64>>,
    /// External axes that become others, by their order; those that are left out stay.
    pub external: &'a [Option<f64>],
}

/// Puts a value in place of a number of the text.
pub(crate) fn put(
    file: &SourceFile,
    number: &NumberText,
    value: f64,
    least_decimals: usize,
    width: Width,
    edits: &mut Edits,
) {
    let original = file.part(&number.span);
    let text = printed(original, number.value, value, least_decimals, width);
    if text != original {
        edits.replace(number.span.clone(), text);
    }
}

/// Puts the numbers of a pose in place of those of a literal.
pub(crate) fn put_pose(
    file: &SourceFile,
    literal: &PoseText,
    wanted: &Wanted<'_>,
    options: &WriteOptions,
    edits: &mut Edits,
) {
    let more = literal.unit_mm.log10().ceil() as usize;
    for (number, value) in literal.position.iter().zip(wanted.position_mm.iter()) {
        put(
            file,
            number,
            *value / literal.unit_mm,
            options.position_decimals + more,
            literal.width,
            edits,
        );
    }
    for (number, value) in literal.external.iter().zip(wanted.external) {
        if let (Some(number), Some(value)) = (number, value) {
            let least = options.position_decimals;
            put(file, number, *value, least, literal.width, edits);
        }
    }
    let Some(rotation) = wanted.orientation else {
        return;
    };
    let least = match literal.convention {
        OrientationText::Quaternion | OrientationText::Axis | OrientationText::RotationVector => {
            options.quaternion_decimals
        }
        _ => options.angle_decimals,
    };
    let near: Vec<f64> = literal
        .orientation
        .iter()
        .map(|number| number.value)
        .collect();
    let values = literal.convention.numbers_of(&rotation, &near);
    for (number, value) in literal.orientation.iter().zip(values) {
        put(file, number, value, least, literal.width, edits);
    }
}

/// The whole literal with the numbers of a pose.
pub(crate) fn literal_of(
    file: &SourceFile,
    literal: &PoseText,
    wanted: &Wanted<'_>,
    options: &WriteOptions,
) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    put_pose(file, literal, wanted, options, &mut edits);
    edits.applied_to_part(file.bytes(), &literal.whole)
}

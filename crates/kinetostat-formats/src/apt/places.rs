//! Text positions of coordinates, and their axes.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::model::frame::{Frame, FrameUse};
use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::text::number::{NumberText, Width};

/// The numbers of a place; `old` where they do not say the place itself.
pub(crate) fn pose_text(file: usize, numbers: Vec<NumberText>, old: Option<f64>) -> PoseText {
    let whole = numbers[0].span.start..numbers[numbers.len() - 1].span.end;
    let mut numbers = numbers.into_iter();
    let mut number = || {
        let mut number = numbers.next().unwrap_or(NumberText {
            span: 0..0,
            value: 0.0,
        });
        if let Some(old) = old {
            number.value = old;
        }
        number
    };
    let position = [number(), number(), number()];
    let orientation: Vec<NumberText> = numbers.collect();
    PoseText {
        file,
        whole,
        position,
        unit_mm: 1.0,
        convention: match orientation.is_empty() {
            true => OrientationText::Unstated,
            false => OrientationText::Axis,
        },
        orientation,
        external: Vec::new(),
        width: Width::Kept,
    }
}

/// The caller's frames by names in capitals.
pub(crate) type Frames = BTreeMap<String, Isometry3<f64>>;

/// A tool or the part by its name.
pub(crate) fn frame_use(frames: &Frames, name: &str) -> FrameUse {
    FrameUse::stated(name, frames.get(&name.to_ascii_uppercase()), "the file")
}

/// The axes of the places: MSYS in the part's, or the part's.
pub(crate) fn work_object(frames: &Frames, system: Option<&Isometry3<f64>>) -> FrameUse {
    let part = frame_use(frames, "PART");
    match (system, part.known()) {
        (None, _) => part,
        (Some(system), Some(part)) => FrameUse {
            name: "MSYS".to_owned(),
            frame: Frame::Known(part * system),
        },
        // Coordinate systems without a known part are identified by their pose in it.
        (Some(system), None) if *system == Isometry3::identity() => part,
        (Some(system), None) => {
            let (at, turn) = (system.translation.vector, system.rotation.scaled_axis());
            FrameUse {
                name: format!(
                    "MSYS at {:.4} {:.4} {:.4} turned by {:.6} {:.6} {:.6} rad",
                    at.x, at.y, at.z, turn.x, turn.y, turn.z
                ),
                ..part
            }
        }
    }
}

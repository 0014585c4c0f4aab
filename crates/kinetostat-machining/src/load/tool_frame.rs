//! The axes in which a load of the feed is stated where the program turns the tool: z from its tip to its holder.

use kinetostat_program::Path;
use nalgebra::{UnitQuaternion, Vector3};

use crate::cut::station::heading;

/// The rotation that takes the part's z to the tool's direction by the shorter way, part axes: none in a program of positions.
pub(crate) fn tool_frame(path: &Path, move_index: usize, share: f64) -> UnitQuaternion<f64> {
    let Some(orientation) = path.moves[move_index].orientation(share) else {
        return UnitQuaternion::identity();
    };
    let direction = orientation * path.tool_axis;
    // Upside down every way is as short: about x.
    UnitQuaternion::rotation_between(&Vector3::z(), &direction).unwrap_or_else(|| {
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
    })
}

/// Heading of a direction (part axes) at a share of a move in the axes of [`tool_frame`], rad; `None` along the tool.
pub(crate) fn heading_on(
    path: &Path,
    (move_index, share): (usize, f64),
    direction: Option<Vector3<f64>>,
) -> Option<f64> {
    match path.moves[move_index].tool_turn {
        None => heading(direction),
        Some(_) => {
            let frame = tool_frame(path, move_index, share);
            heading(direction.map(|along| frame.inverse() * along))
        }
    }
}

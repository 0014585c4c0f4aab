//! The workspace: two opposite corners.

use nalgebra::Vector3;

use crate::elements::quantity::{MM, ReadResult, choice, need};
use crate::problem::KeyPath;
use crate::schema::Document;

/// The workspace's corners.
pub(crate) fn corners(document: &Document) -> ReadResult<Option<Corners>> {
    let Some(w) = &document.workspace else {
        return Ok(None);
    };
    let place = KeyPath::root().key("workspace");
    let from = [
        choice("corner_mm", w.corner_mm, MM),
        choice("corner_m", w.corner_m, 1.0),
    ];
    let to = [
        choice("opposite_corner_mm", w.opposite_corner_mm, MM),
        choice("opposite_corner_m", w.opposite_corner_m, 1.0),
    ];
    let from = need(&place, "corner", &from)?.value;
    let to = need(&place, "opposite corner", &to)?.value;
    Ok(Some((from.into(), to.into())))
}

/// Two opposite corners, m.
pub(crate) type Corners = (Vector3<f64>, Vector3<f64>);

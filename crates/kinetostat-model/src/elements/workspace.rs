//! The workspace: two opposite corners.

use nalgebra::Vector3;

use crate::elements::quantity::{MM, ReadResult, choices, need};
use crate::problem::KeyPath;
use crate::schema::Document;

/// The workspace's corners.
pub(crate) fn corners(document: &Document) -> ReadResult<Option<Corners>> {
    let Some(w) = &document.workspace else {
        return Ok(None);
    };
    let place = KeyPath::root().key("workspace");
    let from = choices!(w, (corner_mm, MM), (corner_m, 1.0));
    let to = choices!(w, (opposite_corner_mm, MM), (opposite_corner_m, 1.0));
    let from = need(&place, "corner", &from)?.value;
    let to = need(&place, "opposite corner", &to)?.value;
    Ok(Some((from.into(), to.into())))
}

/// Two opposite corners, m.
pub(crate) type Corners = (Vector3<f64>, Vector3<f64>);

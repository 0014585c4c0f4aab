//! G41 and G42: the tool and where it is, before its first move along a contour.

use std::collections::BTreeMap;

use crate::expanding::radius::contour::Contour;
use crate::expanding::radius::cutter::{InSpindle, side_and_radius};
use crate::expanding::radius::geometry::Point;
use crate::expanding::radius::words::Switch;
use crate::expanding::translate::wrong::Wrong;
use crate::reading::interpret::Interpreter;
use crate::reading::options::Units;

/// The contour that begins; none for a tool without a radius.
pub(crate) fn begin(
    switch: Switch,
    spindle: InSpindle,
    diameters_mm: &BTreeMap<u32, f64>,
    state: &Interpreter<'_>,
) -> Result<Option<Contour>, Wrong> {
    if state.plane_axes() != [0, 1, 2] {
        return Err((
            "cutter radius compensation outside the plane XY is not followed".to_owned(),
            "write G17, or let the CAM system write the centre line of the tool",
        ));
    }
    let unit = state.units().map(Units::mm_per_unit);
    let places = [0, 1].map(|axis| state.place_mm(axis));
    let (Some(unit), [Some(x), Some(y)]) = (unit, places) else {
        return Err((
            "where the tool is before cutter radius compensation is not known".to_owned(),
            "state units, X and Y before it",
        ));
    };
    let found = side_and_radius(switch, spindle, diameters_mm, unit)?;
    let found = found.filter(|(_, radius)| *radius > 0.0);
    Ok(found.map(|(side, radius)| Contour::new(side, radius, Point::new(x, y))))
}

//! G41 and G42: the tool and where it is, before its first move along a contour.

use std::collections::BTreeMap;

use crate::expanding::options::Dialect;
use crate::expanding::radius::contour::Contour;
use crate::expanding::radius::cutter::{InSpindle, side_and_radius};
use crate::expanding::radius::geometry::Point;
use crate::expanding::radius::words::Switch;
use crate::expanding::translate::wrong::Wrong;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::reading::options::Units;

/// The contour that begins; none for a tool without a radius.
pub(crate) fn begin(
    switch: Switch,
    spindle: InSpindle,
    diameters_mm: &BTreeMap<u32, f64>,
    state: &Interpreter<'_>,
    dialect: Dialect,
) -> Result<Option<Contour>, Wrong> {
    let [first, second, across] = state.plane_axes();
    if across == 0 {
        return Err((
            "there is no cutter radius compensation in the plane YZ (G19): LinuxCNC refuses it too"
                .to_owned(),
            "write G17 or G18, or let the CAM system write the centre line of the tool",
        ));
    }
    let unit = state.units().map(Units::mm_per_unit);
    let places = [first, second].map(|axis| state.place_mm(axis));
    let (Some(unit), [Some(x), Some(y)]) = (unit, places) else {
        return Err((
            "where the tool is before cutter radius compensation is not known".to_owned(),
            match across {
                2 => "state units, X and Y before it",
                _ => "state units, Z and X before it",
            },
        ));
    };
    let found = side_and_radius(switch, spindle, diameters_mm, unit)?;
    let found = found.filter(|(_, radius)| *radius > 0.0);
    Ok(found.map(|(side, radius)| Contour::new(side, radius, Point::new(x, y), dialect)))
}

//! The radius of the tool, and the contour that begins with it.

use std::collections::BTreeMap;

use crate::expanding::radius::contour::Contour;
use crate::expanding::radius::geometry::{Point, Side};
use crate::expanding::radius::words::{Switch, Words};
use crate::expanding::{Dialect, Wrong};
use crate::reading::interpreting::Interpreter;
use crate::reading::options::Units;

/// A number this near to a whole one is one (LinuxCNC).
const WHOLE: f64 = 1e-4;

/// Diameters beyond this are no tool's, in mm.
const LARGEST_DIAMETER_MM: f64 = 1e4;

/// A negative diameter is that of a tool thinner than the contour was made for, by its wear; beyond this it is a sign, in mm.
const MOST_WEAR_MM: f64 = 1.0;

/// Tool in the spindle, as the program states it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct InSpindle {
    selected: Option<u32>,
    changed: Option<u32>,
}

impl InSpindle {
    /// Follows T, M6 and M61.
    pub fn note(&mut self, words: &Words) {
        self.selected = words.tool.and_then(whole).or(self.selected);
        if words.has_function(60) {
            self.changed = self.selected;
        }
        if words.has_function(610) {
            self.changed = words.q.and_then(whole);
        }
    }
}

/// Side and radius, in mm, that a switch means.
pub(crate) fn side_and_radius(
    switch: Switch,
    spindle: InSpindle,
    diameters_mm: &BTreeMap<u32, f64>,
    mm_per_unit: f64,
) -> Result<Option<(Side, f64)>, Wrong> {
    let (side, diameter) = match switch {
        Switch::Off => return Ok(None),
        Switch::Tool(side, number) => (side, of_tool(number, spindle, diameters_mm)?),
        Switch::Diameter(_, None) => {
            return Err((
                "G41.1 and G42.1 need the diameter of the tool (D)".to_owned(),
                "write D, or G41 and G42 for a tool by its number",
            ));
        }
        Switch::Diameter(side, Some(diameter)) => (side, diameter * mm_per_unit),
    };
    if diameter.is_nan() || diameter.abs() > LARGEST_DIAMETER_MM {
        return Err((
            format!("a tool of {diameter} mm in diameter"),
            "give the diameter in mm",
        ));
    }
    if diameter < -MOST_WEAR_MM {
        return Err((
            format!(
                "a tool of {diameter} mm in diameter: wear makes at most -{MOST_WEAR_MM} mm of a corrected contour"
            ),
            "give the diameter of the tool, above 0, and the other side (G42 for G41) where that is meant",
        ));
    }
    // A tool that is thinner than the contour was made for.
    let side = match diameter < 0.0 {
        true => side.other(),
        false => side,
    };
    Ok(Some((side, 0.5 * diameter.abs())))
}

fn of_tool(
    number: Option<f64>,
    spindle: InSpindle,
    diameters_mm: &BTreeMap<u32, f64>,
) -> Result<f64, Wrong> {
    let named = match number {
        None => None,
        Some(number) => match whole(number) {
            Some(tool) => Some(tool).filter(|tool| *tool > 0),
            None => {
                return Err((
                    format!("D{number} is no number of a tool"),
                    "write D with the number of the tool, or G41.1 and G42.1 with its diameter",
                ));
            }
        },
    };
    let Some(tool) = named.or(spindle.changed) else {
        return Err((
            "which tool is in the spindle is not known here, and its radius decides where it goes"
                .to_owned(),
            "write D with its number beside G41 or G42, or T and M6 before",
        ));
    };
    diameters_mm.get(&tool).copied().ok_or((
        format!("the diameter of tool {tool} is not known here, and it decides where the tool goes"),
        "give its diameter (0 where the program states the way of the tool's centre; --tool-diameter-mm, or tool_diameters_mm under [expand] in the job file), or write G41.1 and G42.1 with D, the diameter in the program",
    ))
}

fn whole(value: f64) -> Option<u32> {
    let near = value.round();
    let is_whole = (value - near).abs() < WHOLE && (0.0..1e9).contains(&near);
    is_whole.then_some(near as u32)
}

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

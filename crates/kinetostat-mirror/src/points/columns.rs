//! Columns of a measurement, by their names with units.

use crate::error::MirrorError;

/// Units of lengths, and how many mm each has.
const UNITS: [(&str, f64); 5] = [
    ("mm", 1.0),
    ("m", 1e3),
    ("um", 1e-3),
    ("cm", 10.0),
    ("in", 25.4),
];

const NEEDED: &str = "expected x_mm,y_mm,z_mm (or _m, _um, _cm, _in) and, if they are known, weight or sigma_mm, and line (of the program)";

/// Index of each quantity's column, lengths with the mm of their unit.
#[derive(Clone, Copy, Default)]
pub(crate) struct Columns {
    pub axes: [(usize, f64); 3],
    pub weight: Option<usize>,
    pub sigma: Option<(usize, f64)>,
    pub line: Option<usize>,
}

impl Columns {
    pub(crate) fn of(headers: &csv::StringRecord) -> Result<Self, MirrorError> {
        let mut axes = [None; 3];
        let mut found = Self::default();
        for (index, name) in headers.iter().map(str::trim).enumerate() {
            let twice = match quantity(name)? {
                Quantity::Axis(axis, mm) => axes[axis].replace((index, mm)).is_some(),
                Quantity::Sigma(mm) => found.sigma.replace((index, mm)).is_some(),
                Quantity::Weight => found.weight.replace(index).is_some(),
                Quantity::Line => found.line.replace(index).is_some(),
            };
            if twice {
                return Err(refused(&format!(
                    "column `{name}` stands for something that another column says already"
                )));
            }
        }
        if found.sigma.is_some() && found.weight.is_some() {
            return Err(refused("weight and sigma both, of which one is enough"));
        }
        for (axis, place) in axes.iter().enumerate() {
            found.axes[axis] =
                place.ok_or_else(|| refused(&format!("no column of {}", ["x", "y", "z"][axis])))?;
        }
        Ok(found)
    }
}

enum Quantity {
    Axis(usize, f64),
    Sigma(f64),
    Weight,
    Line,
}

fn quantity(name: &str) -> Result<Quantity, MirrorError> {
    match name {
        "weight" => return Ok(Quantity::Weight),
        "line" => return Ok(Quantity::Line),
        _ => {}
    }
    let (quantity, unit) = name.split_once('_').unwrap_or((name, ""));
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == quantity);
    if axis.is_none() && quantity != "sigma" {
        return Err(refused(&format!("unknown column `{}`", shown(name))));
    }
    if unit.is_empty() {
        return Err(refused(&format!("column `{name}` states no unit")));
    }
    let known = UNITS.iter().find(|(known, _)| *known == unit);
    let Some((_, mm)) = known else {
        return Err(refused(&format!(
            "column `{}` has an unknown unit",
            shown(name)
        )));
    };
    Ok(axis.map_or(Quantity::Sigma(*mm), |axis| Quantity::Axis(axis, *mm)))
}

fn refused(what: &str) -> MirrorError {
    MirrorError::new(format!("{what}; {NEEDED}"))
}

pub(crate) fn shown(cell: &str) -> String {
    cell.chars().take(40).collect()
}

//! Rotary axes: from what is written to SI.

use nalgebra::{Unit, Vector3};

use crate::elements::placement::direction;
use crate::elements::quantity::{MM, ReadResult, choices, pick};
use crate::problem::{Finding, KeyPath};
use crate::schema::{CarriesWord, Document, RotaryAxisTable};

/// A rotary axis of a machine, base axes, where all of them stand at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct RotaryAxis {
    /// Letter of the axis in programs: A, B or C.
    pub letter: char,
    /// Body that the axis turns.
    pub carries: CarriesWord,
    /// Axis about which a positive word turns it, right-handed.
    pub direction: Unit<Vector3<f64>>,
    /// A point on it, m; zero where it does not matter.
    pub point: Vector3<f64>,
    /// Lower and upper limit of its angle, deg.
    pub limits_deg: Option<[f64; 2]>,
}

/// The axes, each with its place in the file or what is wrong with it.
pub(crate) fn rotary_axes(document: &Document) -> Vec<ReadResult<RotaryAxis>> {
    let tables = document.rotary_axis.iter().enumerate();
    tables
        .map(|(index, table)| {
            let place = KeyPath::root().key("rotary_axis").index(index);
            let before = &document.rotary_axis[..index];
            if before.iter().any(|other| other.word == table.word) {
                return Err(Finding::new(
                    &place.key("word"),
                    format!(
                        "the word {} is that of another rotary axis",
                        table.word.letter()
                    ),
                    "give each axis a word of its own",
                ));
            }
            axis(&place, table)
        })
        .collect()
}

fn axis(place: &KeyPath, table: &RotaryAxisTable) -> ReadResult<RotaryAxis> {
    let given = choices!(table, (point_mm, MM), (point_m, 1.0));
    let point = pick(place, "point", &given)?;
    if point.is_none() && table.carries == CarriesWord::Part {
        return Err(Finding::new(
            place,
            "where this axis lies is not stated: a table turns the part about it",
            "write a point on it, as in  point_mm = [0, 0, 0]",
        ));
    }
    if let Some([least, largest]) = table.limits_deg
        && !(least.is_finite() && largest.is_finite() && least < largest)
    {
        return Err(Finding::new(
            &place.key("limits_deg"),
            format!("the limits {least} and {largest} leave no angle between them"),
            "write the least angle and the largest one, as in  limits_deg = [-110, 110]",
        ));
    }
    Ok(RotaryAxis {
        letter: table.word.letter(),
        carries: table.carries,
        direction: direction(&place.key("axis"), &table.axis)?,
        point: point.map_or_else(Vector3::zeros, |given| given.value.into()),
        limits_deg: table.limits_deg,
    })
}

//! Data that every RAPID controller has: speeds, zones, the flange as a tool, the world as a work object.
//!
//! Source: ABB, RAPID Instructions, Functions and Data types, pages of `speeddata`, `zonedata`, `tooldata`, `wobjdata`.

use std::f64::consts::PI;

use crate::interpreter::value::{Datum, Value};
use crate::rapid::literals::list_of_frame;
use crate::text::name::Name;

/// The value of a name that no module declares.
pub(crate) fn predefined(name: &Name) -> Option<Datum> {
    let identity = || list_of_frame(&nalgebra::Isometry3::identity());
    let empty_load = || {
        let zero = || Datum::number(0.0);
        let centre = Datum::numbers([0.0; 3]);
        let axes = Datum::numbers([1.0, 0.0, 0.0, 0.0]);
        Datum::list(vec![zero(), centre, axes, zero(), zero(), zero()])
    };
    if name.is("TOOL0") {
        let hold = Datum::truth(true);
        return Some(Datum::list(vec![hold, identity(), empty_load()]));
    }
    if name.is("WOBJ0") {
        let [hold, fixed] = [false, true].map(Datum::truth);
        let unit = Datum::of(Value::Text("".into()));
        return Some(Datum::list(vec![hold, fixed, unit, identity(), identity()]));
    }
    match name.letters() {
        b"PI" => return Some(Datum::number(PI)),
        b"LOAD0" => return Some(empty_load()),
        b"FINE" => return Some(zone(true, 0.0)),
        _ => {}
    }
    speed(name).or_else(|| zone_by_number(name))
}

/// `v100` and its kin: 500 degrees/s, 5000 mm/s, 1000 degrees/s with each.
fn speed(name: &Name) -> Option<Datum> {
    const SPEEDS: [u32; 25] = [
        5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000,
        2500, 3000, 4000, 5000, 6000, 7000,
    ];
    let number = number_behind(name, b"V").filter(|number| SPEEDS.contains(number))?;
    Some(Datum::numbers([f64::from(number), 500.0, 5000.0, 1000.0]))
}

/// `z10` and its kin.
fn zone_by_number(name: &Name) -> Option<Datum> {
    const ZONES: [u32; 14] = [0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200];
    let number = number_behind(name, b"Z").filter(|number| ZONES.contains(number))?;
    let radius = match number {
        0 => 0.3,
        _ => f64::from(number),
    };
    Some(zone(false, radius))
}

fn zone(is_stop: bool, radius: f64) -> Datum {
    let turning = match radius {
        5.0.. => (1.5 * radius).round(),
        _ => radius,
    };
    let numbers = [
        radius,
        turning,
        turning,
        0.1 * turning,
        turning,
        0.1 * turning,
    ];
    let numbers = numbers.into_iter().map(Datum::number);
    Datum::list(
        std::iter::once(Datum::truth(is_stop))
            .chain(numbers)
            .collect(),
    )
}

fn number_behind(name: &Name, letter: &[u8]) -> Option<u32> {
    let digits = std::str::from_utf8(name.letters().strip_prefix(letter)?).ok()?;
    digits.parse().ok()
}

//! What the tests of the stock share.

use std::f64::consts::TAU;

use kinetostat_cutting::{Contact, Edge, Engagement, Probe, Shape, Stock, StockSettings, Tool};

pub fn flat(diameter: f64) -> Tool {
    Tool::new(Shape::Flat, diameter, 2).unwrap()
}

pub fn cells(cell: f64) -> StockSettings {
    StockSettings::with_cell_mm(cell).unwrap()
}

pub fn block(a: [f64; 3], b: [f64; 3], cell: f64) -> Stock {
    Stock::block(a, b, &cells(cell)).unwrap()
}

/// The one contact of the side.
pub fn only_side(engagement: &Engagement) -> Contact {
    assert_eq!(engagement.contacts.len(), 1, "{engagement:?}");
    let contact = engagement.contacts[0];
    assert_eq!(contact.edge, Edge::Side);
    contact
}

/// Largest difference of the ends of an arc from those expected, rad.
pub fn arc_error(contact: &Contact, entry: f64, exit: f64) -> f64 {
    let around = |angle: f64| (angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
    let (a, b) = (
        around(contact.entry - entry).abs(),
        around(contact.exit - exit).abs(),
    );
    let length = (contact.exit - contact.entry - (exit - entry)).abs();
    assert!(
        a.is_finite() && b.is_finite() && length < 3.0,
        "{contact:?}"
    );
    if a < b { b } else { a }
}

/// Places on a circle in the plane of a height, from one angle (counted from x to y) to another.
pub fn circle(
    centre: [f64; 2],
    radius: f64,
    z: f64,
    [from, to]: [f64; 2],
    n: usize,
) -> Vec<[f64; 3]> {
    (0..=n)
        .map(|k| {
            let angle = from + (to - from) * k as f64 / n as f64;
            [
                centre[0] + radius * angle.cos(),
                centre[1] + radius * angle.sin(),
                z,
            ]
        })
        .collect()
}

/// Share of the whole in contact, as area of height times angle, mm rad.
pub fn extent(engagement: &Engagement) -> f64 {
    let of = |c: &Contact| (c.to_mm - c.from_mm) * (c.exit - c.entry);
    engagement.contacts.iter().map(of).sum()
}

/// A probe that has no memory of a move before.
pub fn look(tool: &Tool, stock: &Stock, at: [f64; 3], towards: [f64; 3]) -> Engagement {
    Probe::new(tool).engagement(stock, at, towards).unwrap()
}

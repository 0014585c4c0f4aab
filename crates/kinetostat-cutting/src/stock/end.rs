//! Contact of the flat end of a descending tool with the material.

use crate::engagement::{Contact, Engagement};
use crate::stock::arcs::{Range, same};
use crate::stock::grid::Stock;
use crate::stock::rim::{Cell, Stand};

/// Rings of the end at one place.
const RINGS: [f64; 2] = [4.0, 64.0];

/// Buffers for the contacts of a flat end.
#[derive(Clone, Debug, Default)]
pub(crate) struct End {
    arcs: Vec<[f64; 2]>,
    within: Vec<[f64; 2]>,
}

impl End {
    /// Adds the contacts of a flat end of this radius.
    pub fn contacts(&mut self, stock: &Stock, stand: &Stand, radius: f64, found: &mut Engagement) {
        let level = stand.tip.max(0.0) + stock.tolerance();
        if stand.tip < -stock.tolerance() || level >= stock.height {
            return;
        }
        let rings = (radius / stock.cell).ceil().clamp(RINGS[0], RINGS[1]);
        let width = radius / rings;
        self.within.clear();
        for ring in 0..rings as usize {
            let inner = width * ring as f64;
            let middle = inner + 0.5 * width;
            let value = |direction: [f64; 2]| {
                depth_below(stock, stand, stand.place(middle, direction), level, radius)
            };
            Range::full(middle, stock.cell).arcs(value, &mut self.arcs);
            let outer = match ring + 1 == rings as usize {
                true => radius,
                false => inner + width,
            };
            match same(&self.arcs, &self.within) {
                true => {
                    let first = found.contacts.len() - self.arcs.len();
                    for contact in &mut found.contacts[first..] {
                        contact.to_mm = outer;
                    }
                }
                false => {
                    let contact = |arc: &[f64; 2]| Contact::end(inner, outer, arc[0], arc[1]);
                    found.contacts.extend(self.arcs.iter().map(contact));
                }
            }
            std::mem::swap(&mut self.arcs, &mut self.within);
        }
    }
}

/// Positive in the material at a place under the end; about the distance of the next wall. Points beyond the end do not count:
/// the walls there are none of its own business.
fn depth_below(stock: &Stock, stand: &Stand, place: [f64; 2], level: f64, radius: f64) -> f64 {
    let Some(cell) = Cell::at(stock, place) else {
        return -stock.cell;
    };
    let columns = cell.columns(stock);
    let inside = columns.map(|column| f64::from(column.top) > level);
    if inside == [false; 4] {
        return -stock.cell;
    }
    let known = stock.known() as f32;
    let wall = |k: usize| {
        if inside[k] {
            columns[k].drop
        } else {
            columns[k].rise
        }
    };
    let is_slope = (0..4).all(|k| wall(k) >= known);
    let mut sum = 0.0;
    for k in 0..4 {
        if cell.distance(stock, k, stand.centre) > radius {
            continue;
        }
        let signed = match (is_slope, inside[k]) {
            (true, _) => f64::from(columns[k].top) - level,
            (false, true) => f64::from(wall(k)),
            (false, false) => -f64::from(wall(k)),
        };
        sum += cell.shares[k] * signed;
    }
    sum
}

//! Contact of a cylinder's rim with the material.
//!
//! Each point of the grid stores the distance of the next wall; the distance of the rim from the point is known
//! exactly. Their difference is interpolated, not the two themselves: where the wall was made by the same circle it
//! vanishes at every point, and so between them. A tool that passes the same way again finds nothing.

use crate::engagement::{Contact, Engagement};
use crate::stock::arcs::{Range, same};
use crate::stock::faces::{Faces, OnRim, Seen};
use crate::stock::grid::{Column, Stock};

/// Maximum number of bands of height at one place.
const BANDS: usize = 16;
/// Shares of a short or shallow arc at which it is checked again.
const SHARES: [f64; 3] = [0.25, 0.5, 0.75];
/// Depth of a shallow arc, as a share of a cell: where a wall begins to bend, its place is off by half of that.
const SHALLOW: f64 = 2e-3;
/// Tops that differ by less than this share of a cell are in one band.
const BAND: f64 = 0.1;

/// Position of a tool: its axis, the height of its tip above the stock's bottom, and the direction of the feed seen
/// from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stand {
    pub centre: [f64; 2],
    pub tip: f64,
    pub feed: [f64; 2],
    /// Rise of the tip per way in the plane.
    pub slope: f64,
}

impl Stand {
    /// Position of a radius at the `(sin, cos)` of an angle of the tool.
    #[inline]
    pub fn place(&self, radius: f64, [sin, cos]: [f64; 2]) -> [f64; 2] {
        let [fx, fy] = self.feed;
        [
            self.centre[0] + radius * (sin * fx - cos * fy),
            self.centre[1] + radius * (sin * fy + cos * fx),
        ]
    }
}

impl Stand {
    /// Rise of the tip on a ramp from now until the end of the tool leaves a point (downwards) or reaches it (upwards):
    /// the floor there is not lower.
    #[inline]
    pub fn floor_above(&self, [x, y]: [f64; 2], radius: f64) -> f64 {
        let (dx, dy) = (x - self.centre[0], y - self.centre[1]);
        let way = dx * self.feed[0] + dy * self.feed[1];
        let across = dy * self.feed[0] - dx * self.feed[1];
        let square = radius * radius - across * across;
        let half = if square > 0.0 { square.sqrt() } else { 0.0 };
        let until = if self.slope > 0.0 {
            way - half
        } else {
            way + half
        };
        (self.slope * until).max(0.0)
    }
}

/// A cell of the grid: the index of its lower corner and the shares of its corners at a place in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    pub i: usize,
    pub j: usize,
    pub shares: [f64; 4],
}

impl Cell {
    /// The cell that holds a place.
    #[inline]
    pub fn at(stock: &Stock, [x, y]: [f64; 2]) -> Option<Self> {
        let u = (x - stock.origin[0]) * stock.per_mm;
        let v = (y - stock.origin[1]) * stock.per_mm;
        let [nx, ny] = stock.points;
        if !(u >= 0.0 && v >= 0.0 && u < (nx - 1) as f64 && v < (ny - 1) as f64) {
            return None;
        }
        let (i, j) = (u as usize, v as usize);
        let (a, b) = (u - i as f64, v - j as f64);
        Some(Self {
            i,
            j,
            shares: [(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b],
        })
    }

    /// Columns of the cell, in the order of the shares.
    #[inline]
    pub fn columns(&self, stock: &Stock) -> [Column; 4] {
        let (nx, first) = (stock.points[0], self.j * stock.points[0] + self.i);
        let lower = &stock.columns[first..first + 2];
        let upper = &stock.columns[first + nx..first + nx + 2];
        [lower[0], lower[1], upper[0], upper[1]]
    }

    /// Distance of its corner from a place.
    #[inline]
    pub fn distance(&self, stock: &Stock, corner: usize, [x, y]: [f64; 2]) -> f64 {
        let place = stock.place(self.i + (corner & 1), self.j + (corner >> 1));
        let (dx, dy) = (place[0] - x, place[1] - y);
        (dx * dx + dy * dy).sqrt()
    }
}

/// Marks the points of a cell that are in the material at a height above the bottom.
#[inline]
fn inside(
    stock: &Stock,
    cell: &Cell,
    columns: &[Column; 4],
    level: f64,
    stand: &Stand,
    radius: f64,
) -> [bool; 4] {
    std::array::from_fn(|k| {
        let floor = match stand.slope == 0.0 {
            true => level,
            false => {
                let at = stock.place(cell.i + (k & 1), cell.j + (k >> 1));
                level + stand.floor_above(at, radius)
            }
        };
        f64::from(columns[k].top) > floor
    })
}

/// Positive in the material, at a place of a rim of this radius about a stand and at a height above the bottom; about the
/// distance of the next wall.
#[inline]
fn depth_in(stock: &Stock, place: [f64; 2], level: f64, stand: &Stand, radius: f64) -> f64 {
    let Some(cell) = Cell::at(stock, place) else {
        return -stock.cell;
    };
    let columns = cell.columns(stock);
    let known = stock.known() as f32;
    let inside = inside(stock, &cell, &columns, level, stand, radius);
    let walls: [f32; 4] = std::array::from_fn(|k| match inside[k] {
        true => columns[k].drop,
        false => columns[k].rise,
    });
    let seen = walls.map(|wall| wall < known);
    match inside {
        // With all points on one side, a wall passes between them only if all see it: a rib, or a rim outside of all of
        // them.
        [false, false, false, false] if seen != [true; 4] => return -stock.cell,
        [true, true, true, true] if seen != [true; 4] => return stock.cell,
        _ => {}
    }
    if seen == [false; 4] {
        // No tool has been here: a slope.
        let tops = (0..4).map(|k| cell.shares[k] * (f64::from(columns[k].top) - level));
        return tops.sum();
    }
    let rim = OnRim {
        centre: stand.centre,
        radius,
        place,
    };
    // A cut too shallow to have a wall.
    if (0..4).any(|k| !inside[k] && !seen[k]) {
        return mean_depth(stock, &cell, &columns, inside, &rim);
    }
    let mut faces = Faces::default();
    for k in 0..4 {
        if seen[k] {
            let (normal, sign) = match inside[k] {
                true => (columns[k].drop_normal, 1.0),
                false => (columns[k].rise_normal, -1.0),
            };
            let seen = Seen {
                point: stock.place(cell.i + (k & 1), cell.j + (k >> 1)),
                distance: sign * f64::from(walls[k]),
                normal,
                share: cell.shares[k],
            };
            faces.add(&rim, &seen);
        }
    }
    match inside {
        [false, false, false, false] if faces.is_one() => -stock.cell,
        _ => faces.nearest(),
    }
}

/// Positive where the interpolated distances of a cell say that a place of a rim is in the material.
fn interpolated(stock: &Stock, place: [f64; 2], level: f64, stand: &Stand, radius: f64) -> f64 {
    let Some(cell) = Cell::at(stock, place) else {
        return -stock.cell;
    };
    let columns = cell.columns(stock);
    let inside = inside(stock, &cell, &columns, level, stand, radius);
    let rim = OnRim {
        centre: stand.centre,
        radius,
        place,
    };
    mean_depth(stock, &cell, &columns, inside, &rim)
}

/// The distances of the points' walls, less those of the rim, weighted by the points' shares.
fn mean_depth(
    stock: &Stock,
    cell: &Cell,
    columns: &[Column; 4],
    inside: [bool; 4],
    rim: &OnRim,
) -> f64 {
    let mut sum = 0.0;
    for k in 0..4 {
        let signed = match inside[k] {
            true => f64::from(columns[k].drop),
            false => -f64::from(columns[k].rise),
        };
        let from_rim = cell.distance(stock, k, rim.centre) - rim.radius;
        sum += cell.shares[k] * (signed - from_rim);
    }
    sum
}

/// Buffers for the arcs of a rim.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rim {
    levels: Vec<f64>,
    arcs: Vec<[f64; 2]>,
    below: Vec<[f64; 2]>,
}

impl Rim {
    /// Adds the contacts of a cylinder from a height above its tip upwards.
    pub fn contacts(
        &mut self,
        stock: &Stock,
        stand: &Stand,
        radius: f64,
        from: f64,
        range: &Range,
        found: &mut Engagement,
    ) {
        let tolerance = stock.tolerance();
        let sliver = stock.sliver(radius);
        let base = (stand.tip + from).max(0.0);
        self.find_levels(stock, stand, radius, base, range);
        let first = found.contacts.len();
        let mut bottom = base;
        self.below.clear();
        for k in 0..self.levels.len() {
            let top = self.levels[k];
            let level = 0.5 * (bottom + top);
            let value = |direction: [f64; 2]| {
                let place = stand.place(radius, direction);
                depth_in(stock, place, level, stand, radius) - tolerance
            };
            range.arcs_but(sliver, value, &mut self.arcs);
            // A short arc may be the corner of two walls of which a cell knows one, and a shallow one the bend of a wall: what
            // made them vanishes from the interpolated distances.
            self.arcs.retain(|[from, to]| {
                let long = to - from > 2.0 * sliver.arc;
                SHARES.iter().any(|share| {
                    let (sin, cos) = (from + share * (to - from)).sin_cos();
                    let place = stand.place(radius, [sin, cos]);
                    let is_deep =
                        || depth_in(stock, place, level, stand, radius) > SHALLOW * stock.cell;
                    long && is_deep()
                        || interpolated(stock, place, level, stand, radius) > tolerance
                })
            });
            if self.arcs.is_empty() {
                break;
            }
            let (lower, upper) = (bottom - stand.tip, top - stand.tip);
            match k > 0 && same(&self.arcs, &self.below) {
                true => {
                    let count = found.contacts.len() - self.arcs.len();
                    for contact in &mut found.contacts[count.max(first)..] {
                        contact.to_mm = upper;
                    }
                }
                false => {
                    let contact = |arc: &[f64; 2]| Contact::side(lower, upper, arc[0], arc[1]);
                    found.contacts.extend(self.arcs.iter().map(contact));
                }
            }
            std::mem::swap(&mut self.arcs, &mut self.below);
            bottom = top;
        }
    }

    /// Heights of the stock along the rim, above the base, each once.
    fn find_levels(&mut self, stock: &Stock, stand: &Stand, radius: f64, base: f64, range: &Range) {
        let levels = &mut self.levels;
        levels.clear();
        let least = base + stock.tolerance();
        let mut last = f64::NAN;
        range.each(|_, direction| {
            let Some(cell) = Cell::at(stock, stand.place(radius, direction)) else {
                return;
            };
            for column in cell.columns(stock) {
                let top = f64::from(column.top);
                if top > least && top != last {
                    last = top;
                    levels.push(top);
                }
            }
        });
        // Sorts from above; the highest of those that lie close together represents them.
        levels.sort_by(|a, b| b.total_cmp(a));
        let (Some(highest), Some(lowest)) = (levels.first(), levels.last()) else {
            return;
        };
        let gap = (BAND * stock.cell).max((highest - lowest) / BANDS as f64);
        levels.dedup_by(|lower, higher| *higher - *lower < gap);
        levels.reverse();
    }
}

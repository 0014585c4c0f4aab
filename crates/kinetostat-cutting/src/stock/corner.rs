//! Contact of a tool's corner (ball, bull nose, cone of a face mill) with the material.
//!
//! At the grid points under the tool, the height of the stock over the envelope is taken, or, where the envelope is
//! steep, the excess of the tool's radius at the height of the stock over that at the point. Both vanish at every point
//! that this tool has cut from the same place, so that what is interpolated between them vanishes too.

use crate::engagement::{Contact, Engagement};
use crate::stock::arcs::{Range, same};
use crate::stock::grid::Stock;
use crate::stock::profile::Profile;
use crate::stock::rim::{Cell, Stand};

/// Bands of the corner at one place.
const BANDS: [f64; 2] = [3.0, 64.0];

/// A grid point under the tool.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    /// Height of the stock over the envelope, or distance of the envelope at that height.
    over: f64,
    /// Top of the stock above the tip.
    top: f64,
    /// Radius of the wall down, up to which there is material.
    drop: f64,
    /// Radius of the wall up.
    rise: f64,
}

/// Buffers for the contacts of a corner.
#[derive(Clone, Debug, Default)]
pub(crate) struct Corner {
    nodes: Vec<Node>,
    first: [usize; 2],
    size: [usize; 2],
    highest: f64,
    arcs: Vec<[f64; 2]>,
    below: Vec<[f64; 2]>,
}

/// A band of the corner: its heights, and radius, height and normal in its middle.
struct Band {
    from: f64,
    to: f64,
    radius: f64,
    height: f64,
    normal: f64,
}

impl Corner {
    /// Adds the contacts of the corner; the motion has a horizontal and a vertical part.
    pub fn contacts(
        &mut self,
        stock: &Stock,
        stand: &Stand,
        profile: &Profile,
        motion: [f64; 2],
        found: &mut Engagement,
    ) {
        self.look(stock, stand, profile, motion[1]);
        if self.highest <= 0.0 {
            return;
        }
        let top = self.highest.min(profile.shoulder());
        let lowest = -stand.tip;
        let count = match profile.cone {
            Some(slope) => top * (1.0 + 1.0 / (slope * slope)).sqrt(),
            None => profile.corner * (1.0 - top / profile.corner).acos(),
        };
        let count = (count / stock.cell).ceil().clamp(BANDS[0], BANDS[1]) as usize;
        self.below.clear();
        for k in 0..count {
            let band = band(profile, top, k, count);
            if band.to <= lowest {
                continue;
            }
            self.contacts_of(stock, stand, &band, motion);
            match same(&self.arcs, &self.below) {
                true => {
                    let first = found.contacts.len() - self.arcs.len();
                    for contact in &mut found.contacts[first..] {
                        contact.to_mm = band.to;
                    }
                }
                false => {
                    let from = band.from.max(lowest);
                    let contact = |arc: &[f64; 2]| Contact::side(from, band.to, arc[0], arc[1]);
                    found.contacts.extend(self.arcs.iter().map(contact));
                }
            }
            std::mem::swap(&mut self.arcs, &mut self.below);
        }
    }

    fn contacts_of(&mut self, stock: &Stock, stand: &Stand, band: &Band, motion: [f64; 2]) {
        let Some(range) = Range::facing(band.normal, motion, band.radius, stock.cell) else {
            self.arcs.clear();
            return;
        };
        let tolerance = stock.tolerance();
        let (nodes, first, size, known) = (&self.nodes, self.first, self.size, stock.known());
        let value = |direction: [f64; 2]| {
            let Some(cell) = Cell::at(stock, stand.place(band.radius, direction)) else {
                return -stock.cell;
            };
            let (i, j) = (cell.i.wrapping_sub(first[0]), cell.j.wrapping_sub(first[1]));
            if i >= size[0] - 1 || j >= size[1] - 1 {
                return -stock.cell;
            }
            let corner = j * size[0] + i;
            let mut sum = 0.0;
            for (k, index) in [corner, corner + 1, corner + size[0], corner + size[0] + 1]
                .iter()
                .enumerate()
            {
                sum += cell.shares[k] * nodes[*index].over_at(band, known);
            }
            sum - tolerance
        };
        range.arcs(value, &mut self.arcs);
    }

    /// Takes what is known of the points under the tool.
    fn look(&mut self, stock: &Stock, stand: &Stand, profile: &Profile, upwards: f64) {
        self.nodes.clear();
        self.size = [1, 1];
        self.highest = 0.0;
        let above = stock.height - stand.tip;
        if above <= 0.0 {
            return;
        }
        let top = above.min(profile.shoulder());
        let widest = profile.reach(top).min(profile.radius(top));
        let reach = widest + 2.0 * stock.cell;
        let bounds = |axis: usize| {
            let index = |value: f64| (value - stock.origin[axis]) / stock.cell;
            let most = stock.points[axis] as f64;
            let low = index(stand.centre[axis] - reach).floor().max(0.0).min(most) as usize;
            let high = (index(stand.centre[axis] + reach).ceil() + 1.0)
                .max(0.0)
                .min(most);
            [low, high as usize]
        };
        let ([i0, i1], [j0, j1]) = (bounds(0), bounds(1));
        if i1 < i0 + 2 || j1 < j0 + 2 {
            return;
        }
        self.first = [i0, j0];
        self.size = [i1 - i0, j1 - j0];
        let (known, steep_from) = (stock.known(), profile.steep_from());
        let reach_square = reach * reach;
        // A tool that does not go down has nothing to cut behind its axis.
        let behind = if upwards < 0.0 {
            -2.0 * reach
        } else {
            -1.5 * stock.cell
        };
        for j in j0..j1 {
            let dy = stock.origin[1] + j as f64 * stock.cell - stand.centre[1];
            for i in i0..i1 {
                let column = &stock.columns[j * stock.points[0] + i];
                let dx = stock.origin[0] + i as f64 * stock.cell - stand.centre[0];
                let square = dx * dx + dy * dy;
                if square > reach_square || dx * stand.feed[0] + dy * stand.feed[1] < behind {
                    self.nodes.push(Node::default());
                    continue;
                }
                let radius = square.sqrt();
                let top = match column.top > 0.0 {
                    true => f64::from(column.top) - stand.tip,
                    false => f64::NEG_INFINITY,
                };
                let top = match stand.slope != 0.0 && radius > profile.outer {
                    true => top - stand.floor_above(stock.place(i, j), profile.outer),
                    false => top,
                };
                let over = match radius <= steep_from {
                    true => top - profile.height(radius),
                    false => profile.radius(top) - radius,
                };
                let (drop, rise) = (f64::from(column.drop), f64::from(column.rise));
                if over > -known && top > self.highest {
                    self.highest = top;
                }
                let near = 0.999 * known;
                self.nodes.push(Node {
                    over,
                    top,
                    drop: if drop < near {
                        drop - radius
                    } else {
                        f64::INFINITY
                    },
                    rise: if rise < near {
                        -rise - radius
                    } else {
                        f64::NEG_INFINITY
                    },
                });
            }
        }
    }
}

impl Node {
    /// Positive in the material, for a band.
    #[inline]
    fn over_at(&self, band: &Band, known: f64) -> f64 {
        match self.top > band.height {
            true => {
                let wall = self.drop + band.radius;
                let wall = if wall < 2.0 * known {
                    wall
                } else {
                    2.0 * known
                };
                if self.over < wall { self.over } else { wall }
            }
            false => {
                let wall = self.rise + band.radius;
                let wall = if wall > -2.0 * known {
                    wall
                } else {
                    -2.0 * known
                };
                if self.over > wall { self.over } else { wall }
            }
        }
    }
}

/// Returns one of the bands of equal length along the meridian up to a height.
fn band(profile: &Profile, top: f64, k: usize, count: usize) -> Band {
    let share = |k: f64| k / count as f64;
    let (at, middle) = (k as f64, k as f64 + 0.5);
    match profile.cone {
        Some(slope) => {
            let height = |k: f64| top * share(k);
            Band {
                from: height(at),
                to: height(at + 1.0),
                radius: profile.end + height(middle) / slope,
                height: height(middle),
                normal: slope.atan(),
            }
        }
        None => {
            let most = (1.0 - top / profile.corner).acos();
            let height = |k: f64| match share(k) < 1.0 {
                true => profile.corner * (1.0 - (most * share(k)).cos()),
                false => top,
            };
            let normal = most * share(middle);
            Band {
                from: height(at),
                to: height(at + 1.0),
                radius: profile.end + profile.corner * normal.sin(),
                height: height(middle),
                normal,
            }
        }
    }
}
